"""What all rows of energy.csv say together: the residual beside the work of the loads and the energy turned over."""

import numpy as np
import pytest

import dilatedem
from dilatedem.numerics.balance import turned_over
from dilatedem.output.energies import Totals, work_up
from dilatedem.post.figures.energy import residual_share
from dilatedem.results.tables import read_table

FLOE = [[-4.9, -1.4], [-2.1, -1.4], [-2.1, 1.4], [-4.9, 1.7]]
NAMES = ["kinetic", "gravity", "buoyancy", "elastic", "work_drag", "work_structure", "loss_damping", "loss_friction", "gain_law"]


def row(time, **terms):
    return [time, 0.0, *(terms.get(name, 0.0) for name in NAMES)]


@pytest.mark.parametrize(("faster", "told"), [(0.0, False), (1e-6, False), (1e-3, True)])
def test_a_residual_is_no_share_of_a_work_that_is_round_off(faster, told, tmp_path):
    run = dilatedem.run(
        {"field": {"source": "bodies"}, "body": [{"outline": FLOE, "velocity": [0.3, 0.0, 0.0]}]}, tmp_path / "run",
        water={"velocity": [0.3 + faster, 0.0]}, time={"duration": 1.0},
    )  # fmt: skip
    share = run.summary["energy"]["residual_over_work"]
    assert (share is not None) == told
    assert not told or 0.0 <= share < 1e-4
    assert residual_share(read_table(tmp_path / "run/energy.csv")) == (pytest.approx(share, rel=1e-3) if told else None)


def test_what_turns_over_is_half_of_all_changes_whatever_the_batches():
    rows = [
        row(0.0, kinetic=100.0, gravity=-5000.0, buoyancy=5000.0),
        row(1.0, kinetic=40.0, gravity=-4000.0, buoyancy=4000.0, work_drag=20.0, loss_damping=50.0, loss_friction=30.0),
        row(2.0, kinetic=60.0, gravity=-5000.0, buoyancy=5000.0, work_drag=20.0, loss_damping=50.0, loss_friction=9.0),
    ]
    whole, parts = Totals(), Totals()
    work_up(rows, NAMES, whole)
    for one in rows:
        work_up([one], NAMES, parts)
    assert whole == parts
    assert whole.largest_turned_over == pytest.approx(0.5 * (60.0 + 20.0 + 50.0 + 30.0))  # bobbing trades weight for buoyancy
    assert whole.largest_stored == pytest.approx(10100.0)


def test_weight_alone_turns_over():
    assert turned_over({"gravity": np.array([-3.0]), "kinetic": np.array([3.0])}).tolist() == [3.0]


def test_a_body_that_flies_and_spins_freely_turns_nothing_over(tmp_path):
    """The error of its steps is all that changes: no share of it says anything."""
    corners = [[x, y, z] for x in (-1.4, 1.4) for y in (-0.7, 0.7) for z in (-0.2, 0.2)]
    run = dilatedem.run(
        {"field": {"source": "bodies"}, "body": [{"vertices": corners, "angular_velocity": [0.3, 5.0, 0.0]}]}, tmp_path / "run",
        water={"enabled": False}, gravity={"acceleration": 0.0}, time={"duration": 0.5},
    )  # fmt: skip
    energy = run.summary["energy"]
    assert 0.0 < energy["residual_J"] < 1e-6 * energy["kinetic_J"]
    assert energy["residual_over_turned_over"] is None
