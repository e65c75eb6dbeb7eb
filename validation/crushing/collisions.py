"""Random collisions of irregular floes that crush: what they lose, and whether the ledger knows."""

from dataclasses import dataclass

import numpy as np

from validation.contact_lab.impacts import collide
from validation.contact_lab.random_collisions import LONGEST, SEED, collision

COLLISIONS = 1000
PRESSURE = 2e6  # Pa


@dataclass(frozen=True)
class Losses:
    """Of those collisions of a survey that happen, over the kinetic energy before."""

    kept: np.ndarray  # (n,) kinetic energy afterwards
    crushed: np.ndarray  # (n,) lost to crushing
    residual: np.ndarray  # (n,) what the ledger does not account for
    gained: np.ndarray  # (n,) made by the contact law


def survey(model: str, numbers=range(COLLISIONS)) -> Losses:
    """Collisions with these numbers; those of the contact laboratory, in ice that crushes."""
    rows = []
    for i in numbers:
        impact = collide(collision(model, np.random.default_rng([SEED, i]), PRESSURE), patience=LONGEST)
        if impact is not None:
            terms, before = impact.ledger, impact.kinetic_before
            after = terms["kinetic"] + terms["elastic"] + terms["loss_damping"] + terms["loss_friction"] + terms["loss_crushing"]
            rows.append([impact.kept, terms["loss_crushing"] / before, (after - terms["gain_law"]) / before - 1.0,
                         terms["gain_law"] / before])  # fmt: skip
    return Losses(*np.array(rows).T)
