"""Rare loads of an ensemble: return levels, Gumbel paper, mean residual life, the band against the number of runs."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator
from scipy import stats

from dilatedem.post.ensembles.laws import Extremes
from dilatedem.post.ensembles.study import Ensemble, Study
from dilatedem.post.figures.canvas import BLACK, BLUE, GREEN, ORANGE, SKY, VERMILION, Drawing, file_name, new_figure, styled
from dilatedem.post.figures.sweep import setting_words, turns
from dilatedem.post.labels import number
from dilatedem.statistics import Band, Gumbel, Pareto, fit_gumbel, growth, needed
from dilatedem.statistics.gumbel import plotting_places, reduced

#: runs of which one exceeds a load: where the levels are drawn, and their marks on the axis
RARE = np.array([1.05, 1.2, 1.5, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0, 100.0])
RARE_MARKS = (2, 5, 10, 20, 50, 100)
#: per cent of the runs on Gumbel paper
SHARES = (5, 20, 50, 80, 90, 95, 98, 99)
#: share of the mean to which it is told how many runs it takes; the level whose band is drawn beside it
CLOSENESS, RARE_OF_GROWTH = 0.1, 10
#: with fewer runs there is nothing to see, and from so many on the growth of a band is drawn
FEWEST, FIRST = 8, 5


@styled
def extremes_figure(study: Study, ensemble: Ensemble, structure: str, laws: Extremes, place: int) -> Drawing | None:
    """Four panels on the highest horizontal load of the runs, or blocks, of one ensemble, the `place`-th of the sweep."""
    if laws.gumbel is None or len(laws.maxima) < FEWEST:
        return None
    figure = new_figure(8.2, 7.0)
    panels = figure.subplots(2, 2)
    draw_levels(panels[0, 0], laws, study.noun)
    draw_paper(panels[0, 1], laws.gumbel, study.noun)
    draw_excess(panels[1, 0], laws)
    draw_growth(panels[1, 1], laws.maxima, study.noun)
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    keys = study.sweep.keys
    setting = setting_words(ensemble.values, keys, turning=[key for key in keys if turns(study, key)])
    title = f"Rare loads on {structure}" + (f", {setting}" if setting else "")
    name = f"extremes_{file_name(structure)}" + (f"_{place:02d}" if len(study.ensembles) > 1 else "")
    return Drawing(name, title, caption(study, laws), figure)


def caption(study: Study, laws: Extremes) -> str:
    gumbel, pareto, nouns = laws.gumbel, laws.pareto, f"{study.noun}s"
    said = (
        f"Highest horizontal force of {len(laws.maxima)} {nouns} ({study.looked_at}), kN. Above left: the load that one of so many "
        f"{nouns} exceeds, by the laws, with 95 % bands; dots: the {nouns}. Above right: the {nouns} on Gumbel paper, shaded where "
        f"95 % of {nouns} of this law would lie (correlation {number(gumbel.correlation, 3)}; {number(100.0 * gumbel.chance, 2)} % "
        f"of samples of the law lie as badly). Below left: by how much hits exceed a threshold on average, with 95 % bands; "
        f"straight where a generalized Pareto law holds. "
    )
    if pareto:
        chosen = "as asked for" if study.fixed else "the lowest that fits"
        said += (
            f"Threshold {number(pareto.threshold / 1e3, 3)} kN ({chosen}), {len(pareto.peaks)} hits above it, shape "
            f"{number(pareto.shape.value, 2)} ({number(pareto.shape.low, 2)} to {number(pareto.shape.high, 2)}). "
        )
    enough = needed(laws.maxima, CLOSENESS)
    told = f" It would take about {enough} {nouns} to know the mean within {100.0 * CLOSENESS:g} %." if enough else ""
    growing = f"Below right: mean of the first n {nouns}, and the load that one of {RARE_OF_GROWTH} exceeds, with 95 % bands."
    return said + growing + told + idle_words(laws, study.noun) + neighbour_words(laws)


def idle_words(laws: Extremes, noun: str) -> str:
    """How many runs or blocks bore nothing, which no law foresees, as a sentence; nothing where all bore some load."""
    idle = int(np.count_nonzero(laws.maxima == 0.0))
    return f" {idle} of the {noun}s bore no load, which the laws do not foresee." if idle else ""


def neighbour_words(laws: Extremes) -> str:
    """Whether blocks may be taken for independent, as a sentence; nothing of runs, which are."""
    if laws.neighbours is None:
        return ""
    found, chance = (number(value, 2) for value in laws.neighbours)
    verdict = "they depend on each other, and bands are too narrow: take longer ones" if laws.depend else "chance alone would do"
    return f" Neighbouring blocks correlate by {found} (chance: within ±{chance}): {verdict}."


def draw_levels(axes: Axes, laws: Extremes, noun: str) -> None:
    """Levels on an axis on which Gumbel's law is straight."""
    marks = reduced(RARE)
    shown = (("Gumbel", laws.gumbel, BLUE, "-"), ("GEV", laws.gev, ORANGE, "--"), ("Pareto, from hits", laws.pareto, GREEN, "-."))
    for name, law, colour, dash in shown:
        if law is None:
            continue
        bands = [law.level(runs) for runs in RARE]
        draw_band(axes, marks, bands, colour, dash, name)
    place = reduced(1.0 / (1.0 - plotting_places(len(laws.maxima))))
    axes.plot(place, np.sort(laws.maxima) / 1e3, "o", color=BLACK, markersize=3.5, label=f"{noun}s", zorder=4)
    axes.set_xticks(reduced(np.array(RARE_MARKS)), [str(runs) for runs in RARE_MARKS])
    top = max(laws.maxima.max(), max((band.value for band in laws.levels.values() if np.isfinite(band.value)), default=0.0))
    axes.set_ylim(0.0, 1.6 * top / 1e3)
    axes.set_xlabel(f"Exceeded by one {noun} of")
    axes.set_ylabel("Highest horizontal force (kN)")
    axes.set_title("Return levels")
    axes.grid(True)


