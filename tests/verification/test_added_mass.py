"""Boxes that take water along: heave T = 2 pi sqrt((m + M)/(rho_w g A)), roll T = 2 pi sqrt((I + J)/(m g GM)), whole or cut into
parts that are one floe.

Of a thin disc with the same plan area, a = sqrt(A/pi): M = 4/3 rho_w a^3, J = 8/45 rho_w a^5. I and GM as in test_floating_box.
"""

from math import pi, sqrt
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest import mock

import numpy as np
import pytest

from dilatedem.case.schema import Case
from dilatedem.field import survey
from dilatedem.field.partition import Part
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status
from tests.verification.comparison import Comparison, check, follow, start, zero_crossings

CASE = "added_mass"
BOXES = ((2.8, 0.5), (10.0, 1.0))
#: parts along x and y that the smaller box is cut into
PIECES = ((2, 1), (2, 2))
#: m, by which boxes are lifted
LIFT = 0.01
ICE, WATER, GRAVITY = 915.0, 1025.0, 9.81


def heave(width: float, height: float, added: float) -> float:
    mass, radius = ICE * width**2 * height, width / sqrt(pi)
    return 2 * pi * sqrt((mass + added * 4 / 3 * WATER * radius**3) / (WATER * GRAVITY * width**2))


def roll(width: float, height: float, added: float) -> float:
    mass, draft, radius = ICE * width**2 * height, height * ICE / WATER, width / sqrt(pi)
    metacentre = width**2 / (12 * draft) - 0.5 * (height - draft)
    inertia = mass * (width**2 + height**2) / 12 + added * 8 / 45 * WATER * radius**5
    return 2 * pi * sqrt(inertia / (mass * GRAVITY * metacentre))


def periods(*overrides: str) -> list[float]:
    simulation = start(CASE, *overrides)
    levels = simulation.state.bodies.position[:2, 2] - LIFT

    def read(simulation):
        bodies = simulation.state.bodies
        return *(bodies.position[:2, 2] - levels), bodies.orientation[2, 1]

    times, seen = follow(simulation, 15.0, read, every=100)
    return [float(2 * np.diff(zero_crossings(times, seen[:, i])).mean()) for i in range(3)]


def cut(pieces: tuple[int, int]):
    """Cuts a square into so many rectangles along x and y, as if it were not convex."""

    def parts(polygon) -> list[Part]:
        low, high = np.array(polygon.bounds[:2]), np.array(polygon.bounds[2:])
        size = (high - low) / pieces
        found = []
        for column, row in np.ndindex(pieces):
            corners = low + size * ([column, row] + np.array([[0, 0], [1, 0], [1, 1], [0, 1]]))
            sides = np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)
            middle = sides.mean(axis=1)
            within = ((middle > low + 1e-9) & (middle < high - 1e-9)).all(axis=1)
            found.append(Part(corners, sides[within]))
        return found

    return parts


def square(pieces: tuple[int, int] = (1, 1), added: bool = True) -> Simulation:
    """The smaller box as a floe of a file, cut into so many parts along x and y, in still water without drag."""
    rows = ["floe,x,y"]
    rows += [f"0,{0.5 * x * BOXES[0][0]},{0.5 * y * BOXES[0][0]}" for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    with TemporaryDirectory() as folder, mock.patch.object(survey, "_whole", cut(pieces)):
        file = Path(folder) / "floes.csv"
        file.write_text("\n".join(rows))
        return Simulation.of_case(Case.model_validate({
            "domain": {"size": [80.0, 40.0]}, "ice": {"dilated_radius": 1e-4}, "contact": {"damping": 0.0},
            "field": {"source": "file", "file": str(file), "tolerance": 0.0},
            "water": {"velocity": [0.0, 0.0], "drag_force_coefficient": 0.0, "drag_moment_coefficient": 0.0, "added_mass": added},
        }))  # fmt: skip


def period_in_parts(pieces: tuple[int, int], added: bool) -> float:
    """Of heave [s], by the steps of a floe of parts that are joined."""
    simulation = square(pieces, added)
    bodies, parts = simulation.state.bodies, simulation.model.floating
    assert simulation.model.joined.tolist() == [[0, parts]] and parts == pieces[0] * pieces[1]
    level = float(bodies.position[0, 2])
    bodies.position[:parts, 2] += LIFT
    assert simulation.evaluate() == Status.DONE
    times, seen = follow(simulation, 15.0, lambda simulation: simulation.state.bodies.position[:parts, 2] - level, every=100)
    assert not np.ptp(seen, axis=1).any(), "all parts are where the floe is"
    return float(2 * np.diff(zero_crossings(times, seen[:, 0])).mean())


def compare() -> list[Comparison]:
    found, without = periods(), periods("water.added_mass=false")
    rows = [
        Comparison(CASE, f"heave period of {width:g} m x {height:g} m, {how}, s", heave(width, height, added), periods_found[i])
        for i, (width, height) in enumerate(BOXES)
        for how, added, periods_found in (("alone", 0.0, without), ("with its water", 1.0, found))
    ]
    rows += [
        Comparison(CASE, f"heave period of 2.8 m x 0.5 m in {x * y} parts, {how}, s", heave(*BOXES[0], added),
                   period_in_parts((x, y), bool(added)))
        for x, y in PIECES
        for how, added in (("alone", 0.0), ("with its water", 1.0))
    ]  # fmt: skip
    return [*rows, Comparison(CASE, "roll period of 2.8 m x 0.5 m, with its water, s", roll(*BOXES[0], 1.0), found[2])]


def test_added_mass():
    check(compare())


def test_targets_of_the_specification():
    targets = [heave(*box, added) for box in BOXES for added in (0.0, 1.0)]
    assert [round(target, 4) for target in targets] == [1.3402, 2.12, 1.8954, 3.6371]


@pytest.mark.parametrize("pieces", PIECES)
def test_a_floe_cut_into_parts_takes_along_what_it_does_uncut(pieces):
    whole, simulation = square().model.solids, square(pieces)
    solids = simulation.model.solids
    for name in ("inverse_mass", "inverse_heave_mass", "inertia", "inverse_inertia"):
        found, asked = getattr(solids, name), getattr(whole, name)
        assert np.abs(found - asked[0]).max() < 1e-3 * np.abs(asked[0]).max(), name
    for name in ("added_mass", "added_inertia"):
        assert getattr(solids, name).sum(axis=0) == pytest.approx(getattr(whole, name)[0], rel=1e-3)
    stiffness = WATER * GRAVITY * simulation.model.hulls.plan[:, 0].sum()
    for part in range(simulation.model.floating):
        assert 2 * pi / sqrt(solids.inverse_heave_mass[part] * stiffness) == pytest.approx(heave(*BOXES[0], 1.0), rel=1e-3)
