"""energy.csv: energies are noted as they come and made rows many at once."""

from dataclasses import asdict, dataclass, field

import numpy as np

from dilatedem.numerics import balance
from dilatedem.output import folder
from dilatedem.output.observer import TableObserver
from dilatedem.state.ledger import GAIN, LOAD, STORED, STRUCTURE, TERMS


@dataclass
class Totals:
    """What all rows of energy.csv say together."""

    initial_energy: float | None = None  # J
    largest_residual: float = 0.0  # J
    largest_work: float = 0.0  # J, of all loads and drives together, each by its size
    largest_stored: float = 0.0  # J, all that is stored, each by its size
    largest_turned_over: float = 0.0  # J
    largest_kinetic: float = 0.0  # J
    initial: dict[str, float] = field(default_factory=dict)  # J, every term of the first row
    largest_step_ratio: float = 0.0  # dt over the critical step of the open contacts


def work_up(noted: list[list[float]], names: list[str], totals: Totals) -> np.ndarray:
    """Bring energies into the totals; returns their rows of energy.csv: time, terms, residual.

    noted: time [s], dt over the critical step, and the terms called `names` [J] of each moment. A row on its own would take 20 us.
    """
    if not noted:
        return np.zeros((0, len(names) + 2))
    values = dict(zip(("time_s", "step_ratio", *names), np.array(noted).T, strict=True))
    there = [term for term in TERMS if term.name in values]
    total = sum(values[term.name] for term in there if term.sign == STORED)
    # a sum in another order would be another number: first what came in, then what went out
    flows = sorted((term for term in there if term.sign != STORED), key=lambda term: -term.sign)
    total = total - sum(term.sign * values[term.name] for term in flows)
    if totals.initial_energy is None:
        totals.initial_energy = float(total[0])
        totals.initial = {term.name: float(values[term.name][0]) for term in there}
    values["residual"] = total - totals.initial_energy
    totals.largest_residual = max(totals.largest_residual, float(np.abs(values["residual"]).max()))
    work = sum(np.abs(values[term.name]) for term in there if term.sign == GAIN and term.owner in (LOAD, STRUCTURE))
    totals.largest_work = max(totals.largest_work, float(np.max(work)))
    stored = balance.sizes(values[term.name] for term in there if term.sign == STORED)
    totals.largest_stored = max(totals.largest_stored, float(np.max(stored)))
    turned_over = balance.turned_over({name: values[name] - initial for name, initial in totals.initial.items()})
    totals.largest_turned_over = max(totals.largest_turned_over, float(np.max(turned_over)))
    totals.largest_kinetic = max(totals.largest_kinetic, float(np.max(values["kinetic"])))
    totals.largest_step_ratio = max(totals.largest_step_ratio, float(values["step_ratio"].max()))
    return np.column_stack([values[name] for name in ("time_s", *names, "residual")])


class Energies(TableObserver):
    """energy.csv: the ledger in time, and the largest residual of all its rows."""

    name, file = "energy", folder.ENERGY

    @classmethod
    def interval(cls, case) -> float:
        return case.output.energy_interval

    def open(self, kept: dict | None, since: int) -> None:
        self.names = list(self.simulation.energies())
        self.columns = ("time_s", *self.names, "residual")
        super().open(kept, since)
        self.totals = Totals(**kept["totals"]) if kept else Totals()
        self._noted: list[list[float]] = []  # time, step ratio and energies, since the last refresh

    def look(self, step: int, last: bool) -> None:
        if last or self.schedule.is_due(step):
            simulation = self.simulation
            self._noted.append([simulation.time_s, simulation.assembled_step_ratio(), *simulation.energies().values()])

    def refresh(self) -> None:
        noted, self._noted = self._noted, []
        rows = work_up(noted, self.names, self.totals)
        self.put(lambda table: table.append(rows))

    def kept(self) -> dict:
        return {"totals": asdict(self.totals)}

    def summary(self) -> dict:
        terms = self.simulation.energies() if self.simulation.state.clock.step[0] else {}
        totals, residual = self.totals, self.totals.largest_residual
        turned_over = totals.largest_turned_over
        in_flight = turned_over <= balance.FREE_FLIGHT * totals.largest_kinetic
        return {
            "dt_over_critical_of_open_contacts": totals.largest_step_ratio,
            "energy": {f"{name}_J": value for name, value in terms.items()}
            | {
                "residual_J": residual,
                "residual_over_work": balance.share(residual, totals.largest_work, totals.largest_stored),
                "turned_over_J": turned_over,
                "residual_over_turned_over": None if in_flight else balance.share(residual, turned_over, totals.largest_stored),
            },
        }
