"""An upright beam on springs by cubic Hermite elements: an independent answer to what `dilatedem.structures.beam` solves."""

import numpy as np
from scipy.linalg import eigh


def matrices(beam, elements: int = 60) -> tuple[np.ndarray, np.ndarray]:
    """Mass and stiffness (n, n) of deflections and slopes from the foot up; what is clamped is left out."""
    count = 2 * (elements + 1)
    mass, stiffness, h = np.zeros((count, count)), np.zeros((count, count)), beam.height / elements
    k = beam.stiffness / h**3 * np.array([
        [12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h],
        [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h],
    ])  # fmt: skip
    m = beam.mass * h / 420 * np.array([
        [156, 22 * h, 54, -13 * h], [22 * h, 4 * h * h, 13 * h, -3 * h * h],
        [54, 13 * h, 156, -22 * h], [-13 * h, -3 * h * h, -22 * h, 4 * h * h],
    ])  # fmt: skip
    for e in range(elements):
        rows = slice(2 * e, 2 * e + 4)
        stiffness[rows, rows] += k
        mass[rows, rows] += m
    mass[-2, -2] += beam.top_mass
    springs = np.array([beam.foot_stiffness, beam.foot_turning])
    soft = np.isfinite(springs)
    stiffness[[0, 1], [0, 1]] += np.where(soft, springs, 0.0)
    kept = np.concatenate([soft, np.ones(count - 2, bool)])
    return mass[np.ix_(kept, kept)], stiffness[np.ix_(kept, kept)]


def place_row(beam, place: float, elements: int = 60) -> np.ndarray:
    """(n,) deflection at `place` [m] as a combination of the unknowns of `matrices`."""
    h = beam.height / elements
    e = min(int(place / h), elements - 1)
    x = place / h - e
    row = np.zeros(2 * (elements + 1))
    row[2 * e : 2 * e + 4] = 1 - 3 * x**2 + 2 * x**3, h * (x - 2 * x**2 + x**3), 3 * x**2 - 2 * x**3, h * (x**3 - x**2)
    return row[np.concatenate([np.isfinite([beam.foot_stiffness, beam.foot_turning]), np.ones(len(row) - 2, bool)])]


def element_modes(beam, count: int, place: float, elements: int = 60) -> tuple[np.ndarray, np.ndarray]:
    """(n,) frequencies [rad/s] and sizes of the shapes at `place` [1/sqrt(kg)]."""
    mass, stiffness = matrices(beam, elements)
    square, shapes = eigh(stiffness, mass, subset_by_index=[0, count - 1])
    return np.sqrt(square), np.abs(place_row(beam, place, elements) @ shapes)