def draw_band(axes: Axes, place: np.ndarray, bands: list[Band], colour: str, dash: str, label: str | None) -> None:
    """Estimates [N] and their bands, in kN; an open end is as far as the axis goes."""
    value, low, high = (np.array([getattr(band, end) for band in bands]) / 1e3 for end in ("value", "low", "high"))
    known = np.isfinite(value)
    place, value, low, high = place[known], value[known], low[known].clip(0.0), high[known]
    shade = {"color": colour, "alpha": 0.13, "linewidth": 0, "zorder": 1}
    axes.fill_between(place, low, high.clip(max=1e3 * value.max(initial=1.0)), **shade)
    for end in (low, high):
        axes.plot(place, np.where(np.isfinite(end), end, np.nan), color=colour, linewidth=0.6, linestyle=dash, zorder=2)
    axes.plot(place, value, color=colour, linestyle=dash, linewidth=1.5, label=label, zorder=3)


def draw_paper(axes: Axes, law: Gumbel, noun: str) -> None:
    """Probability plot: the sorted loads against the share of runs, or blocks, that stay below, straight for this law."""
    count = len(law.maxima)
    rank = np.arange(1, count + 1)
    variate = reduced(1.0 / (1.0 - plotting_places(count)))
    fitted = stats.gumbel_r(law.location.value / 1e3, law.scale.value / 1e3)
    ends = [fitted.ppf(stats.beta.ppf(share, rank, count + 1 - rank)) for share in (0.025, 0.975)]
    axes.fill_betweenx(variate, *ends, color=SKY, alpha=0.35, linewidth=0)
    axes.plot(fitted.ppf(np.exp(-np.exp(-variate))), variate, color=BLUE)
    axes.plot(law.maxima / 1e3, variate, "o", color=BLACK, markersize=3.5)
    shares = [share for share in SHARES if variate[0] - 0.6 < -np.log(-np.log(share / 100.0)) < variate[-1] + 0.6]
    axes.set_yticks([-np.log(-np.log(share / 100.0)) for share in shares], [f"{share}" for share in shares])
    axes.set_xlabel("Highest horizontal force (kN)")
    axes.set_ylabel(f"{noun.capitalize()}s that stay below (%)")
    axes.set_title("Gumbel paper")
    axes.grid(True)


def draw_excess(axes: Axes, laws: Extremes) -> None:
    """Mean residual life, and what the fitted law says of it."""
    found = laws.excess
    axes.set_title("Mean residual life of hits")
    axes.set_xlabel("Threshold (kN)")
    axes.set_ylabel("Mean excess (kN)")
    if not found:
        axes.annotate("too few hits", (0.5, 0.5), xycoords="axes fraction", ha="center")
        return
    place = np.array([threshold for threshold, _ in found]) / 1e3
    draw_band(axes, place, [band for _, band in found], VERMILION, "-", None)
    if laws.pareto:
        draw_law_of_excess(axes, laws.pareto, place[-1])
    axes.set_ylim(0.0, 2.5 * max(band.value for _, band in found) / 1e3)
    axes.set_xlim(left=0.0)
    axes.grid(True)


def draw_law_of_excess(axes: Axes, law: Pareto, last: float) -> None:
    """The straight line (scale + shape (u - threshold))/(1 - shape) from the law's threshold on, which is marked; last [kN]."""
    first, shape = law.threshold / 1e3, law.shape.value
    axes.axvline(first, color="0.4", linestyle=":", linewidth=1.0)
    if shape < 1.0 and last > first:
        place = np.array([first, last])
        axes.plot(place, (law.scale / 1e3 + shape * (place - first)) / (1.0 - shape), color=GREEN, linestyle="-.")


def draw_growth(axes: Axes, maxima: np.ndarray, noun: str) -> None:
    """The first n runs, in the order of the sweep: the mean, and a rarer load by Gumbel's law."""
    count = len(maxima)
    every = np.unique(np.linspace(FIRST, count, min(24, count - FIRST + 1)).round().astype(int))
    laws = [fit_gumbel(maxima[:n]) for n in every]
    rare = [law.level(RARE_OF_GROWTH) if law else Band(0, np.nan) for law in laws]
    draw_band(axes, every, rare, ORANGE, "--", None)
    means = growth(maxima)
    draw_band(axes, every, [means[n - 1] for n in every], BLUE, "-", None)
    axes.plot(np.arange(1, count + 1), maxima / 1e3, "o", color=BLACK, markersize=2.5, alpha=0.6)
    for words, value, colour in ((f"one of {RARE_OF_GROWTH}", rare[-1].value, "#9a6a00"), ("mean", means[-1].value, BLUE)):
        place = {"xy": (count, value / 1e3), "xytext": (5, 0), "textcoords": "offset points", "va": "center"}
        axes.annotate(words, color=colour, annotation_clip=False, **place)
    axes.set_title(f"Band against number of {noun}s")
    top = max(maxima.max(), max(band.value for band in rare if np.isfinite(band.value)))
    axes.set_ylim(0.0, 1.5 * top / 1e3)
    axes.set_xlim(0.0, count + 0.5)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set_xlabel(f"Number of {noun}s n")
    axes.set_ylabel("Highest horizontal force (kN)")
    axes.grid(True)
