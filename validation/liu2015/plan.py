"""Which runs the comparison with the paper needs, in which order, and where each of them lies."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path

MODELS = ("liu2015", "consistent")

#: mean floe size in m, as the paper names it -> case
CASES = {"2.8": Path("cases/pile.toml"), "1.79": Path("cases/pile_small.toml")}
LARGE, SMALL = "2.8", "1.79"

SPEEDS = (0.1, 0.3, 0.5, 0.7, 0.9, 1.0)  # m/s, of the paper's Fig. 14
SIZE_SPEED = 0.3  # m/s at which the two sizes are compared
FIRST_SPEEDS = (0.3, 1.0)  # m/s; run first, so that early figures span the range
SEED_COUNT = 10

#: s; each snapshot is 75 kB. Jam and lane are read from them, and the views in plan drawn.
SNAPSHOT_INTERVAL = 5.0

#: of the critical step; twice the default. Every run replays its highest load at half of it (`error_check`): some 0.1 % of the
#: peak, a hundredth of the spread between seeds
STEP_FRACTION = 0.2

#: s of one core for a run of 100 s, for the estimate until a run of that size is there
TYPICAL_WALL = {"2.8": 50.0, "1.79": 120.0}


@dataclass(frozen=True, order=True)
class Run:
    """One run of the plan."""

    model: str
    size: str  # m, a key of CASES
    speed: float  # m/s, of the current and of the ice at the start
    seed: int

    @property
    def case(self) -> Path:
        return CASES[self.size]

    @property
    def name(self) -> str:
        return f"{self.model}, {self.size} m, {self.speed:g} m/s, seed {self.seed}"

    def folder(self, root: Path) -> Path:
        return root / self.model / f"size_{self.size}" / f"speed_{self.speed:g}" / f"seed_{self.seed:02d}"

    def overrides(self) -> list[str]:
        """What differs from the case file, as KEY=VALUE."""
        return [
            f"contact.model={self.model}",
            f"water.velocity=[{self.speed:g}, 0.0]",
            f"field.seed={self.seed}",
            f"output.snapshot_interval={SNAPSHOT_INTERVAL:g}",
            f"time.step_fraction={STEP_FRACTION:g}",
        ]


def plan(models: Sequence[str] = MODELS, speeds: Sequence[float] = SPEEDS, seeds: int = SEED_COUNT) -> list[Run]:
    """All runs, seed after seed: a command that ends early leaves whole seeds.

    Within a seed the ends of the range of speeds come first, then the small floes, then the other speeds.
    """
    first = [speed for speed in FIRST_SPEEDS if speed in speeds]
    rest = [speed for speed in speeds if speed not in first]
    points = [(LARGE, speed) for speed in first] + [(SMALL, SIZE_SPEED)] + [(LARGE, speed) for speed in rest]
    return [Run(model, size, speed, seed) for seed, (size, speed), model in product(range(1, seeds + 1), points, models)]


def found(root: Path) -> Iterable[Run]:
    """The runs that have a folder below this one, whichever plan they came from."""
    for folder in sorted(root.glob("*/size_*/speed_*/seed_*")):
        model, size, speed, seed = folder.parts[-4:]
        size = size.removeprefix("size_")
        if model in MODELS and size in CASES:
            yield Run(model, size, float(speed.removeprefix("speed_")), int(seed.removeprefix("seed_")))
