"""At which frequencies a structure on a beam answers the ice."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from dilatedem.post.figures.canvas import BLACK, BLUE, GREEN, SKY, Drawing, file_name, new_figure, styled
from dilatedem.post.labels import number
from dilatedem.results.tables import Table, row_count

#: line style of each horizontal axis
LOOKS = {"x": (BLUE, "-"), "y": (GREEN, (0, (4, 1.5)))}
#: rows below which there is no spectrum
FEWEST = 64
#: pieces that a history is cut into, each half over the next: their spectra are averaged
PIECES = 4
#: decades below the highest density that are drawn
DECADES = 8


def spectral_density(time: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies [Hz] and one-sided density [unit of values squared per Hz] of evenly sampled values, by Welch's method."""
    from scipy.signal import welch  # only where there is a spectrum: it loads half of SciPy

    step = float(np.median(np.diff(time)))
    even = np.concatenate([[True], np.abs(np.diff(time) - step) < 0.01 * step])  # the last window of a run may be short
    kept = values[even]
    piece = 2 * len(kept) // (PIECES + 1)
    frequency, density = welch(kept, 1.0 / step, nperseg=piece)
    return frequency[1:], density[1:]


@styled
def spectrum_figure(
    structure: str, motion: Table, frequencies: Mapping[str, Sequence[float]], history: Table | None = None
) -> Drawing | None:
    """Densities of displacement (above) and of the force of the foot beside that of the ice (below) against frequency.

    frequencies: natural ones, `along_x_Hz` and `along_y_Hz`; history: its rows of forces.csv. None of too short a run.
    """
    if row_count(motion) < FEWEST:
        return None
    figure = new_figure(8.2, 5.0)
    above, below = figure.subplots(2, 1, sharex=True)
    if history is not None and row_count(history) >= FEWEST:
        below.loglog(*spectral_density(history["time_s"], history["fx_N"] / 1e3), color=SKY, linewidth=0.8, label="ice along x")
    highest = {}
    for axis, (colour, style) in LOOKS.items():
        look = {"color": colour, "linestyle": style, "linewidth": 1.0}
        frequency, density = spectral_density(motion["time_s"], motion[f"{axis}_m"] * 1e3)
        highest[axis] = float(frequency[density.argmax()])
        above.loglog(frequency, density, label=f"along {axis}", **look)
        below.loglog(*spectral_density(motion["time_s"], motion[f"reaction_{axis}_N"] / 1e3), label=f"foot along {axis}", **look)
    natural = sorted({value for name in ("along_x_Hz", "along_y_Hz") for value in frequencies.get(name, ())})
    for axes, unit in ((above, "mm²/Hz"), (below, "kN²/Hz")):
        top = max((float(np.max(line.get_ydata())) for line in axes.lines), default=0.0)
        if top > 0.0:
            axes.set_ylim(10.0**-DECADES * top, 5.0 * top)
        for value in natural:
            axes.axvline(value, color=BLACK, linewidth=0.6, linestyle=":", zorder=1)
        axes.set_ylabel(f"Density ({unit})")
        axes.grid(True)
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3, borderaxespad=0.2)
    above.set_title(f"Response spectrum of {structure}")
    below.set_xlabel("Frequency (Hz)")
    figure.align_ylabels([above, below])
    told = ", ".join(number(value, 3) for value in natural)
    caption = (
        f"Spectral densities of the displacement of {structure} (mm²/Hz) and of the force that its foot bears, beside the ice's "
        f"(kN²/Hz), against frequency (Hz), by Welch's method in {PIECES} pieces. Dotted: natural frequencies, {told} Hz. The "
        f"displacement along x is strongest at {number(highest['x'], 3)} Hz."
    )
    return Drawing(f"spectrum_{file_name(structure)}", f"Response spectrum, {structure}", caption, figure)
