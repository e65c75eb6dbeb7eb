"""Work of the contact force around closed loops of poses: zero if, and only if, the force has an energy."""

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from scipy.spatial.transform import Rotation

from dilatedem.post.figures.canvas import BLACK, new_figure, styled
from dilatedem.post.labels import number
from validation.contact_lab.attitudes import attitude
from validation.contact_lab.drawing import COLOUR
from validation.contact_lab.probe import Poses, Probe
from validation.contact_lab.scenes import COLUMNS, FLOE, MODELS, PILE, scene
from validation.contact_lab.tilts import X, Y, Z, seat_on_column

LOOPS = 60  # of each kind
POSES = 600  # along a loop, at first: evenly spread
RESOLVED = 1e-5  # of the peak stored energy: work of a piece of the way that may change when the piece is halved
HALVINGS = 9  # of a piece, at most: 3e-6 of the way
SEED = 20150601
WAVES = 3  # sines of each of the six coordinates
OVERLAP, SWING = 1e-3, 0.7  # m, mean of the deepest overlap; share by which it swings
TILTS = np.radians([0.05, 5.0])  # rad, of the largest tilt of a loop, drawn evenly on a logarithmic scale
SLIDE = 0.5  # m, of the largest slide along y and z
ALLOWED = 0.01  # net work over peak stored energy


@dataclass(frozen=True)
class Kind:
    """What meets: the first floe stays (or the pile does), the other moves; slide: share of SLIDE along y and z."""

    name: str
    partner: dict
    held: Rotation
    moving: Rotation
    slide: tuple[float, float]

    @property
    def mover(self) -> int:
        return 0 if self.partner is PILE else 1


FLAT = Rotation.identity()
UPENDED = Rotation.from_rotvec(0.5 * np.pi * Y)  # top towards +x
KINDS = (
    Kind("side on side", FLOE, FLAT, FLAT, (1.0, 0.3)),
    Kind("corner on side", FLOE, FLAT, attitude("edge", -X, Z), (1.0, 0.3)),
    Kind("bottom on top", FLOE, UPENDED, UPENDED, (1.0, 1.0)),
    Kind("side on pile", PILE, FLAT, FLAT, (1.0, 1.0)),
)


class Wave:
    """A periodic sum of a few sines, its largest size 1."""

    def __init__(self, random: np.random.Generator):
        self.size, self.phase = random.normal(size=WAVES) / np.arange(1, WAVES + 1), random.uniform(0.0, 2.0 * np.pi, WAVES)
        self.largest = 1.0
        self.largest = float(np.abs(self.at(np.linspace(0.0, 1.0, 4001))).max())

    def at(self, way: np.ndarray) -> np.ndarray:
        """Its values at ways around the loop, 0 to 1."""
        turn = 2.0 * np.pi * way[:, None] * np.arange(1, WAVES + 1)
        return (self.size * np.sin(turn + self.phase)).sum(axis=1) / self.largest


class Loop:
    """A closed loop: tilt, slide and deepest overlap are random and smooth, the distance along x follows from them.

    Against a floe's side the overlap is that of the corners and the side's plane; where a slide carries them past the side's rim,
    the true overlap is smaller.
    """

    def __init__(self, kind: Kind, random: np.random.Generator):
        self.kind = kind
        self.largest_tilt = np.exp(random.uniform(*np.log(TILTS)))
        self.tilts, self.slides = [Wave(random) for _ in range(3)], [Wave(random) for _ in kind.slide]
        self.overlap = Wave(random)

    def poses(self, probe: Probe, way: np.ndarray) -> Poses:
        """At ways (n,) around the loop, 0 to 1, which is the start again."""
        kind, way = self.kind, way % 1.0
        tilt = self.largest_tilt * np.column_stack([wave.at(way) for wave in self.tilts])
        slide = SLIDE * np.column_stack([share * wave.at(way) for share, wave in zip(kind.slide, self.slides, strict=True)])
        overlap = OVERLAP * (1.0 + SWING * self.overlap.at(way))
        turn = Rotation.from_rotvec(tilt) * kind.moving
        corners = np.einsum("nij,vj->nvi", turn.as_matrix(), probe.core(kind.mover))
        reach = probe.radius(0) + probe.radius(1) - overlap
        poses = Poses.at_rest(probe, len(way))
        if kind.partner is PILE:
            place = seat_on_column(corners[:, :, :2] + [0.0, 1.0] * slide[:, None, :1], reach)
        else:
            wall = kind.held.apply(probe.core(0))[:, 0].max()
            poses = poses.moved(0, position=-wall * X, rotation=kind.held)
            place = reach - corners[:, :, 0].min(axis=1)
        return poses.moved(kind.mover, position=np.column_stack([place, slide]), rotation=turn)


