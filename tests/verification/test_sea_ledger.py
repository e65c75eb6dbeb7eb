"""The energy ledger closes with every load of water and wind on, alone and together, while floes collide: its residual stays below
1e-4 of the work done, kinetic + ... - work + losses of docs/output.md.

Floes start at rest, so that what moves and what is lost is all work of these loads.
"""

from dilatedem.run.simulation import Simulation
from dilatedem.state.ledger import GAIN, LOAD, TERMS
from tests.verification.comparison import Comparison, by_model, check, follow, start

CASE = "sea_ledger"
#: what is left of the case, and what else is put in its place
CALM = ("water={velocity=[0.8, 0.1]}", "wind={}", "wave=[]")
ALONE = {
    "drag by skin and form": (*CALM, "water.drag=skin_form"),
    "water taken along": (*CALM, "water.added_mass=true"),
    "a shear": (*CALM, "water.shear=[[0.0, 1.0], [0.3, 0.8], [1.0, 0.4]]"),
    "a current that changes": ("water={velocity_table=[[0.0, 0.6, 0.0], [3.0, 1.0, 0.2], [6.0, 0.5, -0.2]]}", *CALM[1:]),
    "a wind that changes": (*CALM[:1], *CALM[2:]),
    "waves": CALM[:2],
    "all together": (),
}


def residual_and_work(simulation: Simulation) -> tuple[float, float]:
    """What the ledger leaves [J], up to its value at t = 0, and the work of all loads, each by its size."""
    energies = simulation.energies()
    terms = [term for term in TERMS if term.name in energies]
    residual = sum(energies[term.name] * (-term.sign if term.sign else 1) for term in terms)
    return residual, sum(abs(energies[term.name]) for term in terms if term.sign == GAIN and term.owner == LOAD)


def compare() -> list[Comparison]:
    return by_model(closures)


def closures(model: str) -> list[Comparison]:
    rows = []
    for what, overrides in ALONE.items():
        simulation = start(CASE, *overrides, model=model)
        _, seen = follow(simulation, 6.0, residual_and_work, every=200)
        residual, work = abs(seen[:, 0] - seen[0, 0]).max(), seen[:, 1].max()
        rows.append(Comparison(CASE, f"residual, J, of {work:.0f} J: {what}", 0.0, residual, 1e-4, scale=work))
    return rows


def test_the_ledger_closes_at_sea():
    check(compare())
