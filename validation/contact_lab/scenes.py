"""The bodies of the laboratory, and cases of two of them: no weight, no water, no friction, no damping unless asked for."""

from dilatedem.case.schema import Case

#: contact models that are run, in the order of the columns
MODELS = ("liu2015", "consistent")
#: columns of the tables; a model that is not run leaves its cells empty
COLUMNS = ("liu2015", "consistent")

HALF_CUBE, HALF_FLOE = 0.25, 1.4  # m
_ENDS = (-HALF_CUBE, HALF_CUBE)
#: core of 0.5 m, hence edges of 0.5 m and faces of 0.25 m2, dilated by 0.04 m
CUBE = {"vertices": [[x, y, z] for x in _ENDS for y in _ENDS for z in _ENDS]}
#: 2.8 m x 2.8 m x 0.5 m, dilated radius 0.04 m
FLOE = {
    "outline": [[-HALF_FLOE, -HALF_FLOE], [HALF_FLOE, -HALF_FLOE], [HALF_FLOE, HALF_FLOE], [-HALF_FLOE, HALF_FLOE]],
    "thickness": 0.5,
}
SPHERE = {"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": 0.5}
#: of steel, at the origin
PILE = {"kind": "pile", "center": [0.0, 0.0], "radius": 2.0}
PILE_RADIUS = 2.0

#: m, side of the domain: copies of it side by side are out of each other's reach
SIDE = 16.0
#: where nothing is set: far enough apart for two floes, in reach of each other's list of neighbours
APART = ((-1.5, 0.0, 0.0), (1.5, 0.0, 0.0))


def scene(
    model: str, *solids: dict, damping: float = 0.0, damping_law: str = "viscous", speeds=(0.0, 0.0), crushing: float | None = None
) -> Case:
    """A case of two bodies, or of a body and a structure; speeds: of the bodies along x at the start [m/s]; crushing: pressure
    [Pa], if the ice crushes."""
    bodies = [solid for solid in solids if "kind" not in solid]
    placed = [
        {"position": list(place), "velocity": [speed, 0.0, 0.0]} | body
        for body, place, speed in zip(bodies, APART, speeds, strict=False)
    ]
    return Case.model_validate(
        {
            "domain": {"size": [SIDE, SIDE]},
            "field": {"source": "bodies"},
            "water": {"enabled": False},
            "gravity": {"acceleration": 0.0},
            "ice": {} if crushing is None else {"crushing_pressure": crushing},
            "contact": {"model": model, "damping": damping, "damping_law": damping_law, "friction": 0.0},
            "structure": [solid for solid in solids if "kind" in solid],
            "body": placed,
        }
    )
