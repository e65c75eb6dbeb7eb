"""Force, moment and energy while a floe rolls over its features on another floe's side or on the pile, and how far they jump."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.spatial.transform import Rotation

from validation.contact_lab.attitudes import attitude, feature_centre
from validation.contact_lab.probe import Answers, Poses, Probe
from validation.contact_lab.scenes import FLOE, PILE, scene

OVERLAP = 1e-3  # m, the deepest: all along the path, or at its start
STEP = 1e-5  # rad, between the poses that are searched for jumps
FINEST = 1e-9  # rad, to which the largest changes are narrowed down
NARROWED = 8  # changes that are narrowed down: so many of the largest, and so many that exceed their neighbours most
LEVER = 1.0  # m
#: rad, up to which a path of fixed height is followed: far beyond, the bodies would be too deep in each other
FIXED_HEIGHT_END = 0.04
X, Y, Z = np.eye(3)


@dataclass(frozen=True)
class Roll:
    """A floe that turns about `axis` (world) from an attitude, one of its corners or edges kept where it is along y and z.

    partner: FLOE (its side faces -x there, the roller comes from +x) or PILE (the roller comes from -x); lean [rad]: a small
    turn that tells which feature is the pivot; pivot: its place (y, z) [m].
    """

    name: str
    title: str
    partner: dict
    start: Rotation
    axis: tuple[float, float, float]
    lean: float
    pivot: tuple[float, float]

    @property
    def roller(self) -> int:
        return 0 if self.partner is PILE else 1

    @property
    def toward(self) -> np.ndarray:
        return X if self.partner is PILE else -X

    def probe(self, model: str) -> Probe:
        return Probe(scene(model, FLOE, self.partner))

    def rotation(self, tilts) -> Rotation:
        return Rotation.from_rotvec(np.outer(tilts, np.asarray(self.axis) / np.linalg.norm(self.axis))) * self.start

    def poses(self, probe: Probe, tilts: np.ndarray, *, fixed_height: bool) -> Poses:
        """tilts (n,) [rad]; the overlap is OVERLAP all along, or at tilt 0 with the centroid kept where it is there."""
        poses = Poses.at_rest(probe, len(tilts))
        if self.partner is FLOE:
            wall = feature_centre(probe.core(0), Rotation.identity(), X)
            poses = poses.moved(0, position=-wall)  # the middle of the core's side at the origin
        turn = self.rotation(tilts)
        seats = self._seats(probe, np.zeros(len(tilts)) if fixed_height else tilts)
        return poses.moved(self.roller, position=seats, rotation=turn)

    def _seats(self, probe: Probe, tilts: np.ndarray) -> np.ndarray:
        """Centroid (n, 3) at which the deepest overlap is OVERLAP."""
        core = probe.core(self.roller)
        leaning = self.rotation([self.lean])[0]
        pivot = leaning.inv().apply(feature_centre(core, leaning, self.toward))
        turn = self.rotation(tilts)
        seat = np.array([0.0, *self.pivot]) - turn.apply(pivot)
        corners = np.einsum("nij,vj->nvi", turn.as_matrix(), core)
        reach = probe.radius(0) + probe.radius(1) - OVERLAP
        if self.partner is FLOE:
            seat[:, 0] = reach - corners[:, :, 0].min(axis=1)
        else:
            corners[:, :, 1] += seat[:, 1, None]
            seat[:, 0] = seat_on_column(corners[:, :, :2], reach)
        return seat


def seat_on_column(corners: np.ndarray, radius: float) -> np.ndarray:
    """How far (n,) to shift hulls of corners (n, v, 2) along x, from -x, to touch the circle of this radius around the origin [m].

    A point at y touches at x = -sqrt(radius^2 - y^2), and that of a side that touches first has a tangent along the side.
    """
    least = np.full(len(corners), np.inf)
    for i, j in combinations(range(corners.shape[1]), 2):
        p, side = corners[:, i], corners[:, j] - corners[:, i]
        across = side[:, 1]
        level = np.abs(across) < 1e-12  # a side along x touches with its front end
        slope = side[:, 0] / np.where(level, 1.0, across)
        y = np.where(level, p[:, 1], radius * slope / np.hypot(1.0, slope))
        low, high = np.sort([p[:, 1], p[:, 1] + across], axis=0)
        y = np.clip(y, low, high)
        ahead = p[:, 0] + np.where(level, np.maximum(side[:, 0], 0.0), slope * (y - p[:, 1]))
        beside = np.abs(y) >= radius
        room = -np.sqrt(np.maximum(radius**2 - y**2, 0.0)) - ahead
        least = np.minimum(least, np.where(beside, np.inf, room))
    return least


FLAT = Rotation.identity()
ROLLS = (
    Roll(
        "side_upright", "a floe turns on another's side about a vertical axis: side, vertical edge, next side",
        FLOE, FLAT, (0.0, 0.0, 1.0), 0.3, (0.3, 0.03),
    ),
    Roll(
        "side_askew", "a floe turns on another's side about a skew axis: side, corner, horizontal edge",
        FLOE, FLAT, (0.0, 1.0, -0.8), 0.3, (0.3, 0.05),
    ),
    Roll(
        "pile_upright", "a floe turns on the pile about a vertical axis: side, vertical edge, next side",
        PILE, FLAT, (0.0, 0.0, 1.0), 0.3, (-0.3, 0.0),
    ),
    Roll(
        "pile_across", "a floe's vertical edge turns across the pile's axis, its middle 2 mm beside it",
        PILE, attitude("edge", X, Z), (1.0, 0.0, 0.0), 0.0, (0.002, 0.0),
    ),
)  # fmt: skip


@dataclass(frozen=True)
class Jump:
    """The largest change of a load between two poses of a path, relative to the larger of both."""

    change: float  # at increments of STEP
    narrowed: float  # at increments of FINEST: what is left of it where the path is smooth
    tilt: float  # rad, where that is


def relative_changes(load: np.ndarray, least) -> np.ndarray:
    """Of loads (n, 3) from each pose to the next, relative to the larger, or to `least` (n,) where that is more still."""
    size = np.maximum(np.linalg.norm(load, axis=1), least)
    larger = np.maximum(size[1:], size[:-1])
    return np.linalg.norm(np.diff(load, axis=0), axis=1) / np.where(larger > 0.0, larger, 1.0)


def _changes(answers: Answers, body: int) -> tuple[np.ndarray, np.ndarray]:
    """Relative changes of the force, and of the moment on `body`; a moment that passes zero is measured by force x LEVER."""
    return relative_changes(answers.force, 0.0), relative_changes(answers.moment[:, body], LEVER * answers.strength)


def _places(changes: np.ndarray) -> set[int]:
    """Of the largest changes, and of those that stick out most: a small jump hides among the changes of a steep place."""
    beside = np.concatenate([[0.0], changes, [0.0]])
    excess = changes - np.maximum(beside[:-2], beside[2:])
    return {*np.argsort(changes)[-NARROWED:].tolist(), *np.argsort(excess)[-NARROWED:].tolist()}


def search(probe: Probe, poses_at: Callable[[np.ndarray], Poses], end: float, body: int, scan: float) -> np.ndarray:
    """Tilts from 0 to `end` [rad] by `scan`, and by STEP wherever the mode, the force or the moment changes most."""
    tilts = np.arange(0.0, end, scan)
    if scan <= STEP:
        return tilts
    answers = probe.at(poses_at(tilts))
    force, moment = _changes(answers, body)
    places = _places(force) | _places(moment) | set(np.flatnonzero(np.diff(answers.mode)).tolist())
    dense = [np.arange(tilts[max(i - 1, 0)], tilts[min(i + 2, len(tilts) - 1)], STEP) for i in places]
    return np.unique(np.concatenate([tilts, *dense]))


def largest_jumps(
    probe: Probe, poses_at: Callable[[np.ndarray], Poses], end: float, body: int, *, scan: float = STEP
) -> tuple[Jump, Jump]:
    """Of the force and of the moment: search tilts from 0 to `end` [rad] by STEP, halve the largest changes down to FINEST.

    scan [rad]: where larger than STEP, the path is searched by so much first, and by STEP only where it pays.
    """
    tilts = search(probe, poses_at, end, body, scan)
    found = _changes(probe.at(poses_at(tilts)), body)
    close = np.diff(tilts) < 1.5 * STEP

    def narrow(which: int) -> Jump:
        changes, narrowed, place = np.where(close, found[which], 0.0), 0.0, 0.0
        for i in _places(changes):
            low, high, left = tilts[i], tilts[i + 1], changes[i]
            while high - low > FINEST:
                middle = 0.5 * (low + high)
                first, second = _changes(probe.at(poses_at(np.array([low, middle, high]))), body)[which]
                low, high, left = (low, middle, first) if first >= second else (middle, high, second)
            if left > narrowed:
                narrowed, place = float(left), float(low)
        return Jump(float(changes.max()), narrowed, place)

    return narrow(0), narrow(1)
