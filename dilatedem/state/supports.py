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
    MODAL = 3  # on a beam that swings in some of its modes


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


#: `Supports` of which some are beams, with k modes together: a class of its own, so that kernels know nothing of beams where there
#: are none. Inverse mass, stiffness and damping of a beam are those of an oscillator that bounds all its modes together: the sum of
#: their 1/m at the place that ice pushes, and the frequency and the damping of the fastest.
ModalSupports = NamedTuple("ModalSupports", [
    *Supports.__annotations__.items(),
    ("mode_start", np.ndarray),  # (s + 1,) first mode of each record
    ("mode_shape", np.ndarray),  # (k, 2) 1/sqrt(kg), modes along x and y: how far the place that ice pushes goes, modal mass 1
    ("mode_square", np.ndarray),  # (k, 2) 1/s2, frequencies squared
    ("mode_damping", np.ndarray),  # (k, 2) 1/s, twice the damping ratio times the frequency
    ("mode_shear", np.ndarray),  # (k, 2) sqrt(kg), of which its acceleration keeps a part of the load from the foot
    ("mode_moment", np.ndarray),  # (k, 2) sqrt(kg) m, and of its moment about the foot
    ("push_height", np.ndarray),  # (s,) m, of the place that ice pushes above the foot
])  # fmt: skip


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


#: `Excursions` of which some are of beams, with k modes together.
ModalExcursions = NamedTuple("ModalExcursions", [
    *Excursions.__annotations__.items(),
    ("mode", np.ndarray),  # (k, 2) sqrt(kg) m, along x and along y
    ("mode_rate", np.ndarray),  # (k, 2) sqrt(kg) m/s
    ("mode_middle_rate", np.ndarray),  # (k, 2) half a step ago
    ("mode_dashpot", np.ndarray),  # (k, 2) force of its damping
    ("mode_force", np.ndarray),  # (k, 2) all forces: its acceleration
    ("foot", np.ndarray),  # (s, 4) N and N m, what the foot bears: force along x and y, moment about x and y
    ("foot_most", np.ndarray),  # (s, 2) N, N m, size of both at most, over the steps of the open window of loads
])  # fmt: skip


def excursions_at_start(place: np.ndarray, velocity: np.ndarray) -> Excursions:
    """Structures at their places (s, 3) [m], those that are driven with their velocity (s, 3)."""
    zeros = {name: np.zeros(place.shape) for name in Excursions._fields}
    own = {"center": place.copy(), "velocity": velocity.copy(), "middle_velocity": velocity.copy()}
    return Excursions(**zeros | own | {"work": np.zeros(len(place)), "loss": np.zeros(len(place))})


def with_modes(supports: Supports, excursions: Excursions) -> Excursions:
    """The same with modes at rest, where there are beams."""
    if not isinstance(supports, ModalSupports):
        return excursions
    modes, feet = (np.zeros(supports.mode_shape.shape) for _ in range(5)), len(supports.push_height)
    return ModalExcursions(*excursions, *modes, np.zeros((feet, 4)), np.zeros((feet, 2)))


def reaction(supports: Supports, excursions: Excursions) -> np.ndarray:
    """(s, 3) what each structure that moves passes on to what carries it: force of springs and dashpots, or the load of the ice.

    Of a beam its foot's along x and y, and 0 about z.
    """
    bent = supports.stiffness * excursions.displacement + supports.damping * excursions.velocity
    found = np.where(supports.kind[:, None] == Carried.SPRUNG, bent, excursions.ice)
    if isinstance(supports, ModalSupports):
        foot = np.column_stack([excursions.foot[:, :2], np.zeros(len(found))])
        found = np.where(supports.kind[:, None] == Carried.MODAL, foot, found)
    return found


def beam_loads(supports: Supports, excursions: Excursions) -> np.ndarray:
    """(s, 4) of each structure on a beam, 0 of all others: moment of its foot about x and y, and the size of its force and of its
    moment at most in the open window of loads [N m, N m, N, N m]; (s, 0) where none is on a beam."""
    if not isinstance(supports, ModalSupports):
        return np.zeros((len(supports.kind), 0))
    return np.column_stack([excursions.foot[:, 2:], excursions.foot_most])


def support_energies(supports: Supports, excursions: Excursions) -> dict[str, float]:
    """The ledger's terms of supports [J], by name; those of springs and beams where some structure is on such."""
    found = {"work_structure": float(excursions.work.sum())}
    is_sprung = supports.kind[:, None] == Carried.SPRUNG
    give, stiffness = np.where(is_sprung, supports.inverse_mass, 0.0), np.where(is_sprung, supports.stiffness, 0.0)
    mass = np.divide(1.0, give, out=np.zeros(give.shape), where=give > 0.0)
    kinetic = 0.5 * float((mass * excursions.velocity**2).sum())
    elastic = 0.5 * float((stiffness * excursions.displacement**2).sum())
    if isinstance(supports, ModalSupports):
        kinetic += 0.5 * float((excursions.mode_rate**2).sum())
        elastic += 0.5 * float((supports.mode_square * excursions.mode**2).sum())
    elif not is_sprung.any():
        return found
    return found | {"structure_kinetic": kinetic, "structure_elastic": elastic, "loss_support": float(excursions.loss.sum())}
