"""Where the mode changes, `liu2015` makes energy: the ledger says how much, with what the step that sees it adds.

Velocity Verlet in steps of h, books by trapezoids with predicted velocities: beyond what these tell, a force that jumps by dF
makes h^2 dF^2/(4 m'), 1/m' what both bodies give way where they touch (docs/theory.md, the energy ledger).
"""

import math

from dilatedem.case.schema import Case
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status
from dilatedem.state.modes import Mode

BLOCK = {
    "vertices": [[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-0.25, 0.25)], "dilated_radius": 0.04,
}  # fmt: skip
TILT, DEPTH, SPIN = 0.0201, 3e-3, -0.3


def closing_block() -> Simulation:
    """A block that stands with an edge DEPTH [m] in the face of another, which is held, and closes on it by SPIN [rad/s]: its face
    leans by TILT [rad], a little more than what passes for parallel."""
    corner = (math.sin(TILT) - math.cos(TILT), -math.sin(TILT) - math.cos(TILT))
    nearest = -math.cos(TILT) - math.sin(TILT)
    still = (nearest, -math.sin(TILT) + math.cos(TILT))
    assert nearest < corner[0]
    moving = BLOCK | {
        "position": [1.08 - DEPTH - nearest, 0.0, 0.0], "rotation": [0.0, 0.0, TILT],
        "velocity": [SPIN * still[1], -SPIN * still[0], 0.0], "angular_velocity": [0.0, 0.0, SPIN],
    }  # fmt: skip
    made = Simulation.of_case(Case.model_validate({
        "field": {"source": "bodies"}, "water": {"enabled": False}, "gravity": {"acceleration": 0.0},
        "contact": {"damping": 0.0, "friction": 0.0}, "time": {"duration": 1.0, "step_fraction": 0.2},
        "body": [BLOCK | {"fixed": True}, moving],
    }))  # fmt: skip
    made.span, made.strides = 1, False
    return made


def untold(simulation: Simulation) -> float:
    """Energy [J] less what the law made of it."""
    now = simulation.energies()
    return now["kinetic"] + now["elastic"] + now["loss_damping"] + now["loss_friction"] - now["gain_law"]


def test_the_ledger_holds_what_a_jump_of_the_force_makes():
    simulation = closing_block()
    assert simulation.evaluate() == Status.DONE
    start, modes = untold(simulation), []
    while simulation.contacts:
        modes.append(Mode(int(simulation.state.pairs.mode[0])))
        assert simulation.advance(1) == Status.DONE
    assert modes[0] == Mode.EDGE_FACE and modes[-1] == Mode.FACE_FACE
    assert simulation.energies()["gain_law"] > 200.0
    assert abs(untold(simulation) - start) < 0.2  # 0.37 without
