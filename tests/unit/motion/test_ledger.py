"""The energy ledger of an impact closes: its residual is small against the energy that is exchanged, and of second order in
the step.
"""

import pytest

from dilatedem.case.load import load
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status
from tests.verification.comparison import CASES


def residual(case: str, step: float, duration: float, *overrides: str) -> tuple[float, float]:
    """Energy that the ledger cannot account for over a run, and the energy dissipated or stored at most [J]."""
    simulation = Simulation.of_case(load(CASES / f"{case}.toml", [f"time.step={step}", *overrides]))
    assert simulation.evaluate() == Status.DONE

    def balance():
        e = simulation.energies()
        stored = e["kinetic"] + e["gravity"] + e["buoyancy"] + e["elastic"]
        return stored - e["work_drag"] + e["loss_damping"] + e["loss_friction"] - e["gain_law"], e

    before, first = balance()
    worst = 0.0
    for _ in range(50):
        assert simulation.advance(round(duration / 50 / step)) == Status.DONE
        worst = max(worst, abs(balance()[0] - before))
    return worst, first["kinetic"] - simulation.energies()["kinetic"]


@pytest.mark.parametrize("overrides", [(), ("contact.damping=0.36", "contact.friction=0.3")], ids=["elastic", "damped"])
def test_point_impacts(overrides):
    coarse, fine = (residual("hertz_impact", step, 0.03, *overrides)[0] for step in (2e-5, 1e-5))
    kinetic = 0.5 * 30.7 * 0.3**2
    assert fine < 1e-3 * kinetic
    assert coarse / fine == pytest.approx(4.0, rel=0.25)


def test_collision_of_floes():
    coarse, fine = (residual("collision", step, 1.0) for step in (2e-5, 1e-5))
    assert fine[1] > 1.0  # J: something was lost in the collisions
    assert fine[0] < 1e-5 * fine[1]
    assert coarse[0] / fine[0] == pytest.approx(4.0, rel=0.25)


def test_collision_of_floes_with_friction():
    # where sticking turns into slipping within a step the residual is small, but no longer of second order
    left, lost = residual("collision", 1e-5, 1.0, "contact.friction=0.3")
    assert left < 1e-5 * lost
