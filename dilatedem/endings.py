"""How a command ends on a known fault: the one sentence that the user reads, and an exit code."""

from dilatedem.errors import INTERRUPTED, STOPPED, WRONG, CaseError, Interrupted, SimulationStopped
from dilatedem.files.faults import FULL, sentence


def ending(error: BaseException, *, can_resume: bool = False) -> tuple[str, int] | None:
    """Sentence and exit code of a fault; None for one that nobody foresaw.

    can_resume: whether what was under way goes on with --resume once there is room on the disk again.
    """
    match error:
        case CaseError():
            return str(error), WRONG
        case SimulationStopped():
            return str(error), STOPPED
        case Interrupted():
            return str(error), INTERRUPTED
        case KeyboardInterrupt():
            return "interrupted", INTERRUPTED
        case OSError(errno=number) if number in FULL:
            return f"{sentence(error)}{'; make room and go on with --resume' if can_resume else ''}", STOPPED
        case OSError():
            return sentence(error), WRONG
    return None
