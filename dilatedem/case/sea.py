"""Tables of a case that say what floes float in: water, wind, waves."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from dilatedem.keys import MOST_ROWS, Fault, NonNegative, Positive, Table, Vector2, complete, key

#: amplitude over length of the steepest wave that does not break
STEEPEST = 1.0 / 14.0

Moment = Annotated[list[float], Field(min_length=3, max_length=3)]
History = Annotated[list[Moment], Field(min_length=1, max_length=MOST_ROWS)]
Share = Annotated[list[float], Field(min_length=2, max_length=2)]

_FILE = (
    "A table instead, CSV with the columns `time_s, u_m_s, v_m_s`, beside the case file: linear between two rows, before the first "
    "and after the last as there. `velocity` is then what it says at t = 0."
)
_TABLE = "The rows of such a table, `[[time, u, v], ...]`; the program writes those of a file here, so that a run can be repeated."


class Flow(Table):
    """What a steady velocity or a table of time says of water or air."""

    def faults(self) -> list[Fault]:
        if self.velocity_table is None:
            text = "was not read: hand the case to dilatedem as a file or a dictionary, or give its rows as `velocity_table`"
            return [(("velocity_file",), text)] if self.velocity_file is not None else []
        if not _grows(self.velocity_table):
            return [(("velocity_table",), "times must grow from row to row")]
        told = self._at_start()
        if "velocity" in self.model_fields_set and tuple(self.velocity) != told:
            return [(("velocity",), f"must be left out where a table says it, or be what that says at t = 0, {list(told)}")]
        return []

    @model_validator(mode="after")
    def _velocity_at_start(self):
        if self.velocity_table is not None:
            complete(self, "velocity", self._at_start())
        return self

    def _at_start(self) -> tuple[float, float]:
        times, *columns = zip(*self.velocity_table, strict=True)
        return float(np.interp(0.0, times, columns[0])), float(np.interp(0.0, times, columns[1]))

    @property
    def history(self) -> list[list[float]]:
        """Rows of time [s] and velocity [m/s]: one where it is steady."""
        return self.velocity_table or [[0.0, *self.velocity]]

    @property
    def strongest(self) -> tuple[float, float]:
        """The velocity [m/s] of the row that has the highest speed."""
        _, u, v = max(self.history, key=lambda row: row[1] * row[1] + row[2] * row[2])
        return u, v


class Water(Flow):
    """Buoyancy and the drag of a uniform current, on the part of a floe below the surface, z = 0 where there are no waves."""

    enabled: bool = key(True, "", "`false` switches buoyancy, drag and waves off.")
    density: Positive = key(1025.0, "kg/m3", "Density of the sea water.")
    velocity: Vector2 = key((0.3, 0.0), "m/s", "Velocity of the current at the surface, along x and y.")
    velocity_file: str | None = key(None, "", _FILE)
    velocity_table: History | None = key(None, "", _TABLE)
    shear: Annotated[list[Share], Field(min_length=1, max_length=MOST_ROWS)] | None = key(
        None, "",
        "The current against depth, `[[depth in m, share of velocity], ...]`: linear between two rows, above the first and below "
        "the last as there. Without it the current is the same at all depths.",
    )
    drag: Literal["wetted", "skin_form"] = key(
        "wetted", "",
        "`wetted`: the paper's, on the wetted surface; `skin_form`: friction along the bottom and pressure on the sides, as "
        "measured for real floes, some six times less.",
    )
    drag_force_coefficient: NonNegative = key(
        0.6, "", "Of `wetted`: coefficient of the drag force, referred to the wetted surface (Liu 2015, Eq. 26)."
    )
    drag_moment_coefficient: NonNegative = key(
        0.1, "", "Of `wetted`: coefficient of the drag moment, referred to the wetted surface (Liu 2015, Eq. 27)."
    )
    skin_coefficient: NonNegative = key(
        0.004, "", "Of `skin_form`: coefficient of the friction along the bottom, referred to its area."
    )
    form_coefficient: NonNegative = key(
        0.8, "",
        "Of `skin_form`: coefficient of the pressure on the sides, referred to the draught times the mean width of the floe, and "
        "under the bottom of a floe that heaves or tilts, referred to its area.",
    )
    added_mass: bool = key(
        False, "", "`true`: floes take water along where they are accelerated, as discs of their plan area and draught do."
    )

    def faults(self) -> list[Fault]:
        found = super().faults()
        if self.shear is not None and not _grows(self.shear):
            found.append((("shear",), "depths must grow from row to row"))
        elif self.shear is not None and self.shear[0][0] < 0.0:
            found.append((("shear", 0, 0), "must be at least 0: depths count downwards from the surface"))
        return found

    @property
    def varies(self) -> bool:
        """Whether it is more than a steady, uniform current with the paper's drag."""
        return self.drag != "wetted" or self.added_mass or self.shear is not None or self.velocity_table is not None


class Wind(Flow):
    """Wind, on what of a floe stands out of the water. `velocity = [0, 0]` switches it off, unless a table tells another one."""

    velocity: Vector2 = key((0.0, 0.0), "m/s", "Velocity of the wind along x and y, at the height that the coefficients refer to.")
    velocity_file: str | None = key(None, "", _FILE)
    velocity_table: History | None = key(None, "", _TABLE)
    density: Positive = key(1.3, "kg/m3", "Density of the air.")
    skin_coefficient: NonNegative = key(0.002, "", "Coefficient of the drag on the upper face, referred to the plan area.")
    form_coefficient: NonNegative = key(
        0.8, "", "Coefficient of the drag on the sides, referred to the freeboard times the mean width of the floe."
    )


class Wave(Table):
    """A component of the waves, an Airy wave of deep water; several add up. They ride on the current, and floes are short against
    them: each lies in the plane that touches the surface at its centroid.
    """

    amplitude: NonNegative = key(..., "m", "Height of the crests over the still level.")
    period: Positive = key(..., "s", "Period as seen from the water, which moves with the current at the surface.")
    direction: float = key(0.0, "deg", "Where it runs to, counter-clockwise from +x.")
    phase: float = key(0.0, "deg", "At t = 0 and the origin; 0: a crest is there, 90: a level surface that rises.")
    rise: NonNegative | None = key(
        None, "s", "Time over which it grows from nothing, as floes begin at the still level; its period unless given."
    )

    @model_validator(mode="after")
    def _default_rise(self):
        if self.rise is None:
            complete(self, "rise", self.period)
        return self


def wave_faults(waves: list[Wave], water: bool, gravity: float) -> list[Fault]:
    """What is wrong with the waves of a case, on water or none, under gravity [m/s2]."""
    if waves and not water:
        return [(("wave",), "needs water.enabled = true")]
    if waves and gravity == 0.0:
        return [(("wave",), "needs a gravity.acceleration above 0")]
    found: list[Fault] = []
    for number, wave in enumerate(waves):
        highest = STEEPEST * gravity * wave.period * wave.period / (2.0 * np.pi)
        if wave.amplitude > highest:
            text = f"must be at most {highest:.3g} m: waves of that period break at a seventh of their length from trough to crest"
            found.append((("wave", number, "amplitude"), text))
    return found


def _grows(rows: list[list[float]]) -> bool:
    return bool((np.diff([row[0] for row in rows]) > 0.0).all())
