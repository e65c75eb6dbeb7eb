"""Bodies that bend, case by case (validation/bao2004): at rest by relaxation, in hits, on water.

At rest. A beam on two supports sags by 5 q l^4/(384 E I) and shear q l^2/(8 kappa G A); n symmetric modes of Euler-Bernoulli miss
1.33, 0.72, 0.13, 0.10 and 0.013 % of it for n = 1, 2, 3, 4 and 8. A cantilever of length c between clamps a apart bends down by
theta c + q c^4/(8 E I), theta = M a/(3 E I) - q a^3/(24 E I), M = q c^2/2, and shears by q c^2/(2 kappa G A) + M c/(a kappa G A). A
bar that stands shortens by rho g L^2/(2 E), of which odd modes n have 8/(pi n)^2; block k of a stack by (k - 1/2) rho g h^2/E.
A rigid floe on water that a load P pushes down e from its end is borne by P (4 L - 6 e)/L^2 + x P (12 e - 6 L)/L^3; for e = 0 its
moment is 4/27 P L, at L/3. A long one is a beam on water: M = P exp(-s) (L_b sin s - e (cos s + sin s)), s = x/L_b,
L_b^4 = 4 E I/(rho g b); 0.3224 P L_b at pi/4 L_b for e = 0.

In hits. Two bars end on end exchange their momenta by waves in 2 L/c; a spring k between them makes that longer by 1.678 tau,
tau = rho c A/(2 k): as the wave comes back, s ago, tau F' + F = F0 (2 exp(-s/tau) - 1) from F = F0 = rho c A v/2 on, which is zero
where 2 (1 + s/tau) exp(-s/tau) = 1. The k of a face is 2 E* beta sqrt(A/pi), beta = 1.018. No wave bears more than F0.
"""

from pathlib import Path

import numpy as np
import pytest

from dilatedem.case.load import load
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status
from tests.verification.comparison import Comparison, check
from validation.bao2004 import reference

CASES = Path(__file__).parents[2] / "validation" / "bao2004"
FOLDER = "bao2004"
GRAVITY, DENSITY, MODULUS = reference.GRAVITY, reference.ICE.density, reference.ICE.elastic_modulus
#: weight of a metre of the beams [N/m], and what they oppose to bending [N m2] and to shear [N]
LOAD, FLEXURE, SHEAR = DENSITY * GRAVITY * reference.area(), MODULUS * reference.second_moment(), reference.shear_stiffness()
#: modes of the beam on two supports that have so many symmetric ones among them
SYMMETRIC = {1: 1, 2: 6, 3: 11, 4: 18, 8: 50}
#: steps between two looks at whether a case is at rest
EACH = 100


@pytest.fixture(autouse=True)
def _elements():
    pytest.importorskip("skfem")


def row(quantity: str, target: float, result: float, tolerance: float, scale: float | None = None) -> Comparison:
    return Comparison(FOLDER, quantity, target, result, tolerance, scale, "consistent")


def start(case: str, *overrides: str) -> Simulation:
    simulation = Simulation.of_case(load(CASES / f"{case}.toml", overrides))
    assert simulation.evaluate() == Status.DONE
    return simulation


def at_rest(case: str, *overrides: str) -> Simulation:
    simulation = start(case, *overrides)
    while simulation.state.relaxed.settled[0] < 0:
        assert simulation.time < simulation.case.time.duration
        simulation.step(EACH)
    return simulation


def line(simulation: Simulation, *places: float) -> np.ndarray:
    """How far points of the middle line of body 0 at x [m] have risen by bending [m]."""
    bent = simulation.bent[0]
    points = np.column_stack((places, np.zeros((len(places), 2))))
    return simulation.state.bodies.coordinate[0] @ bent.lattice.at(points)[:, :, 2]


