"""Bodies: what they are made of (constant) and how they move (varying). Floes first, structures last."""

from typing import NamedTuple

import numpy as np


class Solids(NamedTuple):
    """Mass, elasticity and friction of n bodies; fixed bodies and structures have zero inverse mass and inertia.

    What a structure gives way by, its support has: `give`, about its place, which `seat` leads to.
    """

    inverse_mass: np.ndarray  # (n,) 1/kg
    mass: np.ndarray  # (n,) kg
    inertia: np.ndarray  # (n, 3, 3) body frame, about the centroid, kg m2
    inverse_inertia: np.ndarray  # (n, 3, 3) body frame, 1/(kg m2)
    compliance: np.ndarray  # (n,) (1 - nu^2)/E, 1/Pa: a body's term of Liu 2015, Eq. (7)
    friction: np.ndarray  # (n,) mu of Liu 2015, Eq. (6), of a structure with ice; that of ice on ice for a body that floats
    carried: np.ndarray  # (n,) whether it is part of a structure that moves
    give: np.ndarray  # (n, 2) of the support of its structure: inverse mass 1/kg along x and y, 1/(kg m2) about z
    floe: np.ndarray  # (n,) of a body that is part of a floe of several: a number that the parts share; -1 = it is one by itself
    seat: np.ndarray  # (n, 3) m, from the place of a structure that moves to the body's centroid, in the body's frame


#: `Solids` that take water along, which resists being accelerated with them. `inverse_mass` is that of body and water together
#: along x and y, and so are `inertia` and `inverse_inertia`; `mass` is the body's own. A class of its own, so that kernels know
#: nothing of it where no body has any.
WateredSolids = NamedTuple("WateredSolids", [
    *Solids.__annotations__.items(),
    ("inverse_heave_mass", np.ndarray),  # (n,) 1/kg, of body and water along z
    ("added_mass", np.ndarray),  # (n, 2) kg, of the water: along x and y, along z
    ("added_inertia", np.ndarray),  # (n,) kg m2, of the water, about any axis across the body's z axis
])  # fmt: skip


def joined_rows(floe: np.ndarray) -> np.ndarray:
    """(j, 2) first body of each floe of several parts, and the body behind its last one; floe (n,) as in `Solids`."""
    bounds = np.flatnonzero(np.diff(floe, prepend=-1, append=-1))
    rows = [(first, last) for first, last in zip(bounds[:-1], bounds[1:], strict=True) if floe[first] >= 0]
    return np.array(rows, np.int64).reshape(-1, 2)


class Ids(NamedTuple):
    """Numbers of the bodies that float, as users know them. A row may stand for another body once some have come or gone."""

    body: np.ndarray  # (floating,)


class Bodies(NamedTuple):
    """Motion of n bodies at the same instant, and the loads that act on them."""

    position: np.ndarray  # (n, 3) centroid, m
    orientation: np.ndarray  # (n, 4) unit quaternion, body to world
    velocity: np.ndarray  # (n, 3) m/s
    angular_velocity: np.ndarray  # (n, 3) world axes, rad/s
    angular_momentum: np.ndarray  # (n, 3) world axes, about the centroid, kg m2/s
    middle_velocity: np.ndarray  # (n, 3) velocity half a step ago: displacement of the last step / dt
    middle_angular_velocity: np.ndarray  # (n, 3)
    middle_angular_momentum: np.ndarray  # (n, 3)
    force: np.ndarray  # (n, 3) N, all loads
    torque: np.ndarray  # (n, 3) N m about the centroid
    contact_force: np.ndarray  # (n, 3) N, contacts only
    contact_torque: np.ndarray  # (n, 3) N m
    contact_count: np.ndarray  # (n,) contacts at this instant
    path: np.ndarray  # (n,) m: bound on the distance any point of the body has moved, in the frame of `Pairs.frame`
    power: np.ndarray  # (n, works) W of the loads in `water.loads.WORKS`
    work: np.ndarray  # (n, works) J done by them since the start


def bodies_at_rest(count: int, works: int) -> Bodies:
    """n bodies at the origin, unturned, at rest, without loads; works: loads whose work is booked."""
    orientation = np.zeros((count, 4))
    orientation[:, 0] = 1.0
    shapes = {"orientation": orientation, "contact_count": np.zeros(count, np.int64)}
    shapes |= {"path": np.zeros(count), "power": np.zeros((count, works)), "work": np.zeros((count, works))}
    return Bodies(**{name: shapes.get(name, np.zeros((count, 3))) for name in Bodies._fields})
