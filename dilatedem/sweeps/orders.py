"""A case of a sweep as an order to somebody who runs it, what becomes of it, and who that can be."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from dilatedem.case import write
from dilatedem.errors import INTERRUPTED, STOPPED, WRONG
from dilatedem.output import folder
from dilatedem.processes.children import Answer
from dilatedem.sweeps.plan import Job
from dilatedem.sweeps.progress import Progress


@dataclass(frozen=True)
class Order:
    """A case to be run. case: text of a case file; laws: of `Case.laws`; out, resume, overwrite: as `dilatedem run` has them."""

    case: str
    out: str
    resume: bool = False
    overwrite: bool = False
    laws: dict[str, Any] = field(default_factory=dict)


class Executor(Protocol):
    """Whoever carries out orders, some at a time, within `with`: processes of this machine (`local`), or a cluster (`cluster`).

    stopping : whether no order is begun any more. fault : why it carries out no more of them, empty where it does.
    """

    stopping: bool
    fault: str

    def __enter__(self) -> "Executor": ...

    def __exit__(self, *exception) -> None: ...

    def carry_out(self, orders: Sequence[Order], progress: Progress) -> Iterator[tuple[int, Answer]]:
        """The answers as they come, each with the number of its order, once the files of the run are in its folder.

        progress : told every second or so how far the runs are.
        """

    def interrupt(self) -> None:
        """Have the runs save their state and end, and no other begin."""

    def kill(self) -> None:
        """Have the runs end as they are."""


def order_of(job: Job) -> Order:
    """What is asked of whoever runs a case."""
    resume = (job.folder / folder.CHECKPOINT).exists()
    overwrite = not resume and job.folder.exists()  # killed before its first saved state
    return Order(write.dump(job.case), str(job.folder), resume, overwrite, job.case.laws)


def outcome(answer: Answer, stopping: bool) -> tuple[str, str]:
    """Status and message of a run; stopping: whether it was asked to end."""
    lines = [line.strip() for line in answer.said.splitlines() if line.strip()]
    if answer.code == 0:
        return "completed", ""
    if answer.code == INTERRUPTED or stopping:
        return "interrupted", "--resume goes on"
    if answer.code == STOPPED:
        return "stopped", "; ".join(lines)
    if answer.code == WRONG:
        return "failed", "; ".join(lines)
    if answer.code < 0:
        return "failed", f"killed by signal {-answer.code}"
    return "failed", lines[-1] if lines else f"exit code {answer.code}"
