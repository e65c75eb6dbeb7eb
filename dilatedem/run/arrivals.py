"""When there is ice at each structure: foretold in plan, as if all ice drifted with the current, past structures and other ice."""

from dataclasses import dataclass

import numpy as np
import shapely

from dilatedem.case.names import WALL_NAMES
from dilatedem.case.schema import Case
from dilatedem.run.advice_driven import way_of
from dilatedem.run.simulation import Simulation
from dilatedem.scene.place import PlacedStructure, Scene
from dilatedem.scene.recipe import periodic_axes

#: of the mean floe's size, how far the ice drifts from one look to the next
STRIDE = 0.1
#: looks at least, and at most
FEWEST, MOST = 200, 20_000


@dataclass(frozen=True)
class Presence:
    """Ice at a structure: from `first_s` to `last_s`, None where none comes; `ongoing`: still there when the run ends."""

    first_s: float | None
    last_s: float | None
    ongoing: bool

    def words(self) -> str:
        if self.first_s is None:
            return "none, as it drifts with the current"
        until = "the end" if self.ongoing else f"{self.last_s:.3g} s"
        return f"from {self.first_s:.3g} s to {until}, about" if self.first_s > 0.0 else f"from the start to {until}, about"


def presence(simulation: Simulation) -> dict[str, Presence]:
    """Of each structure of a case that has an outline at the water level, by name; for a simulation at t = 0."""
    case, scene, model = simulation.case, simulation.scene, simulation.model
    free = np.flatnonzero(model.solids.inverse_mass[: scene.count] > 0.0)
    outlines = [scene.outlines[i] for i in free if len(scene.outlines[i]) > 2]
    if not outlines:
        return {}
    floes = shapely.STRtree([shapely.Polygon(outline) for outline in outlines])
    velocity = np.zeros(2) if case.water.enabled else simulation.state.bodies.velocity[free, :2].mean(axis=0)
    size = float(np.sqrt(scene.plan_area[free].mean()))
    found = {}
    for structure, _ in scene.standing():
        sketched = _sketched(case, scene, structure)
        if sketched and structure.name not in WALL_NAMES:
            times = _times(case, structure, velocity, size)
            shift = way_of(case, structure, times) - drift(case, times, velocity)
            found[structure.name] = _met(case, floes, sketched, times, shift)
    return found


def drift(case: Case, times: np.ndarray, still: np.ndarray) -> np.ndarray:
    """(n, 2) [m] how far the ice has drifted at times (n,) [s]; still (2,) [m/s]: its velocity where there is no water."""
    if not case.water.enabled:
        return times[:, None] * still
    rows = np.array(case.water.history)
    fine = np.unique(np.concatenate([[0.0], times, rows[(rows[:, 0] > 0.0) & (rows[:, 0] < times[-1]), 0]]))
    flow = np.column_stack([np.interp(fine, rows[:, 0], rows[:, axis]) for axis in (1, 2)])
    way = np.concatenate([[[0.0, 0.0]], np.cumsum(0.5 * (flow[1:] + flow[:-1]) * np.diff(fine)[:, None], axis=0)])
    return way[np.searchsorted(fine, times)]


def _sketched(case: Case, scene: Scene, structure: PlacedStructure) -> list[np.ndarray]:
    """Outlines (k, 2) [m] of a structure and of its parts at the water level."""
    extent = float(np.hypot(*case.domain.size))
    sketches = [each.about.sketch(extent) for each in scene.structures if structure in (each, each.whole)]
    return [sketch.outline for sketch in sketches if sketch is not None and len(sketch.outline) > 2]


def _times(case: Case, structure: PlacedStructure, velocity: np.ndarray, size: float) -> np.ndarray:
    """When to look [s], so that ice and structure come no farther past each other in between than STRIDE of `size` [m]."""
    rough = np.linspace(0.0, case.time.duration, MOST // 10)
    past = np.diff(drift(case, rough, velocity) - way_of(case, structure, rough), axis=0)
    looks = float(np.hypot(*past.T).sum()) / (STRIDE * size)
    return np.linspace(0.0, case.time.duration, int(min(max(looks, FEWEST), MOST)) + 1)


def _met(case: Case, floes: shapely.STRtree, sketched: list[np.ndarray], times: np.ndarray, shift: np.ndarray) -> Presence:
    """Where outlines meet floes, moved against them by shift (n, 2) [m] at times (n,) [s]."""
    wraps = np.array(periodic_axes(case))
    period = np.where(wraps, case.domain.size, 0.0)
    copies = [np.array([i, j]) * period for i in (-1, 0, 1) for j in (-1, 0, 1) if (wraps[0] or not i) and (wraps[1] or not j)]
    there = np.zeros(len(times), bool)
    for outline in sketched:
        centre = outline.mean(axis=0) + shift
        turns = np.where(wraps, np.floor(centre / np.where(wraps, period, 1.0) + 0.5), 0.0)
        for copy in copies:
            moved = outline[None] + (shift - turns * period + copy)[:, None]
            there[floes.query(shapely.polygons(moved), predicate="intersects")[0]] = True
    met = np.flatnonzero(there)
    if not len(met):
        return Presence(None, None, False)
    ongoing = bool(there[-1]) or case.domain.inflow is not None
    return Presence(float(times[met[0]]), float(times[-1 if ongoing else met[-1]]), ongoing)
