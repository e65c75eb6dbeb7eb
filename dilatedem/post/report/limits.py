"""What a run cannot tell: the limits of its models, as far as they matter to this case, with its own figures."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import shapely

from dilatedem.post.labels import number
from dilatedem.post.loads import PRESSURES
from dilatedem.post.read import RunFolder
from dilatedem.results.tables import row_count

#: flexural strength of sea ice [Pa] with which floes are asked whether they would break, at the lower end of small beams
FLEXURAL_STRENGTH = 5.0e5
#: lengths of sqrt(sigma h / (rho g)) beyond which a floe that is lifted at one end breaks under its own weight
BREAKING_LENGTH = 1.5
#: blocked share of a periodic width from which on it is told
LEAST_BLOCKED = 0.02


class Limit(NamedTuple):
    """What it is about, and the limit in a sentence or two."""

    about: str
    text: str


LIU2015 = Limit(
    "Contact laws",
    "Those of Liu, Long & Ji (2015), mode by mode. They jump where a contact changes its mode, by factors up to some hundreds at "
    "0.1 mm overlap; the laws for parallel edges stand for a contact one metre long and are far softer than elasticity; "
    "restitution depends on speed. The energy that the jumps create is booked as gain_law in the ledger.",
)
CONSISTENT = Limit(
    "Contact laws", "Elastic half spaces: they hold as long as contacts are small against the floes and their radii of curvature."
)
CURRENT = "The water is a current without waves, and the ice does not change its flow."
WAVES = (
    "Waves ride on a current; ice and structures change neither, and each floe lies in one plane of the surface: floes that are "
    "not short against the waves feel too much of them."
)
HELD = Limit("Structure", "It does not give way; its own compliance would soften the peaks.")
WINDOWS = Limit(
    "Times of hits", "Those above their threshold are counted in whole windows of forces.csv, too long by up to two windows each."
)
UNFINISHED = Limit("Unfinished", "This run did not reach its end: everything here covers only the part that was simulated.")


def limits(run: RunFolder) -> list[Limit]:
    """What the reader must not expect of these numbers, what matters most first."""
    return list(_limits(run))


def _limits(run: RunFolder) -> Iterator[Limit]:
    if run.summary.get("status") != "completed":
        yield UNFINISHED
    yield Limit("Ice that breaks", breaking_words(run))
    yield Limit("Pressure", pressure_words(run))
    yield LIU2015 if run.case.get("contact", {}).get("model", "liu2015") == "liu2015" else CONSISTENT
    yield Limit("Water", (WAVES if run.case.get("wave") else CURRENT) + drag_words(run))
    if not run.motion:
        yield HELD
    if words := neighbour_words(run):
        yield Limit("Periodic sides", words)
    yield Limit("One random field" if is_random(run) else "One field", scatter_words(run))
    if words := waiting_words(run):
        yield Limit("Before the ice came", words)
    yield WINDOWS


def breaking_words(run: RunFolder) -> str:
    """Whether floes bend through before they ride up, which rigid ones cannot."""
    rigid = "Floes are rigid: they do not bend, split, raft or ridge."
    ice, gravity = run.case.get("ice", {}), float(run.case.get("gravity", {}).get("acceleration", 9.81))
    thickness, density = ice.get("thickness"), ice.get("density")
    if run.ice is None or not len(run.ice.outlines) or not thickness or not density or not gravity > 0.0:
        return rigid
    longest = BREAKING_LENGTH * math.sqrt(FLEXURAL_STRENGTH * thickness / (density * gravity))
    count = sum(length_of(outline) > longest for outline in run.ice.outlines)
    told = f"of {len(run.ice.outlines)} floes {count or 'none'} {'are' if count > 1 else 'is'} longer than {number(longest, 3)} m"
    meaning = (
        f"the length from which a floe that rides up a slope breaks under its own weight at a flexural strength of "
        f"{number(FLEXURAL_STRENGTH / 1e6)} MPa"
    )
    verdict = "on a slope these would break first, and load it less than here" if count else "none is long enough to break that way"
    return f"{rigid} Here {told}, {meaning}: {verdict}."


def length_of(outline: np.ndarray) -> float:
    """The largest distance [m] between two corners of an outline (k, 2) [m]."""
    return float(np.hypot(*(outline[:, None] - outline[None]).transpose(2, 0, 1)).max())


def pressure_words(run: RunFolder) -> str:
    """What crushed, or what would have."""
    limit = run.case.get("ice", {}).get("crushing_pressure")
    pressures = np.concatenate([hits["pressure_Pa"] for hits in run.hits.values()] or [np.zeros(0)])
    if limit is not None:
        crushed = [hits["crushed_m"] for hits in run.hits.values()]
        depth = max((float(each.max(initial=0.0)) for each in crushed), default=0.0)
        told = f" The deepest crushing of a leading contact is {number(1e3 * depth, 3)} mm." if depth > 0.0 else ""
        return (
            f"Ice crushes where it touches, at {number(limit / 1e6)} MPa on the nominal area whatever its speed; what has crushed "
            f"is gone.{told}"
        )
    if not len(pressures):
        return "Floes do not crush here (ice.crushing_pressure): a peak is that of elastic ice, which real ice would not bear."
    above = ", ".join(f"{int(np.sum(pressures > 1e6 * limit))} above {limit} MPa" for limit in PRESSURES)
    return (
        f"Floes do not crush here (ice.crushing_pressure); sea ice crushes at 1 to 3 MPa. The mean nominal pressures at the peaks "
        f"of the {len(pressures)} load event{'s' * (len(pressures) != 1)}: {above}, the highest "
        f"{number(float(pressures.max()) / 1e6, 3)} MPa. Peaks beyond "
        "what ice bears are those of elastic ice, and no design loads."
    )


def drag_words(run: RunFolder) -> str:
    """How much stronger the drag on the whole wetted surface is than one by skin and form, on these floes."""
    water = run.case.get("water", {})
    if water.get("drag", "wetted") != "wetted" or not water.get("enabled", True):
        return ""
    told = " Its drag acts on the whole wetted surface of a floe"
    if run.ice is None or not len(run.ice.outlines) or run.afloat is None:
        return f"{told}: about ten times the drag of a formula for the frontal area."
    draft, area = run.afloat[0], float(run.ice.plan_area.sum())
    sides = draft * sum(float(np.hypot(*(np.roll(outline, -1, axis=0) - outline).T).sum()) for outline in run.ice.outlines)
    wetted = float(water.get("drag_force_coefficient", 0.6)) * (area + sides)
    by_form = float(water.get("skin_coefficient", 0.004)) * area + float(water.get("form_coefficient", 0.8)) * sides / math.pi
    if not by_form > 0.0:
        return f"{told}."
    return f'{told}: on the floes of this case {number(wetted / by_form, 2)} times that of water.drag = "skin_form".'


def neighbour_words(run: RunFolder) -> str:
    """How much of a periodic width the structures block: the ice meets a row of them."""
    across = 1 if abs(run.current[0]) >= abs(run.current[1]) else 0
    blocked = width_blocked(run) / run.domain_size[across]
    if run.boundaries[across] != "periodic" or not any(run.current) or blocked < LEAST_BLOCKED:
        return ""
    return (
        f"Across the current the domain repeats itself every {number(run.domain_size[across])} m: the ice meets a row of "
        f"structures that block {number(100.0 * blocked, 2)} % of its way, and jams between them sooner than in the open."
    )


def width_blocked(run: RunFolder) -> float:
    """Width [m] across the current that structures and their parts stand in, each place once."""
    sides = np.array([-run.current[1], run.current[0]]) / (math.hypot(*run.current) or 1.0)
    across = [plan.outline @ sides for plan in run.outlines.values() if plan.bounded and len(plan.outline)]
    return shapely.union_all([shapely.LineString([(side.min(), 0.0), (side.max(), 0.0)]) for side in across]).length


def is_random(run: RunFolder) -> bool:
    """Whether another seed is another field."""
    return run.case.get("field", {}).get("source", "voronoi") == "voronoi"


def scatter_words(run: RunFolder) -> str:
    """How little one run says of another."""
    count = sum(row_count(hits) for name, hits in run.hits.items() if "/" not in name)  # parts share the events of their structure
    told = f" Here there {'was' if count == 1 else 'were'} {count} load event{'s' * (count != 1)}." if run.hits else ""
    if is_random(run):
        return (
            "Peaks last tens of milliseconds, and their height and number vary from one random field to the next: judge by several "
            f"seeds, not by one run.{told}"
        )
    return (
        "Peaks last tens of milliseconds, and their height and number vary with the least change of where floes lie: judge by "
        f"several runs, in which the ice or its drift differs a little, not by one.{told}"
    )


def waiting_words(run: RunFolder) -> str:
    """How long no ice touched anything; means and quantiles have that time in them."""
    loaded = [history["time_s"][history["fh_max_N"] > 0.0] for history in run.forces.values()]
    first = min((float(times[0]) for times in loaded if len(times)), default=0.0)
    told = f"The first load is at {number(first, 3)} s; means, quantiles and shares of time have the time before in them, too."
    return told if first > 0.0 else ""
