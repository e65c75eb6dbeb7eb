"""Work of the contact force around closed loops of poses: zero if, and only if, the force has an energy."""

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from scipy.spatial.transform import Rotation

from dilatedem.post.canvas import BLACK, new_figure, styled
from dilatedem.post.labels import number
from validation.contact_lab.attitudes import attitude
from validation.contact_lab.drawing import COLOUR
from validation.contact_lab.probe import Answers, Poses, Probe
from validation.contact_lab.scenes import COLUMNS, FLOE, MODELS, PILE, scene
from validation.contact_lab.tilts import X, Y, Z, seat_on_column

LOOPS = 60  # of each kind
POSES = 4000  # along a loop
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


def smooth(random: np.random.Generator, count: int) -> np.ndarray:
    """A periodic sum of a few sines, sampled `count` times from a start to the same point again, its largest size 1."""
    turn = np.linspace(0.0, 2.0 * np.pi, count)
    size, phase = random.normal(size=WAVES) / np.arange(1, WAVES + 1), random.uniform(0.0, 2.0 * np.pi, WAVES)
    waves = sum(a * np.sin((k + 1) * turn + p) for k, (a, p) in enumerate(zip(size, phase, strict=True)))
    waves[-1] = waves[0]
    return waves / np.abs(waves).max()


def loop(probe: Probe, kind: Kind, random: np.random.Generator) -> Poses:
    """A closed loop: tilt, slide and deepest overlap are random and smooth, the distance along x follows from them.

    Against a floe's side the overlap is that of the corners and the side's plane; where a slide carries them past the side's rim,
    the true overlap is smaller.
    """
    tilt = np.exp(random.uniform(*np.log(TILTS))) * np.column_stack([smooth(random, POSES + 1) for _ in range(3)])
    slide = SLIDE * np.column_stack([share * smooth(random, POSES + 1) for share in kind.slide])
    overlap = OVERLAP * (1.0 + SWING * smooth(random, POSES + 1))
    turn = Rotation.from_rotvec(tilt) * kind.moving
    corners = np.einsum("nij,vj->nvi", turn.as_matrix(), probe.core(kind.mover))
    reach = probe.radius(0) + probe.radius(1) - overlap
    poses = Poses.at_rest(probe, POSES + 1)
    if kind.partner is PILE:
        place = seat_on_column(corners[:, :, :2] + [0.0, 1.0] * slide[:, None, :1], reach)
    else:
        wall = kind.held.apply(probe.core(0))[:, 0].max()
        poses = poses.moved(0, position=-wall * X, rotation=kind.held)
        place = reach - corners[:, :, 0].min(axis=1)
    return poses.moved(kind.mover, position=np.column_stack([place, slide]), rotation=turn)


def work(poses: Poses, answers: Answers, body: int) -> np.ndarray:
    """Work of the contact on a body from the start to each pose [J], force and moment by trapezoids."""
    force = answers.force if body == 1 else -answers.force
    moment = answers.moment[:, body]
    turn = Rotation.from_quat(poses.orientation[:, body], scalar_first=True)
    turned = (turn[1:] * turn[:-1].inv()).as_rotvec()
    moved = np.diff(poses.position[:, body], axis=0)
    steps = 0.5 * ((force[1:] + force[:-1]) * moved + (moment[1:] + moment[:-1]) * turned).sum(axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def every_other(poses: Poses, answers: Answers) -> tuple[Poses, Answers]:
    """Half the poses of a loop, the ends among them."""
    part = slice(None, None, 2)
    return poses[part], Answers(*(getattr(answers, name)[part] for name in Answers.__dataclass_fields__))


@dataclass(frozen=True)
class Balance:
    """Of a loop, relative to its peak stored energy."""

    net: float  # net work
    rough: float  # how much of that comes from the finite number of poses: its change where half of them are left out


def balance(poses: Poses, answers: Answers, body: int) -> Balance:
    peak = float(answers.energy.max())
    if peak == 0.0:
        return Balance(0.0, 0.0)
    net = float(work(poses, answers, body)[-1]) / peak
    half = float(work(*every_other(poses, answers), body)[-1]) / peak
    return Balance(net, abs(half - net))


@dataclass(frozen=True)
class Survey:
    """All loops: balances by kind and model, and one loop to show."""

    balances: dict[tuple[str, str], list[Balance]]
    example: dict[str, tuple[np.ndarray, np.ndarray]]  # model -> stored energy and work along the first loop


def survey() -> Survey:
    balances, example = {}, {}
    for model in MODELS:
        for order, kind in enumerate(KINDS):
            random = np.random.default_rng([SEED, order])
            probe = Probe(scene(model, FLOE, kind.partner))
            found = []
            for _ in range(LOOPS):
                poses = loop(probe, kind, random)
                answers = probe.at(poses)
                found.append(balance(poses, answers, kind.mover))
                if model not in example:
                    example[model] = answers.energy, work(poses, answers, kind.mover)
            balances[kind.name, model] = found
            print(f"{kind.name}, {model}: {LOOPS} loops", flush=True)
    return Survey(balances, example)


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
        energy, paid = found.example[model]
        way = np.linspace(0.0, 1.0, len(energy))
        one.plot(way, energy, color=COLOUR[model], label=f"{model}: stored")
        one.plot(way, energy[0] - paid, color=COLOUR[model], linestyle=":", label=f"{model}: paid by the motion")
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
