"""Modes of an upright uniform beam on a foundation, with a mass on its top: Euler and Bernoulli's equation, solved exactly.

    m w_tt + E I w_xxxx = 0,   w = phi(x) cos(omega t),   phi'''' = beta^4 phi,   omega^2 = beta^4 E I/m,   x up from the foot

    foot, on springs k and k_r:   E I phi''' + k phi = 0,   E I phi'' - k_r phi' = 0   (clamped: phi = 0, phi' = 0)
    top, under a mass M:          E I phi''' + omega^2 M phi = 0,   phi'' = 0

phi is a sum of cos beta x, sin beta x, exp(-beta x) and exp(-beta (H - x)), none of which ever grows large; the four conditions
have a solution where their determinant is zero. All is written in lambda = beta H and in the derivatives phi^(d)/beta^d.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from dilatedem.numerics.plain import determinant, dot, exponential, norm, nth_root, sine_cosine
from dilatedem.numerics.root import bracketed_root

#: a slowest lambda below which the determinant has too few digits: (0.1/1.875)^2, a 350th of the frequency of a clamped beam
LEAST = 0.1
#: between places where the determinant is looked at: a factor below 1, a distance above; no two roots are nearer to each other
FACTOR, APART = 1.05, 0.05
#: how often that factor is taken, so that it leads from the least to 1
GROWTHS = 48
#: error of a root, of its own size
PRECISION = 1e-15


@dataclass(frozen=True)
class Beam:
    """Uniform from its foot to its top; a stiffness of the foot that is infinite holds it fast."""

    height: float  # m
    mass: float  # kg/m
    stiffness: float  # N m2, E I
    top_mass: float = 0.0  # kg
    foot_stiffness: float = np.inf  # N/m, sideways
    foot_turning: float = np.inf  # N m/rad

    def flexibility(self, place: float) -> float:
        """How far it gives way at `place` [m] above its foot under a steady force there [m/N]."""
        bent = place * place * place / (3.0 * self.stiffness)
        return bent + 1.0 / self.foot_stiffness + place * place / self.foot_turning

    def slowness(self) -> float:
        """The sum of 1/lambda^4 over all modes, that of mass times flexibility over the beam: no lambda^4 is below its inverse."""
        shift, turn = self.stiffness / self.foot_stiffness / self.height**3, self.stiffness / self.foot_turning / self.height
        on_top = self.top_mass / (self.mass * self.height)
        return 1.0 / 12.0 + shift + turn / 3.0 + on_top * (1.0 / 3.0 + shift + turn)


@dataclass(frozen=True, eq=False)
class Modes:
    """n modes with a modal mass of 1, slowest first.

    frequency (n,) [rad/s]; shape (n,) [1/sqrt(kg)]: phi at the place asked for; shear (n,) [sqrt(kg)] and moment (n,) [sqrt(kg) m]:
    integrals of m phi and of m x phi with the top's share, so that the foot lacks shear q'' and moment q'' of the load.
    """

    frequency: np.ndarray
    shape: np.ndarray
    shear: np.ndarray
    moment: np.ndarray

    def flexibility(self) -> float:
        """As of the beam, of these modes alone [m/N]: less than that."""
        return float(dot(self.shape / self.frequency, self.shape / self.frequency))


@cache
def beam_modes(beam: Beam, count: int, place: float) -> Modes:
    """The first `count` modes, their shapes at `place` [m] above the foot. Raises ValueError if the foot hardly holds the beam."""
    roots = _roots(beam, count)
    frequency = roots * roots / beam.height**2 * np.sqrt(beam.stiffness / beam.mass)
    ends = [_at(roots, end) for end in (0.0, 1.0)]  # (4 derivatives, n, 4 functions) each
    weights = _weights(beam, roots)
    (f0, f1, f2, f3), (t0, t1, t2, t3) = (dot(end, weights) for end in ends)
    # 4 lambda^4 int phi^2 = [3 phi phi''' - phi' phi'' + x (lambda^4 phi^2 - 2 phi' phi''' + phi''^2)]: differentiate it
    square = 0.25 * ((3.0 * (t0 * t3 - f0 * f3) - (t1 * t2 - f1 * f2)) / roots + t0 * t0 - 2.0 * t1 * t3 + t2 * t2)
    scale = 1.0 / np.sqrt(beam.mass * beam.height * square + beam.top_mass * t0 * t0)
    shape = dot(_at(roots, place / beam.height)[0], weights)
    scale = np.where(shape < 0.0, -scale, scale)
    reach = beam.height / roots  # 1/beta
    # of the whole beam: omega^2 int m phi = -E I phi'''(0), omega^2 int m x phi = E I phi''(0)
    return Modes(frequency, scale * shape, -scale * beam.mass * reach * f3, scale * beam.mass * reach * reach * f2)


def _roots(beam: Beam, count: int) -> np.ndarray:
    """(n,) lambda of the slowest modes, all of which lie below (n + 1) pi."""
    below = 0.999 * nth_root(1.0 / beam.slowness(), 4)
    if below < LEAST:
        raise ValueError("the soil hardly holds it: its slowest motion takes 350 times as long as if it were clamped")
    low = below * np.cumprod([1.0, *[FACTOR] * GROWTHS])
    places = np.concatenate([low[low < 1.0], np.arange(max(1.0, below), (count + 1) * np.pi, APART)])
    positive = _determinant(_conditions(beam, places)) > 0.0
    found = np.flatnonzero(positive[1:] != positive[:-1])[:count]

    def value(root: float) -> float:
        return float(_determinant(_conditions(beam, np.array([root])))[0])

    bounds = places[found].tolist(), places[found + 1].tolist()
    return np.array([bracketed_root(value, a, b, absolute=0.0, relative=PRECISION) for a, b in zip(*bounds, strict=True)])


def _at(roots: np.ndarray, place: float) -> np.ndarray:
    """(4, n, 4) the four functions and their derivatives over beta, by order, at `place`, a share of the height."""
    sine, cosine = sine_cosine(roots * place)
    down, up = exponential(-roots * place), exponential(-roots * (1.0 - place))
    return np.array([
        np.column_stack([cosine, sine, down, up]), np.column_stack([-sine, cosine, -down, up]),
        np.column_stack([-cosine, -sine, down, up]), np.column_stack([sine, -cosine, -down, up]),
    ])  # fmt: skip


def _conditions(beam: Beam, roots: np.ndarray) -> np.ndarray:
    """(n, 4, 4) what each function adds to the shear and moment of the foot, and to those of the top; rows of a size of 1."""
    foot, top = _at(roots, 0.0), _at(roots, 1.0)
    held = beam.foot_stiffness * beam.height**3 / beam.stiffness / (roots * roots * roots)
    turned = beam.foot_turning * beam.height / beam.stiffness / roots
    gives, turns = (1.0 / (1.0 + held))[:, None], (1.0 / (1.0 + turned))[:, None]
    heavy = (roots * (beam.top_mass / (beam.mass * beam.height)))[:, None]
    rows = (
        gives * foot[3] + (1.0 - gives) * foot[0], turns * foot[2] - (1.0 - turns) * foot[1],
        (top[3] + heavy * top[0]) / (1.0 + heavy), top[2],
    )  # fmt: skip
    return np.stack(rows, axis=1)


def _minor(matrix: np.ndarray, row: int, column: int) -> np.ndarray:
    """(n,) with its sign, of matrices (n, 4, 4)."""
    rows, columns = [k for k in range(4) if k != row], [k for k in range(4) if k != column]
    return (-1.0) ** (row + column) * determinant(matrix[:, rows][:, :, columns])


def _determinant(matrix: np.ndarray) -> np.ndarray:
    """(n,) of matrices (n, 4, 4)."""
    return sum(matrix[:, 3, column] * _minor(matrix, 3, column) for column in range(4))


def _weights(beam: Beam, roots: np.ndarray) -> np.ndarray:
    """(n, 4) how much of each function a mode has: any row of minors where the determinant is zero, the largest for its digits."""
    matrix = _conditions(beam, roots)
    rows = np.stack([np.column_stack([_minor(matrix, row, column) for column in range(4)]) for row in range(4)], axis=1)
    largest = norm(rows).argmax(axis=1)
    chosen = rows[np.arange(len(roots)), largest]
    return chosen / norm(chosen)[:, None]
