"""What the files of a run say: statistics, figures and a report, from run folders and sweep folders alone.

Nothing here knows the simulation: whatever is shown was read from the files that a run leaves behind, so
that a run of another machine, or one that was killed half way, is treated like any other.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

__all__ = ["info", "post"]


def post(
    run_dirs: Sequence[Path], *, start: str | None = None, end: str | None = None, threshold: float | None = None,
    gap: float | None = None, block: str | None = None, **signed: str,
) -> list[Path]:  # fmt: skip
    """Write figures/, report.html and the load statistics (key `post` of summary.json, statistics.csv of a sweep) of each folder.

    run_dirs: run folders (with a case.toml), sweep folders (with a sweep.csv), or both. Several run folders
        given together are also compared, in a folder `comparison` beside them.
    start, end: of the part of each run that sweeps and comparisons look at: a drift of the ice, as "5m", or a time, as "10s".
    threshold [N], gap [s]: what counts as a hit there.
    block: cuts runs, single ones too, into pieces of a drift, as "180m", or a time, as "600s", which stand for runs then.
    signed: for the front page of reports of runs: project, document, prepared_by, checked_by, approved_by; lines to be filled in
        by hand unless given.
    Returns the paths written, in the order written. Raises CaseError for a folder that is neither.
    """
    import math

    from dilatedem.errors import CaseError
    from dilatedem.post.ensembles.blocks import read_block
    from dilatedem.post.ensembles.part import read_part
    from dilatedem.post.ensembles.study import Choice
    from dilatedem.post.folders import post_folders  # matplotlib and the report, only when they are wanted
    from dilatedem.post.report.front import Signed

    for option, value in (("--threshold", threshold), ("--gap", gap)):
        if value is not None and not 0.0 <= value < math.inf:
            raise CaseError(f"{option} {value}: must be a number of at least 0")
    choice = Choice(read_part(start, end), threshold, gap, read_block(block))
    return post_folders([Path(folder) for folder in run_dirs], choice, Signed(**signed))


def info(run_dir: Path) -> str:
    """What the run or sweep in this folder is, how far it got, and its headline loads, as plain text."""
    from dilatedem.post.overview import describe

    return describe(Path(run_dir))
