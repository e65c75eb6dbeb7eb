"""dilatedem paraview: a run in ParaView."""

from pathlib import Path
from typing import Annotated

import typer

from dilatedem.commands.manners import known_faults, say


@known_faults
def paraview(
    run: Annotated[Path, typer.Argument(metavar="RUN_DIR", help="Folder of a run.")],
    movie: Annotated[bool, typer.Option("--movie", help="Let pvbatch make a film, too.")] = False,
    contacts: Annotated[bool, typer.Option("--contacts", help="With contact forces as arrows.")] = False,
) -> None:
    """Write view.py, which shows a run in ParaView: floes by speed, structures, water level, domain, time.

    Examples:

    - `dilatedem paraview runs/pile` then `paraview --script=runs/pile/view.py`
    - `dilatedem paraview runs/pile --movie` then `pvbatch runs/pile/view.py`
    """
    from dilatedem.errors import SimulationStopped
    from dilatedem.files.faults import told_as
    from dilatedem.paraview.script import write_script

    with told_as(SimulationStopped):
        path = write_script(run, contacts=contacts, movie=movie)
    made = "view.png and view.avi" if movie else "view.png"
    say(f"{path}: paraview --script={path} shows the run; pvbatch {path} writes {made} beside it")
