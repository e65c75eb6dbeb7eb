"""The wind's drag on a floe and on a ball is that of its areas; its work is what the floe gains; without wind nothing changes."""

import csv

import numpy as np
import pytest

from dilatedem.case.schema import Case
from dilatedem.run import loop
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status

THICKNESS, SIDE = 0.5, 2.0
FREEBOARD = THICKNESS * (1.0 - 915.0 / 1025.0)
FLOE = {"outline": [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]}
#: an outline that is rounded has a little less of everything
ROUNDED = 0.01


def case_of(body: dict, wind=(0.0, 0.0), **more) -> Case:
    return Case.model_validate({
        "field": {"source": "bodies"}, "body": [body], "water": {"velocity": [0.0, 0.0], "drag_force_coefficient": 0.0, **more},
        "wind": {"velocity": list(wind)}, "time": {"duration": 5.0, "step_fraction": 0.5},
    })  # fmt: skip


def test_the_force_on_a_floe_is_that_of_its_skin_and_of_its_sides():
    simulation = Simulation.of_case(case_of(FLOE | {"velocity": [1.0, 0.0, 0.0]}, wind=(7.0, 8.0)))
    assert simulation.evaluate() == Status.DONE
    u = np.array([6.0, 8.0])
    skin, form = 0.002 * SIDE**2, 0.8 * 4.0 * SIDE / np.pi * FREEBOARD
    expected = 0.5 * 1.3 * 10.0 * u * (skin + form)
    np.testing.assert_allclose(simulation.state.bodies.force[0, :2], expected, rtol=ROUNDED)
    # it pushes the upper half, so that the lee side is pressed down
    top, level = 0.5 * THICKNESS, 0.5 * THICKNESS - FREEBOARD
    arm = (skin * top + form * 0.5 * (top + level)) / (skin + form)
    torque = simulation.state.bodies.torque[0, :2]
    np.testing.assert_allclose(torque, arm * np.array([-expected[1], expected[0]]), rtol=ROUNDED)


def test_a_ball_in_the_air_shows_its_great_circle():
    ball = {"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": 0.3, "position": [0.0, 0.0, 5.0]}
    simulation = Simulation.of_case(case_of(ball, wind=(10.0, 0.0)))
    assert simulation.evaluate() == Status.DONE
    radius = simulation.model.hulls.effective_radius[0]
    expected = 0.5 * 1.3 * 100.0 * np.pi * radius**2 * (0.002 + 0.8)
    assert simulation.state.bodies.force[0, 0] == pytest.approx(expected, rel=1e-12)
    assert radius == pytest.approx(0.3, rel=0.1)


def test_under_water_there_is_no_wind():
    sunk = FLOE | {"position": [0.0, 0.0, -2.0]}
    simulation = Simulation.of_case(case_of(sunk, wind=(10.0, 0.0)))
    assert simulation.evaluate() == Status.DONE
    assert simulation.state.bodies.force[0, 0] == 0.0


def test_its_work_is_what_the_floe_gains_and_stands_in_energy_csv(tmp_path):
    out = loop.run(case_of(FLOE, wind=(20.0, 0.0)), tmp_path / "run", quiet=True)
    with open(out / "energy.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    kinetic, work = float(rows[-1]["kinetic"]), float(rows[-1]["work_wind"])
    assert work > 5.0 and kinetic == pytest.approx(work, rel=0.02)
    assert max(abs(float(row["residual"])) for row in rows) < 1e-5 * work


def test_without_wind_there_is_neither_force_nor_column(tmp_path):
    out = loop.run(case_of(FLOE), tmp_path / "run", quiet=True)
    assert "work_wind" not in (out / "energy.csv").read_text()
    assert "kinetic" in (out / "energy.csv").read_text()
