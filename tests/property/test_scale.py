"""Bodies a thousand times smaller, in times as much shorter, do the same, to the last digit: no length hides in the program.

With a power of two for the factor every product and quotient has the same digits. Speeds, density and moduli are the same, so that
pressures are, and forces go with the square of lengths, energies with their cube; gravity and water would set a length.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dilatedem.run.simulation import Simulation

SMALLER = 2.0**-10
CUBE = np.array(np.meshgrid([-1.0, 1.0], [-1.0, 1.0], [-1.0, 1.0])).reshape(3, -1).T * 0.45
WEDGE = np.array([[-0.6, -0.4, -0.2], [0.6, -0.4, -0.2], [0.6, 0.4, -0.2], [-0.6, 0.4, -0.2], [0.0, -0.4, 0.3], [0.0, 0.4, 0.3]])
RADIUS = 0.05
TURNS = {  # of the two bodies, and how far the second stands aside
    "cubes, flush": (CUBE, [0.0, 0.0, 0.0], CUBE, [0.0, 0.0, 0.0], [0.0, 0.0]),
    "corner on face": (CUBE, [0.0, 0.0, 0.0], CUBE, [0.4, 0.7, 0.3], [0.1, 0.0]),
    "cubes, askew": (CUBE, [0.0, 0.0, 0.0], CUBE, [0.0, 0.005, 0.0], [0.5, 0.1]),
    "ridge on face": (CUBE, [0.0, 0.0, 0.0], WEDGE, [0.0, -np.pi / 2, 0.0], [0.0, 0.05]),
    "edges across": (CUBE, [0.0, 0.0, np.pi / 4], CUBE, [0.0, np.pi / 4, 0.0], [0.05, 0.1]),
}
#: `liu2015` has unit slips, the paper's, where an edge presses along its length (L stands for L / 1 m) and in its damping of points
PAIRS = [("liu2015", "cubes, flush"), ("liu2015", "corner on face"), *(("consistent", pose) for pose in TURNS)]


def simulated(model: str, pose: str, factor: float) -> Simulation:
    """Two bodies 1 mm apart that come together at 0.2 m/s, 600 steps later."""
    first, first_turn, second, second_turn, aside = TURNS[pose]
    ahead, behind = (
        Rotation.from_rotvec(first_turn).apply(first)[:, 0].max(),
        Rotation.from_rotvec(second_turn).apply(second)[:, 0].min(),
    )
    place = factor * np.array([ahead - behind + 2.0 * RADIUS + 0.001, *aside])
    bodies = [
        {"vertices": (factor * first).tolist(), "rotation": first_turn, "position": [0.0, 0.0, 0.0], "velocity": [0.1, 0.0, 0.0]},
        {"vertices": (factor * second).tolist(), "rotation": second_turn, "position": place.tolist(), "velocity": [-0.1, 0.0, 0.0]},
    ]
    bodies = [{**body, "dilated_radius": RADIUS * factor} for body in bodies]
    simulation = Simulation.from_case({
        "title": pose, "domain": {"size": [64.0 * factor, 64.0 * factor]}, "field": {"source": "bodies"}, "body": bodies,
        "water": {"enabled": False}, "gravity": {"acceleration": 0.0},
        "contact": {"model": model, "damping": 0.0 if model == "liu2015" else 0.36},
        "time": {"duration": factor, "step": 2.0**-14 * factor},
        "output": {"force_interval": 0.25 * factor, "snapshot_interval": 0, "checkpoint_interval": 0},
    })  # fmt: skip
    simulation.step(600)
    return simulation


@pytest.mark.parametrize("model, pose", PAIRS)
def test_smaller_bodies_collide_alike_to_the_last_digit(model, pose):
    large, small = simulated(model, pose, 1.0), simulated(model, pose, SMALLER)
    assert large.floes.velocity[0, 0] < 0.09  # they have met
    assert (small.floes.position == SMALLER * large.floes.position).all()
    assert (small.floes.orientation == large.floes.orientation).all()
    assert (small.floes.velocity == large.floes.velocity).all()
    assert (small.floes.contact_force == SMALLER**2 * large.floes.contact_force).all()
