"""A run of floes that bend equals itself when it is stopped and resumed.

One thread, and the model of the cases of theory: machine code of bodies that bend takes minutes to compile.
"""

import json
from math import inf

import pytest
from folders import assert_same_run
from test_resume_matrix import asked_after, stopped_halfway

from dilatedem.case.schema import Case
from dilatedem.results.tables import read_table
from dilatedem.run import loop

SQUARE = [[-0.7, -0.7], [0.7, -0.7], [0.7, 0.7], [-0.7, 0.7]]
BENDS = {"modes": 4, "mesh_size": 0.5}


def case_of() -> Case:
    """Three floes that run into each other and into a pile, the last one rigid, in a wind."""
    return Case.model_validate({
        "domain": {"size": [12.0, 12.0]}, "field": {"source": "bodies"}, "deformation": BENDS,
        "ice": {"flexural_strength": 2e4}, "wind": {"velocity": [5.0, 0.0]},
        "structure": [{"kind": "pile", "name": "pile", "center": [1.2, 0.1], "radius": 0.4}],
        "contact": {"model": "consistent"},
        "body": [
            {"outline": SQUARE, "position": [0.05, 0.0, 0.0], "velocity": [1.0, 0.0, 0.0]},
            {"outline": SQUARE, "position": [-1.45, 0.1, 0.02], "velocity": [1.5, 0.0, 0.0], "rotation": [0.05, 0.0, 0.1]},
            {"outline": SQUARE, "position": [-3.0, 0.0, 0.0], "velocity": [2.0, 0.0, 0.0], "modes": 0},
        ],
        "time": {"duration": 0.2, "step": 1e-4},
        "output": {"force_interval": 0.01, "snapshot_interval": 0.05, "checkpoint_interval": 0.03, "track": "all"},
    })  # fmt: skip


@pytest.fixture(autouse=True)
def _elements():
    pytest.importorskip("skfem")


def test_resumed_equals_uninterrupted(monkeypatch, tmp_path):
    case = case_of()
    never = asked_after(inf)
    monkeypatch.setattr(loop, "Interruption", never)
    whole = loop.run(case, tmp_path / "whole", quiet=True)
    told = json.loads((whole / "summary.json").read_text())["flexure"]
    assert told["floes"] == 2 and told["above_strength"] >= 1 and told["largest_Pa"] > 2e4
    table = read_table(whole / "flexure.csv")
    assert table["body"].tolist() == [0, 1] and max(table["tension_Pa"]) == pytest.approx(told["largest_Pa"])
    energy = read_table(whole / "energy.csv")
    assert energy["modal"].max() > 0.0 and abs(energy["residual"]).max() < 2e-3 * energy["kinetic"].max()
    parts = stopped_halfway(monkeypatch, case, tmp_path / "parts", never.looks, threads=1)
    assert_same_run(parts, whole)
    names = sorted(path.name for path in (whole / "snapshots").glob("bent_*.vtu"))
    assert len(names) == 5
    for name in ("flexure.csv", "bent.pvd", *(f"snapshots/{name}" for name in names)):
        assert (parts / name).read_bytes() == (whole / name).read_bytes(), name
