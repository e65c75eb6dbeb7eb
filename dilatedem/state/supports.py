"""What carries structures: how those that are not held may move (constant), and how far they have moved (varying).

A structure that moves is one rigid body in plan: its place shifts along x and y, and it turns about the upright axis through it.
These three are the columns of most arrays here: metres (or N), metres (or N), radians (or N m).
"""

from enum import IntEnum
from typing import NamedTuple

import numpy as np


class Carried(IntEnum):
    """How a structure is carried."""

    HELD = 0
    DRIVEN = 1  # as a table of time says, whatever the ice does
    SPRUNG = 2  # on springs and dashpots, with a mass of its own


class Supports(NamedTuple):
    """Of s records (`state.records`), of which m move by themselves, with p bodies together; constant during a run.

    A structure that is a part of another is carried as that one is, and has no mass, springs or table of time; a sum of several
    structures stays where it is.
    """

    moving: np.ndarray  # (m,) the structures that move, without those that are parts of others
    kind: np.ndarray  # (s,) Carried
    place: np.ndarray  # (s, 3) m, of each at rest: about it moments are stated
    inverse_mass: np.ndarray  # (s, 3) 1/kg, 1/kg, 1/(kg m2); 0 = no load moves it
    stiffness: np.ndarray  # (s, 3) N/m, N/m, N m/rad
    damping: np.ndarray  # (s, 3) N s/m, N s/m, N m s/rad
    part_start: np.ndarray  # (m + 1,) first body of each structure that moves
    part: np.ndarray  # (p,) bodies, counted from the first that belongs to a structure
    seat: np.ndarray  # (p, 3) m, from the structure's place to a part's centroid, at rest
    upright: np.ndarray  # (p, 4) orientation of a part at rest
    knot_start: np.ndarray  # (s + 1,) first row of each structure's table of time
    knot_time: np.ndarray  # (k,) s
    knot: np.ndarray  # (k, 3) displacement
    slope: np.ndarray  # (k, 3) and its rate


def all_held(place: np.ndarray) -> Supports:
    """None of the structures at `place` (s, 3) [m] moves."""
    none, fixed = np.zeros(0, np.int64), np.zeros(place.shape)
    return Supports(
        moving=none, kind=np.zeros(len(place), np.int64), place=place, inverse_mass=fixed, stiffness=fixed, damping=fixed,
        part_start=np.zeros(1, np.int64), part=none, seat=np.zeros((0, 3)), upright=np.zeros((0, 4)),
        knot_start=np.zeros(len(place) + 1, np.int64), knot_time=np.zeros(0), knot=np.zeros((0, 3)), slope=np.zeros((0, 3)),
    )  # fmt: skip


class Excursions(NamedTuple):
    """How far s records are from their places, how fast, under what loads, and what that took."""

    center: np.ndarray  # (s, 3) m, where the place of each is now: about it moments are stated
    displacement: np.ndarray  # (s, 3)
    velocity: np.ndarray  # (s, 3)
    middle_velocity: np.ndarray  # (s, 3) half a step ago: displacement of the last step / dt
    ice: np.ndarray  # (s, 3) load of the ice
    dashpot: np.ndarray  # (s, 3) force of the dashpots on the structure
    force: np.ndarray  # (s, 3) all loads on one that is sprung
    work: np.ndarray  # (s,) J that its drive has done since the start
    loss: np.ndarray  # (s,) J lost in its dashpots since the start


def excursions_at_start(place: np.ndarray, velocity: np.ndarray) -> Excursions:
    """Structures at their places (s, 3) [m], those that are driven with their velocity (s, 3)."""
    zeros = {name: np.zeros(place.shape) for name in Excursions._fields}
    own = {"center": place.copy(), "velocity": velocity.copy(), "middle_velocity": velocity.copy()}
    return Excursions(**zeros | own | {"work": np.zeros(len(place)), "loss": np.zeros(len(place))})


def reaction(supports: Supports, excursions: Excursions) -> np.ndarray:
    """(s, 3) what each structure that moves passes on to what carries it: force of springs and dashpots, or the load of the ice."""
    bent = supports.stiffness * excursions.displacement + supports.damping * excursions.velocity
    return np.where(supports.kind[:, None] == Carried.SPRUNG, bent, excursions.ice)


def support_energies(supports: Supports, excursions: Excursions) -> dict[str, float]:
    """The ledger's terms of supports [J], by name; those of springs where some structure is sprung."""
    found = {"work_structure": float(excursions.work.sum())}
    if (supports.kind == Carried.SPRUNG).any():
        give = supports.inverse_mass
        mass = np.divide(1.0, give, out=np.zeros(give.shape), where=give > 0.0)
        found["structure_kinetic"] = 0.5 * float((mass * excursions.velocity**2).sum())
        found["structure_elastic"] = 0.5 * float((supports.stiffness * excursions.displacement**2).sum())
        found["loss_support"] = float(excursions.loss.sum())
    return found
