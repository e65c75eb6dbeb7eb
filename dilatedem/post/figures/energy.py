"""The energy ledger in time: where the current's work went, and what is left unexplained."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from dilatedem.numerics import balance
from dilatedem.post.figures.canvas import (
    BLACK,
    BLUE,
    GREEN,
    ORANGE,
    PURPLE,
    SERIES,
    SKY,
    VERMILION,
    Drawing,
    new_figure,
    styled,
)
from dilatedem.post.labels import number
from dilatedem.results.tables import Table

STORED = ("kinetic", "gravity", "buoyancy", "elastic")  # columns of what is stored
ROUND_OFF = 1e-18  # of what is stored: terms that stay below are left out
# label, columns added up, colour, line style
TERMS = (
    ("work of the current (drag)", ("work_drag",), BLUE, "-"),
    ("work of the structures", ("work_structure",), BLACK, "--"),
    ("kinetic", ("kinetic",), GREEN, "-"),
    ("gravity + buoyancy", ("gravity", "buoyancy"), SKY, "-"),
    ("elastic", ("elastic",), PURPLE, "-"),
    ("lost to damping", ("loss_damping",), VERMILION, "-"),
    ("lost to friction", ("loss_friction",), ORANGE, "-"),
    ("made by jumps of the contact law", ("gain_law",), BLACK, ":"),
)


@styled
def energy_figure(energy: Table, labels: Mapping[str, str] = MappingProxyType({})) -> Drawing:
    """Terms of energy.csv since the start (above) and the residual of the ledger (below); labels: in words, of terms by name."""
    time = energy["time_s"]
    known = [term for term in TERMS if present(energy, term[1])]
    shown = {"time_s", "residual", *(name for term in known for name in term[1])}
    others = sorted(set(energy) - shown)
    further = [(labels.get(name, name.replace("_", " ")), (name,), SERIES[n % len(SERIES)], "-.") for n, name in enumerate(others)]
    terms = [(label, energy_change(energy, names), *look) for label, names, *look in (*known, *further)]
    stored = sum(float(np.abs(energy[name]).max(initial=0.0)) for name in STORED if name in energy)
    terms = [term for term in terms if np.abs(term[1]).max(initial=0.0) > ROUND_OFF * stored]
    largest = max((float(np.abs(values).max()) for _, values, *_ in terms), default=0.0)
    scale, unit = scale_of(largest)
    figure = new_figure(8.2, 5.4)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(2.4, 1.0))
    for label, values, colour, line in terms:
        above.plot(time, values / scale, color=colour, linestyle=line, label=label)
    above.set_ylabel(f"Energy since t = {number(float(time[0]))} s ({unit})")
    figure.legend(*above.get_legend_handles_labels(), loc="outside upper center", ncols=3)
    residual = energy["residual"]
    small, small_unit = scale_of(float(np.abs(residual).max()))
    below.plot(time, residual / small, color=BLACK, linewidth=1.0)
    below.set_ylabel(f"Residual ({small_unit})")
    below.set_xlabel("Time (s)")
    for axes in (above, below):
        axes.grid(True)
        axes.axhline(0.0, color=BLACK, linewidth=0.5, zorder=1)
    if len(time) > 1:
        below.set_xlim(float(time[0]), float(time[-1]))
    below.margins(y=0.12)
    figure.align_ylabels([above, below])
    words = ""
    share = residual_share(energy)
    if share is not None:
        words = f" The largest residual is {number(100.0 * share, 3)} % of the largest work of the loads."
    caption = (
        f"Energy ledger against time (s). Above: each term's change since the first row ({unit}), terms that "
        f"stay zero left out; below: what the ledger leaves unexplained ({small_unit}).{words}"
    )
    return Drawing("energy", "Energy ledger", caption, figure)


def present(energy: Table, names: tuple[str, ...]) -> bool:
    return all(name in energy for name in names)


def energy_change(energy: Table, names: tuple[str, ...]) -> np.ndarray:
    """Sum of these columns [J], less its first value."""
    total = np.sum([energy[name] for name in names], axis=0)
    return total - total[0]


def residual_share(energy: Table) -> float | None:
    """Largest residual over the largest work of all loads, each by its size; None where they did none but round-off."""
    loads = [name for name in energy if name.startswith("work_")]
    if "residual" not in energy or not loads or not len(energy["time_s"]):
        return None
    stored = [name for name in STORED if name in energy]
    work, size = (float(np.sum([np.abs(energy[name]) for name in names], axis=0).max(initial=0.0)) for names in (loads, stored))
    return balance.share(float(np.abs(energy["residual"]).max()), work, size)


def scale_of(largest: float) -> tuple[float, str]:
    """(divisor, unit) that bring an energy [J] into a readable range."""
    for divisor, unit in ((1e6, "MJ"), (1e3, "kJ"), (1.0, "J"), (1e-3, "mJ")):
        if largest >= divisor:
            return divisor, unit
    return (1.0, "J") if largest == 0.0 else (1e-6, "µJ")
