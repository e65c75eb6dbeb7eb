"""Energies of a run: noted as they come, made rows of energy.csv many at once."""

import numpy as np

from dilatedem.output.tables import ENERGY_COLUMNS
from dilatedem.state.ledger import STORED, TERMS


def work_up(noted: list[list[float]], names: list[str], totals) -> np.ndarray:
    """Bring energies into the totals of the run; returns their rows of energy.csv.

    noted: time [s], dt over the critical step, and the terms called `names` [J] of each moment. A row on its own would take 20 us.
    """
    if not noted:
        return np.zeros((0, len(ENERGY_COLUMNS)))
    values = dict(zip(("time_s", "step_ratio", *names), np.array(noted).T, strict=True))
    total = sum(values[term.name] for term in TERMS if term.sign == STORED)
    # a sum in another order would be another number: first what came in, then what went out
    flows = sorted((term for term in TERMS if term.sign != STORED), key=lambda term: -term.sign)
    total = total - sum(term.sign * values[term.name] for term in flows)
    if totals.initial_energy is None:
        totals.initial_energy = float(total[0])
    values["residual"] = total - totals.initial_energy
    totals.largest_residual = max(totals.largest_residual, float(np.abs(values["residual"]).max()))
    totals.largest_step_ratio = max(totals.largest_step_ratio, float(values["step_ratio"].max()))
    return np.column_stack([values[name] for name in ENERGY_COLUMNS])
