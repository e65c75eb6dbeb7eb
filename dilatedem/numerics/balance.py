"""What a ledger of energies is judged by: its residual, over the work of the loads and over the energy turned over."""

from collections.abc import Iterable, Mapping

import numpy as np

#: an amount of energy below this share of all stored energy is round-off: the terms of a ledger are known to some 1e-15 of their
#: sizes together, so that of a larger amount round-off makes less than a ten-thousandth
RESOLVED = 1e-10
#: share of the kinetic energy that the error of free motion may reach: in free flight nothing else is turned over
FREE_FLIGHT = 1e-6
#: terms that trade with each other as a floe bobs and count as one: energies of its place
PLACE = ("gravity", "buoyancy")


def turned_over(changes: Mapping[str, np.ndarray]) -> np.ndarray:
    """Energy (n,) [J] that has gone from one term of a ledger to another.

    changes: of every term since the start, each (n,) [J]. Half the sum of their sizes: what leaves one term arrives in another.
    """
    place = sum(changes[name] for name in PLACE if name in changes)
    return 0.5 * (np.abs(place) + sum(np.abs(change) for name, change in changes.items() if name not in PLACE))


def sizes(stored: Iterable[np.ndarray]) -> np.ndarray:
    """Sum (n,) [J] of the sizes of all stored energies, each (n,)."""
    return sum(np.abs(energy) for energy in stored)


def share(residual: float, amount: float, stored: float) -> float | None:
    """Residual over an amount of energy, both in J; None where the amount is round-off beside what is `stored`, by its `sizes`."""
    return residual / amount if amount > RESOLVED * stored else None
