"""Tables on the ensembles of a study, for the reports of sweeps and of runs cut into blocks: statistics with bands, rare loads."""

from __future__ import annotations

import math
from typing import Any

from dilatedem.post.ensembles.laws import LEVELS, Extremes
from dilatedem.post.ensembles.measures import HIGHEST, MEAN_ALONG, QUANTITIES
from dilatedem.post.ensembles.study import Ensemble, Study
from dilatedem.post.ensembles.sweeps import value_words
from dilatedem.post.ensembles.table import Laws, of_quantity
from dilatedem.post.figures.extremes import idle_words, neighbour_words
from dilatedem.post.figures.sweep import plural, turning_label, turns, vector_words
from dilatedem.post.labels import axis_label, number
from dilatedem.statistics import Band, enough_for, needed

#: statistics that the tables show, with their heads
SHOWN = {"mean": "mean", "standard_deviation": "standard deviation", "median": "median", "percentile_90": "90 % of {noun}s below"}
#: share of the mean to which it is told how many runs it takes
CLOSENESS = 0.1

Rows = list[list[str]]


def ensemble_tables(study: Study, laws: Laws) -> dict[str, Any]:
    """What the templates show of the ensembles of a study."""
    structures = study.sweep.structures
    return {
        "noun": study.noun,
        "looked_at": part_words(study),
        "few": few_words(study),
        "heads": [head.format(noun=study.noun) for head in SHOWN.values()],
        "statistics": [table for structure in structures for table in statistics_tables(study, structure)],
        "enough": enough_words(study),
        "rare": [table for structure in structures if (table := rare_table(study, structure, laws))["rows"]],
        "doubts": doubts_of_laws(study, laws),
        "hits": f"{number(study.threshold / 1e3, 3)} kN, apart by {number(study.gap)} s or more below it",
    }


def part_words(study: Study) -> str:
    """Which part of the runs was looked at, and why."""
    said = f"Looked at: {study.looked_at}"
    if study.equalized:
        said += ", as far as the ice drifts in all of the runs, so that each meets as much of it"
    if study.left_out:
        said += f". Left out, as they end before: {', '.join(study.left_out)}"
    return f"{said}."


def few_words(study: Study) -> str:
    """What is left out of the tables for want of runs, nothing where nothing is."""
    least = enough_for(0.9)
    counts = [len(ensemble.members) for ensemble in study.ensembles]
    if min(counts, default=least) >= least:
        return ""
    few = f"What 90 % of the {study.noun}s stay below is told from {least} {study.noun}s on"
    return f"{few}: of fewer it would be no more than the largest."


def statistics_tables(study: Study, structure: str) -> list[dict[str, Any]]:
    """Of seeds alone all quantities in one table, else a row for each setting of the keys, in a table each for the main ones."""
    if not study.sweep.keys:
        rows = [
            [words[0].upper() + words[1:], *statistics_cells(ensemble, structure, quantity)]
            for ensemble in study.ensembles
            for quantity, words in QUANTITIES.items()
            if len(ensemble.sample(structure, quantity))
        ]
        return [{"title": f"{structure} (kN; hits: number)", "head": [f"of each {study.noun}"], "rows": rows}] if rows else []
    tables = []
    for quantity in (HIGHEST, MEAN_ALONG):
        rows = [
            [*value_cells(study, ensemble.values), *statistics_cells(ensemble, structure, quantity)]
            for ensemble in study.ensembles
            if len(ensemble.sample(structure, quantity))
        ]
        if rows:
            head = [head_words(study, key) for key in study.sweep.keys]
            tables.append({"title": f"{structure}: {QUANTITIES[quantity]} (kN)", "head": head, "rows": rows})
    return tables


def head_words(study: Study, key: str) -> str:
    """A key at the head of a column."""
    return turning_label(key) if turns(study, key) else axis_label(key)


def value_cells(study: Study, values: dict[str, Any]) -> list[str]:
    """Values of the keys; both components of a velocity that turns."""
    keys = study.sweep.keys
    return [vector_words(values[key]) if turns(study, key) else value_words(key, values[key]) for key in keys]


def statistics_cells(ensemble: Ensemble, structure: str, quantity: str) -> list[str]:
    """Number of runs, then each statistic with its band."""
    unit = 1e3 if quantity.endswith("_N") else 1.0
    found = of_quantity(ensemble, structure, quantity)
    return [str(found["mean"].n), *(band_words(found[name] / unit) for name in SHOWN)]


def band_words(band: Band) -> str:
    """An estimate and, behind it, its band as far as it is known; the band alone where there is no estimate."""
    value = number(band.value, 3)
    if band.closed:
        return f"{value} ({number(band.low, 3)} to {number(band.high, 3)})"
    if math.isfinite(band.low) and band.low != 0.0:
        return f"{value} (over {number(band.low, 3)})" if math.isfinite(band.value) else f"over {number(band.low, 3)}"
    return f"{value} (below {number(band.high, 3)})" if math.isfinite(band.high) else value


def enough_words(study: Study) -> list[str]:
    """How many runs it takes to know the mean of the highest load well, for each structure."""
    said = []
    for structure in study.sweep.structures:
        counts = [needed(ensemble.sample(structure, HIGHEST), CLOSENESS) for ensemble in study.ensembles]
        counts = [count for count in counts if count is not None]
        if counts:
            most = f"{min(counts)} to {max(counts)}" if min(counts) < max(counts) else str(counts[0])
            said.append(f"{structure}: about {most} {study.noun}s")
    return said


def rare_table(study: Study, structure: str, laws: Laws) -> dict[str, Any]:
    """Loads that one of so many runs exceeds, by the three laws, and how well these fit."""
    rows = []
    for place, ensemble in enumerate(study.ensembles):
        found = laws.get((place, structure))
        if found is None or found.gumbel is None:
            continue
        rows += [[*value_cells(study, ensemble.values), *cells] for cells in law_rows(found, study.noun)]
    return {"title": structure, "head": [head_words(study, key) for key in study.sweep.keys], "levels": LEVELS, "rows": rows}


def law_rows(found: Extremes, noun: str) -> Rows:
    """Law, what it is fitted to, its shape, its levels, how well it fits."""
    rows = []
    for name, words in (("gumbel", "Gumbel"), ("gev", "GEV"), ("pareto", "generalized Pareto")):
        law = getattr(found, name)
        if law is None:
            continue
        levels = [band_words(found.levels[name, runs] / 1e3) for runs in LEVELS]
        if name == "pareto":
            to = f"{plural(len(law.peaks), 'hit')} over {number(law.threshold / 1e3, 3)} kN"
        else:
            to = plural(len(law.maxima), noun)
        fit = "–" if name == "gev" else f"{number(100.0 * law.chance, 2)} %"
        shape = "0" if name == "gumbel" else band_words(law.shape)
        rows.append([words, to, shape, *levels, fit])
    return rows


def doubts_of_laws(study: Study, laws: Laws) -> list[str]:
    """For each structure how many bore no load, and whether blocks are independent; of several settings the doubtful ones."""
    several = len(study.ensembles) > 1
    found = []
    for (place, structure), law in laws.items():
        said = idle_words(law, study.noun) + (neighbour_words(law) if law.depend or not several else "")
        if said and law.gumbel is not None:
            setting = f", {', '.join(value_cells(study, study.ensembles[place].values))}" if several else ""
            found.append(f"{structure}{setting}:{said}")
    return found