def of_supports() -> list[Comparison]:
    span, rows = 9.96, []
    whole = 5.0 * LOAD * span**4 / (384.0 * FLEXURE) + LOAD * span**2 / (8.0 * SHEAR)
    sags = {}
    for count, modes in SYMMETRIC.items():
        simulation = at_rest("supports", f"deformation.modes={modes}")
        middle, *ends = line(simulation, 0.0, -0.5 * span, 0.5 * span)
        sags[count] = float(np.mean(ends) - middle)
    rows.append(row("beam on two supports: deflection by 8 symmetric modes, m", whole, sags[8], 1e-2))
    for count in (1, 2, 3, 4):
        target = (1.0 + reference.SERIES[count]) / (1.0 + reference.SERIES[8]) - 1.0
        quantity = f"beam on two supports: error of {count} symmetric modes, against 8"
        rows.append(row(quantity, target, sags[count] / sags[8] - 1.0, 1e-3, 1.0))
    stress = 0.5 * reference.THICKNESS / reference.second_moment() * LOAD * span**2 / 8.0
    found = float(simulation.state.bodies.peak_tension[0])
    rows.append(row("beam on two supports: largest tension on the way, Pa", stress, found, 2e-2))
    return rows


def of_cantilever() -> list[Comparison]:
    free, apart = 4.48, 1.5
    moment = 0.5 * LOAD * free**2
    slope = moment * apart / (3.0 * FLEXURE) - LOAD * apart**3 / (24.0 * FLEXURE)
    target = slope * free + LOAD * free**4 / (8.0 * FLEXURE) + (0.5 * LOAD * free**2 + moment * free / apart) / SHEAR
    tip, front, rear = line(at_rest("cantilever"), 3.0, -1.48, -2.98)
    found = float(front + (front - rear) / apart * free - tip)
    return [row("cantilever between two clamping blocks: deflection of its tip, m", target, found, 4e-2)]


def shortened(simulation: Simulation, number: int) -> float:
    """How much nearer the lower face of a body is to the upper one than unbent, the mean of each [m]."""
    solids, out = simulation.model.solids, simulation.state.bodies.coordinate[number]
    faces = np.arange(solids.skin_face[number], solids.skin_face[number + 1])
    up, down = (faces[(side * solids.skin_normal[faces, 2]).argmax()] for side in (1.0, -1.0))
    rise = solids.skin_first[:, :, 2] / solids.skin_area[:, None]
    return float((rise[down] - rise[up]) @ out)


def of_columns() -> list[Comparison]:
    whole, rows = DENSITY * GRAVITY * 3.0**2 / (2.0 * MODULUS), []
    for modes, odd in ((20, 1), (60, 2)):
        share = sum(8.0 / (np.pi * (2 * n + 1)) ** 2 for n in range(odd))
        found = shortened(at_rest("standing", f"deformation.modes={modes}"), 0)
        quantity = f"standing bar: shortening by {modes} modes, {odd} of them odd along it, m"
        rows.append(row(quantity, whole * share, found, 1.5e-2))
    blocks = at_rest("stacked")
    found = np.array([shortened(blocks, k) for k in range(3)])
    for k in range(3):
        target = (k + 0.5) * DENSITY * GRAVITY / MODULUS
        quantity = f"three stacked blocks: shortening of block {k + 1}, 60 modes and strains, m"
        rows.append(row(quantity, target, float(found[k]), 2e-2))
        quantity, share = f"three stacked blocks: share of block {k + 1} in it", (2 * k + 1) / 9.0
        rows.append(row(quantity, share, float(found[k] / found.sum()), 5e-3))
    return rows


def moments(simulation: Simulation, places: np.ndarray) -> np.ndarray:
    """Bending moment [N m] at places [m] from the end on which the load of body 1 stands, positive where the upper side is pulled.

    From the stress of the modes at both surfaces, over the width and two metres along.
    """
    modes = simulation.bent[0].modes
    stress = np.tensordot(simulation.state.bodies.coordinate[0], modes.stress, 1)[:, 0]
    corner, found = modes.nodes[: len(stress)], []
    for height in (corner[:, 2].min(), corner[:, 2].max()):
        skin = np.abs(corner[:, 2] - height) < 1e-6
        place, value = corner[:, 0].max() - corner[skin, 0], stress[skin]
        near = [np.abs(place - x) < 1.0 for x in places]
        found.append([np.polynomial.Polynomial.fit(place[n], value[n], 2)(x) for n, x in zip(near, places, strict=True)])
    return (np.array(found[1]) - np.array(found[0])) / 2.0 * reference.second_moment() / (0.5 * reference.THICKNESS)


