"""The solver against closed forms: what is known exactly about half-spaces, and the identities of its own energy."""

from dataclasses import dataclass

import numpy as np

from validation.half_space import pieces
from validation.half_space.contact import CELLS, resolve
from validation.half_space.profile import paraboloid, punch, rounded_core

#: capacitance of a unit square plate over 4 pi eps0 (Read 1997, J. Comput. Phys. 133:1); a flat punch of any plan has
#: F/E* = pi * capacitance * overlap, the disc (2 a/pi) among them
SQUARE_CAPACITANCE = 0.3667896

RADIUS, OVERLAP = 0.04, 1e-3


@dataclass(frozen=True)
class Check:
    """What is compared, the known value and the one computed [m2, m3 or -]."""

    what: str
    known: float
    computed: float

    @property
    def error(self) -> float:
        return self.computed / self.known - 1


def hertz(cells: int = CELLS) -> list[Check]:
    """Force and energy of Hertz, circular and elliptic."""
    checks = []
    for ratio in (1, 10, 100, 10000):
        large, small = 1 / RADIUS, 1 / (RADIUS * ratio)
        force, energy = pieces.point(small, large, OVERLAP)
        contact = resolve(paraboloid(small, large, OVERLAP), cells).contact
        checks.append(Check(f"Hertz, curvatures 1:{ratio}, F/E*, m2", force, contact.force))
        checks.append(Check(f"Hertz, curvatures 1:{ratio}, W/E*, m3", energy, contact.energy))
    return checks


def flat_punches(cells: int = CELLS) -> list[Check]:
    """Force of sharp flat punches with a closed form."""
    side = 0.1

    def force(length, **options):
        return resolve(punch(length, side, OVERLAP, **options), cells).contact.force

    return [
        Check("flat punch, disc, F/E*, m2", side * OVERLAP, force(side, round_plan=True)),
        Check("flat punch, square, F/E*, m2", np.pi * SQUARE_CAPACITANCE * side * OVERLAP, force(side)),
        Check(
            "flat punch, ellipse 1:5, F/E*, m2",
            2 * pieces.elliptic_beta(5) * np.sqrt(5 / 4) * side * OVERLAP,
            force(5 * side, round_plan=True),
        ),
    ]


def betas(cells: int = CELLS) -> list[tuple[float, float]]:
    """Aspect ratio and shape factor of rectangular punches."""
    found = []
    for aspect in pieces.BETA:
        force = resolve(punch(0.1 * aspect, 0.1, OVERLAP), cells).contact.force
        found.append((aspect, force / (2 * np.sqrt(0.01 * aspect / np.pi) * OVERLAP)))
    return found


def energy(cells: int = CELLS) -> list[Check]:
    """dW/d(overlap) = F, and -dW/d(tilt) = moment, by central differences on a rolled face; and the parabola against the circle."""
    length, width, tilt = 1.0, 0.42, 3e-3

    def pose(change, turn):  # by overlap and tilt, both at the reference point
        deepest = OVERLAP + change + turn * length / 2
        return resolve(rounded_core(length, width, RADIUS, deepest, tilt=tilt + turn), cells).contact

    here, step, turn = pose(0, 0), 2e-5, 4e-5
    by_overlap = (pose(step, 0).energy - pose(-step, 0).energy) / (2 * step)
    by_tilt = (pose(0, turn).energy - pose(0, -turn).energy) / (2 * turn)
    circular = resolve(rounded_core(length, width, RADIUS, OVERLAP, tilt=0.1, circular=True), cells).contact
    parabolic = resolve(rounded_core(length, width, RADIUS, OVERLAP, tilt=0.1), cells).contact
    return [
        Check("face at tilt 0.003, dW/d(overlap) = F, m2", here.force, by_overlap),
        Check("face at tilt 0.003, dW/d(tilt) = moment, m3", here.energy_moment, by_tilt),
        Check("face at tilt 0.1, circular rim (known: parabolic), F/E*, m2", parabolic.force, circular.force),
    ]
