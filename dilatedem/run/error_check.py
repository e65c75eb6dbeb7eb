"""The error of the time step, measured where it matters: the moments around the highest load, replayed with half the step.

While a run goes on, a `Watch` keeps copies of its state and knows which of them lies before the highest horizontal load on any
structure so far. When the run is done, `check` goes from that copy through the load once more, with the run's own step, which
must give the same load to the last bit (or resuming is not exact), and with half of it.

Hits last 20 to 60 ms. Over some tenths of a second two steps follow one history and differ by their error; over seconds the
motion of many bodies is chaotic, and a longer replay would compare two histories. So what is found is the error in this one hit and
no error bar of the run: another history, of another step or another seed, has another highest hit.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from dilatedem.errors import Interrupted
from dilatedem.output import checkpoint
from dilatedem.output.observer import Observer
from dilatedem.output.schedule import Schedule
from dilatedem.state.bodies import Bodies
from dilatedem.state.clock import NEVER, Status, clock_at
from dilatedem.state.hits import no_hits
from dilatedem.state.ledger import empty_ledger
from dilatedem.state.loads import Windows, empty_loads
from dilatedem.state.pairs import PackedPairs, packed, unpacked
from dilatedem.state.supports import Excursions

#: s between two copies of the state: longer ones cost less time, but the replays that begin at them cost more
WINDOW = 0.25
#: s between the start of a replay and its peak, at least: a hit is in it as a whole; else the replay starts a window earlier
LEAD = 0.1
#: s that a replay goes on after its peak
TAIL = 0.1
#: steps between two looks at the keyboard
CHUNK = 2000

COPIES = ("before", "latest", "worst")  # of a `Watch`, as they are called in a checkpoint


class Moment(NamedTuple):
    """When a copy was taken, and the loads of that step."""

    step: np.ndarray  # (1,)
    step_load: np.ndarray  # (s, 6) N and N m on each structure


class Copy(NamedTuple):
    """All that the motion after some step depends on; never written to."""

    moment: Moment
    bodies: Bodies
    pairs: PackedPairs
    excursions: Excursions

    @classmethod
    def of(cls, state) -> "Copy":
        return cls(
            Moment(state.clock.step.copy(), state.loads.step_load.copy()),
            Bodies(*(values.copy() for values in state.bodies)),
            packed(state.pairs),
            type(state.excursions)(*(values.copy() for values in state.excursions)),
        )

    @property
    def step(self) -> int:
        return int(self.moment.step[0])


@dataclass
class Watch:
    """The highest horizontal load on any structure up to the last look, and copies of the state around it.

    It looks at scheduled steps only, so what it keeps does not depend on where a run was interrupted.
    """

    dt: float  # s
    span: int = 1  # steps after which all bodies stand at one instant
    structures: int | None = None  # the records that are no sums, the first so many; None: all
    peak: float = 0.0  # N
    structure: int = -1  # its number, -1 = none was touched
    until: int = 0  # step of the look that saw the peak
    seen: int = 0  # step of the last look
    before: Copy | None = None  # at the last window but one
    latest: Copy | None = None  # at the last window
    worst: Copy | None = None  # where the replay begins
    windows: Schedule = field(init=False)  # when a copy is due

    def __post_init__(self):
        self.windows = Schedule(WINDOW, self.dt, self.span)

    def look(self, state, windows: Windows, first: int) -> None:
        """At every window of this watch, or more often.

        state: at this moment; windows: of forces.csv, of which those from the number `first` on have ended since the last look
        """
        step, count = int(state.clock.step[0]), int(windows.count[0])
        highest = windows.extreme[first:count, : self.structures, 4]
        if highest.max(initial=0.0) > self.peak:
            for end, loads in zip(windows.due[first:count].tolist(), highest.tolist(), strict=True):
                self._note(loads, end)
        elif count > first:  # nearly always: one comparison of all takes less than one of each
            self.seen = int(windows.due[count - 1])
        if self.windows.is_due(step):
            if state.loads.steps[0] > 0:  # a window is open
                self._note(state.loads.window_extreme[: self.structures, 4].tolist(), step)
            self.before, self.latest = self.latest, Copy.of(state)

    def _note(self, highest: list[float], step: int) -> None:
        """The highest load on each structure between the step seen last and this one."""
        if max(highest, default=0.0) > self.peak:
            self.peak, self.until = max(highest), step
            self.structure = highest.index(self.peak)
            early = self.seen < self.latest.step + LEAD / self.dt
            self.worst = self.before if early and self.before else self.latest
        self.seen = step

    def groups(self) -> dict[str, NamedTuple]:
        """The copies as groups of a checkpoint."""
        kept = {name: getattr(self, name) for name in COPIES}
        return {f"{name}_{part}": value for name, copy in kept.items() if copy for part, value in copy._asdict().items()}

    def figures(self) -> dict:
        """The rest, as meta of a checkpoint."""
        return {name: getattr(self, name) for name in ("peak", "structure", "until", "seen")}

    def restore(self, groups: dict[str, dict], figures: dict, excursions: type[Excursions], *, where: str) -> None:
        """Take up `groups` and `figures` of a checkpoint; excursions: their class. Raises CaseError as `checkpoint.restore`."""
        kinds = {"moment": Moment, "bodies": Bodies, "pairs": PackedPairs, "excursions": excursions}
        for name in COPIES:
            if f"{name}_moment" in groups:
                parts = (checkpoint.restore(kind, groups[f"{name}_{part}"], where=where) for part, kind in kinds.items())
                setattr(self, name, Copy(*parts))
        for name, value in figures.items():
            setattr(self, name, value)


class LoadWatch(Observer):
    """Has the watch, where the case asks for one, look at every window of loads."""

    name = "watch"

    def open(self, kept: dict | None, since: int) -> None:
        self._looked_at = 0  # windows that wait to be written and were looked at

    def next_due(self, step: int) -> int:
        watch = self.simulation.state.watch
        return watch.windows.next_due(step) if watch else NEVER

    def look(self, step: int, last: bool) -> None:
        state, windows = self.simulation.state, self.simulation.windows
        if state.watch:
            state.watch.look(state, windows, self._looked_at)
            self._looked_at = int(windows.count[0])

    def refresh(self) -> None:
        self._looked_at = 0


def check(simulation, names: list[str], asked: Callable[[], bool] = lambda: False) -> dict:
    """What summary.json says of the error of the step; docs/output.md explains each entry.

    simulation  at its end, with a `Watch` in its state; it is not touched
    names       of the structures, in their order
    asked       whether the user wants to end; then Interrupted is raised
    """
    watch = simulation.state.watch
    if watch.worst is None:
        cause = "no structure was touched" if names else "the case has no structure"
        return {"message": f"time step not checked: {cause}, so there is no load to compare"}
    start, end = watch.worst.step, min(watch.until + round(TAIL / simulation.dt), int(simulation.state.clock.step[0]))
    found = {
        "message": "", "structure": names[watch.structure], "start_s": start * simulation.dt, "end_s": end * simulation.dt,
        "reproduced": False,
    }  # fmt: skip
    try:
        found["at_dt"] = own = replay(simulation, end - start, 1, asked)
        found["reproduced"] = own["fh_max_N"] == watch.peak
        if not found["reproduced"]:
            peaks = f"a peak load of {own['fh_max_N']:.9g} N instead of {watch.peak:.9g} N"
            raise ReplayFault(f"the replay with the run's own step gave {peaks}, so this run cannot be resumed exactly")
        found["at_half_dt"] = half = replay(simulation, end - start, 2, asked)
    except ReplayFault as fault:
        return found | {"message": f"time step not checked: {fault}"}
    found["change"] = change = {
        "fh_max": (half["fh_max_N"] - own["fh_max_N"]) / own["fh_max_N"],
        "impulse_x": _share(half["impulse_x_Ns"] - own["impulse_x_Ns"], own["impulse_h_Ns"]),
        "impulse_h": _share(half["impulse_h_Ns"] - own["impulse_h_Ns"], own["impulse_h_Ns"]),
    }
    return found | {"message": (
        f"in the one hit replayed, the highest on {found['structure']} ({own['fh_max_N'] / 1e3:.4g} kN), half the time step "
        f"changes the peak by {_percent(change['fh_max'])}, the impulse from {found['start_s']:.2f} to {found['end_s']:.2f} s by "
        f"{_percent(change['impulse_h'])}; this is no error bar of the run: another history would have another highest hit"
    )}  # fmt: skip


class ReplayFault(Exception):
    """A replay did not come to its end, or to another one than the run."""


def replay(simulation, steps: int, parts: int, asked: Callable[[], bool]) -> dict[str, float]:
    """Go through `steps` steps from the worst copy again, each in so many equal parts.

    Returns step [s], highest horizontal load [N] on the worst structure, impulse [N s] along x and size of the horizontal one.
    Raises ReplayFault where the simulation cannot go on.
    """
    watch, loads = simulation.state.watch, simulation.state.loads
    copy, s = watch.worst, watch.structure
    state = replace(
        simulation.state, bodies=Bodies(*(values.copy() for values in copy.bodies)),
        pairs=unpacked(copy.pairs, 2 * len(copy.pairs.a) + 64), ledger=empty_ledger(len(simulation.state.ledger.departed_work)),
        loads=empty_loads(len(loads.step_contacts), len(loads.impulse_map)), hits=no_hits(0),
        clock=clock_at(copy.step * parts, simulation.dt / parts),
        excursions=type(copy.excursions)(*(values.copy() for values in copy.excursions)),
    )  # fmt: skip
    again = replace(simulation, state=state, dt=simulation.dt / parts)
    left = steps * parts
    while left > 0:
        if asked():
            raise Interrupted("interrupted while the time step was checked; the run is saved, --resume checks again")
        chunk = min(left, -(-CHUNK // again.span) * again.span)
        status = again.advance(chunk)
        if status != Status.DONE:
            share = "half the step" if parts == 2 else "the run's own step"
            raise ReplayFault(f"the replay with {share} stopped at t = {again.time_s:.6g} s ({status.name})")
        left -= chunk
    # trapezoids: at the ends of the window a force may be acting, and counting it whole would look like an error of the step
    ends = 0.5 * (state.loads.step_load[s] - copy.moment.step_load[s])
    x, y = ((state.loads.window_sum[s] - ends)[:2] * again.dt).tolist()
    peak = float(state.loads.window_extreme[s, 4])
    return {"dt_s": again.dt, "fh_max_N": peak, "impulse_x_Ns": x, "impulse_h_Ns": float(np.hypot(x, y))}


def _share(part: float, whole: float) -> float | None:
    return part / whole if whole > 0.0 else None


def _percent(share: float | None) -> str:
    return "an unknown share" if share is None else f"{100.0 * share:+.2g} %"
