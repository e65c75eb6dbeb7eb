"""The command line: reads what the user typed, calls the package, turns known faults into one message.

Whatever a command needs is imported when it runs, so that `--help` answers at once.
"""

import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated, Any

import typer

from dilatedem import __version__
from dilatedem.commands.export import export
from dilatedem.commands.init import init
from dilatedem.commands.manners import Program, cautions, known_faults, say
from dilatedem.commands.paraview import paraview
from dilatedem.commands.post import post
from dilatedem.errors import WRONG, CaseError, printable
from dilatedem.garbage import left_at_the_end, seldom_collected
from dilatedem.processes import interrupts

app = Program(
    name="dilatedem",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="markdown",
    context_settings={"help_option_names": ["-h", "--help"]},
)

CaseArgument = Annotated[
    str, typer.Argument(metavar="CASE", help="Case file (TOML), or - for standard input.")
]
SetOption = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Override a key of the case; again for more."),
]
OutOption = Annotated[
    Path | None,
    typer.Option("--out", metavar="DIR", help="Folder to write to; runs/NAME for NAME.toml unless given."),
]
RunsArgument = Annotated[
    list[Path], typer.Argument(metavar="RUN_DIR...", help="Folders of runs or sweeps.")
]


def _version(asked: bool) -> None:
    if asked:
        print(f"dilatedem {__version__}")
        raise typer.Exit


@app.callback()
def dilatedem(
    version: Annotated[
        bool, typer.Option("--version", help="Print the version and end.", is_eager=True, callback=_version)
    ] = False,
) -> None:
    """Broken sea ice against offshore structures: discrete elements of dilated polyhedra.

    Start with `dilatedem init small`, then `dilatedem run small.toml`, then `dilatedem post runs/small`.
    """


@app.command()
@known_faults
def run(
    case: CaseArgument,
    out: OutOption = None,
    overrides: SetOption = None,
    threads: Annotated[
        int, typer.Option(min=1, metavar="N", help="Threads; the numbers do not depend on it.")
    ] = 1,
    resume: Annotated[bool, typer.Option("--resume", help="Go on from the state that DIR holds.")] = False,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace the run that DIR holds.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print nothing but faults.")] = False,
) -> None:
    """Simulate a case and write its run folder.

    Examples:

    - `dilatedem run cases/pile.toml`
    - `dilatedem run cases/pile.toml --set water.velocity=[0.5,0] --out runs/fast`
    - `dilatedem run cases/pile.toml` again goes on where it was cut short, or has nothing to do
    - `dilatedem run runs/pile/case.toml --out runs/again` (repeats a run)
    """
    from dilatedem.case.load import load

    if resume and overwrite:
        raise CaseError("give either --resume or --overwrite, not both")
    folder = out or _default_out(case)
    loaded = load(case, overrides or ())
    from dilatedem.run import loop  # after the case: a wrong key is answered without loading the kernels

    loop.run(loaded, folder, threads=threads, resume=resume, overwrite=overwrite, quiet=quiet)
    if not quiet:
        say(_headline(folder))


@app.command()
@known_faults
def generate(case: CaseArgument, out: OutOption = None, overrides: SetOption = None) -> None:
    """Build the ice field only: field.vtu, field.png and field.json.

    Examples:

    - `dilatedem generate cases/pile.toml`
    - `dilatedem generate cases/pile.toml --set field.seed=2 --out runs/field2`
    """
    from dilatedem.case.load import load
    from dilatedem.generate import generate as generate_field

    folder = out or _default_out(case)
    _print_facts(generate_field(load(case, overrides or ()), folder))
    say(f"field.vtu, field.png and field.json are in {folder}")


@app.command()
@known_faults
def check(
    case: CaseArgument,
    overrides: SetOption = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print it as JSON, for other programs.")] = False,
) -> None:
    """Validate a case and print what follows from it: floes, time step, wall time, memory, disk, ice at structures.

    Examples:

    - `dilatedem check cases/pile.toml --set field.floe_size=1.5`
    - `dilatedem check cases/pile.toml --json`
    """
    from dilatedem.case.load import load

    loaded = load(case, overrides or ())
    from dilatedem.run import foretell  # after the case: a wrong key is answered without loading the kernels

    facts = dict(foretell.check(loaded, trial_s=foretell.TRIAL_S))
    if as_json:
        import json

        say(json.dumps(foretell.as_json(facts), indent=2, ensure_ascii=False))
        return
    facts = foretell.told(facts)
    for warning in facts.pop("warnings", ()):
        print(printable(f"warning: {warning}"), file=sys.stderr)
    _print_facts(facts)


@app.command()
@known_faults
def info(run_dir: Annotated[Path, typer.Argument(metavar="RUN_DIR", help="Folder of a run.")]) -> None:
    """Say what a run is, how far it got, and its headline loads.

    Example: `dilatedem info runs/pile`
    """
    from dilatedem.post import info as describe

    _require_run(run_dir)
    say(describe(run_dir))


