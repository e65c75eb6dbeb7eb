"""Which snapshots of a run its pictures show."""

from __future__ import annotations

from dilatedem.post.read import RunFolder
from dilatedem.results.snapshots import Snapshot, nearest_snapshot
from dilatedem.results.whole import whole_snapshot


def snapshots_at(run: RunFolder, fractions: tuple[float, ...]) -> list[Snapshot]:
    """The readable snapshots nearest to these fractions of the snapshots' time span, in order, none twice."""
    if not run.snapshots:
        return []
    first, last = run.snapshots[0][0], run.snapshots[-1][0]
    chosen: dict[float, Snapshot] = {}
    for fraction in fractions:
        try:
            snapshot = whole_snapshot(nearest_snapshot(run.snapshots, first + fraction * (last - first)), run.floes)
        except OSError:
            return []  # all of them were cut short
        chosen[snapshot.time] = snapshot
    return [chosen[time] for time in sorted(chosen)]
