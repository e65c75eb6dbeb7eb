"""What a case can hold that is hardly meant: a line each, before it runs. Nothing here stops anything."""

import math

import numpy as np

from dilatedem.case.schema import Case
from dilatedem.run.advice_driven import about_driven, extent, farthest
from dilatedem.run.advice_waves import about_waves
from dilatedem.scene.overlaps import structures_in_each_other
from dilatedem.scene.place import PlacedStructure, Scene
from dilatedem.scene.recipe import periodic_axes
from dilatedem.state.bodies import Bodies
from dilatedem.state.model import Model
from dilatedem.structures.kind import Part
from dilatedem.water.loads import fastest_water

#: share of the critical step above which loads are too far off: at 0.6 peaks overshoot by 5 to 23 % (docs/theory.md, time step)
LARGEST_FRACTION = 0.5
#: share of the time step that contacts would allow below which a short force window is hardly meant
SHORT_WINDOW = 0.5
#: widths of the largest floe beside the ice, across its drift, that it may spread to by collisions
SPREAD = 1.0
#: m/s below which nothing drifts
STILL = 1e-9
#: boundaries that no ice passes, and how many floes far it still sticks out through them
PASSED_BY = {"wall": 0.0, "outflow": 1.0, "inflow": 1.0}


def advice(case: Case, scene: Scene, model: Model, bodies: Bodies, *, share: float) -> list[str]:
    """Sentences about a simulation at t = 0; share: time step over the critical one."""
    found = [_about_step(share), _about_window(case, share), _about_thickness(case, scene)]
    found += _about_structures(case, scene, model, bodies) + about_driven(case, scene) + about_waves(case, model)
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
    if len(areas := scene.field.floe_area):
        widths["the floes"] = (float(scene.ice.thickness.mean()), math.sqrt(areas.mean()))
    for number, body in enumerate(case.body):
        if body.outline is not None and not body.fixed:
            widths[f"body {number}"] = (body.thickness, math.sqrt(scene.plan_area[number]))
    thick = {name: sizes for name, sizes in widths.items() if sizes[0] > sizes[1]}
    if not thick:
        return ""
    name, (thickness, width) = next(iter(thick.items()))
    more = f" (and {len(thick) - 1} more)" if len(thick) > 1 else ""
    return f"{name}{more}: {thickness:.3g} m thick, {width:.3g} m wide: ice thicker than wide tips over; check thickness and size"


def _about_structures(case: Case, scene: Scene, model: Model, bodies: Bodies) -> list[str]:
    """Structures that stand in each other, beyond sides that no ice passes, or where none comes to as long as water carries it."""
    found = [
        f'structures "{first}" and "{second}" lie in each other, by {depth:.3g} m; make them parts of one structure if they are one'
        for first, second, depth in structures_in_each_other(scene, model, bodies)
    ]
    standing = [(structure, parts) for structure, parts in scene.standing() if not any(part.is_half_space for part in parts)]
    why = {structure.name: _why_beyond(case, model, parts) for structure, parts in standing}
    ice = _Ice(case, scene, model, bodies)
    if case.water.enabled and len(ice.place):
        why = {structure.name: why[structure.name] or ice.why_not_at(structure, parts) for structure, parts in standing}
    missed = {name: sentence for name, sentence in why.items() if sentence}
    if len(missed) == len(scene.standing()) > 1 and len(set(missed.values())) == 1:
        return [*found, f"no ice can reach any structure: {next(iter(missed.values()))}"]
    return [*found, *(f'no ice can reach structure "{name}": {sentence}' for name, sentence in missed.items())]


def _why_beyond(case: Case, model: Model, parts: list[Part]) -> str:
    """How far a structure stands beyond a side which no ice passes, in words; empty for any other, and for a body that is held."""
    floe = 2.0 * float(model.shapes.reach[: model.floating].max())
    for axis, boundary in enumerate(case.domain.boundaries):
        if not parts or boundary not in PASSED_BY:
            continue
        half = 0.5 * case.domain.size[axis]
        gap = min(abs(float(part.position[axis])) - part.plan_reach for part in parts) - half
        if gap > PASSED_BY[boundary] * floe:
            return f'it stands {gap:.3g} m beyond a side of the domain that is "{boundary}"'
    return ""


