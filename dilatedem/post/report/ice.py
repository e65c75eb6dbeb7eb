"""The ice field in figures: how many floes of which sizes, and how they are spread."""

from __future__ import annotations

import math

import numpy as np

from dilatedem.post.labels import number
from dilatedem.post.read import RunFolder

#: per cent of the floes between which sizes are told
SPREAD = (5.0, 50.0, 95.0)


def field_rows(run: RunFolder) -> list[list[str]]:
    """What, value and unit of the floes at the start; nothing of a run that did not record them.

    Where ice enters on the way, run.h5 holds the floes that are there at the end, and those that load events name.
    """
    floes = run.ice
    if floes is None or not len(floes.outlines):
        return []
    entering = "inflow" in run.boundaries
    size, mass = np.sqrt(floes.plan_area), floes.mass
    least, most = number(float(size.min()), 3), number(float(size.max()), 3)
    rows = [
        ["floes there at the end, or named by load events: of these" if entering else "floes", str(len(size)), ""],
        ["floe size: root of the mean plan area", number(math.sqrt(float(floes.plan_area.mean()))), "m"],
        ["smallest and largest floe, root of the plan area", f"{least} to {most}", "m"],
    ]
    low, middle, high = (number(float(value), 3) for value in np.percentile(size, SPREAD))
    rows.append(["5 %, half and 95 % of the floes are smaller than", f"{low}, {middle}, {high}", "m"])
    if not entering:
        lx, ly = run.domain_size
        rows.append(["share of the domain that they cover", number(100.0 * float(floes.plan_area.sum()) / (lx * ly), 3), "%"])
    rows.append(["mass of a floe: mean, smallest to largest", masses(mass), "t"])
    if not entering:
        rows.append(["mass of all floes", number(float(mass.sum()) / 1e3), "t"])
    corners = np.array([len(outline) for outline in floes.outlines])
    mean = number(float(corners.mean()), 3)
    rows.append(["corners of a floe: mean, fewest to most", f"{mean}, {corners.min()} to {corners.max()}", ""])
    if run.afloat:
        rows.append(["draft and freeboard of the mean thickness", " and ".join(number(value, 3) for value in run.afloat), "m"])
    return rows


def masses(mass: np.ndarray) -> str:
    mean, least, most = (number(float(value) / 1e3, 3) for value in (mass.mean(), mass.min(), mass.max()))
    return f"{mean}, {least} to {most}"
