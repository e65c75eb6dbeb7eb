"""The study of validation/statistics: a few ensembles of it, and its record."""

import math

import pytest

from validation.statistics.coverage import cells, coverage
from validation.statistics.run import HERE, recorded, table

#: ensembles that are made here, and three standard errors of 95 % of them
ENSEMBLES = 40
ERROR = 300.0 * math.sqrt(0.95 * 0.05 / ENSEMBLES)


@pytest.mark.parametrize("law", ["Pareto, shape 0.15", "GEV, shape -0.2"])
def test_bands_by_likelihood_hold(law):
    cell = next(cell for cell in cells() if cell.law == law and cell.runs == 20)
    assert all(percent >= 95.0 - ERROR for percent in coverage(cell, ENSEMBLES))


def test_the_record_is_whole_and_on_the_page():
    asked = {(name, cell.law, str(cell.runs)) for cell in cells() for name in cell.names}
    found = {(row["band"], row["law"], row["runs"]) for row in recorded() if int(row["ensembles"]) >= 400}
    assert found == asked
    assert (HERE / "README.md").read_text(encoding="utf-8").endswith(table())
