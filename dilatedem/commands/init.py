"""dilatedem init: a commented case to begin with."""

from pathlib import Path
from typing import Annotated

import typer

from dilatedem.commands.manners import known_faults, say
from dilatedem.examples import names


@known_faults
def init(
    name: Annotated[str, typer.Argument(metavar="[NAME]", help=f"One of {', '.join(names())}; pile unless given.")] = "pile",
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE", help="File, or folder, to write to; NAME.toml unless given.")
    ] = None,
) -> None:
    """Write a commented example case to start from; a file that exists is never replaced.

    Examples:

    - `dilatedem init` (the paper's case: pile.toml)
    - `dilatedem init small` (a run of seconds)
    - `dilatedem init jacket --out my_jacket.toml`
    """
    from dilatedem.examples import title, write

    case = write(name, out)[0]
    say(f"{case}: {title(name)}\ndilatedem check {case} says what to expect, dilatedem run {case} simulates it")