class _Ice:
    """Bodies that float freely: place (n, 2), height, reach (n,) [m] and velocity (n, 2) [m/s] at t = 0, and where they drift."""

    def __init__(self, case: Case, scene: Scene, model: Model, bodies: Bodies):
        free = np.flatnonzero(model.solids.inverse_mass[: scene.count] > 0.0)
        self.case, self.scene = case, scene
        self.place, self.velocity = bodies.position[free, :2], bodies.velocity[free, :2]
        self.height, self.reach, self.every_reach = bodies.position[free, 2], model.shapes.reach[free], model.shapes.reach
        self.current = np.array(case.water.strongest if case.water.enabled else (0.0, 0.0))
        self.wind, self.fastest_water = np.array(case.wind.strongest), fastest_water(model.loads)
        self.periodic = np.array(periodic_axes(case))

    def why_not_at(self, structure: PlacedStructure, parts: list[Part]) -> str:
        """Why none of it comes to a structure of these bodies, in words; empty where some may."""
        if parts and (sentence := self._why_not_over(parts)):
            return sentence
        place, reach = self._extent(structure, parts)
        size = np.where(self.periodic, self.case.domain.size, np.inf)
        offset = place - self.place
        offset -= np.where(self.periodic, np.round(offset / size) * np.where(self.periodic, size, 0.0), 0.0)
        gap = float((np.hypot(*offset.T) - self.reach - reach).min())
        fastest = max(float(np.hypot(*self.velocity.T).max()), self.fastest_water, float(np.hypot(*self.wind)))
        duration = self.case.time.duration
        driven = farthest(self.case, structure)
        if gap > fastest * duration + driven:
            if driven > 0.0:
                return f"it lies {gap:.3g} m from the nearest floe, and is driven no farther than {driven:.3g} m"
            if fastest <= STILL:
                return f"nothing moves, and it lies {gap:.3g} m from the nearest floe"
            far = f"{duration:g} s at {fastest:.3g} m/s are enough for {fastest * duration:.3g} m"
            return f"it lies {gap:.3g} m from the nearest floe, and {far}"
        return self._why_not_along(offset, reach) if driven == 0.0 else ""

    def _why_not_over(self, parts: list[Part]) -> str:
        """As `why_not_at`, by the heights of a structure and of the ice, however it turns."""
        heights = [part.heights for part in parts]
        low, high = min(low for low, _ in heights), max(high for _, high in heights)
        lowest, highest = float((self.height - self.reach).min()), float((self.height + self.reach).max())
        if low > highest:
            return f"it begins at z = {low:.3g} m, and the ice reaches up to {highest:.3g} m, even on edge"
        if high < lowest:
            return f"it ends at z = {high:.3g} m, and the ice reaches down to {lowest:.3g} m, even on edge"
        return ""

    def _extent(self, structure: PlacedStructure, parts: list[Part]) -> tuple[np.ndarray, float]:
        """Centre in plan (2,) and radius [m] of a circle that holds a structure."""
        if not parts:  # a body that is held
            return structure.place[:2], float(self.every_reach[structure.about.number])
        return extent(parts)

    def _why_not_along(self, offset: np.ndarray, reach: float) -> str:
        """As `why_not_at`, by the direction in which all ice drifts, if there is one; offset (n, 2) [m]: to the structure."""
        speed, steady = float(np.hypot(*self.current)), len(self.case.water.history) == len(self.case.wind.history) == 1
        if speed <= STILL or self.case.wave or not steady:
            return ""
        ahead = self.current / speed
        across = np.array([-ahead[1], ahead[0]])
        sideways = max(float(np.abs(self.velocity @ across).max()), abs(float(self.wind @ across)))
        backward = min(float((self.velocity @ ahead).min()), float(self.wind @ ahead))
        if sideways > STILL or backward < -STILL:
            return ""
        comes_again = self.case.domain.inflow is not None or bool(np.any(self.periodic & (np.abs(ahead) > STILL)))
        if not comes_again and ((offset @ ahead) + reach + self.reach < 0.0).all():
            return "all ice starts downstream of it, and the current leads it away"
        beside = np.abs(offset @ across) - self.reach - reach
        if not np.any(self.periodic & (np.abs(across) > STILL)) and beside.min() > 2.0 * SPREAD * self.reach.max():
            return f"all ice drifts past it, {beside.min():.3g} m beside it at least"
        return ""
