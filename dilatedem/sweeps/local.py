"""Cases on this machine: processes that are copies of this one, which has loaded all that the cases need."""

from collections.abc import Callable, Iterator, Sequence

from dilatedem.errors import INTERRUPTED
from dilatedem.processes.children import Answer, Children
from dilatedem.processes.interrupts import end_at_once
from dilatedem.sweeps.orders import Order
from dilatedem.sweeps.progress import Progress


class Local(Children):
    """So many processes at a time.

    leave : called in each copy of this process: what it must not share with it (locks).
    """

    def __init__(self, count: int, leave: Callable[[], None] = lambda: None):
        super().__init__(simulate_here, count, leave=leave)
        self._warming = False

    def carry_out(self, orders: Sequence[Order], progress: Progress) -> Iterator[tuple[int, Answer]]:
        self.warm(orders, progress)
        yield from super().carry_out(orders, progress.tell)

    def interrupt(self) -> None:
        super().interrupt()
        if self._warming:  # there is nothing to save
            raise KeyboardInterrupt

    def kill(self) -> None:
        super().kill()
        if self._warming:  # the exception met a line of Numba from which nothing can be raised
            end_at_once(INTERRUPTED)

    def warm(self, orders: Sequence[Order], progress: Progress) -> None:
        """Compile or load the kernels of all orders, before any process is made that would have to do it again."""
        from dilatedem.run.loop import compile_kernels  # once the cases are known to be fine

        self._warming = True
        for laws in sorted({tuple(order.laws.items()) for order in orders}):
            compile_kernels(**dict(laws), announce=progress.message)
        self._warming = False


def simulate_here(order: Order, tell: Callable[[float], None]) -> Answer:
    from dilatedem.sweeps.work import simulate  # in a copy it is there already

    return simulate(order, tell)
