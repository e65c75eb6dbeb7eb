"""statistics.csv: what an ensemble says of each structure, with bands, a row per number."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from dilatedem.files.atomic import write_text
from dilatedem.post.ensembles.laws import Extremes
from dilatedem.post.ensembles.measures import HIGHEST, QUANTITIES
from dilatedem.post.ensembles.study import Ensemble, Study
from dilatedem.post.harm import STATISTICS, STATISTICS_END
from dilatedem.statistics import Band, deviation, mean, quantile

#: of the values of all runs, in percent
PERCENTILES = (10, 90, 95)

Row = tuple[str, str, Band]  # quantity, statistic, its band
Laws = dict[tuple[int, str], Extremes]  # by number of the ensemble, and structure


def of_quantity(ensemble: Ensemble, structure: str, quantity: str) -> dict[str, Band]:
    """The statistics of one quantity over the runs of an ensemble."""
    values = ensemble.sample(structure, quantity)
    if not len(values):
        return {}
    return {
        "mean": mean(values), "standard_deviation": deviation(values), "median": quantile(values, 0.5),
        **{f"percentile_{share}": quantile(values, share / 100.0) for share in PERCENTILES},
    }  # fmt: skip


def rows_of(ensemble: Ensemble, structure: str, laws: Extremes, noun: str) -> Iterator[Row]:
    """All of one structure; noun: what is counted, run or block."""
    for quantity in QUANTITIES:
        for statistic, band in of_quantity(ensemble, structure, quantity).items():
            yield quantity, statistic, band
    for statistic, band in rows_of_laws(laws, noun):
        yield HIGHEST, statistic, band


def rows_of_laws(laws: Extremes, noun: str) -> Iterator[tuple[str, Band]]:
    """Parameters and goodness of the laws, then the loads that one of so many runs exceeds."""
    if laws.neighbours:
        yield "neighbour_correlation", Band(len(laws.maxima), laws.neighbours[0])
    if laws.gumbel:
        count = len(laws.gumbel.maxima)
        yield "gumbel_location", laws.gumbel.location
        yield "gumbel_scale", laws.gumbel.scale
        yield "gumbel_correlation", Band(count, laws.gumbel.correlation)
        yield "gumbel_fit_chance", Band(count, laws.gumbel.chance)
    if laws.gev:
        count = len(laws.gev.maxima)
        yield "gev_location", Band(count, laws.gev.location)
        yield "gev_scale", Band(count, laws.gev.scale)
        yield "gev_shape", laws.gev.shape
    if laws.pareto:
        count = len(laws.pareto.peaks)
        yield "pareto_threshold", Band(count, laws.pareto.threshold)
        yield "pareto_hits_in_a_run", laws.pareto.rate
        yield "pareto_scale", Band(count, laws.pareto.scale)
        yield "pareto_shape", laws.pareto.shape
        yield "pareto_fit_chance", Band(count, laws.pareto.chance)
    for (law, runs), band in laws.levels.items():
        yield f"{law}_level_{runs}_{noun}s", band


def write_statistics(study: Study, laws: Laws) -> Path:
    """statistics.csv in the sweep's folder."""
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([*study.sweep.keys, *STATISTICS_END.split(",")])
    for number, ensemble in enumerate(study.ensembles):
        values = [cell(ensemble.values[key]) for key in study.sweep.keys]
        for structure in study.sweep.structures:
            for quantity, statistic, band in rows_of(ensemble, structure, laws[number, structure], study.noun):
                ends = [f"{end:.9g}" if math.isfinite(end) else "" for end in (band.value, band.low, band.high)]
                writer.writerow([*values, structure, quantity, statistic, band.n, *ends])
    path = study.sweep.folder / STATISTICS
    write_text(path, text.getvalue())
    return path


def cell(value: Any) -> str:
    """A value of a key as sweep.csv has it."""
    return "" if value is None else value if isinstance(value, str) else json.dumps(value, default=str)
