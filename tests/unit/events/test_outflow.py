"""Floes that have left are dropped: the files speak of those that are there, by their numbers."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from dilatedem.case.load import load
from dilatedem.case.schema import Case
from dilatedem.errors import CaseError, Interrupted
from dilatedem.processes.interruption import Interruption
from dilatedem.results.load import load as results
from dilatedem.run import loop
from dilatedem.run.simulation import Simulation

CROWDED = Path(__file__).parents[2] / "cases" / "crowded.toml"
#: body 0 is held fast amid the ice
LEAVING = [
    "domain.x_boundary=outflow", "water.velocity=[1.5,0.1]", "field.concentration=0.7", "structure.pile.radius=0.5",
    "time.step_fraction=0.3", "body=[{outline=[[-1.5,2.5],[-0.5,2.5],[-0.5,3.5],[-1.5,3.5]], fixed=true}]",
]  # fmt: skip


@pytest.fixture(scope="module")
def run(tmp_path_factory) -> Path:
    return loop.run(load(CROWDED, LEAVING), tmp_path_factory.mktemp("outflow") / "run", quiet=True)


def test_a_run_that_is_resumed_after_floes_have_left_equals_one_that_never_stopped(run, monkeypatch, tmp_path):
    case, out = load(CROWDED, LEAVING), tmp_path / "run"
    happen, left = Simulation.let_happen, []

    def noted(self):
        left.append(happen(self))
        return left[-1]

    class AskedOnceTheyHaveLeft(Interruption):
        asked = property(lambda self: any(left), lambda self, value: None)

    monkeypatch.setattr(Simulation, "let_happen", noted)
    monkeypatch.setattr(loop, "Interruption", AskedOnceTheyHaveLeft)
    with pytest.raises(Interrupted):
        loop.run(case, out, quiet=True)
    monkeypatch.undo()
    stopped = results(out).summary
    assert 1.0 <= stopped["simulated_s"] < 4.0 and stopped["floes"] < len(results(run).snapshot(0.0).body)
    loop.run(case, out, resume=True, quiet=True)
    for name in ("forces.csv", "energy.csv", "bodies.csv", "ice.pvd"):
        assert (out / name).read_bytes() == (run / name).read_bytes(), name
    forces = results(run).forces
    held = forces[(forces.structure == "body_0") & (forces.time_s > stopped["simulated_s"])]
    assert held.fh_max_N.max() > 1e3, "the held body is hit after floes have left"


def test_bodies_leave_as_a_whole_and_only_downstream(run):
    told = results(run)
    start, end = told.snapshot(0.0), told.snapshot(4.0)
    assert set(end.body) < set(start.body) and len(end.body) == json.loads((run / "summary.json").read_text())["floes"]
    for number, outline in zip(end.body, end.outlines, strict=True):
        assert outline[:, 0].min() < 7.5 + 1.5 * 1.1, f"body {number} left more than a look ago"
    gone = set(start.body) - set(end.body)
    places = {number: outline[:, 0].max() for number, outline in zip(start.body, start.outlines, strict=True)}
    assert min(places[number] for number in gone) > max(places.values()) - 6.5


def test_a_body_has_one_number_all_the_way(run):
    with open(run / "bodies.csv", newline="") as file:
        rows = [(float(row["time_s"]), int(row["body"]), float(row["x_m"])) for row in csv.DictReader(file)]
    by_body: dict[int, list] = {}
    for time, number, x in rows:
        by_body.setdefault(number, []).append((time, x))
    assert len({len(way) for way in by_body.values()}) > 1, "some left before the end"
    for way in by_body.values():
        steps = np.diff(np.array(way), axis=0)
        assert np.all(np.abs(steps[:, 1]) < 3.0 * steps[:, 0] + 1e-9)


def test_the_ledger_closes_with_what_was_carried_out(run):
    energy = results(run).energy
    carried = energy["carried_out"].to_numpy()
    assert carried[0] == 0.0 and np.all(np.diff(carried[carried > 0.0]) >= 0.0) and carried[-1] > 1e3
    turned_over = energy["loss_damping"].iloc[-1] + energy["loss_friction"].iloc[-1] + carried[-1]
    assert np.abs(energy["residual"]).max() < 1e-3 * turned_over


def test_the_report_of_such_a_run_is_made(run):
    from dilatedem.post import post

    assert any(path.name == "report.html" for path in post([run]))
    assert "where ice leaves" in (run / "report.html").read_text()


def test_the_check_of_the_step_is_refused_with_the_way_on():
    with pytest.raises(CaseError, match=r"time.error_check = true: must be false where a boundary is \"outflow\""):
        load(CROWDED, [*LEAVING, "time.error_check=true"])
    assert Case().domain.x_boundary == "open"
