"""What ends a run before its time is up."""

from typing import Annotated

from pydantic import Field

from dilatedem.case.domain import Domain
from dilatedem.keys import Fault, Positive, Table, key


class Until(Table):
    """What ends a run before its duration is over, looked at every second: whichever comes first. Nothing does, by default."""

    ice_gone: bool = key(False, "", "`true`: all ice has drifted past every structure, so that none can come to one any more.")
    load_above: Positive | None = key(None, "N", "The horizontal load on some structure has been above this at any step.")
    steady: Annotated[float, Field(gt=0, lt=1)] | None = key(
        None,
        "",
        "The mean loads along the current, of the latter half of the run, are known to this share of themselves (half the width of "
        "their 95 % bands, from the means of ten parts) on all structures, and do not rise or fall within that half.",
    )

    @property
    def asked(self) -> tuple[str, ...]:
        """The conditions that a case has."""
        return tuple(name for name in ("ice_gone", "load_above", "steady") if getattr(self, name))


def until_faults(until: Until, domain: Domain, current: tuple[float, float], structures: int) -> list[Fault]:
    """Conditions that could never be met; current [m/s]: of the water; structures: that the case lists, without planes."""
    found = [
        (("time", "until", name), "needs a structure that is no plane")
        for name in until.asked if not structures
    ]  # fmt: skip
    if until.ice_gone and structures:
        where = ("time", "until", "ice_gone")
        if domain.inflow is not None:
            found.append((where, 'must be false where ice enters without an end (a boundary is "inflow")'))
        elif not any(drift_past(domain, current)):
            found.append((where, "needs a current that carries the ice away, out of a side that is not periodic"))
    return found


def drift_past(domain: Domain, current: tuple[float, float]) -> tuple[float, float]:
    """The current [m/s] along the axes on which ice does not come back."""
    u, v = (0.0 if side == "periodic" else value for side, value in zip(domain.boundaries, current, strict=True))
    return u, v
