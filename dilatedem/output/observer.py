"""What looks at a simulation from time to time and keeps one file of its run folder: each owns its interval and its rows."""

from collections.abc import Callable
from pathlib import Path

from dilatedem.output.background import Background
from dilatedem.output.schedule import Schedule
from dilatedem.output.tables import Table


class Observer:
    """One observer of a run. After `open`, it is asked to `look` at the steps that it named, and to `refresh` its file at times.

    Of the simulation it may read everything and change nothing. What takes long goes to the background, in copies.
    """

    #: its name in a checkpoint
    name: str

    @classmethod
    def interval(cls, case) -> float:
        """Simulated time between two looks [s], 0 = never; time steps are chosen to divide it where they can."""
        return 0.0

    @classmethod
    def size(cls, case, floes: int, structures: int) -> float:
        """What it will write in a whole run, about [bytes]."""
        return 0.0

    def __init__(self, simulation, out: Path, background: Background):
        self.simulation, self.out, self.background = simulation, out, background
        self.schedule = Schedule(self.interval(simulation.case), simulation.dt, simulation.span)

    def open(self, kept: dict | None, since: int) -> None:
        """Start its file, or go on with it from what a checkpoint `kept` of it; since: the last step that was looked at."""

    def next_due(self, step: int) -> int:
        """The first step after `step` that it must see."""
        return self.schedule.next_due(step)

    def look(self, step: int, last: bool) -> None:
        """At the present step, one of those that some observer must see; last: of the run."""
        if self.schedule.is_due(step):
            self.note(step)

    def note(self, step: int) -> None:
        """At a step that is due."""

    def is_full(self, step: int) -> bool:
        """Whether it has no room for what comes after `step` until it is refreshed."""
        return False

    def must_save(self, step: int) -> bool:
        """Whether the state is to be saved at `step`."""
        return False

    def refresh(self) -> None:
        """Bring its file up to this moment."""

    def save(self) -> None:
        """The state is about to be saved."""

    def kept(self) -> dict:
        """What a checkpoint of this moment holds of it, in copies that JSON can hold."""
        return {}

    def settle(self) -> dict:
        """In the background, after all that was handed over: have its file on the disk; what a checkpoint holds of that."""
        return {}

    def summary(self) -> dict:
        """What it has to say in summary.json at this moment."""
        return {}

    def repacked(self) -> None:
        """Bodies have come or gone: rows stand for others than before."""

    def close(self) -> None:
        """The run goes no further."""


class TableObserver(Observer):
    """An observer that writes a CSV table, which only the background touches once it is open."""

    file: str
    columns: tuple[str, ...]

    def open(self, kept: dict | None, since: int) -> None:
        path = self.out / self.file
        self.table = Table(path, self.columns) if kept is None else Table.reopen(path, self.columns, kept["offset"], kept["digest"])

    def put(self, append: Callable[[Table], None] | None) -> None:
        """Have rows appended, then the table handed to the system, in the background."""
        self.background.put(self._append, append)

    def _append(self, append: Callable[[Table], None] | None) -> None:
        if append:
            append(self.table)
        self.table.flush()

    def settle(self) -> dict:
        self.table.flush(durable=True)
        return {"offset": self.table.offset, "digest": self.table.digest}

    def close(self) -> None:
        self.table.close()
