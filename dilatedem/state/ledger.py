"""The energy ledger of a run: one table of its terms, and the sums of those that no body keeps itself.

A new term is a line of the table, besides where it is computed: the columns of energy.csv, the residual, and (of contacts) what
each pair books and the sums over pairs follow.
"""

from collections.abc import Collection
from typing import NamedTuple

import numpy as np

#: signs of a term: stored, so that its change counts; came in since the start; went out
STORED, GAIN, LOSS = 0, 1, -1
#: who computes a term: `motion.energy` of an instant; the laws of contact, pair by pair; loads, body by body; structures; `events`
INSTANT, CONTACT, LOAD, STRUCTURE, EVENT = "instant", "contact", "load", "structure", "event"


class Term(NamedTuple):
    """A term of the ledger [J]."""

    name: str  # its column in energy.csv
    sign: int
    owner: str
    label: str  # in words, for figures
    optional: bool = False  # whether only some cases have it, and a column for it


#: in the order of energy.csv
TERMS = (
    Term("kinetic", STORED, INSTANT, "kinetic"),
    Term("gravity", STORED, INSTANT, "weight"),
    Term("buoyancy", STORED, INSTANT, "buoyancy"),
    Term("elastic", STORED, INSTANT, "elastic"),
    Term("work_drag", GAIN, LOAD, "work of the water's drag"),
    Term("work_structure", GAIN, STRUCTURE, "work of the structures"),
    Term("loss_damping", LOSS, CONTACT, "lost to damping"),
    Term("loss_friction", LOSS, CONTACT, "lost to friction"),
    Term("gain_law", GAIN, CONTACT, "made by jumps of the contact law"),
    Term("loss_crushing", LOSS, CONTACT, "lost to crushing", optional=True),
    Term("work_wind", GAIN, LOAD, "work of the wind", optional=True),
    Term("work_wave", GAIN, LOAD, "work of the waves", optional=True),
    Term("kinetic_water", STORED, INSTANT, "kinetic, of the water that floes take along", optional=True),
    Term("modal", STORED, INSTANT, "kinetic and elastic, of modes of vibration", optional=True),
    Term("loss_modal", LOSS, LOAD, "lost to the damping of modes", optional=True),
    Term("structure_kinetic", STORED, STRUCTURE, "kinetic, of structures", optional=True),
    Term("structure_elastic", STORED, STRUCTURE, "elastic, of what carries structures", optional=True),
    Term("loss_support", LOSS, STRUCTURE, "lost in what carries structures", optional=True),
    Term("loss_relax", LOSS, EVENT, "taken out on the way to rest", optional=True),
    Term("carried_in", GAIN, EVENT, "brought by bodies that entered", optional=True),
    Term("carried_out", LOSS, EVENT, "carried out by bodies that left", optional=True),
)
#: what contacts cost: the entries of `Pairs.cost`, of `Tally.cost` and of `Ledger.cost`, and the number of each
COSTS = tuple(term.name for term in TERMS if term.owner == CONTACT)
LOSS_DAMPING, LOSS_FRICTION, GAIN_LAW, LOSS_CRUSHING = map(
    COSTS.index, ("loss_damping", "loss_friction", "gain_law", "loss_crushing")
)
#: what an instant has: the entries of `Ledger.instant`, and the number of each
INSTANTS = tuple(term.name for term in TERMS if term.owner == INSTANT)
KINETIC, GRAVITY, BUOYANCY, ELASTIC, KINETIC_WATER, MODAL = map(
    INSTANTS.index, ("kinetic", "gravity", "buoyancy", "elastic", "kinetic_water", "modal")
)


class Ledger(NamedTuple):
    """Energies, J: what contacts cost since the start, what is stored where `advance` came back, what went with bodies."""

    cost: np.ndarray  # (COSTS,)
    instant: np.ndarray  # (INSTANTS,)
    carried_out: np.ndarray  # (1,) energy that bodies had when they left
    departed_work: np.ndarray  # (works,) done by loads on bodies that have left


def empty_ledger(works: int = 0) -> Ledger:
    """Nothing done yet; works: loads whose work is booked."""
    return Ledger(np.zeros(len(COSTS)), np.zeros(len(INSTANTS)), np.zeros(1), np.zeros(works))


def energies(ledger: Ledger, works: dict[str, float], absent: Collection[str] = ()) -> dict[str, float]:
    """All terms by name [J], in the order of the table.

    works: those that the ledger does not hold; absent: of those that it holds, what the case does not have. Terms that are optional
    and not there are left out.
    """
    found = works | dict(zip(COSTS, ledger.cost.tolist(), strict=True)) | dict(zip(INSTANTS, ledger.instant.tolist(), strict=True))
    found = {name: value for name, value in found.items() if name not in absent}
    return {term.name: found[term.name] for term in TERMS if term.name in found or not term.optional}
