"""The three ways a command ends other than well; each carries the one sentence the user reads."""


class CaseError(Exception):
    """The command line or the case is wrong: nothing was written (exit code 2)."""


class SimulationStopped(Exception):
    """The simulation could not go on: the state was saved; the message names bodies, time and cause (exit code 3)."""


class Interrupted(Exception):
    """The user stopped the run: the state was saved, `--resume` continues it (exit code 130)."""
