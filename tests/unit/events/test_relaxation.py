"""The way to rest: a rigid block that is let go above a plate comes to lie on it, and what the stops take is in the ledger."""

import json

import pytest
from pydantic import ValidationError

from dilatedem.case.load import case_from
from dilatedem.case.schema import Case
from dilatedem.errors import SimulationStopped
from dilatedem.events.relaxation import imbalance, kinetic_energy
from dilatedem.results.tables import read_table
from dilatedem.run.loop import run
from dilatedem.run.simulation import Simulation

BLOCK = {
    "field": {"source": "bodies"}, "water": {"enabled": False}, "time": {"mode": "relax", "duration": 2.0, "residual": 1e-6},
    "structure": [{"kind": "plane", "name": "plate", "point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0]}],
    "body": [{"outline": [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], "position": [0.0, 0.0, 0.251]}],
    "output": {"snapshot_interval": 0.0, "energy_interval": 0.01},
}  # fmt: skip


def test_a_block_comes_to_rest(tmp_path):
    run(case_from(BLOCK, {}), tmp_path / "run", quiet=True)
    told = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert told["status"] == "completed" and told["simulated_s"] < 1.0
    relaxation = told["relaxation"]
    assert relaxation["settled"] and relaxation["residual"] <= 1e-6 and relaxation["stops"] > 1
    energy = read_table(tmp_path / "run" / "energy.csv")
    assert energy["loss_relax"][-1] > 0.0 and energy["kinetic"][-1] < 1e-9
    assert abs(energy["residual"]).max() < 1e-3 * energy["loss_relax"][-1]


def test_what_is_left_is_the_weight_where_nothing_bears_it():
    simulation = Simulation.from_case(BLOCK)
    simulation.evaluate()
    assert imbalance(simulation) == pytest.approx(1.0) and kinetic_energy(simulation) == 0.0


def test_a_case_that_finds_no_rest_says_so(tmp_path):
    case = case_from(BLOCK | {"structure": [], "time": {"mode": "relax", "duration": 0.1}}, {})
    with pytest.raises(SimulationStopped, match="no rest within time.duration = 0.1 s"):
        run(case, tmp_path / "run", quiet=True)
    assert json.loads((tmp_path / "run" / "summary.json").read_text())["status"] == "stopped"


@pytest.mark.parametrize(("more", "said"), [
    ({"domain": {"x_boundary": "outflow"}}, "nothing comes to rest"),
    ({"water": {"velocity_table": [[0.0, 0.1, 0.0], [1.0, 0.2, 0.0]]}}, "nothing comes to rest"),
    ({"time": BLOCK["time"] | {"error_check": True}}, "must be false"),
])  # fmt: skip
def test_cases_without_a_rest_are_refused(more, said):
    with pytest.raises(ValidationError, match=said):
        Case.model_validate(BLOCK | more)
