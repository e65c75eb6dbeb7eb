"""The ice around the pile: how much of it, and how fast, ahead of the pile, behind it and beside it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from dilatedem.post.figures.plan import periodic_copies
from dilatedem.post.read import RunFolder
from dilatedem.results.snapshots import Snapshot, read_snapshot

CELL = 0.25  # m, of the raster that areas are counted on
REACH = (-15.0, 10.0)  # m, of the raster along x from the pile's axis
#: m of drift between which ice is looked at: by the first, strips hold only ice that has come past the pile; by the last,
#: the ice that began at the domain's upstream side comes to the raster
DRIFT = (10.0, 20.0)
STRIP = 6.0  # m, length of the strips ahead of and behind the pile, which are as wide as the pile
FAR = 0.25  # of the domain's width: beyond it, to either side of the pile, ice counts as beside it


@dataclass
class Raster:
    """Sums over instants: how often a place was covered with ice, and the ice's velocity along x there."""

    x: np.ndarray  # (columns,) [m] from the pile's axis
    y: np.ndarray  # (rows,) [m]
    instants: int
    covered: np.ndarray  # (rows, columns)
    velocity: np.ndarray  # (rows, columns) [m/s], sum over the instants at which it was covered

    def add(self, other: Raster) -> None:
        self.instants += other.instants
        self.covered += other.covered
        self.velocity += other.velocity

    @property
    def concentration(self) -> np.ndarray:
        return self.covered / max(self.instants, 1)

    @property
    def speed(self) -> np.ndarray:
        """Mean velocity of the ice along x [m/s]; nan where there never was any."""
        return np.divide(self.velocity, self.covered, out=np.full(self.covered.shape, np.nan), where=self.covered > 0)


def drift(run: RunFolder, time: float) -> float:
    """How far undisturbed ice has drifted [m]."""
    return run.current[0] * time


def mean_ice(run: RunFolder) -> Raster:
    """The raster of all snapshots within DRIFT."""
    total = empty_raster(run)
    for time, path in run.snapshots:
        if DRIFT[0] - 1e-6 <= drift(run, time) <= DRIFT[1] + 1e-6:
            total.add(rasterized(run, read_snapshot(path, time)))
    return total


def empty_raster(run: RunFolder) -> Raster:
    half = run.domain_size[1] / 2.0
    x = np.arange(REACH[0], REACH[1], CELL) + CELL / 2.0
    y = np.arange(-half, half, CELL) + CELL / 2.0
    return Raster(x, y, 0, np.zeros((len(y), len(x))), np.zeros((len(y), len(x))))


def rasterized(run: RunFolder, snapshot: Snapshot) -> Raster:
    """One instant: a cell is covered when its centre lies in a floe."""
    raster = empty_raster(run)
    raster.instants = 1
    centre = np.array(run.structures[0]["center"])
    outlines, owner = periodic_copies(run, snapshot.outlines)
    for outline, floe in zip(outlines, owner, strict=True):
        if len(outline) < 3:
            continue
        place = outline - centre
        low, high = place.min(axis=0), place.max(axis=0)
        columns = slice(*np.searchsorted(raster.x, (low[0], high[0])))
        rows = slice(*np.searchsorted(raster.y, (low[1], high[1])))
        if columns.start == columns.stop or rows.start == rows.stop:
            continue
        x, y = np.meshgrid(raster.x[columns], raster.y[rows])
        inside = contains(place, x, y)
        raster.covered[rows, columns][inside] = 1.0
        raster.velocity[rows, columns][inside] = snapshot.velocity[floe, 0]
    return raster


def contains(outline: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Which of the points lie in a convex outline (k, 2), whichever way round it runs."""
    following = np.roll(outline, -1, axis=0)
    sides = [(b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) for a, b in zip(outline, following, strict=True)]
    return np.all(np.array(sides) >= 0.0, axis=0) | np.all(np.array(sides) <= 0.0, axis=0)


def strips(run: RunFolder, raster: Raster) -> dict[str, float]:
    """Concentration of the ice ahead of and behind the pile over that beside it, and the speed of the ice ahead over the current.

    Empty while no snapshot lies within DRIFT.
    """
    if not raster.instants:
        return {}
    radius = run.structures[0]["radius"]
    x, y = np.meshgrid(raster.x, np.abs(raster.y))
    result = {}
    far = y >= FAR * run.domain_size[1]
    for name, along in (("ahead", (x >= -radius - STRIP) & (x <= -radius)), ("behind", (x >= radius) & (x <= radius + STRIP))):
        strip = along & (y <= radius)
        beside = raster.concentration[along & far].mean()
        result[f"ice_{name}"] = float(raster.concentration[strip].mean())
        result[f"ice_{name}_over_beside"] = float(raster.concentration[strip].mean() / beside) if beside else np.nan
        moving = raster.covered[strip].sum()
        if name == "ahead":
            speed = raster.velocity[strip].sum() / moving if moving else np.nan
            result["speed_ahead_over_current"] = float(speed / run.current[0])
    return result