@dataclass(frozen=True)
class Course:
    """What is known along a loop, at ways (n,) from 0 to 1 in order: poses of the moving body and the load on it."""

    way: np.ndarray
    place: np.ndarray  # (n, 3) m
    turn: np.ndarray  # (n, 4) unit quaternions, scalar first
    force: np.ndarray  # (n, 3) N
    moment: np.ndarray  # (n, 3) N m
    energy: np.ndarray  # (n,) J, stored

    def work(self) -> np.ndarray:
        """Of the contact on the body, from each pose to the next (n - 1,) [J], force and moment by trapezoids."""
        turn = Rotation.from_quat(self.turn, scalar_first=True)
        turned = (turn[1:] * turn[:-1].inv()).as_rotvec()
        force, moment = (0.5 * (load[1:] + load[:-1]) for load in (self.force, self.moment))
        return (force * np.diff(self.place, axis=0) + moment * turned).sum(axis=1)

    def with_more(self, other: "Course") -> "Course":
        order = np.argsort(np.concatenate([self.way, other.way]))
        return Course(*(np.concatenate([getattr(self, name), getattr(other, name)])[order] for name in Course.__dataclass_fields__))


def course(probe: Probe, loop: Loop, way: np.ndarray) -> Course:
    poses, body = loop.poses(probe, way), loop.kind.mover
    answers = probe.at(poses)
    force = answers.force if body == 1 else -answers.force
    return Course(way, poses.position[:, body], poses.orientation[:, body], force, answers.moment[:, body], answers.energy)


def resolved(probe: Probe, loop: Loop) -> tuple[Course, float]:
    """A loop in poses so close that its work is known, and by how much the last halving of all pieces has changed it [J]."""
    found, left = course(probe, loop, np.linspace(0.0, 1.0, POSES + 1)), 0.0
    open_pieces = np.ones(POSES, bool)
    for _ in range(HALVINGS):
        before, first = found.work()[open_pieces], np.flatnonzero(open_pieces)
        found = found.with_more(course(probe, loop, 0.5 * (found.way[first] + found.way[first + 1])))
        half = first + np.arange(len(first))  # where the first halves of these pieces are now
        work = found.work()
        change = work[half] + work[half + 1] - before
        more = np.abs(change) > RESOLVED * found.energy.max()
        left += float(change[~more].sum())
        open_pieces = np.zeros(len(work), bool)
        open_pieces[half[more]] = open_pieces[half[more] + 1] = True
        if not more.any():
            return found, abs(left)
    return found, abs(left + float(change[more].sum()))


@dataclass(frozen=True)
class Balance:
    """Of a loop, relative to its peak stored energy."""

    net: float  # net work
    rough: float  # how much of that comes from the finite number of poses: its change where each piece of the way is halved


def balance(probe: Probe, loop: Loop) -> Balance:
    found, left = resolved(probe, loop)
    peak = float(found.energy.max())
    return Balance(float(found.work().sum()) / peak, left / peak) if peak > 0.0 else Balance(0.0, 0.0)


