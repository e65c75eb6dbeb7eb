"""A cone structure: what it answers, the floes that it keeps away, and impacts whose energy is all accounted for."""

import numpy as np
import pytest

from dilatedem.case.schema import Case
from dilatedem.errors import CaseError
from dilatedem.geometry.packing import selected
from dilatedem.geometry.shapes import TaperedShapes
from dilatedem.run.simulation import Simulation
from dilatedem.scene.overlaps import require_apart
from dilatedem.state.clock import Status
from dilatedem.structures.cone import Cone

CONE = {"kind": "cone", "name": "cone", "center": [4.5, 0.0], "waterline_radius": 2.0, "slope": 60.0, "top": 2.0}


def thrown(model: str, away: float = 0.0, **keys) -> Simulation:
    """A floe that flies at a cone, without water and weight."""
    return Simulation.of_case(Case.model_validate({
        "field": {"source": "bodies"}, "water": {"enabled": False}, "gravity": {"acceleration": 0.0},
        "contact": {"model": model}, "time": {"step": 2e-5}, "structure": [CONE | keys],
        "body": [{
            "outline": [[-1.4, -1.4], [1.4, -1.4], [1.4, 1.4], [-1.4, 1.4]], "position": [0.3 - away, 0.3, 0.05],
            "rotation": [0.0, 0.0, 0.4], "velocity": [0.5, 0.0, 0.0],
        }],
    }))  # fmt: skip


@pytest.mark.parametrize("model", ["liu2015", "consistent"])
@pytest.mark.parametrize("slope", [60.0, -60.0])
def test_the_energy_of_a_hit_is_accounted_for(model, slope):
    simulation = thrown(model, slope=slope, bottom=-2.0)
    assert simulation.evaluate() == Status.DONE
    before, impulse = simulation.energies()["kinetic"], np.zeros(3)
    mass, velocity = simulation.model.solids.mass[0], simulation.state.bodies.velocity[0].copy()
    for _ in range(4000):
        assert simulation.advance(10) == Status.DONE
        impulse += simulation.state.loads.step_load[0, :3] * 10 * simulation.dt
    after = simulation.energies()
    turned = after["kinetic"] + after["elastic"] + after["loss_damping"] + after["loss_friction"] - after["gain_law"]
    assert turned == pytest.approx(before, rel=1e-4)
    assert simulation.state.bodies.velocity[0, 0] < 0.4, "it was hit"
    np.testing.assert_allclose(impulse, mass * (velocity - simulation.state.bodies.velocity[0]), atol=0.01 * mass)
    # a side that looks up pushes the floe up, and is pushed down
    assert np.sign(impulse[2]) == -np.sign(slope)
    assert simulation.state.loads.impulse_map[0].sum() > 0.0


def test_a_floe_in_it_at_the_start_is_named():
    simulation = thrown("consistent", away=-0.5)
    with pytest.raises(CaseError, match=r'body 0 at \(0.80, 0.30\) and structure "cone", by 0\.\d+ m'):
        require_apart(simulation.scene, simulation.model, simulation.state.bodies)
    clear = thrown("consistent")
    require_apart(clear.scene, clear.model, clear.state.bodies)


def test_it_stays_a_cone_when_bodies_leave():
    shapes = thrown("consistent").model.shapes
    left = selected(shapes, np.array([1]))
    assert type(left) is TaperedShapes and left.taper == pytest.approx(-0.5), "minus the cosine of 60 degrees"
    assert (left.reach, left.radius) == (shapes.reach[1:], shapes.radius[1:])


def test_its_spheres_touch_the_side_along_its_two_circles():
    for slope in (60.0, -60.0, 20.0):
        cone = Cone(kind="cone", slope=slope, bottom=-1.0, top=1.2)
        (part,) = cone.parts()
        for end, height in ((0, -1.0), (1, 1.2)):
            middle = part.position + part.shape.core.vertices[end]
            radius = part.shape.radius + part.taper * part.shape.core.vertices[end, 2]
            circle = 4.0 - height / np.tan(np.radians(slope))
            assert np.hypot(circle, height - middle[2]) == pytest.approx(radius, rel=1e-12)
            # the side is square to the way there
            assert (height - middle[2]) / circle == pytest.approx(1.0 / np.tan(np.radians(slope)), rel=1e-12)
        assert part.plan_reach >= circle


def test_floes_start_beside_its_widest_circle_in_the_ice():
    (disk,) = Cone(kind="cone", slope=45.0).obstacles(0.5)
    assert disk.radius == pytest.approx(4.5)
    (disk,) = Cone(kind="cone", slope=-45.0).obstacles(0.5)
    assert disk.radius == pytest.approx(4.5)
    assert Cone(kind="cone", bottom=-3.0, top=-1.0).sketch(50.0) is None


def test_impossible_cones_are_refused():
    with pytest.raises(ValueError, match=r"must be below the tip of the cone, 1.73 m"):
        Cone(kind="cone", waterline_radius=1.0)
    with pytest.raises(ValueError, match=r"must be above the tip of the cone, -1.73 m"):
        Cone(kind="cone", waterline_radius=1.0, slope=-60.0)
    with pytest.raises(ValueError, match=r"must be above bottom, -3 m"):
        Cone(kind="cone", top=-3.0)
    with pytest.raises(ValueError, match=r"must be between 5 and 90 degrees"):
        Cone(kind="cone", slope=0.0)
