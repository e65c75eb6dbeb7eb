"""How a structure that is not held moves, and what its base bears."""

from __future__ import annotations

import numpy as np

from dilatedem.post.figures.canvas import BLACK, BLUE, GREEN, SKY, Drawing, file_name, new_figure, styled
from dilatedem.post.labels import number
from dilatedem.results.tables import Table

#: line style of each horizontal axis
LOOKS = {"x": (BLUE, "-"), "y": (GREEN, (0, (4, 1.5)))}
#: displacements up to here are drawn in millimetres, m
SMALL = 0.5


@styled
def motion_figure(structure: str, motion: Table, history: Table | None = None) -> Drawing:
    """Displacement along x and y (above) and reaction of the base (below) against time; history: its rows of forces.csv."""
    time = motion["time_s"]
    far = max(float(np.abs(motion[f"{axis}_m"]).max()) for axis in LOOKS)
    scale, unit = (1e-3, "mm") if far < SMALL else (1.0, "m")
    figure = new_figure(8.2, 4.6)
    above, below = figure.subplots(2, 1, sharex=True)
    if history is not None:
        below.plot(history["time_s"], history["fx_N"] / 1e3, color=SKY, linewidth=0.8, label="ice along x, mean of a window")
    for axis, (colour, style) in LOOKS.items():
        look = {"color": colour, "linestyle": style, "linewidth": 1.0}
        above.plot(time, motion[f"{axis}_m"] / scale, label=f"along {axis}", **look)
        below.plot(time, motion[f"reaction_{axis}_N"] / 1e3, label=f"base along {axis}", **look)
    above.set_title(f"Motion of {structure}")
    above.set_ylabel(f"Displacement ({unit})")
    below.set_ylabel("Force (kN)")
    below.set_xlabel("Time (s)")
    for axes in (above, below):
        axes.axhline(0.0, color=BLACK, linewidth=0.5, zorder=1)
        axes.grid(True)
        axes.margins(y=0.08)
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3, borderaxespad=0.2)
    if len(time) > 1:
        below.set_xlim(float(time[0]), float(time[-1]))
    figure.align_ylabels([above, below])
    reached = number(float(np.hypot(motion["x_m"], motion["y_m"]).max()) / scale, 4)
    turned = float(np.abs(motion["yaw_rad"]).max())
    turning = f", turned by up to {number(np.degrees(turned), 3)}°" if turned > 0.0 else ""
    caption = (
        f"Displacement of {structure} from its place ({unit}), and the force that it passes on to its base (kN), against time (s), "
        f"as they were at the end of each window: up to {reached} {unit}{turning}. Of a driven structure the base bears the load "
        "of the ice, of one on springs the force in springs and dashpots."
    )
    return Drawing(f"motion_{file_name(structure)}", f"Motion, {structure}", caption, figure)
