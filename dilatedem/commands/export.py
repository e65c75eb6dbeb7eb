"""dilatedem export: loads of a run for the next program."""

from pathlib import Path
from typing import Annotated

import typer

from dilatedem.commands.manners import known_faults, say


@known_faults
def export(
    run: Annotated[Path, typer.Argument(metavar="RUN_DIR", help="Folder of a run.")],
    structures: Annotated[
        list[str] | None,
        typer.Option("--structure", metavar="NAME", help="As in forces.csv, total too; again for more. All unless given."),
    ] = None,
    step: Annotated[
        float | None, typer.Option(metavar="SECONDS", help="Between two samples; output.force_interval unless given.")
    ] = None,
    keep: Annotated[
        str, typer.Option(metavar="WHAT", help="impulse, peaks, or both as far as they go together: impulse in any case.")
    ] = "both",
    formats: Annotated[
        list[str] | None,
        typer.Option("--format", metavar="FORMAT", help="csv, openfast or abaqus; again for more. All unless given."),
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Folder to write to; RUN_DIR/export unless given.")
    ] = None,
) -> None:
    """Write load histories at a uniform step, with impulse and peaks kept, and loads by height, for other programs.

    Examples:

    - `dilatedem export runs/pile`
    - `dilatedem export runs/legs --structure total --step 0.05 --format abaqus`
    """
    from dilatedem.errors import SimulationStopped
    from dilatedem.export.folder import export as write
    from dilatedem.files.faults import told_as

    with told_as(SimulationStopped):
        written = write(run, structures=structures or (), step=step, keep=keep, formats=formats or (), out=out)
    for sentence in dict.fromkeys(sentence for _, sentence in written):
        say(sentence)
    for path, _ in written:
        say(path)
