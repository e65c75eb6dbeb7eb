"""What runs a case of a sweep, in whatever process that is."""

import time
import traceback
from collections.abc import Callable
from pathlib import Path

from dilatedem.case.load import Source, build
from dilatedem.endings import ending
from dilatedem.garbage import seldom_collected
from dilatedem.processes.children import Answer
from dilatedem.processes.interruption import Interruption
from dilatedem.run.loop import run
from dilatedem.sweeps.fields import scene_at_hand
from dilatedem.sweeps.orders import Order

#: s between two words on how far a run is
TELL_S = 1.0


class Share:
    """Stands for `output.progress.Progress`: tells how far a run is, as a share of its duration, once in a while."""

    def __init__(self, duration_s: float, tell: Callable[[float], None]):
        self._duration_s, self._tell, self._told = duration_s, tell, 0.0

    def __enter__(self) -> "Share":
        return self

    def __exit__(self, *exception) -> None:
        pass

    def update(self, time_s: float, steps: int, contacts: Callable[[], int]) -> None:
        if (now := time.monotonic()) - self._told >= TELL_S:
            self._told = now
            self._tell(time_s / self._duration_s)

    def message(self, text: str) -> None:
        pass


def simulate(order: Order, tell: Callable[[float], None], interruption: Interruption | None = None) -> Answer:
    """Runs a case to its end, as `dilatedem run` does on one thread.

    interruption : asked to stop by somebody else than signals
    """
    try:
        with seldom_collected():
            case = build(Source("<sweep>", order.case))
            told = Share(case.time.duration, tell)
            run(
                case, Path(order.out), resume=order.resume, overwrite=order.overwrite, progress=told, interruption=interruption,
                scene=scene_at_hand(case),
            )  # fmt: skip
    except BaseException as error:
        known = ending(error, can_resume=True)
        return Answer(known[1], known[0]) if known else Answer(1, traceback.format_exc())
    return Answer(0)
