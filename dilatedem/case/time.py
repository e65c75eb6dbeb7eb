"""How long a case takes, and in which steps: the table `[time]` of a case file."""

from typing import Annotated, Literal

from pydantic import Field

from dilatedem.case.until import Until
from dilatedem.keys import Fault, Positive, Table, key


class Time(Table):
    """How long, and in which steps."""

    duration: Positive = key(100.0, "s", "Simulated time.")
    step: Literal["auto"] | Positive = key(
        "auto",
        "s",
        "Time step, or `auto` for `step_fraction` of the critical one.",
        allowed='must be "auto" or a number greater than 0',
    )
    step_fraction: Annotated[float, Field(gt=0, lt=1)] = key(0.1, "", "The automatic step as a share of the critical step.")
    error_check: bool = key(
        False, "", "`true` replays the highest hit of a run with half the step, once it is done, for the error in that one hit."
    )
    until: Until = key(Until(), "", "What ends the run before, see `[time.until]`.")
    mode: Literal["dynamic", "relax"] = key(
        "dynamic", "",
        "`dynamic`: what happens in this time; `relax`: the way to rest, on which everything is stopped whenever it has been "
        "fastest, within `duration` at most.",
    )  # fmt: skip
    residual: Annotated[float, Field(gt=0, lt=1)] = key(
        1e-4, "", "What a case that relaxes may have out of balance at rest, as a share of the largest load on a body."
    )

    @property
    def relaxes(self) -> bool:
        """Whether it is rest that is asked for."""
        return self.mode == "relax"

    def faults(self) -> list[Fault]:
        if self.step != "auto" and self.step > self.duration:
            return [(("step",), f"must be at most time.duration, {self.duration:g} s")]
        return []