def of_floats() -> list[Comparison]:
    rows = []
    stiff = at_rest("endload")
    load_on, e, length = stiff.model.solids.mass[1] * GRAVITY, 5.0 - float(stiff.state.bodies.position[1, 0]), 10.0
    x = length / 3.0
    level, rise = load_on * (4.0 * length - 6.0 * e) / length**2, load_on * (12.0 * e - 6.0 * length) / length**3
    target = load_on * (x - e) - level * x * x / 2.0 - rise * x**3 / 6.0
    found = float(moments(stiff, np.array([x]))[0])
    rows.append(row("stiff floe on water, loaded at its end: moment at L/3, N m", target, found, 3e-2))
    long = at_rest("strip")
    water = long.case.water.density * GRAVITY * reference.WIDTH
    load_on, e = long.model.solids.mass[1] * GRAVITY, 30.0 - float(long.state.bodies.position[1, 0])
    scale = (4.0 * FLEXURE / water) ** 0.25
    places = np.linspace(1.0, 12.0, 45)
    s = places / scale
    target = float((load_on * np.exp(-s) * (scale * np.sin(s) - e * (np.cos(s) + np.sin(s)))).max())
    found = float(moments(long, places).max())
    rows.append(row("long floe on water, loaded at its end: largest moment, N m", target, found, 5e-2))
    return rows


def met(case: str, modes: int) -> tuple[np.ndarray, np.ndarray, Simulation]:
    """Times [s] and forces [N] of a hit of two bodies, and the simulation after it."""
    simulation, times, forces = start(case, f"deformation.modes={modes}"), [], []
    while simulation.time < simulation.case.time.duration * (1.0 - 1e-12):
        assert simulation.advance(1) == Status.DONE
        times.append(simulation.time)
        forces.append(float(simulation.state.bodies.contact_force[1, 0]))
    return np.array(times), np.array(forces), simulation


def of_hits() -> list[Comparison]:
    pace, rows = np.sqrt(MODULUS / DENSITY), []
    times, forces, bars = met("bars", 60)
    mass = float(bars.model.solids.mass[0])
    spring = MODULUS / (1.0 - 0.3**2) * 1.018 * np.sqrt(0.25 / np.pi)
    together, momentum = 2.0 * 4.0 / pace + 1.678 * DENSITY * pace * 0.25 / (2.0 * spring), mass * 0.3
    lasted = float(np.ptp(times[forces > 0.0]))
    rows.append(row("bars end on end, 60 modes: time of contact, s", together, lasted, 1e-2))
    found = float(forces.sum() * bars.dt)
    rows.append(row("bars end on end, 60 modes: momentum of the wave, N s", momentum, found, 5e-2))
    bound = DENSITY * pace * 2.8 * 0.5 * 0.15
    for modes, allowed in ((0, np.inf), (20, np.inf), (40, 3e-2)):
        _, forces, floes = met("flush", modes)
        quantity = f"flush hit of two floes, {modes} modes: highest force, N"
        rows.append(row(quantity, bound, float(forces.max()), allowed))
        kept = sum(floes.energy.get(name, 0.0) for name in ("kinetic", "elastic", "modal")) - floes.energy["gain_law"]
        whole = float(floes.model.solids.mass.sum()) * 0.15**2 / 2.0
        rows.append(row(f"flush hit of two floes, {modes} modes: energy after it, J", whole, kept, 1e-3))
    return rows


def of_rocking(until: float = 60.0) -> list[Comparison]:
    simulation = start("rocking")

    def stored() -> float:
        return sum(simulation.energy[name] for name in ("kinetic", "gravity", "buoyancy", "elastic", "modal"))

    before, worst, most = stored(), 0.0, 0.0
    while simulation.time < until * (1.0 - 1e-12):
        simulation.step(1000)
        worst, most = max(worst, abs(stored() - before)), max(most, simulation.energy["kinetic"])
    quantity = f"floe that rocks in still water for {until:g} s: energy that is lost or won, J"
    return [Comparison(FOLDER, quantity, 0.0, worst, 1e-5, most)]


def compare() -> list[Comparison]:
    return of_supports() + of_cantilever() + of_columns() + of_floats() + of_hits() + of_rocking()


@pytest.mark.parametrize("rows", [of_supports, of_cantilever, of_columns, of_hits])
def test_bodies_bend_as_theory_has_it(rows):
    check(rows())


def test_a_floe_that_rocks_keeps_its_energy():
    check(of_rocking(6.0))
