"""The global pressure of level ice by ISO 19906, as a bound beside the loads of broken ice."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from dilatedem.post.labels import number
from dilatedem.post.read import RunFolder

#: exponent of the width over the thickness
WIDTH_EXPONENT = -0.16
#: strength C_R [Pa], by the region that it stands for
STRENGTHS = {"Baltic and sub-arctic": 1.8e6, "Arctic": 2.8e6}
#: per cent of the windows whose load is turned into the strength that level ice would need for it
SHARE = "99"


@dataclass(frozen=True)
class Bound:
    """What level ice as thick as that of the case would press on a structure, crushing over its whole width."""

    thickness: float  # m
    width: float  # m, of the structure across the current

    def force(self, strength: float) -> float:
        """N, for a strength C_R [Pa]."""
        return global_pressure(strength, self.thickness, self.width) * self.thickness * self.width

    def strength(self, force: float) -> float:
        """C_R [Pa] of level ice that would press with a force [N]."""
        return force / self.force(1.0)


def global_pressure(strength: float, thickness: float, width: float) -> float:
    """p = C_R (h/h1)^n (w/h)^m [Pa] with h1 = 1 m, n = min(-0.3, h/5 - 0.5) and m = -0.16 (ISO 19906, A.8.2.4.3).

    strength: C_R [Pa]; thickness h and width w [m].
    """
    exponent = min(-0.3, -0.5 + thickness / 5.0)
    return strength * thickness**exponent * (width / thickness) ** WIDTH_EXPONENT


def bound_of(run: RunFolder, structure: str) -> Bound | None:
    """That of a structure; None where no width or no thickness is known."""
    plan, thickness = run.outlines.get(structure), run.case.get("ice", {}).get("thickness")
    if plan is None or not plan.bounded or not len(plan.outline) or not thickness:
        return None
    return Bound(float(thickness), width_across(plan.outline, run.current))


def width_across(outline: np.ndarray, current: tuple[float, float]) -> float:
    """Width [m] of an outline (k, 2) [m] as the current meets it; in still water the largest from corner to corner."""
    speed = math.hypot(*current)
    if speed == 0.0:
        return float(np.hypot(*(outline[:, None] - outline[None]).transpose(2, 0, 1)).max())
    return float(np.ptp(outline @ np.array([-current[1], current[0]]) / speed))


def bound_rows(bound: Bound, peak: float, quantile: float) -> list[list[str]]:
    """What, value and unit: the bound for each strength, and what the run's loads would be in such terms.

    peak: highest horizontal force [N] of the run; quantile: force [N] that SHARE per cent of its windows stay below.
    """
    rows = []
    ice = f"level ice of {number(bound.thickness)} m over {number(bound.width)} m"
    for region, strength in STRENGTHS.items():
        force, pressure = bound.force(strength), global_pressure(strength, bound.thickness, bound.width)
        share = f"{number(pressure / 1e6, 3)} MPa; the highest force here is {number(100.0 * peak / force, 2)} % of it"
        rows.append([f"{ice}, C_R {number(strength / 1e6)} MPa ({region})", number(force / 1e3, 4), f"kN, {share}"])
    for what, force in (("highest force", peak), (f"force that {SHARE} % of the windows stay below", quantile)):
        rows.append([f"C_R of level ice that presses like the {what}", number(bound.strength(force) / 1e6, 3), "MPa"])
    return rows
