"""A run that was stopped and resumed equals one that never was, whatever the contact model, boundaries, threads and structure.

Twenty cases in which every pair of these choices occurs.
"""

import csv
from math import inf
from pathlib import Path

import pytest
from folders import assert_same_run

from dilatedem.case.schema import Case
from dilatedem.errors import Interrupted
from dilatedem.processes.interruption import Interruption
from dilatedem.run import loop

MODELS = ("liu2015", "consistent")
BOUNDARIES = (("open", "periodic"), ("periodic", "periodic"), ("wall", "open"), ("outflow", "wall"), ("inflow", "periodic"))
STRUCTURES = (
    [],
    [{"kind": "pile", "center": [1.0, 0.0], "radius": 0.5}],
    [{"kind": "plane", "point": [3.0, 0.0, 0.0], "normal": [-1.0, 0.2, 0.3]}],
    [
        {"kind": "pile", "name": "one", "center": [2.0, -1.0], "radius": 0.4,
         "support": {"kind": "sprung", "mass": 1e3, "stiffness": [1e6, 0.0], "inertia": 1e3, "stiffness_yaw": 1e5}},
        {"kind": "box", "name": "two", "center": [0.0, 2.5], "size": [1.0, 0.8], "rotation": 25.0,
         "support": {"kind": "driven", "table": [[0.0, 4.0, 0.0, 0.0], [0.1, 4.0, 0.1, 0.05], [0.5, 3.5, 0.0, 0.2]]}},
        {"kind": "pile", "name": "three", "center": [-1.0, -3.5], "radius": 0.3},
    ],
)
CHOSEN = [
    (MODELS[(boundary + structure) % 2], BOUNDARIES[boundary], 1 + (boundary // 2 + structure) % 2, STRUCTURES[structure])
    for boundary in range(5)
    for structure in range(4)
]


def case_of(model: str, boundaries: tuple[str, str], structure: list[dict]) -> Case:
    """Twenty floes that move fast and touch each other soon."""
    return Case.model_validate({
        "domain": {"size": [12.0, 12.0], "x_boundary": boundaries[0], "y_boundary": boundaries[1]},
        "field": {"floe_count": 20, "concentration": 0.8, "seed": 5},
        "ice": {"initial_velocity": [3.0, 0.8, 0.0], "dilated_radius": 0.06},
        "water": {"velocity": [2.0, 0.5]},
        "structure": structure,
        "contact": {"model": model},
        "time": {"duration": 1.1, "step_fraction": 0.4},
        "output": {"force_interval": 0.05, "snapshot_interval": 0.15, "checkpoint_interval": 0.12, "track": "all",
                   "track_interval": 0.1, "hit_gap": 0.02, "hits_in_full": 2, "moment_level": -0.7},
    })  # fmt: skip


def asked_after(most: float) -> type[Interruption]:
    """Stands for a user who presses Ctrl-C after so many looks at the keyboard; counts them."""

    class Asked(Interruption):
        looks = 0

        @property
        def asked(self) -> bool:
            type(self).looks += 1
            return self.looks > most

        @asked.setter
        def asked(self, value: bool) -> None:
            pass

    return Asked


def stopped_halfway(monkeypatch, case, out: Path, looks: int, *, threads: int = 2) -> Path:
    """The folder of a run that was stopped after half of its `looks` at the keyboard, and resumed with so many threads."""
    monkeypatch.setattr(loop, "Interruption", asked_after(looks // 2))
    with pytest.raises(Interrupted):
        loop.run(case, out, quiet=True)
    monkeypatch.undo()
    return loop.run(case, out, threads=threads, resume=True, quiet=True)


def hit_at(folder: Path, name: str) -> float:
    """Time [s] at which a structure on springs has left its place."""
    with (folder / "structures.csv").open(encoding="utf-8", newline="") as file:
        return min(float(row["time_s"]) for row in csv.DictReader(file) if row["structure"] == name and float(row["x_m"]) != 0.0)


@pytest.mark.parametrize(("model", "boundaries", "threads", "structure"), CHOSEN)
def test_resumed_equals_uninterrupted(model, boundaries, threads, structure, monkeypatch, tmp_path):
    case = case_of(model, boundaries, structure)
    never = asked_after(inf)
    monkeypatch.setattr(loop, "Interruption", never)
    whole = loop.run(case, tmp_path / "whole", threads=threads, quiet=True)
    if "one" in [each.get("name") for each in structure]:
        assert hit_at(whole, "one") < 0.4 * case.time.duration, "what is on springs swings when the run is stopped"
    monkeypatch.setattr(loop, "Interruption", asked_after(never.looks // 2))
    with pytest.raises(Interrupted):
        loop.run(case, tmp_path / "parts", threads=threads, quiet=True)
    monkeypatch.undo()
    loop.run(case, tmp_path / "parts", threads=3 - threads, resume=True, quiet=True)  # the number of threads changes nothing
    assert_same_run(tmp_path / "parts", whole)


def test_every_pair_of_choices_occurs():
    for one in range(4):
        for other in range(one):
            sets = [{str(choice[k]) for choice in CHOSEN} for k in (one, other)]
            met = {(str(choice[one]), str(choice[other])) for choice in CHOSEN}
            assert len(met) == len(sets[0]) * len(sets[1]), (one, other)