def loops_of(kind: Kind, count: int = LOOPS) -> list[Loop]:
    random = np.random.default_rng([SEED, KINDS.index(kind)])
    return [Loop(kind, random) for _ in range(count)]


def balances(model: str, kind: Kind, count: int = LOOPS) -> list[Balance]:
    """Of the first `count` loops of a kind."""
    probe = Probe(scene(model, FLOE, kind.partner))
    return [balance(probe, loop) for loop in loops_of(kind, count)]


@dataclass(frozen=True)
class Survey:
    """All loops: balances by kind and model, and one loop to show."""

    balances: dict[tuple[str, str], list[Balance]]
    example: dict[str, Course]  # model -> the first loop


def survey() -> Survey:
    found, example = {}, {}
    for model in MODELS:
        for kind in KINDS:
            found[kind.name, model] = balances(model, kind)
            print(f"{kind.name}, {model}: {LOOPS} loops", flush=True)
        example[model], _ = resolved(Probe(scene(model, FLOE, KINDS[0].partner)), loops_of(KINDS[0], 1)[0])
    return Survey(found, example)


@styled
def figure(found: Survey) -> Figure:
    """Histogram of |net work| / peak energy, and one loop: the energy that is stored and the one that was paid for it."""
    drawn = new_figure(9.0, 3.6)
    many, one = drawn.subplots(1, 2, width_ratios=(1.1, 1.0))
    values = {m: np.abs([b.net for k in KINDS for b in found.balances[k.name, m]]) for m in MODELS}
    low = min(v[v > 0.0].min(initial=1e-3) for v in values.values())
    high = max(v.max() for v in values.values())
    bins = np.geomspace(10.0 ** np.floor(np.log10(low)), 10.0 ** np.ceil(np.log10(2.0 * high)), 41)
    for model in MODELS:
        many.hist(np.maximum(values[model], bins[0]), bins, color=COLOUR[model], alpha=0.55, label=model)
        shown = found.example[model]
        paid = shown.energy[0] - np.concatenate([[0.0], np.cumsum(shown.work())])
        one.plot(shown.way, shown.energy, color=COLOUR[model], label=f"{model}: stored")
        one.plot(shown.way, paid, color=COLOUR[model], linestyle=":", label=f"{model}: paid by the motion")
    many.axvline(ALLOWED, color=BLACK, linewidth=0.8, linestyle="--", label=f"{100 * ALLOWED:g} %")
    many.set_xscale("log")
    many.set_xlabel("|Net work around the loop| / peak stored energy")
    many.set_ylabel(f"Loops (of {LOOPS * len(KINDS)})")
    many.set_title("All loops")
    many.legend()
    one.set_xlim(0.0, 1.0)
    one.set_xlabel("Way around the loop")
    one.set_ylabel("Energy (J)")
    one.set_title(f"The first loop, {KINDS[0].name}")
    one.legend()
    for axes in (many, one):
        axes.grid(True)
    return drawn


def table(found: Survey) -> list[str]:
    """Median, 95th percentile and largest of |net work| / peak energy [%], and what of it is due to the number of poses."""
    heads = [f"{model}: {what}" for model in COLUMNS for what in ("median, %", "95th, %", "largest, %", "poses, %")]
    lines = [f"| loops | number | {' | '.join(heads)} |", "| --- | ---: |" + " ---: |" * len(heads)]
    groups = {kind.name: [kind.name] for kind in KINDS} | {"all": [kind.name for kind in KINDS]}
    for name, kinds in groups.items():
        cells = []
        for model in COLUMNS:
            if model not in MODELS:
                cells += ["–"] * 4
                continue
            some = [b for kind in kinds for b in found.balances[kind, model]]
            net, rough = 100.0 * np.abs([b.net for b in some]), 100.0 * np.median([b.rough for b in some])
            cells += [number(float(v), 2) for v in (np.median(net), np.percentile(net, 95), net.max(), rough)]
        lines.append(f"| {name} | {LOOPS * len(kinds)} | {' | '.join(cells)} |")
    return lines
