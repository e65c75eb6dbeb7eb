"""Figures of the ice: jam and lane in plan for one seed (Figs. 10, 11, 16, 17), and their mean over all seeds."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from dilatedem.post.figures.canvas import ICE_EDGE, STRUCTURE, STRUCTURE_EDGE, new_figure, styled
from dilatedem.post.figures.plan import View, draw_domain, draw_floes, draw_flows, draw_structures, dress
from dilatedem.results.snapshots import Snapshot, read_snapshot
from validation.liu2015.figures import SHOWN_SEED, shown_run
from validation.liu2015.ice import DRIFT, STRIP, empty_raster, rasterized, strips
from validation.liu2015.measures import JAM, Ensemble, Result
from validation.liu2015.plan import CASES, LARGE, MODELS, SIZE_SPEED

TIMES = (0.0, 50.0, 100.0)  # s, of the paper's Fig. 10
SPEED_MAP = "viridis"


@styled
def plan_views(ensemble: Ensemble, size: str) -> Figure | None:
    """The floes in plan, coloured by speed, at three times; a row a model."""
    chosen = [result for result in (shown_run(ensemble, model, size) for model in MODELS) if result is not None]
    chosen = [result for result in chosen if result.folder.snapshots]
    if not chosen:
        return None
    width, height = chosen[0].folder.domain_size
    view = View((-width / 2.0 - 1.0, width / 2.0 + 1.0), (-height / 2.0 - 1.0, height / 2.0 + 1.0))
    figure = new_figure(10.0, 3.2 * len(chosen) + 0.3)
    panels = figure.subplots(len(chosen), 3, sharex=True, sharey=True, squeeze=False)
    floes = None
    for row, result in zip(panels, chosen, strict=True):
        for axes, snapshot in zip(row, views(result, size), strict=True):
            dress(axes, result.folder, view)
            draw_domain(axes, result.folder)
            look = {"cmap": SPEED_MAP, "clim": (0.0, 1.1 * SIZE_SPEED), "edgecolors": ICE_EDGE, "linewidths": 0.3}
            floes = draw_floes(axes, result.folder, view, snapshot.outlines, array=snapshot.speed, **look)
            draw_structures(axes, result.folder)
            axes.set_title(f"{result.run.model}, t = {snapshot.time:.3g} s" if axes is row[0] else f"t = {snapshot.time:.3g} s")
        draw_flows(row[-1], result.folder)
    bar = figure.colorbar(floes, ax=panels, extend="max", shrink=0.7, aspect=35, pad=0.015)
    bar.set_label(f"Speed of the floes of {size} m, seed {SHOWN_SEED} (m/s)")
    return figure


def views(result: Result, size: str) -> list[Snapshot]:
    """Snapshots at the paper's times; of the small floes, the middle one where the ice ahead of the pile is slowest."""
    times = np.array([time for time, _ in result.folder.snapshots])
    wanted = [TIMES[0], jam_time(result) if size != LARGE else TIMES[1], TIMES[2]]
    nearest = [int(np.argmin(np.abs(times - time))) for time in wanted]
    return [read_snapshot(result.folder.snapshots[index][1], float(times[index])) for index in nearest]


def jam_time(result: Result) -> float:
    """When, in the time for which the paper reports a jam, the ice ahead of the pile is slowest; 50 s if the run is too short."""
    found = {}
    for time, path in result.folder.snapshots:
        if JAM[0] <= time <= JAM[1]:
            raster = empty_raster(result.folder)
            raster.add(rasterized(result.folder, read_snapshot(path, time)))
            speed = strips(result.folder, raster).get("speed_ahead_over_current", math.nan)
            if math.isfinite(speed):
                found[time] = speed
    return min(found, key=found.__getitem__) if found else TIMES[1]


@styled
def mean_ice(ensemble: Ensemble) -> Figure | None:
    """Concentration and speed around the pile, mean over seeds and over the snapshots within DRIFT; a column a size and model."""
    groups = []
    for model in MODELS:
        for size in CASES:
            found = [result for result in ensemble.chosen(model, size, SIZE_SPEED) if result.ice.instants]
            if found:
                groups.append((model, size, found))
    if not groups:
        return None
    figure = new_figure(2.35 * len(groups) + 1.0, 8.0)
    panels = figure.subplots(2, len(groups), sharex=True, sharey=True, squeeze=False)
    for column, (model, size, found) in zip(panels.T, groups, strict=True):
        total = empty_raster(found[0].folder)
        for result in found:
            total.add(result.ice)
        shown = (total.concentration, (0.0, 1.0), "Blues_r"), (total.speed / SIZE_SPEED, (0.0, 1.1), SPEED_MAP)
        for row, (axes, (values, limits, colours)) in enumerate(zip(column, shown, strict=True)):
            edges = {"cmap": colours, "vmin": limits[0], "vmax": limits[1], "shading": "nearest", "rasterized": True}
            mesh = axes.pcolormesh(total.x, total.y, values, **edges)
            radius = found[0].folder.structures[0]["radius"]
            axes.add_patch(Circle((0.0, 0.0), radius, facecolor=STRUCTURE, edgecolor=STRUCTURE_EDGE, zorder=4))
            axes.set_aspect("equal")
            axes.set_facecolor("#e6e6e6")
            if model == groups[-1][0] and size == groups[-1][1]:
                bar = figure.colorbar(mesh, ax=panels[row], shrink=0.8, aspect=28, pad=0.015)
                bar.set_label(("Mean concentration of the ice", "Mean speed of the ice along x / current")[row])
        column[0].set_title(f"{model}\n{size} m, n = {len(found)}")
        column[1].set_xlabel("x from the pile (m)")
    for axes in panels[:, 0]:
        axes.set_ylabel("y from the pile (m)")
    return figure


MEAN_ICE_CAPTION = (
    f"Mean over the seeds and over the snapshots between {DRIFT[0]:g} and {DRIFT[1]:g} m of drift at {SIZE_SPEED:g} m/s. "
    f"Ahead and behind: {STRIP:g} m long strips as wide as the pile."
)
