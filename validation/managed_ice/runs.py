"""The runs behind the page, one after another: fields, cases, and what was said of the load on the wall; those done are kept."""

import csv
import io
import json
import tomllib
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from dilatedem.case.load import case_from, load
from dilatedem.case.schema import Case
from dilatedem.files.atomic import write_text
from dilatedem.output import folder
from dilatedem.results.load import load as opened
from dilatedem.run.loop import run
from validation.managed_ice.fields import written

HERE = Path(__file__).parent
CASE, RECORD = HERE / "managed_ice.toml", HERE / "runs.csv"
#: m of way between which loads count: behind the length of a floe, within which the wall first meets ice
FROM, TO = 5.0, 20.0
#: m of way that a piece of the history is the mean of
PIECE = 2.5
#: m by which ways are sums of decimal numbers
ROUND_OFF = 1e-6
#: columns of RECORD: those of a point, and what its run said beside the history
POINT = ("shape", "concentration", "thickness_m", "floe_m", "seed")
FIGURES = ("mean_N", "spread_N", "peak_N", "pushed", "crushed_over_work", "residual_over_work")


@dataclass(frozen=True)
class Point:
    """A case: shape and size [m] of the floes, their concentration and thickness [m], and the seed of their field."""

    shape: str
    concentration: float
    thickness: float = 1.0
    floe: float = 5.0
    seed: int = 1

    @property
    def name(self) -> str:
        return f"{self.shape}_c{self.concentration:g}_h{self.thickness:g}_l{self.floe:g}_seed_{self.seed}"

    def case(self, root: Path) -> Case:
        """The case, its field drawn into a folder under `root` where it is not there."""
        size = tuple(load(CASE).domain.size)
        path = written(root / "fields", self.shape, size, self.floe, self.concentration, self.seed)
        field = {"source": "file", "file": str(path.absolute()), "tolerance": 0.0, "seed": self.seed}
        return case_from(tomllib.loads(CASE.read_text()) | {"field": field}, {"ice.thickness": self.thickness})


@dataclass(frozen=True)
class Found:
    """Load on the wall against its way through the ice, between FROM and TO [N].

    mean, spread : of the mean load of every window of forces.csv, and its standard deviation in time
    peak : the highest of any step
    pushed : floes that go along, at more than half the speed of the wall, after TO
    crushed, residual : what went into crushing, and the largest residual of the ledger, over the work of the wall
    history : mean of every PIECE of the way, from its start
    """

    mean: float
    spread: float
    peak: float
    pushed: float
    crushed: float
    residual: float
    history: tuple[float, ...]


def found(points: Iterable[Point], root: Path) -> dict[Point, Found]:
    """What the runs of all points gave; those of which RECORD does not tell are run, and noted there."""
    points, known = list(points), recorded()
    for point in points:
        if point not in known:
            known[point] = of_run(made(point, root))
            record(known)
            print(point.name, known[point], flush=True)
    return {point: known[point] for point in points}


def made(point: Point, root: Path) -> Path:
    """The folder of a run that is complete; one that was broken off goes on."""
    out = root / point.name
    summary = out / "summary.json"
    if not summary.exists() or json.loads(summary.read_text())["status"] != "completed":
        run(point.case(root), out, resume=folder.holds_run(out), quiet=True)
    return out


def of_run(out: Path) -> Found:
    """What a run said."""
    told = opened(out)
    speed = -told.case["structure"][0]["support"]["velocity"][0]
    rows, energy = told.forces[told.forces.structure == "wall"], told.energy[speed * told.energy.time_s <= TO + ROUND_OFF]
    mean, spread, peak, history = measured(speed * rows.time_s.to_numpy(), rows.fx_N.to_numpy(), rows.fh_max_N.to_numpy())
    pushed, end = np.count_nonzero(told.snapshot(TO / speed).velocity[:, 0] < -0.5 * speed), energy.iloc[-1]
    crushed, residual = (float(lost / end.work_structure) for lost in (end.loss_crushing, energy.residual.abs().max()))
    return Found(mean, spread, peak, float(pushed), crushed, residual, history)


def measured(way: np.ndarray, load: np.ndarray, highest: np.ndarray) -> tuple[float, float, float, tuple[float, ...]]:
    """Mean, spread, peak and history of windows (n,) that end after a `way` [m]: mean `load` and `highest` of any step [N]."""
    counts = (way > FROM + ROUND_OFF) & (way <= TO + ROUND_OFF)
    piece = np.ceil((way - ROUND_OFF) / PIECE).astype(int) - 1
    history = tuple(float(load[piece == k].mean()) for k in range(round(TO / PIECE)))
    return float(load[counts].mean()), float(load[counts].std()), float(highest[counts].max()), history


def record(known: dict[Point, Found]) -> None:
    """Note what all runs said: a row a run, in whole newtons."""
    rows = []
    for point, told in known.items():
        loads, rest = (told.mean, told.spread, told.peak), (round(told.pushed), f"{told.crushed:.4g}", f"{told.residual:.2g}")
        rows.append([*asdict(point).values(), *map(round, loads), *rest, *map(round, told.history)])
    pieces = [f"fx_to_{PIECE * (k + 1):g}_m_N" for k in range(max(len(told.history) for told in known.values()))]
    table = io.StringIO()
    rows = [[*POINT, *FIGURES, *pieces], *sorted(rows, key=lambda row: row[: len(POINT)])]
    csv.writer(table, lineterminator="\n").writerows(rows)
    write_text(RECORD, table.getvalue())


def recorded() -> dict[Point, Found]:
    """What is noted of runs that were done before."""
    if not RECORD.exists():
        return {}
    with RECORD.open(newline="") as file:
        rows = list(csv.reader(file))[1:]
    known = {}
    for shape, *numbers in rows:
        concentration, thickness, floe, seed, *loads = map(float, numbers)
        known[Point(shape, concentration, thickness, floe, int(seed))] = Found(*loads[: len(FIGURES)], tuple(loads[len(FIGURES) :]))
    return known
