"""A run with a structure on a beam equals itself when it is stopped and resumed; copies of its state, too.

One thread: structures are moved and pushed by one alone, and machine code of beams for several takes minutes to compile.
"""

import json
from math import inf

import numpy as np
from folders import assert_same_run
from test_resume_matrix import asked_after, hit_at, stopped_halfway

from dilatedem.case.schema import Case
from dilatedem.results.tables import read_table
from dilatedem.run import loop

BEAM = {"kind": "modal", "length": 9.0, "length_above": 2.0, "mass_per_length": 300.0, "bending_stiffness": [4e7, 6e7],
        "deck_mass": 500.0, "soil_stiffness": 1e7, "modes": 4, "push_height": -0.1}  # fmt: skip


def case_of(model: str = "liu2015") -> Case:
    """Twenty floes that move fast, a pile on a beam, one on springs, and one that is driven."""
    return Case.model_validate({
        "domain": {"size": [12.0, 12.0], "y_boundary": "periodic"},
        "field": {"floe_count": 20, "concentration": 0.8, "seed": 5},
        "ice": {"initial_velocity": [3.0, 0.8, 0.0], "dilated_radius": 0.06},
        "water": {"velocity": [2.0, 0.5]},
        "structure": [
            {"kind": "pile", "name": "one", "center": [2.0, -1.0], "radius": 0.4, "support": BEAM},
            {"kind": "parts", "name": "two", "support": BEAM | {"modes": 2},
             "part": [{"kind": "pile", "name": "leg", "center": [0.0, 2.5], "radius": 0.3}]},
            {"kind": "pile", "name": "soft", "center": [4.5, 1.0], "radius": 0.3,
             "support": {"kind": "sprung", "mass": 1e3, "stiffness": [1e6, 0.0]}},
        ],
        "contact": {"model": model},
        "time": {"duration": 1.0, "step_fraction": 0.4, "error_check": True},
        "output": {"force_interval": 0.05, "snapshot_interval": 0.2, "checkpoint_interval": 0.12, "hit_gap": 0.02},
    })  # fmt: skip


def test_resumed_equals_uninterrupted(monkeypatch, tmp_path):
    case = case_of()
    never = asked_after(inf)
    monkeypatch.setattr(loop, "Interruption", never)
    whole = loop.run(case, tmp_path / "whole", quiet=True)
    assert hit_at(whole, "one") < 0.4, "it vibrates when the run is stopped"
    told = json.loads((whole / "summary.json").read_text())
    assert told["error_check"]["reproduced"], "a copy of the state holds the modes"
    assert len(told["natural_frequencies"]["one"]["along_x_Hz"]) == 4 and set(told["natural_frequencies"]) == {"one", "two"}
    assert told["motion"]["one"]["base_moment_max_Nm"] > 0.0 and "base_moment_max_Nm" not in told["motion"]["soft"]
    table = read_table(whole / "structures.csv")
    own = table["structure"] == "one"
    assert (table["base_moment_max_Nm"][own] >= (1.0 - 1e-8) * np.hypot(*(table[f"base_moment_{c}_Nm"][own] for c in "xy"))).all()
    assert (table["base_force_max_N"][own] >= (1.0 - 1e-8) * np.hypot(*(table[f"reaction_{c}_N"][own] for c in "xy"))).all()
    assert not table["base_moment_max_Nm"][table["structure"] == "soft"].any()
    assert_same_run(stopped_halfway(monkeypatch, case, tmp_path / "parts", never.looks, threads=1), whole)
