"""When an output is due: steps counted exactly, so that a resumed run writes at the same steps."""

import math
from dataclasses import dataclass, field

import numpy as np

from dilatedem.state.clock import NEVER

ROUND_OFF = 1e-9  # relative; an event this close after a step belongs to that step, not to the next one


@dataclass(frozen=True)
class Schedule:
    """Events at times k * interval_s, k = 0, 1, 2, ..., each due at the first step that reaches its time.

    interval_s  [s], 0 = never
    dt          time step [s]
    span        only every so many steps can something be due: when all bodies stand at the same instant (`motion.paces`)

    The due step is a pure function of k (no sum of time steps), hence the same before and after a restart.
    Where the interval is shorter than a span, every span's end is due, once.
    """

    interval_s: float
    dt: float
    span: int = 1
    #: a step, the first due step after it and its event, as last found: what is asked next lies between them nearly always
    _known: list[int] = field(default_factory=lambda: [0, -1, -1], init=False, repr=False, compare=False)

    def __post_init__(self):
        if not (self.interval_s >= 0.0 and math.isfinite(self.interval_s)):
            raise ValueError(f"the interval must be 0 or a positive number of seconds, not {self.interval_s}")
        if not (self.dt > 0.0 and math.isfinite(self.dt)):
            raise ValueError(f"the time step must be a positive number of seconds, not {self.dt}")

    def due_step(self, event: int) -> int:
        """Step at which event number `event` is due."""
        if self.interval_s == 0.0:
            return NEVER
        steps = event * self.interval_s / self.dt
        first = math.ceil(steps - ROUND_OFF * max(1.0, steps))
        return -(-first // self.span) * self.span

    def events_until(self, step: int) -> int:
        """Number of events due at steps 0 .. `step`, both included; the next event has that number."""
        if self.interval_s == 0.0 or step < 0:
            return 0
        event = max(0, math.floor((step - self.span) * self.dt / self.interval_s) - 1)  # at or just below the answer
        while self.due_step(event) <= step:
            event += 1
        while event > 0 and self.due_step(event - 1) > step:
            event -= 1
        return event

    def next_due(self, step: int) -> int:
        """The first due step after `step` (NEVER if there is none); next_due(-1) is 0."""
        since, due, event = self._known
        if not since <= step < due:
            following = self.due_step(event + 1)
            event, due = (event + 1, following) if step == due < following else self._next_event(step)
            self._known[:] = step, due, event
        return due

    def _next_event(self, step: int) -> tuple[int, int]:
        """Number and due step of the first event after `step`."""
        event = self.events_until(step)
        return event, self.due_step(event)

    def due_after(self, step: int, count: int) -> np.ndarray:
        """Due steps after `step`, in order: up to `count` (fewer where several events are due at one step)."""
        if self.interval_s == 0.0:
            return np.zeros(0, np.int64)
        steps = (self._next_event(step)[0] + np.arange(count)) * self.interval_s / self.dt
        first = np.ceil(steps - ROUND_OFF * np.maximum(1.0, steps)).astype(np.int64)
        return np.unique(-(-first // self.span) * self.span)

    def is_due(self, step: int) -> bool:
        """Whether an event is due at `step`."""
        return self.next_due(step - 1) == step
