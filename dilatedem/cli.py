"""The command line: reads what the user typed, calls the package, turns known faults into one message.

Whatever a command needs is imported when it runs, so that `--help` answers at once.
"""

import functools
import sys
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any

import typer

from dilatedem import __version__
from dilatedem.endings import ending
from dilatedem.errors import WRONG, CaseError, printable
from dilatedem.garbage import seldom_collected
from dilatedem.processes import interrupts, lifeline

app = typer.Typer(
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


def known_faults(command: Callable) -> Callable:
    """Ends a command on a known fault: its message on standard error, its exit code, no traceback."""

    @functools.wraps(command)
    def wrapped(*args: Any, **kwargs: Any) -> None:
        try:
            command(*args, **kwargs)
        except (Exception, KeyboardInterrupt) as error:
            known = ending(error, can_resume=command.__name__ == "run")
            if not known:
                raise
            _end(*known)

    return wrapped


def _flag(*names: str, **options: Any) -> Any:
    # Without an empty metavar the help shows a switch as if it took a value.
    return typer.Option(*names, metavar="", **options)


def _version(asked: bool) -> None:
    if asked:
        print(f"dilatedem {__version__}")
        raise typer.Exit


@app.callback()
def dilatedem(
    version: Annotated[
        bool, _flag("--version", help="Print the version and end.", is_eager=True, callback=_version)
    ] = False,
) -> None:
    """Broken sea ice against offshore structures: discrete elements of dilated polyhedra.

    Start with `dilatedem run cases/pile.toml`, then `dilatedem post runs/pile`.
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
    resume: Annotated[bool, _flag("--resume", help="Go on from the state that DIR holds.")] = False,
    overwrite: Annotated[bool, _flag("--overwrite", help="Replace the run that DIR holds.")] = False,
    quiet: Annotated[bool, _flag("--quiet", "-q", help="Print nothing but faults.")] = False,
) -> None:
    """Simulate a case and write its run folder.

    Examples:

    - `dilatedem run cases/pile.toml`
    - `dilatedem run cases/pile.toml --set water.velocity=[0.5,0] --out runs/fast`
    - `dilatedem run cases/pile.toml --resume`
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
        _say(_headline(folder))


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
    _print_pairs(generate_field(load(case, overrides or ()), folder))
    _say(f"field.vtu, field.png and field.json are in {folder}")


@app.command()
@known_faults
def check(case: CaseArgument, overrides: SetOption = None) -> None:
    """Validate a case and print what follows from it: floes, mass, time step, size of the output.

    Example: `dilatedem check cases/pile.toml --set field.floe_size=1.5`
    """
    from dilatedem.case.load import load

    loaded = load(case, overrides or ())
    from dilatedem.run import foretell  # after the case: a wrong key is answered without loading the kernels

    facts = dict(foretell.check(loaded))
    for warning in facts.pop("warnings", ()):
        print(printable(f"warning: {warning}"), file=sys.stderr)
    _print_pairs(facts)


@app.command()
@known_faults
def post(
    runs: RunsArgument,
    start: Annotated[
        str | None,
        typer.Option("--from", metavar="DRIFT", help="Of sweeps: from this drift of the ice on, as 5m, or this time, as 10s."),
    ] = None,
    end: Annotated[
        str | None, typer.Option("--to", metavar="DRIFT", help="Of sweeps: up to this drift of the ice, or this time.")
    ] = None,
    threshold: Annotated[
        float | None, typer.Option(min=0.0, metavar="N", help="Of sweeps: least horizontal force (N) of a hit.")
    ] = None,
    gap: Annotated[
        float | None, typer.Option(min=0.0, metavar="S", help="Of sweeps: seconds below it between two hits.")
    ] = None,
) -> None:
    """Make figures, statistics and report.html from the files of runs or sweeps, and nothing else.

    Examples:

    - `dilatedem post runs/pile`
    - `dilatedem post runs/pile-sweep`
    - `dilatedem post runs/pile-sweep --from 5m --to 30m --threshold 2e4`
    """
    from dilatedem.post import post as make_figures
    from dilatedem.results.doubts import doubts
    from dilatedem.results.files import read_summary

    for path in make_figures(list(runs), start=start, end=end, threshold=threshold, gap=gap):
        if path.name == "report.html":
            _say("\n".join([str(path), *_cautions(doubts(read_summary(path.with_name("summary.json"))))]))


@app.command()
@known_faults
def info(run_dir: Annotated[Path, typer.Argument(metavar="RUN_DIR", help="Folder of a run.")]) -> None:
    """Say what a run is, how far it got, and its headline loads.

    Example: `dilatedem info runs/pile`
    """
    from dilatedem.post import info as describe

    _require_run(run_dir)
    _say(describe(run_dir))


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
        str | None, typer.Option(metavar="ADDRESS", help="Run on a cluster (not available yet).")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="DIR", help="Folder of the sweep; runs/NAME-sweep for NAME.toml unless given."
        ),
    ] = None,
    overrides: SetOption = None,
    resume: Annotated[
        bool, _flag("--resume", help="Skip finished runs, go on with the others.")
    ] = False,
) -> None:
    """Run a grid of cases, each in its own folder, and gather their loads in sweep.csv.

    Examples:

    - `dilatedem sweep cases/pile.toml --vary water.velocity.0=0.1:1.0:0.1 --seeds 5`
    - `dilatedem sweep cases/pile.toml --vary water.velocity=[0.3,0],[0.3,0.1]`
    - `dilatedem sweep cases/pile.toml --vary field.floe_size=1.8,2.8 --vary contact.friction=0:0.3:0.1`
    """
    from dilatedem.sweep import sweep as run_grid

    folder = out or Path(f"{_default_out(case)}-sweep")
    table = run_grid(
        case, vary=vary or (), seeds=seeds, jobs=jobs, scheduler=scheduler, out=folder, resume=resume,
        overrides=overrides or (),
    )
    _say(f"{table}: all cases completed; dilatedem post {folder} draws them")


