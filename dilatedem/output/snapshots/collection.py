"""What all snapshots have in common: a file at each of their times, and a .pvd file that lists them."""

import numpy as np
from numpy.typing import ArrayLike

from dilatedem.output.observer import Observer
from dilatedem.output.snapshots.vtu import wrapped, write_pvd


class Collection(Observer):
    """An observer that has `_write`, with the name of a file and what it handed over, called in the background."""

    #: the file that lists all others
    listing: str

    def open(self, kept: dict | None, since: int) -> None:
        self.written: list[list] = kept["written"] if kept else []  # time [s], file
        self._listed = 0

    def number(self, step: int) -> int:
        """Of the snapshot at a step that is due, from 0."""
        return self.schedule.events_until(step) - 1

    def put(self, name: str, *what) -> None:
        """Have the snapshot of this moment written, from copies of what there is of it."""
        self.background.put(self._write, name, *what)
        self.written.append([self.simulation.time_s, name])

    def _write(self, name: str, *what) -> None:
        raise NotImplementedError

    def at_home(self, position: ArrayLike) -> np.ndarray:
        """Places (n, 3) [m] brought back into the domain where it is periodic."""
        domain = self.simulation.case.domain
        return wrapped(position, domain.size, [side == "periodic" for side in (domain.x_boundary, domain.y_boundary)])

    def refresh(self) -> None:
        if self._listed < len(self.written):
            self.background.put(write_pvd, self.out / self.listing, list(self.written))
            self._listed = len(self.written)

    def kept(self) -> dict:
        return {"written": list(self.written)}


def snapshots_of(case, interval: float) -> float:
    """How many snapshots a whole run has."""
    return case.time.duration / interval + 1 if interval else 0.0
