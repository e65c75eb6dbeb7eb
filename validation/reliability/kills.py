"""Runs that are killed at random moments and resumed, and runs beside which a second process is started."""

import os
import shutil
import signal
import subprocess
import time
from functools import cache
from pathlib import Path
from random import Random
from typing import NamedTuple

from tests.regression.folders import CASES, assert_same_run, command, environment

#: a kill is followed by another one of the same run, instead of by its end, so often
AGAIN = 0.5


class Kind(NamedTuple):
    """A case, how it is shortened, a contact model, a number of threads, and settings besides."""

    case: str
    duration: float  # s
    sides: str
    model: str
    threads: int
    more: tuple[str, ...] = ()

    def command(self, out: Path, *options: str) -> list[str]:
        """Of a run that takes a second or two beside its start."""
        settings = [f"contact.model={self.model}", f"time.duration={self.duration}", "output.checkpoint_interval=0.1", *self.more]
        pairs = [part for setting in settings for part in ("--set", setting)]
        return command("run", CASES / f"{self.case}.toml", "--out", out, "--threads", self.threads, "--quiet", *pairs, *options)

    def whole(self, folder: Path) -> Path:
        """A run that nobody stops, made where it is not there; one thread, as the number of threads changes no byte."""
        out = folder / f"{self.case}-{self.sides}-{self.model}"
        if not out.exists():
            subprocess.run(self._replace(threads=1).command(out), check=True, env=environment())
        return out


KINDS = [
    Kind(case, duration, sides, model, threads)
    for case, duration, sides in (("crowded", 1.2, "open and periodic"), ("mixed", 0.6, "walls"))
    for model in ("liu2015", "consistent")
    for threads in (1, 2)
]

#: ice that enters, and settings by which it comes about
RECIPES = {
    "random points": (),
    "squares": ("field.shape=square",),
    "hexagons, in waves and wind, water taken along": (
        "field.shape=hexagon", "wave=[{amplitude=0.1,period=4.0}]", "wind={velocity=[8.0,0.0]}", "water.added_mass=true",
        "water.drag=skin_form",
    ),
    "Lloyd": ("field.regularity=4",),
    "power law": ("field={concentration=0.7,seed=4,size_distribution={kind='power_law',min=1.5,max=4.0}}",),
    "lognormal": ("field.size_distribution={kind='lognormal',spread=0.3}",),
    "ragged sides": ("field.front=ragged", "domain.y_boundary=open", "water.velocity=[1.5,0.0]"),
    "thickness spread": ("ice.thickness_spread=0.2",),
    "hexagons": ("field.shape=hexagon",),
    "Lloyd, lognormal, thickness spread": (
        "field.regularity=2", "field.size_distribution={kind='lognormal',spread=0.3}", "ice.thickness_spread=0.2",
    ),
}  # fmt: skip
INFLOW = (
    "domain.x_boundary=inflow", "water.velocity=[1.5,0.2]", "field.concentration=0.7", "structure.pile.radius=0.5",
    "time.step_fraction=0.4", "output.checkpoint_interval=0.4",
)  # fmt: skip
ENTERING = [
    Kind("crowded", 6.0, recipe, ("liu2015", "consistent")[k % 2], 1 + (k % 4 == 2), (*INFLOW, *more))
    for k, (recipe, more) in enumerate(RECIPES.items())
]


@cache
def wall_time(kind: Kind, folder: Path) -> float:
    """How long a run takes, loading of the program included but not its compiling [s]."""
    for _ in range(2):
        started = time.monotonic()
        subprocess.run(kind.command(folder / "timed"), check=True, env=environment())
        taken = time.monotonic() - started
        shutil.rmtree(folder / "timed")
    return taken


def kill_at_random(kind: Kind, folder: Path, random: Random) -> tuple[int, str]:
    """One run, killed at least once, then resumed to its end.

    Returns the number of kills that met it alive, and what differs from the run that nobody stopped ("" = nothing).
    """
    whole, out, longest, kills = kind.whole(folder), folder / "killed", wall_time(kind, folder), 0
    while kills == 0 or random.random() < AGAIN:
        process = subprocess.Popen(kind.command(out, *way_on(out)), env=environment(), stderr=subprocess.PIPE)
        time.sleep(random.uniform(0.0, longest))
        kills += process.poll() is None
        process.kill()
        said = process.communicate()[1].decode()
        if said:
            return kills, said
        if kills == 0:
            shutil.rmtree(out, ignore_errors=True)
    done = subprocess.run(kind.command(out, *way_on(out)), env=environment(), capture_output=True, text=True, check=False)
    try:
        assert done.returncode == 0, done.stderr
        assert_same_run(out, whole)
    except AssertionError as difference:
        return kills, str(difference)
    shutil.rmtree(out, ignore_errors=True)
    return kills, ""


def way_on(out: Path) -> list[str]:
    """As the killed run left it: a state to resume, or a beginning to replace."""
    return ["--resume"] if (out / "restart.h5").exists() else ["--overwrite"] if (out / "case.toml").exists() else []


def second_process(kind: Kind, folder: Path, way: str) -> str:
    """Start a run, stop it for a moment, try a second one in its folder. Returns what was wrong ("" = nothing)."""
    whole, out = kind.whole(folder), folder / "shared"
    first = subprocess.Popen(kind.command(out), env=environment(), stderr=subprocess.PIPE)
    while not (out / "restart.h5").exists():
        if first.poll() is not None:
            return first.stderr.read().decode()
        time.sleep(0.005)
    os.kill(first.pid, signal.SIGSTOP)
    os.waitid(os.P_PID, first.pid, os.WSTOPPED)
    try:
        second = subprocess.run(kind.command(out, *way.split()), env=environment(), capture_output=True, text=True, check=False)
    finally:
        os.kill(first.pid, signal.SIGCONT)
    said = first.communicate()[1].decode()
    try:
        assert second.returncode == 2 and second.stderr.count("\n") == 1, second.stderr
        assert first.returncode == 0 and not said, said
        assert_same_run(out, whole)
    except AssertionError as difference:
        return str(difference) or "not refused"
    shutil.rmtree(out, ignore_errors=True)
    return ""