@app.command()
@known_faults
def schema() -> None:
    """Print the JSON Schema of the case file, for editors and other programs."""
    import json

    from dilatedem.case.schema import json_schema

    print(json.dumps(json_schema(), indent=2))


def main() -> None:
    """Entry point of the `dilatedem` command."""
    for number, argument in enumerate(sys.argv[1:], start=1):
        if fault := _unusable(argument):
            print(f"argument {number}, {printable(argument[:60])}: {fault}", file=sys.stderr)
            sys.exit(WRONG)
    lifeline.watch()
    with interrupts.heard_once(), seldom_collected():
        app()


def _unusable(argument: str) -> str:
    """Why no command can take an argument, empty where one may: names of files and values are text, and end up in files of text."""
    if any("\ud800" <= character <= "\udfff" for character in argument):
        return "is not UTF-8 text; rename the file or write the value in UTF-8"
    if printable(argument, keep="\n\t") != argument:
        return "holds a control character; leave it out"
    return ""


def _say(text: object) -> None:
    print(printable(str(text), keep="\n"))


def _end(message: str, code: int) -> None:
    interrupts.program_ends()
    with suppress(OSError):  # the terminal may be gone
        print(printable(message, keep="\n"), file=sys.stderr)
    raise typer.Exit(code) from None


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
    return "\n".join(["; ".join([start, *peaks]), *_cautions(doubts(summary))])


def _cautions(doubts: Iterable[str]) -> list[str]:
    return [f"caution: {doubt}" for doubt in doubts]


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


def _print_pairs(pairs: Mapping[str, Any] | Iterable[tuple[str, Any]]) -> None:
    """Labels and values in two columns; nested tables are written with dotted labels."""
    rows = list(_flat(dict(pairs)))
    width = max((len(label) for label, _ in rows), default=0)
    for label, value in rows:
        _say(f"{label:<{width}}  {f'{value:.6g}' if isinstance(value, float) else value}")


def _flat(table: Mapping[str, Any], before: str = "") -> Iterable[tuple[str, Any]]:
    for label, value in table.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{before}{label}.")
        else:
            yield f"{before}{label}", value


if __name__ == "__main__":
    main()
