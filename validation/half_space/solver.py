"""Frictionless normal contact of an elastic half-space on a grid of rectangular cells, each with a constant pressure.

The elastic problem is that of Boussinesq: 1/(pi E*) int p(x')/|x - x'| dA' = overlap(x) where p > 0, and at least overlap(x) where
p = 0. Influence of a cell: Love (1929), Phil. Trans. R. Soc. A 228:377, as in Johnson (1985), Contact Mechanics, eq. (3.25).
Convolution by FFT on a grid of twice the size, hence free of images. Solver: the conjugate gradient with p >= 0 of
Polonsky & Keer (1999), Wear 231:206, for a given approach instead of a given load.

All in units of E*: pressures are p/E* [-], forces F/E* [m2], energies W/E* [m3], moments M/E* [m3].
"""

from dataclasses import dataclass

import numpy as np
from scipy import fft

#: rms over the contact of (displacement - overlap), relative to the largest overlap, at which the iteration ends;
#: forces then are settled to some 1e-6
RESIDUAL = 1e-6

#: conjugate gradient steps; 60-400 are usual
MOST_ITERATIONS = 4000


def love(x: np.ndarray, y: np.ndarray, width: float, height: float) -> np.ndarray:
    """Normal displacement [m] at (x, y) [m], centres of cells, from unit p/E* on the cell `width` by `height` [m] at the origin."""
    right, left = x + width / 2, x - width / 2
    upper, lower = y + height / 2, y - height / 2

    def side(length, near, far):  # length * ln of Love's quotient; by arcsinh, since the plain logarithm cancels far from the cell
        return length * (np.arcsinh(near / abs(length)) - np.arcsinh(far / abs(length)))

    return (side(right, upper, lower) + side(upper, right, left) + side(left, lower, upper) + side(lower, left, right)) / np.pi


class HalfSpace:
    """Displacements of an nx by ny grid of cells dx by dy [m] under pressures on the same cells."""

    def __init__(self, nx: int, ny: int, dx: float, dy: float):
        self.cells = nx, ny
        self.padded = fft.next_fast_len(2 * nx - 1, real=True), fft.next_fast_len(2 * ny - 1, real=True)
        offsets = [np.minimum(np.arange(m), m - np.arange(m)) * d for m, d in zip(self.padded, (dx, dy), strict=True)]
        self.spectrum = fft.rfft2(love(offsets[0][:, None], offsets[1][None, :], dx, dy)).real  # even, hence real

    def displacement(self, pressure: np.ndarray) -> np.ndarray:
        """(nx, ny) [m] from p/E* (nx, ny)."""
        transform = fft.rfft2(pressure, s=self.padded)
        transform *= self.spectrum
        return fft.irfft2(transform, s=self.padded)[: self.cells[0], : self.cells[1]]


@dataclass
class Pressure:
    """p/E* (nx, ny) on the cells, with the residual reached and the number of steps it took."""

    values: np.ndarray
    residual: float
    iterations: int


def solve(overlap: np.ndarray, dx: float, dy: float, start: np.ndarray | None = None, residual: float = RESIDUAL) -> Pressure:
    """Contact pressure for an undeformed overlap [m], (nx, ny) at the centres of cells dx by dy [m].

    start: a first guess of p/E*. Raises ArithmeticError when MOST_ITERATIONS do not reach the residual.
    """
    inside = overlap > 0  # displacements are positive everywhere, so no pressure where the bodies do not overlap
    deepest = overlap.max()
    half_space = HalfSpace(*overlap.shape, dx, dy)
    if start is None:
        start = np.where(inside, deepest / np.sqrt(inside.sum() * dx * dy), 0.0)
    pressure = np.where(inside, start, 0.0)
    direction = np.zeros_like(pressure)
    norm_before, conjugate = 1.0, False
    for iteration in range(MOST_ITERATIONS):
        error = half_space.displacement(pressure) - overlap
        contact = pressure > 0
        norm = float(np.sum(error[contact] ** 2))
        rms = np.sqrt(norm / max(1, contact.sum())) / deepest
        outside = inside & ~contact & (error < 0)
        if rms < residual and not (error[outside] < -10 * residual * deepest).any():
            return Pressure(pressure, rms, iteration)
        direction = np.where(contact, error + (norm / norm_before * direction if conjugate else 0.0), 0.0)
        response = half_space.displacement(direction)
        step = np.sum((error * direction)[contact]) / np.sum((response * direction)[contact])
        pressure = np.maximum(np.where(contact, pressure - step * direction, 0.0), 0.0)
        entering = inside & (pressure == 0) & (error < 0)
        conjugate = not entering.any()
        pressure[entering] -= step * error[entering]
        norm_before = norm
    raise ArithmeticError(f"contact pressure: residual {rms:.1e} after {MOST_ITERATIONS} steps, {residual:.1e} wanted")
