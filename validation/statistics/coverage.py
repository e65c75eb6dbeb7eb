"""How often a 95 % band holds what it should: ensembles of known laws, band by band."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy import stats

from dilatedem.statistics import Band, deviation, fit_gev, fit_gumbel, fit_pareto, mean, quantile

#: per cent of the ensembles whose band must hold the true value
LEAST, MOST = 93.0, 97.0
#: laws of single values. Loads have the shapes of the first ones: means near the normal law, highest loads near Gumbel's
LAWS = {
    "normal": stats.norm(10.0, 3.0),
    "Gumbel": stats.gumbel_r(10.0, 3.0),
    "lognormal, 40 %": stats.lognorm(0.4, scale=10.0),
    "gamma, 58 %": stats.gamma(3.0),
    "exponential": stats.expon(),
    "uniform": stats.uniform(),
}
SIZES = (10, 20, 50)
PERCENTILES = (10, 50, 90, 95)
SHAPES = (-0.2, 0.0, 0.15)
#: runs that exceed a level once
LEVELS = (10, 100)
#: hits in a run above the threshold, on average
RATE = 5.0

Estimate = Callable[[np.random.Generator], list[tuple[Band | None, float]]]  # bands of one ensemble, and what is true


@dataclass(frozen=True)
class Cell:
    """One kind of ensemble: names of its bands, the law, the number of runs, and how one is made."""

    names: tuple[str, ...]
    law: str
    runs: int
    make: Estimate


def cells() -> Iterator[Cell]:
    for runs in SIZES:
        for name, law in LAWS.items():
            yield Cell(("mean", "standard deviation", *(f"{p} % percentile" for p in PERCENTILES)), name, runs, plain(law, runs))
        names = ("Gumbel: location", "Gumbel: scale", *(f"Gumbel: level of {level} runs" for level in LEVELS))
        yield Cell(names, "Gumbel", runs, gumbel(runs))
    for runs in SIZES:
        for shape in SHAPES:
            names = ("Pareto: rate", "Pareto: shape", *(f"Pareto: level of {level} runs" for level in LEVELS))
            yield Cell(names, f"Pareto, shape {shape:g}", runs, pareto(shape, runs))
    for runs in (20, 50):
        for shape in SHAPES:
            names = ("GEV: shape", *(f"GEV: level of {level} runs" for level in LEVELS))
            yield Cell(names, f"GEV, shape {shape:g}", runs, gev(shape, runs))


def plain(law, runs: int) -> Estimate:
    """Mean, standard deviation and percentiles of single values."""

    def make(random: np.random.Generator) -> list[tuple[Band | None, float]]:
        values = law.rvs(runs, random_state=random)
        shares = [(quantile(values, p / 100.0), float(law.ppf(p / 100.0))) for p in PERCENTILES]
        return [(mean(values), law.mean()), (deviation(values), law.std()), *shares]

    return make


def gumbel(runs: int) -> Estimate:
    law = stats.gumbel_r(10.0, 3.0)

    def make(random: np.random.Generator) -> list[tuple[Band | None, float]]:
        fit = fit_gumbel(law.rvs(runs, random_state=random))
        return [(fit.location, 10.0), (fit.scale, 3.0), *((fit.level(n), float(law.ppf(1.0 - 1.0 / n))) for n in LEVELS)]

    return make


def gev(shape: float, runs: int) -> Estimate:
    law = stats.genextreme(-shape, 10.0, 3.0)

    def make(random: np.random.Generator) -> list[tuple[Band | None, float]]:
        fit = fit_gev(law.rvs(runs, random_state=random))
        return [(fit.shape, shape), *((fit.level(n), float(law.ppf(1.0 - 1.0 / n))) for n in LEVELS)]

    return make


def pareto(shape: float, runs: int) -> Estimate:
    """Hits come by Poisson's law, RATE in a run; an ensemble with too few of them to fit has no bands."""
    law = stats.genpareto(shape, 20.0, 5.0)
    true = [float(law.isf(-np.log1p(-1.0 / n) / RATE)) for n in LEVELS]

    def make(random: np.random.Generator) -> list[tuple[Band | None, float]]:
        fit = fit_pareto(law.rvs(random.poisson(RATE * runs), random_state=random), 20.0, runs)
        if fit is None:
            return [(None, 0.0)] * (2 + len(LEVELS))
        return [(fit.rate, RATE), (fit.shape, shape), *((fit.level(n), value) for n, value in zip(LEVELS, true, strict=True))]

    return make


def coverage(cell: Cell, ensembles: int, seed: int = 1) -> list[float]:
    """Per cent of the ensembles whose bands hold what is true, a number for each band of the cell."""
    random = np.random.default_rng([seed, cell.runs, *cell.law.encode()])
    held = [[band.low <= true <= band.high for band, true in cell.make(random) if band] for _ in range(ensembles)]
    return [100.0 * float(share) for share in np.mean([row for row in held if row], axis=0)]
