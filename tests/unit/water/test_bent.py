"""Water on bodies that bend: one energy whose gradient all loads are, those on modes too; a rigid body where none is bent."""

import numpy as np
import pytest

from dilatedem.numerics.frames import quaternion_from_rotation_vector
from dilatedem.run.simulation import Simulation

OUTLINE = [[-1.4, -0.7], [1.4, -0.7], [1.4, 0.7], [-1.4, 0.7]]
MODES = 4


def afloat(tilt, height, **more) -> Simulation:
    pytest.importorskip("skfem")
    return Simulation.from_case({
        "field": {"source": "bodies"}, "time": {"step": 1e-4}, "deformation": {"modes": MODES, "damping": 0.0, "mesh_size": 0.5},
        "body": [{"outline": OUTLINE, "position": [0.0, 0.0, height], "rotation": tilt}], **more,
    })  # fmt: skip


STILL = {"water": {"drag_force_coefficient": 0.0, "drag_moment_coefficient": 0.0}}


def energy(simulation: Simulation) -> float:
    simulation.evaluate()
    return simulation.energy["buoyancy"] + simulation.energy["gravity"]


@pytest.mark.parametrize(("tilt", "height", "out"), [
    ([0.0, 0.0, 0.0], 0.0, [0.0, 0.0, 0.0, 0.0]),
    ([0.02, 0.05, 0.3], 0.02, [1.0, -0.5, 0.7, 0.4]),
    ([0.3, 0.15, 0.3], 0.1, [1.0, -0.5, 0.7, 0.4]),
    ([1.5, 0.2, 0.3], 0.1, [1.0, -0.5, 0.7, 0.4]),
])  # fmt: skip
def test_loads_are_the_gradient_of_the_energy(tilt, height, out):
    """Upright, tilted, with its deck awash, and on its side."""
    simulation = afloat(tilt, height, **STILL)
    bodies, small = simulation.state.bodies, 1e-5
    bodies.coordinate[0] = out
    simulation.evaluate()
    loads = [*bodies.force[0], *bodies.torque[0], *bodies.mode_load[0]]
    place, turn = bodies.position[0].copy(), bodies.orientation[0].copy()
    for which, load in enumerate(loads):
        found = []
        for side in (small, -small):
            step = np.zeros(len(loads))
            step[which] = side
            bodies.position[0] = place + step[:3]
            w, x, y, z = quaternion_from_rotation_vector(step[3:6])
            W, X, Y, Z = turn
            bodies.orientation[0] = (
                w * W - x * X - y * Y - z * Z, w * X + x * W + y * Z - z * Y, w * Y - x * Z + y * W + z * X,
                w * Z + x * Y - y * X + z * W,
            )  # fmt: skip
            bodies.coordinate[0] = out + 1e2 * step[6:]
            found.append(energy(simulation))
        slope = (found[0] - found[1]) / (2.0 * small * (1e2 if which >= 6 else 1.0))
        assert load == pytest.approx(-slope, abs=2e-5 * np.abs(loads).max())


def test_a_face_under_water_is_summed_as_its_points_are():
    """Where `bulge` begins to say that the lower face is all under water, nothing jumps."""
    simulation = afloat([0.0, 0.0, 0.0], 0.0, **STILL)
    bodies, solids, found = simulation.state.bodies, simulation.model.solids, []
    bodies.coordinate[0] = [0.0, 0.5, 0.0, 0.2]
    depth = -float(solids.skin_centre[:, 2].min()) - float(solids.mode_reach[0] @ np.abs(bodies.coordinate[0]))
    for aside in (-1e-9, 1e-9):
        bodies.position[0, 2] = depth + aside
        simulation.evaluate()
        found.append([*bodies.force[0], *bodies.mode_load[0]])
    np.testing.assert_allclose(found[0], found[1], rtol=1e-6, atol=1e-4)


def test_water_bears_a_bent_floe_as_a_foundation_of_springs():
    """rho g a square metre of the lower face, as of a beam on water."""
    simulation, loads = afloat([0.0, 0.0, 0.0], 0.0, **STILL), []
    bodies, solids = simulation.state.bodies, simulation.model.solids
    for out in (-1e-3, 1e-3):
        bodies.coordinate[0, 0] = out
        simulation.evaluate()
        loads.append(bodies.mode_load[0, 0])
    down = int(np.argmin(solids.skin_normal[:, 2]))
    expected = simulation.case.water.density * 9.81 * solids.skin_second[down, 0, 0]
    assert (loads[0] - loads[1]) / 2e-3 == pytest.approx(expected, rel=1e-6)


def test_drags_do_on_modes_what_is_booked():
    """Of current and wind on a body that is held back: their power on the modes' rates, and no more force than on a rigid body."""
    flow = {"water": {"velocity": [1.0, 0.5]}, "wind": {"velocity": [10.0, -5.0]}}
    simulation = afloat([0.05, 0.0, 0.0], 0.0, **flow)
    rigid = afloat([0.05, 0.0, 0.0], 0.0, **flow)
    bodies = simulation.state.bodies
    bodies.rate[0] = [1.0, -2.0, 0.5, 0.3]
    simulation.evaluate(), rigid.evaluate()
    np.testing.assert_array_equal(bodies.force, rigid.state.bodies.force)
    dry = afloat([0.05, 0.0, 0.0], 0.0, **STILL)
    dry.evaluate()
    done = (bodies.mode_load[0] - dry.state.bodies.mode_load[0]) @ bodies.rate[0]
    assert abs(done) > 0.1 and bodies.bent_load[0].sum(axis=0) @ bodies.rate[0] == pytest.approx(done)
