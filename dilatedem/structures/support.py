"""What carries a structure, whatever its shape: it is held fast, driven as a table of time says, or stands on springs or on a beam.

A support answers two questions: its keys in a case file (the fields of its table, `faults`), and how a structure moves on it
(`carriage`). A new one is a class here, its name in `SUPPORTS`, and, where neither a table of time nor masses and springs along x,
along y and about z say what it does, its share of `motion.carry`. What `dilatedem check` says of it: `remarks`.
"""

from abc import abstractmethod
from dataclasses import dataclass, field
from typing import Annotated, Any, Literal, Union

import numpy as np
from pydantic import Field, model_validator

from dilatedem.keys import MOST_ROWS, Fault, NonNegative, Positive, Size2, Stiffness2, Table, Vector2, complete, key
from dilatedem.numerics.plain import dot
from dilatedem.state.supports import Carried
from dilatedem.structures.beam import Beam, Modes, beam_modes

#: of the critical damping, where a case does not say
DAMPING_RATIO = 0.02
#: modes of a beam, where a case does not say, and at most
MODES, MOST_MODES = 3, 20
#: columns of a file of motion
MOTION_COLUMNS = ("time_s", "x_m", "y_m", "yaw_rad")

Row = Annotated[list[float], Field(min_length=4, max_length=4)]


