"""Contact model `consistent`: one elastic energy per pair, a smooth function of the pose, and the force as its exact gradient.

`cap` picks what of each body faces the other; `point`, `line` and `face` (`four`: of four corners) give the energy of every
feature that presses, `rim` bounds for it; `join` makes one energy, one force and one moment of them; `press` adds damping. The
theory is in docs/theory.md.
"""
