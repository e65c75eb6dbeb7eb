"""A run with floes of several parts, some of which leave, equals itself when it is stopped and resumed, with other threads."""

import json
from math import inf

import shapely
from folders import assert_same_run
from test_resume_matrix import asked_after, stopped_halfway

from dilatedem.case.load import case_from
from dilatedem.run import loop
from dilatedem.run.simulation import Simulation

BAY = shapely.Polygon([(0, 0), (1, 0), (1, 1.2), (0.7, 1.2), (0.7, 0.3), (0.3, 0.3), (0.3, 1.2), (0, 1.2)])


def case_of(tmp_path):
    """Nine floes with a bay each, three blocks, a pile in their way; the first have left the domain after a second."""
    floes = [shapely.affinity.translate(BAY, -2.9 + 2.0 * i, -2.5 + 1.6 * j) for i in range(3) for j in range(3)]
    floes += [shapely.box(-1.6 + 2.0 * i, 2.4, -0.9 + 2.0 * i, 2.9) for i in range(2)]
    collection = {"type": "GeometryCollection", "geometries": [json.loads(shapely.to_geojson(floe)) for floe in floes]}
    (tmp_path / "floes.geojson").write_text(json.dumps(collection))
    return case_from({
        "domain": {"size": [6.0, 6.0], "x_boundary": "outflow", "y_boundary": "periodic"},
        "field": {"source": "file", "file": str(tmp_path / "floes.geojson"), "tolerance": 0.0},
        "ice": {"initial_velocity": [3.0, 0.8, 0.0], "dilated_radius": 0.03, "thickness": 0.3},
        "water": {"velocity": [2.0, 0.5]},
        "structure": [{"kind": "pile", "center": [2.6, -0.2], "radius": 0.4}],
        "time": {"duration": 1.6, "step_fraction": 0.4},
        "output": {"force_interval": 0.05, "snapshot_interval": 0.2, "checkpoint_interval": 0.3, "track": "all",
                   "track_interval": 0.1},
    }, {})  # fmt: skip


def test_resumed_equals_uninterrupted(monkeypatch, tmp_path):
    case = case_of(tmp_path)
    simulation = Simulation.of_case(case)
    assert simulation.model.floes == 11 and len(simulation.model.joined) == 9
    never = asked_after(inf)
    monkeypatch.setattr(loop, "Interruption", never)
    whole = loop.run(case, tmp_path / "whole", quiet=True)
    told = json.loads((whole / "summary.json").read_text())
    assert told["floes"] < 11 and told["loads"]["pile"]["touched"]
    assert_same_run(stopped_halfway(monkeypatch, case, tmp_path / "parts", never.looks), whole)
