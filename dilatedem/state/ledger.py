"""The energy ledger of a run: one table of its terms, and the sums of those that no body keeps itself.

A new term is a line of the table, besides where it is computed: the columns of energy.csv, the residual, and (of contacts) what
each pair books and the sums over pairs follow.
"""

from typing import NamedTuple

import numpy as np

#: signs of a term: stored, so that its change counts; came in since the start; went out
STORED, GAIN, LOSS = 0, 1, -1
#: who computes a term: `motion.energy` of an instant; the laws of contact, pair by pair; the water, body by body; structures
INSTANT, CONTACT, WATER, STRUCTURE = "instant", "contact", "water", "structure"


class Term(NamedTuple):
    """A term of the ledger [J]."""

    name: str  # its column in energy.csv
    sign: int
    owner: str
    label: str  # in words, for figures


#: in the order of energy.csv
TERMS = (
    Term("kinetic", STORED, INSTANT, "kinetic"),
    Term("gravity", STORED, INSTANT, "weight"),
    Term("buoyancy", STORED, INSTANT, "buoyancy"),
    Term("elastic", STORED, INSTANT, "elastic"),
    Term("work_drag", GAIN, WATER, "work of the water's drag"),
    Term("work_structure", GAIN, STRUCTURE, "work of the structures"),
    Term("loss_damping", LOSS, CONTACT, "lost to damping"),
    Term("loss_friction", LOSS, CONTACT, "lost to friction"),
    Term("gain_law", GAIN, CONTACT, "made by jumps of the contact law"),
)
NAMES = tuple(term.name for term in TERMS)
#: what contacts cost: the entries of `Pairs.cost`, of `Tally.cost` and of `Ledger.cost`, and the number of each
COSTS = tuple(term.name for term in TERMS if term.owner == CONTACT)
LOSS_DAMPING, LOSS_FRICTION, GAIN_LAW = map(COSTS.index, ("loss_damping", "loss_friction", "gain_law"))
#: what an instant has: the entries of `Ledger.instant`, and the number of each
INSTANTS = tuple(term.name for term in TERMS if term.owner == INSTANT)
KINETIC, GRAVITY, BUOYANCY, ELASTIC = map(INSTANTS.index, ("kinetic", "gravity", "buoyancy", "elastic"))


class Ledger(NamedTuple):
    """Energies, J: what contacts cost since the start, and what is stored where `advance` came back."""

    cost: np.ndarray  # (COSTS,)
    instant: np.ndarray  # (INSTANTS,)


def empty_ledger() -> Ledger:
    return Ledger(np.zeros(len(COSTS)), np.zeros(len(INSTANTS)))


def energies(ledger: Ledger, work_drag: float, work_structure: float) -> dict[str, float]:
    """All terms by name [J], in the order of the table."""
    found = {"work_drag": work_drag, "work_structure": work_structure}
    found |= zip(COSTS, ledger.cost.tolist(), strict=True)
    found |= zip(INSTANTS, ledger.instant.tolist(), strict=True)
    return {name: found[name] for name in NAMES}
