"""hits.csv: a row per separate load event of a structure, once it is over."""

from dilatedem.output import folder
from dilatedem.output.observer import TableObserver
from dilatedem.output.tables import HITS_COLUMNS, Table
from dilatedem.state import hits
from dilatedem.state.hits import ROOM
from dilatedem.state.modes import MODE_NAMES

#: bytes of a row, and rows of a structure in a second, about
ROW, RATE = 130.0, 0.5
#: mean pressures of the leading contact [MPa] of which summary.json says how many events exceed them
PRESSURES = (1, 2, 5)
#: what is above them, over them: ice that crushes bears its pressure but for round-off
ABOVE = 1.0 + 1e-9
MEANING = "shares of the load events whose leading contact has a mean nominal pressure above 1, 2 and 5 MPa at its peak; "
ELASTIC = (
    "sea ice crushes at 1 to 3 MPa, and floes do not crush here (ice.crushing_pressure): peaks above that are those of elastic "
    "ice, which real ice would not bear, and no design loads"
)
CRUSHING = "floes crush here (ice.crushing_pressure), and share_crushed is that of the events whose leading contact did"


class Hits(TableObserver):
    """Kernels tell the events; here they are put into words, many at once."""

    name, file, columns = "hits", folder.HITS, HITS_COLUMNS

    @classmethod
    def size(cls, case, floes: int, structures: int) -> float:
        return ROW * RATE * structures * case.time.duration

    def open(self, kept: dict | None, since: int) -> None:
        super().open(kept, since)
        watched = len(self.simulation.state.hits.recent)
        self.names = [record.name for record in self.simulation.scene.records[:watched]]
        self.told: dict[str, dict] = kept["told"] if kept else {name: _nothing() for name in self.names}
        self._rows: list[tuple] = []

    def next_due(self, step: int) -> int:
        """Before more events can end on a structure than have room."""
        span = self.simulation.span
        return step + max(span, (ROOM - 2) * self.simulation.log.gap // span * span)

    def look(self, step: int, last: bool) -> None:
        log = self.simulation.log
        waiting = int(log.waiting[0])
        for counts, figures in zip(log.counts[:waiting].tolist(), log.figures[:waiting].tolist(), strict=True):
            self._rows.append(_row(counts, figures, self.names, self.simulation.dt))
            _tell(self.told[self.names[counts[hits.STRUCTURE]]], figures)
        log.waiting[0] = 0

    def refresh(self) -> None:
        rows, self._rows = self._rows, []

        def append(table: Table) -> None:
            table.append(rows)

        self.put(append if rows else None)

    def kept(self) -> dict:
        return {"told": {name: dict(told) for name, told in self.told.items()}}

    def summary(self) -> dict:
        log, case = self.simulation.log, self.simulation.case
        meaning = MEANING + (CRUSHING if case.laws["crushing"] else ELASTIC)
        return {
            "hits": {
                "threshold_N": log.threshold, "gap_s": case.output.hit_gap, "meaning": meaning,
                "structures": {name: _headline(told) for name, told in self.told.items()},
            }
        }  # fmt: skip


def _nothing() -> dict:
    """No event yet."""
    above = {f"above_{pressure}_MPa": 0 for pressure in PRESSURES}
    return {"count": 0, "highest_N": 0.0, "highest_pressure_Pa": 0.0, "crushed": 0} | above


def _tell(told: dict, figures: list[float]) -> None:
    """Bring an event into what is told of its structure."""
    told["count"] += 1
    told["highest_N"] = max(told["highest_N"], figures[hits.PEAK])
    told["highest_pressure_Pa"] = max(told["highest_pressure_Pa"], figures[hits.PRESSURE])
    told["crushed"] += figures[hits.CRUSHED] > 0.0
    for pressure in PRESSURES:
        told[f"above_{pressure}_MPa"] += figures[hits.PRESSURE] > ABOVE * 1e6 * pressure


def _headline(told: dict) -> dict:
    """What summary.json says of the events on a structure; shares of none are unknown."""
    shares = {
        f"share_above_{pressure}_MPa": told[f"above_{pressure}_MPa"] / told["count"] if told["count"] else None
        for pressure in PRESSURES
    }
    shares["share_crushed"] = told["crushed"] / told["count"] if told["count"] else None
    return {name: told[name] for name in ("count", "highest_N", "highest_pressure_Pa")} | shares


def _row(counts: list[int], figures: list[float], names: list[str], dt: float) -> tuple:
    """An event as a row of hits.csv; dt: time step [s]."""
    start, last, peak = (counts[which] * dt for which in (hits.START, hits.LAST, hits.PEAK_STEP))
    return (
        names[counts[hits.STRUCTURE]], start, peak - start, last - start, figures[hits.PEAK], peak, figures[hits.IMPULSE],
        counts[hits.BODY], MODE_NAMES[counts[hits.MODE]], figures[hits.AREA], figures[hits.PRESSURE], figures[hits.CRUSHED],
        counts[hits.BODIES],
    )  # fmt: skip
