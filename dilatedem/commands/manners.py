"""How every command speaks and ends: switches, lines on standard output, one message and an exit code for each known fault."""

import functools
import os
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

import typer
from typer.core import TyperCommand, TyperGroup

from dilatedem.endings import ending
from dilatedem.errors import printable
from dilatedem.processes import interrupts

#: exit code of a program whose output nobody reads any more: 128 and SIGPIPE
UNREAD = 141
#: s between two lines about what is being done, where there is no terminal
LINE_INTERVAL_S = 10.0


class _Switches:
    """A command whose help shows switches without the word that says what kind of value follows: none does."""

    def get_params(self, *context: Any) -> list:
        options = super().get_params(*context)
        for option in options:
            if getattr(option, "is_flag", False) and option.metavar is None:
                option.metavar = ""
        return options


class Command(_Switches, TyperCommand):
    """Any command."""


class Commands(_Switches, TyperGroup):
    """The program itself."""


class Program(typer.Typer):
    """All commands, with one kind of help."""

    def __init__(self, **options: Any):
        super().__init__(cls=Commands, **options)

    def command(self, *arguments: Any, **options: Any) -> Callable:
        return super().command(*arguments, **{"cls": Command} | options)


def known_faults(command: Callable) -> Callable:
    """Ends a command on a known fault: its message on standard error, its exit code, no traceback."""

    @functools.wraps(command)
    def wrapped(*args: Any, **kwargs: Any) -> None:
        try:
            command(*args, **kwargs)
            if sys.stdout:
                sys.stdout.flush()
        except BrokenPipeError:
            nobody_reads()
        except (Exception, KeyboardInterrupt) as error:
            known = ending(error, can_resume=command.__name__ == "run")
            if not known:
                raise
            end(*known)

    return wrapped


def say(text: object) -> None:
    """A line, or several, on standard output."""
    print(printable(str(text), keep="\n"))


def whisper(text: object) -> None:
    """The same on standard error, where results are not looked for; a terminal may be gone."""
    with suppress(OSError):
        print(printable(str(text), keep="\n"), file=sys.stderr, flush=True)


def cautions(doubts: Iterable[str]) -> list[str]:
    """A line for each thing to doubt."""
    return [f"caution: {doubt}" for doubt in doubts]


@contextmanager
def busy() -> Iterator[Callable[[str], None]]:
    """What tells the user, within, what is being done: a line that changes on a terminal, elsewhere a line now and then."""
    if not sys.stderr.isatty():
        yield _now_and_then()
        return
    from rich.console import Console

    with Console(stderr=True, highlight=False).status("", spinner="line") as status:
        yield lambda said: status.update(printable(said))


def _now_and_then() -> Callable[[str], None]:
    latest = time.monotonic()

    def tell(said: str) -> None:
        nonlocal latest
        if time.monotonic() - latest >= LINE_INTERVAL_S:
            latest = time.monotonic()
            whisper(said)

    return tell


def nobody_reads() -> None:
    """Ends the program without a word, as SIGPIPE ends others: whoever read its output has what he wanted, as `head` does."""
    interrupts.program_ends()
    with suppress(OSError, ValueError):  # what is left in the buffer has nowhere to go when Python ends
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    raise typer.Exit(UNREAD) from None


def end(message: str, code: int) -> None:
    """Ends the program with a message on standard error."""
    interrupts.program_ends()
    whisper(message)
    raise typer.Exit(code) from None
