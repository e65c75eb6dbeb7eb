"""Modes as smooth fields: quadratic B-splines over a lattice, for whoever asks what a mode does anywhere in a body.

Elements tell it too, but their gradients jump from one to the next, and a point must be looked for among them.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.sparse import csr_matrix, identity
from scipy.sparse.linalg import splu

from dilatedem.deformation.elements import shares
from dilatedem.deformation.modes import Modes

#: points of an element that a field is fitted at: barycentric coordinates in so many parts; more levels than a lattice has places
PARTS = 6
#: weight of the coefficients themselves over that of the fit: it decides where the body does not reach
RIDGE = 1e-11


@dataclass(frozen=True, eq=False)
class Lattice:
    """A field f(x) = sum of B(x/step - place) c over the places of a lattice, B the quadratic B-spline in three directions.

    origin (3,) [m]: of the place (0, 0, 0); step (3,) [m]; coefficients (nx, ny, nz, m, 3) of m fields.
    """

    origin: np.ndarray
    step: np.ndarray
    coefficients: np.ndarray

    def at(self, points: np.ndarray) -> np.ndarray:
        """(m, p, 3) the fields at points (p, 3) [m]."""
        size = self.coefficients.shape[:3]
        fields = _weights(points, self.origin, self.step, size) @ self.coefficients.reshape(np.prod(size), -1)
        return fields.reshape(len(points), -1, 3).transpose(1, 0, 2)


def lattice_of(modes: Modes, size: float) -> Lattice:
    """The shapes of modes as fields over a lattice of steps of `size` [m] at most: the best fit to those of the elements."""
    low, high = modes.nodes.min(axis=0), modes.nodes.max(axis=0)
    cells = np.maximum(np.ceil((high - low) / size * (1.0 - 1e-9)).astype(int), 2)
    step = (high - low) / cells
    places = cells + 3  # a place beyond either end reaches into the body
    barycentric = np.array([p for p in product(range(PARTS + 1), repeat=4) if sum(p) == PARTS]) / PARTS
    share = shares(barycentric)
    points = np.einsum("qk,tkc->tqc", share, modes.nodes[modes.elements]).reshape(-1, 3)
    values = np.einsum("qk,itkc->tqic", share, modes.shape[:, modes.elements]).reshape(len(points), -1)
    weights = _weights(points, low - step, step, places)
    normal = (weights.T @ weights).tocsc()
    normal = normal + RIDGE * normal.diagonal().max() * identity(normal.shape[0], format="csc")
    found = splu(normal).solve(weights.T @ values)
    return Lattice(low - step, step, found.reshape(*places, modes.count, 3))


def _weights(points: np.ndarray, origin: np.ndarray, step: np.ndarray, places) -> csr_matrix:
    """(p, nx ny nz) what each place of a lattice contributes at points (p, 3)."""
    scaled = (points - origin) / step
    middle = np.clip(np.rint(scaled).astype(int), 1, np.asarray(places) - 2)
    u = scaled - middle
    spline = np.stack((0.5 * (0.5 - u) ** 2, 0.75 - u**2, 0.5 * (0.5 + u) ** 2), axis=-1)  # (p, 3 axes, 3 places)
    near = middle[:, :, None] + np.arange(-1, 2)
    weight = spline[:, 0, :, None, None] * spline[:, 1, None, :, None] * spline[:, 2, None, None, :]
    place = (near[:, 0, :, None, None] * places[1] + near[:, 1, None, :, None]) * places[2] + near[:, 2, None, None, :]
    row = np.repeat(np.arange(len(points)), 27)
    return csr_matrix((weight.ravel(), (row, place.ravel())), shape=(len(points), int(np.prod(places))))
