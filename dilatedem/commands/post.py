"""dilatedem post: figures, statistics and reports of runs and sweeps."""

from pathlib import Path
from typing import Annotated

import typer

from dilatedem.commands.manners import cautions, known_faults, say


@known_faults
def post(
    runs: Annotated[list[Path], typer.Argument(metavar="RUN_DIR...", help="Folders of runs or sweeps.")],
    formats: Annotated[
        list[str] | None,
        typer.Option("--format", metavar="KIND", help="Of figures: png, svg, pdf; again for more. png and svg unless given."),
    ] = None,
    show: Annotated[bool, typer.Option("--open", help="Open each report in the browser.")] = False,
    start: Annotated[
        str | None,
        typer.Option("--from", metavar="DRIFT", help="Of sweeps and blocks: from this drift of the ice on, as 5m, or time, 10s."),
    ] = None,
    end: Annotated[
        str | None, typer.Option("--to", metavar="DRIFT", help="Of sweeps and blocks: up to this drift of the ice, or this time.")
    ] = None,
    threshold: Annotated[
        float | None, typer.Option(min=0.0, metavar="N", help="Of sweeps and blocks: least horizontal force (N) of a hit.")
    ] = None,
    gap: Annotated[
        float | None, typer.Option(min=0.0, metavar="S", help="Of sweeps and blocks: seconds below it between two hits.")
    ] = None,
    block: Annotated[
        str | None,
        typer.Option("--block", metavar="LENGTH", help="Cut long runs into blocks of a time, as 600s, or a drift, as 180m."),
    ] = None,
    project: Annotated[str, typer.Option(metavar="TEXT", help="Project, for the front page of reports.")] = "",
    document: Annotated[str, typer.Option(metavar="TEXT", help="Number and revision of the document.")] = "",
    prepared_by: Annotated[str, typer.Option(metavar="NAME", help="Who made it; a line to fill in unless given.")] = "",
    checked_by: Annotated[str, typer.Option(metavar="NAME", help="Who checked it.")] = "",
    approved_by: Annotated[str, typer.Option(metavar="NAME", help="Who approved it.")] = "",
) -> None:
    """Make figures, statistics and report.html from the files of runs or sweeps, and nothing else.

    Examples:

    - `dilatedem post runs/pile`
    - `dilatedem post runs/pile --format pdf --open`
    - `dilatedem post runs/pile --project "Harbour light" --prepared-by "A. Maker" --checked-by "C. Reader"`
    - `dilatedem post runs/pile-sweep --from 5m --to 30m --threshold 2e4`
    - `dilatedem post runs/hour --from 60s --block 120s`
    """
    from dilatedem.commands.figures import opened, written_as
    from dilatedem.post import post as make_figures
    from dilatedem.results.doubts import doubts
    from dilatedem.results.files import read_summary

    part = {"start": start, "end": end, "threshold": threshold, "gap": gap, "block": block}
    signed = {
        "project": project, "document": document, "prepared_by": prepared_by, "checked_by": checked_by, "approved_by": approved_by,
    }  # fmt: skip
    with written_as(formats):
        written = make_figures(list(runs), **part, **signed)
    for path in written:
        if path.name == "report.html":
            if show:
                opened(path)
            say("\n".join([str(path), *cautions(doubts(read_summary(path.with_name("summary.json"))))]))
