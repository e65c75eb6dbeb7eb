"""The energy ledger of a run."""

from typing import NamedTuple

import numpy as np


class Ledger(NamedTuple):
    """Energies, J, each an array (1,): what came in or went out since the start, and what is stored where `advance` came back."""

    loss_damping: np.ndarray
    loss_friction: np.ndarray
    gain_law: np.ndarray
    kinetic: np.ndarray
    gravity: np.ndarray
    buoyancy: np.ndarray
    elastic: np.ndarray


def empty_ledger() -> Ledger:
    return Ledger(*(np.zeros(1) for _ in Ledger._fields))
