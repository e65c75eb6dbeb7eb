"""What a case can hold that is hardly meant: a line each, before it runs. Nothing here stops anything."""

import math

import numpy as np

from dilatedem.case.schema import Case
from dilatedem.scene.place import PlacedStructure, Scene, periodic_axes
from dilatedem.state.bodies import Bodies
from dilatedem.state.model import Model

#: share of the critical step above which loads are too far off: at 0.6 peaks overshoot by 5 to 23 % (docs/theory.md, time step)
LARGEST_FRACTION = 0.5
#: share of the time step that contacts would allow below which a short force window is hardly meant
SHORT_WINDOW = 0.5
#: widths of the largest floe beside the ice, across its drift, that it may spread to by collisions
SPREAD = 1.0
#: m/s below which nothing drifts
STILL = 1e-9


def advice(case: Case, scene: Scene, model: Model, bodies: Bodies, *, share: float) -> list[str]:
    """Sentences about a simulation at t = 0; share: time step over the critical one."""
    found = [_about_step(share), _about_window(case, share), _about_thickness(case, scene)]
    found += _about_reach(case, scene, model, bodies)
    return [sentence for sentence in found if sentence]


def _about_step(share: float) -> str:
    if share <= LARGEST_FRACTION:
        return ""
    return (
        f"the time step is {share:.2g} of the critical one: above {LARGEST_FRACTION:g} the peaks of loads overshoot, "
        "at 0.6 by 5 to 23 %; take a smaller time.step_fraction or time.step"
    )


def _about_window(case: Case, share: float) -> str:
    """The automatic step is never longer than a window of forces.csv."""
    window, shorter = case.output.force_interval, case.time.step_fraction / share
    if case.time.step != "auto" or shorter * SHORT_WINDOW <= 1.0 or case.time.duration <= window:
        return ""
    return (
        f"output.force_interval = {window:g} s makes the time step {shorter:.2g} times shorter than contacts need, and the run as "
        "many times longer; take a longer one"
    )


def _about_thickness(case: Case, scene: Scene) -> str:
    """Floes that are thicker than wide do not float upright."""
    if not case.water.enabled:
        return ""
    widths = {}
    if len(areas := scene.plan_area[scene.explicit :]):
        widths["the floes"] = (case.ice.thickness, math.sqrt(areas.mean()))
    for number, body in enumerate(case.body):
        if body.outline is not None and not body.fixed:
            widths[f"body {number}"] = (body.thickness, math.sqrt(scene.plan_area[number]))
    thick = {name: sizes for name, sizes in widths.items() if sizes[0] > sizes[1]}
    if not thick:
        return ""
    name, (thickness, width) = next(iter(thick.items()))
    more = f" (and {len(thick) - 1} more)" if len(thick) > 1 else ""
    return f"{name}{more}: {thickness:.3g} m thick, {width:.3g} m wide: ice thicker than wide tips over; check thickness and size"


def _about_reach(case: Case, scene: Scene, model: Model, bodies: Bodies) -> list[str]:
    """Structures that no ice comes to, as long as water carries it."""
    bounded = [structure for structure in scene.structures if not any(part.is_half_space for part in structure.parts)]
    ice = _Ice(case, scene, model, bodies)
    if not (case.water.enabled and bounded and len(ice.place)):
        return []
    why = {structure.name: ice.why_not_at(structure, model) for structure in bounded}
    missed = {name: sentence for name, sentence in why.items() if sentence}
    if len(missed) == len(scene.structures) > 1 and len(set(missed.values())) == 1:
        return [f"no ice can reach any structure: {next(iter(missed.values()))}"]
    return [f'no ice can reach structure "{name}": {sentence}' for name, sentence in missed.items()]


class _Ice:
    """Bodies that float freely: place (n, 2), reach (n,) [m] and velocity (n, 2) [m/s] at t = 0, and where they drift."""

    def __init__(self, case: Case, scene: Scene, model: Model, bodies: Bodies):
        free = np.flatnonzero(model.solids.inverse_mass[: scene.count] > 0.0)
        self.case, self.scene = case, scene
        self.place, self.velocity = bodies.position[free, :2], bodies.velocity[free, :2]
        self.reach = model.shapes.reach[free]
        self.current = np.array(case.water.velocity if case.water.enabled else (0.0, 0.0))
        self.wind = np.array(case.wind.velocity)
        self.periodic = np.array(periodic_axes(case))

    def why_not_at(self, structure: PlacedStructure, model: Model) -> str:
        """Why none of it comes to a structure, in words; empty where some may."""
        place, reach = self._extent(structure, model)
        size = np.where(self.periodic, self.case.domain.size, np.inf)
        offset = place - self.place
        offset -= np.where(self.periodic, np.round(offset / size) * np.where(self.periodic, size, 0.0), 0.0)
        gap = float((np.hypot(*offset.T) - self.reach - reach).min())
        fastest = max(float(np.hypot(*self.velocity.T).max()), float(np.hypot(*self.current)), float(np.hypot(*self.wind)))
        duration = self.case.time.duration
        if gap > fastest * duration:
            if fastest <= STILL:
                return f"nothing moves, and it lies {gap:.3g} m from the nearest floe"
            far = f"{duration:g} s at {fastest:.3g} m/s are enough for {fastest * duration:.3g} m"
            return f"it lies {gap:.3g} m from the nearest floe, and {far}"
        return self._why_not_along(offset, reach)

    def _extent(self, structure: PlacedStructure, model: Model) -> tuple[np.ndarray, float]:
        """Centre in plan (2,) and radius [m] of a circle that holds a structure."""
        if not structure.parts:  # a body that is held
            number = structure.about.number
            return structure.about.place[:2], float(model.shapes.reach[number])
        centre = np.mean([part.position[:2] for part in structure.parts], axis=0)
        return centre, max(float(np.hypot(*(part.position[:2] - centre))) + part.plan_reach for part in structure.parts)

    def _why_not_along(self, offset: np.ndarray, reach: float) -> str:
        """As `why_not_at`, by the direction in which all ice drifts, if there is one; offset (n, 2) [m]: to the structure."""
        speed = float(np.hypot(*self.current))
        if speed <= STILL:
            return ""
        ahead = self.current / speed
        across = np.array([-ahead[1], ahead[0]])
        sideways = max(float(np.abs(self.velocity @ across).max()), abs(float(self.wind @ across)))
        backward = min(float((self.velocity @ ahead).min()), float(self.wind @ ahead))
        if sideways > STILL or backward < -STILL:
            return ""
        if not np.any(self.periodic & (np.abs(ahead) > STILL)) and ((offset @ ahead) + reach + self.reach < 0.0).all():
            return "all ice starts downstream of it, and the current leads it away"
        beside = np.abs(offset @ across) - self.reach - reach
        if not np.any(self.periodic & (np.abs(across) > STILL)) and beside.min() > 2.0 * SPREAD * self.reach.max():
            return f"all ice drifts past it, {beside.min():.3g} m beside it at least"
        return ""
