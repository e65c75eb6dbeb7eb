"""The stages of a time step, by name and number, in their order."""

STAGES = ("search", "foresee", "drift", "wake", "collide", "float", "record", "stride", "idle")
SEARCH, FORESEE, DRIFT, WAKE, COLLIDE, FLOAT, RECORD, STRIDE, IDLE = range(len(STAGES))