@dataclass(frozen=True, eq=False)
class Carriage:
    """How a structure moves along x, along y and about z.

    SPRUNG: inverse_mass, stiffness, damping (3,) as in `state.supports.Supports`, an inverse mass of 0 where it does not give way.
    DRIVEN: times (k,) [s] and, in rows, displacement and slope (k, 3); cubic between two rows, beyond the last as fast as there.
    MODAL: modes along x and along y, their damping_ratio, and push_height [m] above the foot, where ice pushes; the first three are
    those of an oscillator that bounds all modes together.
    """

    kind: Carried
    inverse_mass: np.ndarray = field(default_factory=lambda: np.zeros(3))
    stiffness: np.ndarray = field(default_factory=lambda: np.zeros(3))
    damping: np.ndarray = field(default_factory=lambda: np.zeros(3))
    times: np.ndarray = field(default_factory=lambda: np.zeros(0))
    displacement: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    slope: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    modes: tuple[Modes, ...] = ()
    damping_ratio: float = 0.0
    push_height: float = 0.0

    def at(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Displacement and its rate (n, 3) at times (n,) [s] of one that is driven; zero of all others."""
        time = np.asarray(time, float)
        if not len(self.times):
            return np.zeros((len(time), 3)), np.zeros((len(time), 3))
        held = np.clip(time, self.times[0], self.times[-1])
        low = np.clip(np.searchsorted(self.times, held, side="right") - 1, 0, max(len(self.times) - 2, 0))
        high = np.minimum(low + 1, len(self.times) - 1)
        h = np.where(high > low, self.times[high] - self.times[low], 1.0)[:, None]
        x = (held - self.times[low])[:, None] / h
        rise = self.displacement[high] - self.displacement[low]
        begin, end = h * self.slope[low] - rise, h * self.slope[high] - rise
        place = self.displacement[low] + x * rise + x * (1.0 - x) * ((1.0 - x) * begin - x * end)
        rate = (rise + (1.0 - x) * (1.0 - 3.0 * x) * begin - x * (2.0 - 3.0 * x) * end) / h
        rate = np.where(high[:, None] > low[:, None], rate, self.slope[low])
        return place + rate * (time - held)[:, None], rate


class Support(Table):
    """The table `support` of a structure."""

    @abstractmethod
    def carriage(self) -> Carriage:
        """How the structure moves."""

    def remarks(self, dt: float) -> dict[str, str]:
        """What `dilatedem check` says of it, by what that is about; dt: time step [s]."""
        return {}

    @property
    def moves(self) -> bool:
        return self.carriage().kind != Carried.HELD


class Held(Support):
    """Held fast: the structure never moves."""

    kind: Literal["held"] = key(..., "", "The structure is held where it is, whatever pushes it.")

    def carriage(self) -> Carriage:
        return Carriage(Carried.HELD)


class Driven(Support):
    """Driven through the ice as a whole, whatever that takes: a ship, a rig that is pushed. Steady, or as a table of time says."""

    kind: Literal["driven"] = key(..., "", "The structure moves as it is told, whatever pushes it.")
    velocity: Vector2 | None = key(
        None, "m/s", "Velocity along x and y; `[0, 0]` unless given.", allowed="must be a list of 2 numbers"
    )
    turning: float | None = key(None, "rad/s", "Angular velocity about the upright axis through its place; 0 unless given.")
    file: str | None = key(
        None, "",
        "A table instead, CSV with the columns `time_s, x_m, y_m, yaw_rad`, beside the case file: where the structure is, of which "
        "differences alone count; at t = 0 it stands at its place. Smooth between rows, beyond the last as fast as there.",
    )
    table: Annotated[list[Row], Field(min_length=2, max_length=MOST_ROWS)] | None = key(
        None, "", "The rows of that file: written by the program, so that a run can be repeated without it."
    )

    def faults(self) -> list[Fault]:
        told = [name for name in ("velocity", "turning") if getattr(self, name) is not None]
        if (self.file is not None or self.table is not None) and told:
            return [((told[0],), "give either velocity and turning or a table of time, not both")]
        if self.table is not None and (np.diff([row[0] for row in self.table]) <= 0.0).any():
            return [(("table",), "times must grow from row to row")]
        if self.file is not None and self.table is None:
            return [(("file",), "was not read: hand the case to dilatedem as a file or a dictionary, or give its rows as `table`")]
        return []

    @model_validator(mode="after")
    def _default_motion(self):
        if self.table is None:
            complete(self, "velocity", self.velocity or (0.0, 0.0))
            complete(self, "turning", self.turning or 0.0)
        return self

    def carriage(self) -> Carriage:
        if self.table is None:
            slope = np.array([[*self.velocity, self.turning]])
            return Carriage(Carried.DRIVEN, times=np.zeros(1), displacement=np.zeros((1, 3)), slope=slope)
        from scipy.interpolate import PchipInterpolator  # only where there is a table: it loads half of SciPy

        rows = np.array(self.table)
        times, places = rows[:, 0], rows[:, 1:]
        # no overshoot: a structure that stands still between two rows stands still
        slope = PchipInterpolator(times, places)(times, 1)
        told = Carriage(Carried.DRIVEN, times=times, displacement=places, slope=slope)
        return Carriage(Carried.DRIVEN, times=times, displacement=places - told.at(np.zeros(1))[0], slope=slope)


class Sprung(Support):
    """On springs and dashpots, with a mass of its own: a pile that bends, a moored floater. It moves in plan alone."""

    kind: Literal["sprung"] = key(..., "", "The structure gives way on springs.")
    mass: Positive = key(..., "kg", "Mass that moves with it along x and y.")
    stiffness: Stiffness2 = key(..., "N/m", "Of the springs along x and y; 0 lets it move freely.")
    damping_ratio: NonNegative | None = key(
        None, "", f"Damping over the critical one, of each of its motions; {DAMPING_RATIO:g} unless `damping` is given."
    )
    damping: Stiffness2 | None = key(
        None, "N s/m", "Of the dashpots along x and y, instead of a ratio.",
        allowed="must be a list of 2 numbers, each at least 0",
    )
    inertia: Positive | None = key(
        None, "kg m2", "Moment of inertia about the upright axis through its place; without it the structure does not turn."
    )
    stiffness_yaw: NonNegative | None = key(None, "N m/rad", "Of the spring about that axis; 0 lets it turn freely.")
    damping_yaw: NonNegative | None = key(None, "N m s", "Of the dashpot about that axis, beside `damping`; 0 unless given.")

    def faults(self) -> list[Fault]:
        found: list[Fault] = []
        if self.damping is not None and self.damping_ratio is not None:
            found.append((("damping",), "give either damping_ratio or damping, not both"))
        for one, other in (("inertia", "stiffness_yaw"), ("stiffness_yaw", "inertia"), ("damping_yaw", "inertia")):
            if getattr(self, one) is not None and getattr(self, other) is None:
                found.append(((one,), f"needs {other} beside it"))
        if self.damping_yaw is not None and self.damping is None:
            found.append((("damping_yaw",), "needs damping beside it; a damping_ratio counts for turning as well"))
        return found

    @model_validator(mode="after")
    def _default_damping(self):
        if self.damping_ratio is None and self.damping is None:
            complete(self, "damping_ratio", DAMPING_RATIO)
        return self

    def carriage(self) -> Carriage:
        mass = np.array([self.mass, self.mass, self.inertia or np.inf])
        stiffness = np.array([*self.stiffness, self.stiffness_yaw or 0.0])
        if self.damping is not None:
            damping = np.array([*self.damping, self.damping_yaw or 0.0])
        else:
            damping = 2.0 * self.damping_ratio * np.sqrt(stiffness * np.where(stiffness > 0.0, mass, 0.0))
        return Carriage(Carried.SPRUNG, inverse_mass=1.0 / mass, stiffness=stiffness, damping=damping)


class Modal(Support):
    """On an upright beam, uniform from the sea floor to its top, that bends along x and along y in some of its modes: a slender
    pile, or what stands on one. What is above the water goes with the place where the ice pushes and keeps upright."""

    kind: Literal["modal"] = key(..., "", "The structure stands on a beam that vibrates.")
    length: Positive = key(..., "m", "Of the beam, from the sea floor up to the water level.")
    length_above: NonNegative = key(0.0, "m", "And of the same beam above the water, up to its top.")
    mass_per_length: Positive = key(..., "kg/m", "Of the beam with what is in it, and of the water that goes with it.")
    bending_stiffness: Size2 = key(..., "N m2", "Young's modulus times second moment of area, for bending along x and along y.")
    deck_mass: NonNegative = key(0.0, "kg", "Mass on the top of the beam.")
    soil_stiffness: Positive | None = key(None, "N/m", "Of the soil at the foot, sideways; without it the foot cannot shift.")
    soil_stiffness_turning: Positive | None = key(
        None, "N m/rad", "Of the soil against tilting of the foot; without it the foot cannot tilt."
    )
    push_height: float = key(0.0, "m", "Height above the water level at which the ice pushes; negative below it.")
    modes: Annotated[int, Field(ge=1, le=MOST_MODES)] = key(MODES, "", "How many modes along x and as many along y, slowest first.")
    damping_ratio: NonNegative = key(DAMPING_RATIO, "", "Damping of each mode over the critical one.")

    def faults(self) -> list[Fault]:
        if not -self.length < self.push_height <= self.length_above:
            return [(("push_height",), f"must be above -{self.length:g} m, the foot, and up to {self.length_above:g} m, the top")]
        try:
            self.carriage()
        except ValueError as fault:
            soft = "soil_stiffness" if self.soil_stiffness is not None else "soil_stiffness_turning"
            return [((soft,), str(fault))]
        return []

    def beams(self) -> tuple[Beam, ...]:
        """As it bends along x, and along y."""
        height, soil = self.length + self.length_above, (self.soil_stiffness or np.inf, self.soil_stiffness_turning or np.inf)
        return tuple(Beam(height, self.mass_per_length, bends, self.deck_mass, *soil) for bends in self.bending_stiffness)

    def carriage(self) -> Carriage:
        place = self.length + self.push_height
        modes = tuple(beam_modes(beam, self.modes, place) for beam in self.beams())
        give = max(float(dot(each.shape, each.shape)) for each in modes)
        fastest = max(float(each.frequency[-1]) for each in modes)
        level = np.array([1.0, 1.0, 0.0])
        return Carriage(
            Carried.MODAL, give * level, fastest * fastest / give * level, 2.0 * self.damping_ratio * fastest / give * level,
            modes=modes, damping_ratio=self.damping_ratio, push_height=place,
        )  # fmt: skip

    def remarks(self, dt: float) -> dict[str, str]:
        """Natural frequencies beside the time step, and how much of the displacement under a steady load the modes have."""
        found, place = {}, self.length + self.push_height
        for axis, beam, modes in zip("xy", self.beams(), self.carriage().modes, strict=True):
            told = ", ".join(f"{frequency:.4g}" for frequency in (modes.frequency / (2.0 * np.pi)).tolist())
            steps, share = 2.0 * np.pi / (float(modes.frequency[-1]) * dt), modes.flexibility() / beam.flexibility(place)
            found[f"along {axis}"] = (
                f"{told} Hz; {steps:.3g} time steps in a period of the fastest; {100.0 * share:.4g} % of the displacement "
                "under a steady load"
            )
        return found


SUPPORTS: tuple[type[Support], ...] = (Held, Driven, Sprung, Modal)
#: class by what stands under `kind`
BY_NAME: dict[str, type[Support]] = {kind.model_fields["kind"].annotation.__args__[0]: kind for kind in SUPPORTS}
HELD = Held(kind="held")
#: the type of the key `support`
AnySupport = Annotated[Union[SUPPORTS], Field(discriminator="kind")]  # noqa: UP007 (a union of a list of classes)


def support_key() -> Any:
    """The key `support` of a kind of structure."""
    return key(HELD, "", 'What carries it: a table with `kind = "held"`, `"driven"`, `"sprung"` or `"modal"` and its keys.')