@app.command()
@known_faults
def sweep(
    case: CaseArgument,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KEY=VALUES", help="V1,V2,.. or START:STOP:STEP with STOP included; again for a grid."
        ),
    ] = None,
    seeds: Annotated[
        int | None, typer.Option(min=1, metavar="N", help="Run each point with N seeds, from the case's on.")
    ] = None,
    jobs: Annotated[
        int | None, typer.Option(min=1, metavar="N", help="Cases at a time, one a core unless given.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Run on a Dask cluster, as in tcp://host:8786.")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="DIR", help="Folder of the sweep; runs/NAME-sweep for NAME.toml unless given."
        ),
    ] = None,
    overrides: SetOption = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with a sweep of other cases, too.")
    ] = False,
    check_all: Annotated[
        bool, typer.Option("--check-all", help="Try the ice fields of all cases first, however long that takes.")
    ] = False,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Say how many cases, floes, wall time and disk it takes; run nothing.")
    ] = False,
) -> None:
    """Run a grid of cases, each in its own folder, and gather their loads in sweep.csv.

    Examples:

    - `dilatedem sweep cases/pile.toml --vary water.velocity.0=0.1:1.0:0.1 --seeds 5`
    - `dilatedem sweep cases/pile.toml --vary water.velocity=[0.3,0],[0.3,0.1]`
    - `dilatedem sweep cases/pile.toml --vary field.floe_size=1.8,2.8 --vary contact.friction=0:0.3:0.1`
    - `dilatedem sweep cases/pile.toml --seeds 100 --dry-run`

    The same command again goes on, or has nothing to do.
    """
    folder = out or Path(f"{_default_out(case)}-sweep")
    asked = {"vary": vary or (), "seeds": seeds, "jobs": jobs, "scheduler": scheduler, "out": folder, "resume": resume}
    asked |= {"check_all": check_all, "overrides": overrides or ()}
    if dry_run:
        from dilatedem.sweeps.foretell import foretell

        _print_pairs(foretell(case, **asked))
        return
    from dilatedem.sweeps.sweep import sweep as run_grid

    table = run_grid(case, **asked)
    say(f"{table}: all cases completed; dilatedem post {folder} draws them")


@app.command()
@known_faults
def schema() -> None:
    """Print the JSON Schema of the case file, for editors and other programs."""
    import json

    from dilatedem.case.schema import json_schema

    print(json.dumps(json_schema(), indent=2))


app.command()(post)
app.command()(init)
app.command()(export)
app.command()(paraview)


def main() -> None:
    """Entry point of the `dilatedem` command."""
    for number, argument in enumerate(sys.argv[1:], start=1):
        if fault := _unusable(argument):
            print(f"argument {number}, {printable(argument[:60])}: {fault}", file=sys.stderr)
            sys.exit(WRONG)
    left_at_the_end()
    with interrupts.heard_once(), seldom_collected():
        app()


def _unusable(argument: str) -> str:
    """Why no command can take an argument, empty where one may: names of files and values are text, and end up in files of text."""
    if any("\ud800" <= character <= "\udfff" for character in argument):
        return "is not UTF-8 text; rename the file or write the value in UTF-8"
    if printable(argument, keep="\n\t") != argument:
        return "holds a control character; leave it out"
    return ""


def _default_out(case: str) -> Path:
    return Path("runs", "case" if case == "-" else Path(case).stem)


def _require_run(folder: Path) -> None:
    if not any((folder / name).exists() for name in ("summary.json", "case.toml", "sweep.csv")):
        raise CaseError(f"{folder}: {'holds no run' if folder.is_dir() else 'no such folder'}")


def _headline(folder: Path) -> str:
    """How a run ends: where its files are, the peak load on each structure, the time it took; a line for each thing to doubt."""
    import json

    from dilatedem.results.doubts import doubts

    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    peaks = [_peak_words(name, load) for name, load in summary["loads"].items()]
    start = f"{folder}: {summary['simulated_s']:g} s simulated in {_clock(summary['wall_s'])}"
    return "\n".join(["; ".join([start, *peaks]), *cautions(doubts(summary))])


def _peak_words(name: str, load: Mapping[str, Any]) -> str:
    if load["fh_max_N"] > 0.0:
        return f"peak load on {name} {load['fh_max_N'] / 1e3:.1f} kN at {load['fh_max_time_s']:.2f} s"
    return f"no horizontal load on {name}" if load.get("touched") else f"no ice touched {name}"


def _clock(seconds: float) -> str:
    if seconds < 59.95:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min" if hours else f"{minutes} min {rest} s"


def _print_facts(facts: dict[str, Any]) -> None:
    """What follows from a case, in two columns; then, in sentences, what was changed in outlines of a file."""
    from dilatedem.field.survey import sentences

    _print_pairs({label: fact for label, fact in facts.items() if label != "file"})
    if file := facts.get("file"):
        for sentence in sentences(file):
            say(f"{Path(file['path']).name}: {sentence}")


def _print_pairs(pairs: Mapping[str, Any] | Iterable[tuple[str, Any]]) -> None:
    """Labels and values in two columns; nested tables are written with dotted labels."""
    rows = list(_flat(dict(pairs)))
    width = max((len(label) for label, _ in rows), default=0)
    for label, value in rows:
        say(f"{label:<{width}}  {f'{value:.6g}' if isinstance(value, float) else value}")


def _flat(table: Mapping[str, Any], before: str = "") -> Iterable[tuple[str, Any]]:
    for label, value in table.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{before}{label}.")
        elif value is not None:
            yield f"{before}{label}", value


if __name__ == "__main__":
    main()
