"""What is asked of the contact model `consistent` beyond single closed forms, by validation/contact_lab and validation/half_space.

- Kinetic energy of 1000 elastic, frictionless collisions of random floes: median change 0.5 %, worst 2 %.
- Collisions of two floes at one level, or nearly: change 0.2 % at the automatic step, less at half of it; no spin that symmetry
  forbids.
- Work around closed loops of poses: at most 1 % of the peak stored energy.
- Force and moment along paths from face over edge to corner: a change for a turn of 1e-5 rad shrinks with the turn. Of the force it
  is at most 1 %, or what the far end of a 2.8 m side presses more or less by then: 27 um of 1 mm.
- Force within 5 % of the pieces of elasticity where a contact is a pure point, line or face; the same against a boundary-element
  half space, and within 30 % in between.
"""

from functools import cache, partial
from math import inf

import numpy as np
import pytest

from tests.verification import half_space_poses as half_space
from tests.verification.comparison import Comparison, check
from validation.contact_lab import collisions, loops, overlaps, random_collisions, tilts

MODEL = "consistent"
LAB, HALF_SPACE = "contact_lab", "half_space"
COLLISIONS, LOOPS_OF_A_KIND = 1000, 50
#: collisions that are tested in one go; each part keeps the bounds of all
PART = 250
#: largest change for a turn of tilts.FINEST, 1e-4 of that for tilts.STEP where nothing jumps
CONTINUOUS = 1e-5
#: rad, of the first search of a path
SCAN = 1e-4
#: travel of a side's far end in a turn of tilts.STEP, over the overlap
TRAVEL = 2.72 * tilts.STEP / tilts.OVERLAP
PURE, BETWEEN = 0.05, 0.3
ROUND_OFF = 1e-12  # rad/s, for spins of 0.1 rad/s


def row(what: str, result: float, tolerance: float, *, target: float = 0.0, case: str = LAB) -> Comparison:
    return Comparison(case, what, target, float(result), tolerance, scale=1.0, model=MODEL)


def compare_random_collisions(numbers: range = range(COLLISIONS)) -> list[Comparison]:
    change = np.abs(random_collisions.kept_energies(MODEL, numbers) - 1.0)
    assert len(change) == len(numbers)
    return [
        row(f"{len(numbers)} random collisions: median change of kinetic energy", np.median(change), 0.005),
        row(f"{len(numbers)} random collisions: largest change of kinetic energy", change.max(), 0.02),
    ]


def compare_level_collisions() -> list[Comparison]:
    found = {meeting: [collisions.impact(MODEL, meeting, share) for share in (1.0, 0.5)] for meeting in collisions.MEETINGS}
    whole, half = (np.array([impacts[i].kept - 1.0 for impacts in found.values()]) for i in range(2))
    spin = [collisions.forbidden_spin(meeting, impacts[0]) for meeting, impacts in found.items()]
    of = f"{len(found)} level collisions"
    return [
        row(f"{of}: largest change of kinetic energy", np.abs(whole).max(), 0.002),
        row(f"{of}: the same at half the step", np.abs(half).max(), 0.002),
        row(f"{of}: r.m.s. change at half the step, over that at the step", np.sqrt((half**2).mean() / (whole**2).mean()), 1.0),
        row(f"{of}: spin against symmetry, rad/s", max(s for s in spin if s is not None), ROUND_OFF),
    ]


def compare_loops(kind: loops.Kind) -> list[Comparison]:
    net = [abs(each.net) for each in loops.balances(MODEL, kind, LOOPS_OF_A_KIND)]
    return [row(f"{len(net)} closed loops, {kind.name}: largest net work, of the peak energy", max(net), loops.ALLOWED)]


def compare_path(roll: tilts.Roll, fixed_height: bool) -> list[Comparison]:
    probe = roll.probe(MODEL)
    end = tilts.FIXED_HEIGHT_END if fixed_height else 0.5 * np.pi
    poses_at = partial(roll.poses, probe, fixed_height=fixed_height)
    jumps = tilts.largest_jumps(probe, poses_at, end, roll.roller, scan=SCAN)
    of = f"{roll.title}, {'centroid' if fixed_height else 'overlap'} fixed"
    return [row(f"{of}: force per 1e-5 rad", jumps[0].change, max(0.01, TRAVEL))] + [
        row(f"{of}: {load} per 1e-9 rad", jump.narrowed, CONTINUOUS) for load, jump in zip(("force", "moment"), jumps, strict=True)
    ]


def compare_pieces(meeting: overlaps.Meeting) -> list[Comparison]:
    ratios = zip(overlaps.TABLE, overlaps.over_piece(MODEL, meeting), strict=True)
    return [row(f"{meeting.name}, {1e3 * deep:g} mm: force over {meeting.piece}", r, PURE, target=1.0) for deep, r in ratios]


@cache
def _half_space_rows(group: str) -> list[half_space.Row]:
    """Of a family; crossings on the pile, and faces smaller than a corner's contact, are groups of their own."""
    family, _, special = group.partition(", ")
    return [
        each
        for each in half_space.rows(family)
        if special == ("on the pile" if each.on_pile else "smaller than a corner's contact" if each.tiny else "")
    ]


#: groups of poses of half_space/reference.csv, and whether they are pressed on a pile instead
GROUPS = {
    "tilted edge": False, "rolled face": False, "strip": False, "square": False, "crossing": False,
    "square, smaller than a corner's contact": False, "crossing, on the pile": False, "tilted edge, along the pile": True,
}  # fmt: skip


def compare_half_space(group: str) -> list[Comparison]:
    pile = GROUPS[group]
    chosen = _half_space_rows("tilted edge" if pile else group)
    found = []
    for pure in (True, False):
        some = [each for each in chosen if each.pure == pure]
        if some:
            allowed = inf if some[0].tiny else PURE if pure else BETWEEN
            what = f"{group}, {'pure' if pure else 'in between'}, worst of {len(some)}: force over that of the half space"
            found.append(row(what, half_space.farthest(some, pile=pile), allowed, target=1.0, case=HALF_SPACE))
    return found


PATHS = [(roll, fixed_height) for roll in tilts.ROLLS for fixed_height in (False, True)]


def compare() -> list[Comparison]:
    rows = compare_random_collisions() + compare_level_collisions()
    rows += [each for kind in loops.KINDS for each in compare_loops(kind)]
    rows += [each for path in PATHS for each in compare_path(*path)]
    rows += [each for meeting in overlaps.MEETINGS for each in compare_pieces(meeting)]
    return rows + [each for group in GROUPS for each in compare_half_space(group)]


@pytest.mark.parametrize("first", range(0, COLLISIONS, PART))
def test_random_collisions(first):
    check(compare_random_collisions(range(first, first + PART)))


def test_level_collisions():
    check(compare_level_collisions())


@pytest.mark.parametrize("kind", loops.KINDS, ids=lambda kind: kind.name)
def test_loops(kind):
    check(compare_loops(kind))


PATH_NAMES = [f"{roll.name}-{'centroid' if fixed_height else 'overlap'}" for roll, fixed_height in PATHS]


@pytest.mark.parametrize("path", PATHS, ids=PATH_NAMES)
def test_no_jumps(path):
    check(compare_path(*path))


@pytest.mark.parametrize("meeting", overlaps.MEETINGS, ids=lambda meeting: meeting.name)
def test_pieces(meeting):
    check(compare_pieces(meeting))


@pytest.mark.parametrize("group", GROUPS)
def test_half_space(group):
    check(compare_half_space(group))
