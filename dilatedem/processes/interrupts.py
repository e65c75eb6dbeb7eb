"""Ctrl-C on the command line: heard once, as an exception; whoever presses it again gets the prompt, and no traceback."""

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from dilatedem.errors import INTERRUPTED

#: brings back the cursor that a progress bar hides
SHOW_CURSOR = b"\x1b[?25h"

_ending = False


@contextmanager
def heard_once() -> Iterator[None]:
    """Within `with`, the first Ctrl-C is a KeyboardInterrupt; another one, or one while the program ends, ends it at once."""
    signal.signal(signal.SIGINT, _hear)
    sys.unraisablehook = _tell_unraisable
    try:
        yield
    finally:
        program_ends()


def program_ends() -> None:
    """What is left is a last message: an exception would only add its traceback."""
    global _ending
    _ending = True


def end_at_once(code: int) -> None:
    """Leave without another line of Python, as a kill would; files are whole at every moment."""
    with suppress(OSError, ValueError):
        if sys.stderr.isatty():
            os.write(sys.stderr.fileno(), SHOW_CURSOR)
    os._exit(code)


def _hear(number, frame) -> None:
    if _ending:
        end_at_once(INTERRUPTED)
    program_ends()
    raise KeyboardInterrupt


def _tell_unraisable(fault) -> None:
    """A Ctrl-C that met a line from which nothing can be raised is lost without a word: the next one counts as the first."""
    global _ending
    if issubclass(fault.exc_type, KeyboardInterrupt):
        _ending = False
    else:
        sys.__unraisablehook__(fault)
