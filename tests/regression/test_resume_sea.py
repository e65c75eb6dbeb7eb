"""A run in a sea that varies, stopped and resumed, equals one that never was: what waves and tables say depends on the time alone.

One thread, as machine code of a sea for several takes minutes to compile: validation/reliability has runs at sea with two.
"""

from math import inf

from folders import assert_same_run
from test_resume_matrix import asked_after, stopped_halfway

from dilatedem.case.load import load
from dilatedem.run import loop
from tests.verification.comparison import CASES

SHORTER = (
    "time.duration=1.5", "time.step_fraction=0.3", "output.checkpoint_interval=0.2", "output.snapshot_interval=0.25",
    "domain.x_boundary=outflow", "ice.initial_velocity=current",
    "water.velocity_table=[[0.0, 1.5, 0.0], [0.6, 2.0, 0.3], [1.5, 1.0, 0.1]]",
)  # fmt: skip


def test_resumed_equals_uninterrupted(monkeypatch, tmp_path):
    case, never = load(CASES / "sea_ledger.toml", SHORTER), asked_after(inf)
    monkeypatch.setattr(loop, "Interruption", never)
    whole = loop.run(case, tmp_path / "whole", quiet=True)
    assert_same_run(stopped_halfway(monkeypatch, case, tmp_path / "parts", never.looks, threads=1), whole)
