"""Kinetic energy after elastic, frictionless collisions of random floes."""

from collections.abc import Iterable

import numpy as np
from matplotlib.figure import Figure
from scipy.spatial.transform import Rotation
from shapely import Polygon

from dilatedem.case.schema import Case
from dilatedem.post.figures.canvas import BLACK, new_figure, styled
from dilatedem.post.labels import number
from validation.contact_lab.drawing import COLOUR
from validation.contact_lab.impacts import collide
from validation.contact_lab.scenes import COLUMNS, MODELS, scene

COLLISIONS = 1000
SEED = 47
CORNERS = (4, 8)  # of an outline: at least, less than
RADII = (1.0, 1.9)  # m, of the circle that an outline's corners lie on
TILTS = np.radians([0.02, 5.0])  # rad, of a floe about a horizontal axis, drawn evenly on a logarithmic scale
ASIDE, UP = 1.0, 0.1  # m, largest offset of the second floe
SPEEDS = (0.05, 1.0)  # m/s, of approach, drawn evenly on a logarithmic scale
LONGEST = 40.0  # s, until they meet
START_GAP = 0.01  # m, at least, of the sharp outlines
HALF_THICKNESS = 0.25  # m
ALLOWED_MEDIAN, ALLOWED_WORST = 0.005, 0.02


def outline(random: np.random.Generator) -> np.ndarray:
    """A convex polygon (k, 2) with its corners on a circle, its centroid at the origin [m]."""
    count = int(random.integers(*CORNERS))
    # evenly spread corners, each moved by less than half a space: no slivers
    angle = (np.arange(count) + random.uniform(-0.35, 0.35, count)) * 2.0 * np.pi / count
    corners = random.uniform(*RADII) * np.column_stack([np.cos(angle), np.sin(angle)])
    return corners - np.array(Polygon(corners).centroid.coords[0])


def collision(model: str, random: np.random.Generator, crushing: float | None = None) -> Case:
    """Two floes on their way to each other along x, just apart; crushing: pressure [Pa], if they crush."""
    speed = float(np.exp(random.uniform(*np.log(SPEEDS))))
    aside, up = random.uniform(-ASIDE, ASIDE), random.uniform(-UP, UP)
    floes = []
    for side in (-0.5, 0.5):
        corners = outline(random)
        tilt, way = np.exp(random.uniform(*np.log(TILTS))), random.uniform(-np.pi, np.pi)
        turn = Rotation.from_rotvec([tilt * np.cos(way), tilt * np.sin(way), 0.0])
        turn *= Rotation.from_rotvec([0.0, 0.0, random.uniform(-np.pi, np.pi)])
        ends = [turn.apply(np.column_stack([corners, np.full(len(corners), z)])) for z in (-HALF_THICKNESS, HALF_THICKNESS)]
        ahead = max(float((-np.sign(side) * end[:, 0]).max()) for end in ends)
        place = [side * START_GAP + np.sign(side) * ahead, side * aside, side * up]
        floes.append({"outline": corners.tolist(), "position": place, "rotation": turn.as_rotvec().tolist()})
    return scene(model, *floes, speeds=(0.5 * speed, -0.5 * speed), crushing=crushing)


def kept_energies(model: str, numbers: Iterable[int] = range(COLLISIONS)) -> np.ndarray:
    """Kinetic energy after over before, of those of the pairs with these numbers that meet."""
    impacts = [collide(collision(model, np.random.default_rng([SEED, i])), patience=LONGEST) for i in numbers]
    return np.array([impact.kept for impact in impacts if impact is not None])


def survey() -> dict[str, np.ndarray]:
    """model -> kinetic energy after over before, of the collisions that happen."""
    found = {}
    for model in MODELS:
        found[model] = kept_energies(model)
        print(f"random collisions, {model}: {len(found[model])} of {COLLISIONS} meet", flush=True)
    return found


@styled
def figure(found: dict[str, np.ndarray]) -> Figure:
    """Share of the collisions whose kinetic energy changes by less than so much."""
    drawn = new_figure(5.6, 3.6)
    axes = drawn.subplots()
    for model, kept in found.items():
        change = np.sort(np.maximum(np.abs(kept - 1.0), 1e-7))
        axes.step(
            100.0 * change, 100.0 * np.arange(1, len(change) + 1) / len(change), where="post", color=COLOUR[model], label=model
        )
    for allowed, share, name in ((ALLOWED_MEDIAN, 50.0, "median allowed"), (ALLOWED_WORST, 100.0, "largest allowed")):
        axes.plot(
            100.0 * allowed, share, color=BLACK, marker="v" if share < 100.0 else "s", linestyle="none", label=name, clip_on=False
        )
    axes.set_xscale("log")
    axes.set_ylim(0.0, 100.0)
    axes.set_xlabel("|Change of the kinetic energy| (%)")
    axes.set_ylabel("Collisions with less (%)")
    axes.grid(True)
    axes.legend()
    return drawn


def table(found: dict[str, np.ndarray]) -> list[str]:
    lines = [
        "| model | collisions | median change, % | 95th percentile, % | largest loss, % | largest gain, % |",
        "| --- | ---: | ---: | ---: | ---: | ---: |",
    ]
    for model in COLUMNS:
        if model not in found:
            lines.append(f"| {model} |" + " – |" * 5)
            continue
        change = 100.0 * (found[model] - 1.0)
        size = np.abs(change)
        measures = np.median(size), np.percentile(size, 95), max(-change.min(), 0.0), max(change.max(), 0.0)
        cells = [number(float(measure), 2) for measure in measures]
        lines.append(f"| {model} | {len(change)} | {' | '.join(cells)} |")
    return lines
