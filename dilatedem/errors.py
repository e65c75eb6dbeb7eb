"""The three ways a command ends other than well; each carries the one sentence the user reads, and how any text is shown."""

import signal
import unicodedata

#: exit codes of these ends; a shell gives the last one to what Ctrl-C ended
WRONG, STOPPED, INTERRUPTED = 2, 3, 128 + signal.SIGINT

#: categories of Unicode that a terminal would obey, or could not show: control and format characters, halves of surrogate pairs,
#: separators of lines and paragraphs
_UNSHOWN = frozenset({"Cc", "Cf", "Cs", "Zl", "Zp"})


class CaseError(Exception):
    """The command line or the case is wrong: nothing was written (exit code 2)."""


class SimulationStopped(Exception):
    """The simulation could not go on: the state was saved; the message names bodies, time and cause (exit code 3)."""


class Interrupted(Exception):
    """The user stopped the run: the state was saved, `--resume` continues it (exit code 130)."""


def printable(text: str, *, keep: str = "") -> str:
    """`text` as a terminal may have it: what it would obey or cannot show is written as an escape, but for what is in `keep`."""
    if text.isascii() and text.isprintable():
        return text
    return "".join(
        character if character in keep or unicodedata.category(character) not in _UNSHOWN else _escape(character)
        for character in text
    )


def _escape(character: str) -> str:
    return character.encode("unicode_escape").decode("ascii")
