"""What the closed forms share: a case file run in this process, and a result set against its target."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from dilatedem.case.load import load
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status

CASES = Path(__file__).parents[2] / "validation" / "closed_forms"

#: contact models that the tests and the table of validation/README.md go through
MODELS = ("liu2015", "consistent")


@dataclass(frozen=True)
class Comparison:
    """One quantity of a closed form.

    tolerance: largest error allowed, relative to `scale`, infinite where the result is only recorded (a limit of the model, which
    has no closed form to meet); scale: what the error is measured by, the target itself unless given (a target of zero needs
    one); model: the contact model, empty where nothing touches.
    """

    case: str
    quantity: str
    target: float
    result: float
    tolerance: float = 1e-3
    scale: float | None = None
    model: str = ""

    @property
    def error(self) -> float:
        return abs(self.result - self.target) / (abs(self.target) if self.scale is None else self.scale)

    @property
    def holds(self) -> bool:
        return bool(self.error <= self.tolerance)


def check(comparisons: list[Comparison]) -> None:
    """Fail with all that do not hold."""
    assert comparisons
    wrong = [
        f"{c.case} {c.model}: {c.quantity}: {c.result:.9g} instead of {c.target:.9g}, error {c.error:.2g} > {c.tolerance:g}"
        for c in comparisons
        if not c.holds
    ]
    assert not wrong, "\n".join(wrong)


def start(case: str, *overrides: str, model: str = "") -> Simulation:
    """The simulation of `validation/closed_forms/<case>.toml` at t = 0, with the contact model given, its loads evaluated."""
    chosen = (f"contact.model={model}",) if model else ()
    simulation = Simulation.of_case(load(CASES / f"{case}.toml", (*chosen, *overrides)))
    assert simulation.evaluate() == Status.DONE
    return simulation


def follow(simulation: Simulation, until: float, read: Callable[[Simulation], object], *, every: int = 1):
    """Advance to the time `until` [s]; returns times (n,) and what `read` gives every so many steps, the start included."""
    times, seen = [simulation.time_s], [read(simulation)]
    while simulation.time_s < until * (1.0 - 1e-12):
        assert simulation.advance(every) == Status.DONE
        times.append(simulation.time_s)
        seen.append(read(simulation))
    return np.array(times), np.array(seen)


def by_model(compare: Callable[[str], list[Comparison]]) -> list[Comparison]:
    """What `compare` gives for each of `MODELS`, each row with its model."""
    return [replace(row, model=model) for model in MODELS for row in compare(model)]


def advance_to(simulation: Simulation, time: float) -> None:
    """Advance to the step nearest to a time [s]."""
    assert simulation.advance(round(time / simulation.dt) - int(simulation.state.clock.step[0])) == Status.DONE


def zero_crossings(times: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Times at which a smooth history (n,) passes zero, by a cubic through the four samples around."""
    found = []
    for i in np.flatnonzero(values[:-1] * values[1:] < 0.0):
        part = slice(max(i - 1, 0), i + 3)
        shift, scale = times[i], times[i + 1] - times[i]
        roots = np.roots(np.polyfit((times[part] - shift) / scale, values[part], len(times[part]) - 1))
        roots = roots[np.abs(roots.imag) < 1e-9].real
        found.append(shift + scale * roots[np.argmin(np.abs(roots - 0.5))])
    return np.array(found)
