"""view.py of a run: its figures, and then scene.py as it stands."""

from __future__ import annotations

from pathlib import Path
from pprint import pformat

from dilatedem import __version__
from dilatedem.errors import CaseError
from dilatedem.files.atomic import write_text
from dilatedem.results.files import list_snapshots, read_case

SCRIPT = "view.py"
#: in the first line of each: what has it may be replaced
MARK = "written by dilatedem paraview"
#: of structures, those that are there are shown
STRUCTURES = ("structures.vtu", "structures.pvd")


def write_script(run: Path, *, contacts: bool = False, movie: bool = False) -> Path:
    """Write view.py into the folder of a run; returns it.

    contacts: with arrows for contact forces; movie: a film, too, when ParaView runs it without a window.
    Raises CaseError for a folder without a run or without snapshots, and for a view.py that something else wrote.
    """
    case, path = read_case(run), run / SCRIPT
    if not list_snapshots(run, case) or not (run / "ice.pvd").is_file():
        raise CaseError(f"{run}: this run has no snapshots to show; run it with output.snapshot_interval above 0")
    if path.is_symlink() or (path.exists() and not (path.is_file() and MARK.encode() in path.read_bytes()[:400])):
        raise CaseError(f"{path}: stands in the way: it was not written by dilatedem; move it away")
    write_text(path, text_of(run, case, contacts=contacts, movie=movie))
    return path


def text_of(run: Path, case: dict, *, contacts: bool, movie: bool) -> str:
    """The script: it finds the run beside itself, wherever both are moved to, or where the run was, in ParaView's own shell."""
    figures = {
        "title": str(case.get("title") or run.resolve().name),
        "size": [float(side) for side in case.get("domain", {}).get("size", (50.0, 50.0))],
        "thickness": float(case.get("ice", {}).get("thickness", 0.5)),
        "structure_files": [name for name in STRUCTURES if (run / name).is_file()],
    }
    scene = Path(__file__).with_name("scene.py").read_text(encoding="utf-8")
    imports, _, functions = scene.partition('"""\n')[2].partition("\nWHITE")
    return f'''"""A run in ParaView, {MARK} {__version__}.

In its window: View > Python Shell > Run Script, or `paraview --script=view.py`. Without one: `pvbatch view.py --help`.
"""
{imports}
#: of the run
RUN = {pformat(figures, sort_dicts=False)}
CONTACTS, MOVIE = {contacts}, {movie}

WHITE{functions}

FOLDER = os.path.dirname(os.path.abspath(__file__)) if "__file__" in globals() else {str(run.resolve())!r}
main(RUN, FOLDER, CONTACTS, MOVIE)
'''
