"""Closed forms of a body that hits with crushing: rigid-plastic, and elasticity and crushing in series.

Crushed ice bears P(d) = C A(d)^(1+q) at a crushed depth d. A rigid body of the kinetic energy E, pushed by a constant Q, stops
where the integral of P - Q over 0..d is E; the highest force is P(d), and it takes the integral of dd over its speed. With
elasticity in series, F the elastic force and W its energy at an overlap x, it stops where F(x) = P(d) and W(x) + integral of P
is E; the speed of parting over that of approach is sqrt(W/E), as what has crushed does not come back.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import acos, cos, inf, pi, sin, sqrt, tan

import numpy as np
from scipy.integrate import quad
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

#: m, deeper than any hit here
DEEP = 1.0


@dataclass(frozen=True)
class Crushing:
    """A nominal area [m2] over the depth [m], and the pressure on it."""

    area: Callable[[float], float]
    pressure: float  # Pa, on 1 m2
    exponent: float = 0.0

    def bears(self, depth: float) -> float:
        """Force [N]."""
        area = self.area(depth)
        return self.pressure * area ** (1.0 + self.exponent) if area > 0.0 else 0.0

    def costs(self, depth: float, start: float = 0.0) -> float:
        """Energy [J] to crush from one depth to another, at substituted depths z^2, as the force may rise steeply."""
        return quad(lambda z: 2.0 * z * self.bears(z * z), sqrt(start), sqrt(depth), epsabs=0.0, epsrel=1e-10, limit=200)[0]


@dataclass(frozen=True)
class Expected:
    force: float  # N
    depth: float  # m
    time: float  # s, from touch to the highest force
    restitution: float
    lost: float  # J


def rigid(crushing: Crushing, mass: float, speed: float, push: float = 0.0) -> Expected:
    """A rigid body that crushes until it stops."""
    energy = 0.5 * mass * speed**2
    depth = brentq(lambda d: crushing.costs(d) - push * d - energy, 1e-9, DEEP, xtol=1e-14)

    def slowness(z: float) -> float:  # at depth (1 - z^2) of the whole: the speed ends as a root
        d = depth * (1.0 - z * z)
        return 2.0 * z * depth / sqrt(2.0 / mass * max(energy + push * d - crushing.costs(d), 1e-300))

    time = quad(slowness, 0.0, 1.0, epsrel=1e-7, limit=200)[0]
    return Expected(crushing.bears(depth), depth, time, 0.0, crushing.costs(depth))


@dataclass(frozen=True)
class Elastic:
    """A force law F(x) that was looked up at overlaps x (n,) [m], with its energy."""

    overlap: np.ndarray
    force: np.ndarray  # N

    def _spline(self) -> CubicSpline:
        return CubicSpline(np.r_[0.0, self.overlap], np.r_[0.0, self.force])

    def overlap_at(self, force: float) -> float:
        spline = self._spline()
        return brentq(lambda x: float(spline(x)) - force, 0.0, self.overlap[-1], xtol=1e-15)

    def stored(self, force: float) -> float:
        """Energy [J] at a force [N]."""
        return float(self._spline().integrate(0.0, self.overlap_at(force)))


def series(crushing: Crushing, elastic: Elastic, mass: float, speed: float, start: float = 0.0) -> Expected:
    """An elastic body that crushes; start [m]: what has crushed before. The time is not known in closed form."""
    energy = 0.5 * mass * speed**2
    if start > 0.0 and elastic.stored(crushing.bears(start)) >= energy:
        high = elastic.force[-1]
        force = brentq(lambda f: elastic.stored(f) - energy, 1e-3, high) if elastic.stored(high) > energy else inf
        return Expected(force, start, inf, 1.0, 0.0)
    depth = brentq(
        lambda d: elastic.stored(crushing.bears(d)) + crushing.costs(d, start) - energy,
        max(start, 1e-9), rigid_depth(crushing, energy, start), xtol=1e-14,
    )  # fmt: skip
    force = crushing.bears(depth)
    return Expected(force, depth, inf, sqrt(elastic.stored(force) / energy), crushing.costs(depth, start))


def rigid_depth(crushing: Crushing, energy: float, start: float) -> float:
    return brentq(lambda d: crushing.costs(d, start) - energy, max(start, 1e-9), DEEP, xtol=1e-14)


def side_on_pile(height: float, radius: float) -> Callable[[float], float]:
    """A flat side on a pile, exactly."""
    return lambda d: 2.0 * height * sqrt(d * (2.0 * radius - d))


def round_on_pile(height: float, radius: float, other: float) -> Callable[[float], float]:
    """Two upright cylinders: the chord of both circles."""

    def area(depth: float) -> float:
        apart = radius + other - depth
        ahead = (apart**2 + radius**2 - other**2) / (2.0 * apart)
        return 2.0 * height * sqrt(radius**2 - ahead**2)

    return area


def corner_on_wall(height: float, angle: float, radius: float) -> Callable[[float], float]:
    """An upright edge between two sides at an angle [rad], rounded by a radius [m]."""
    half = 0.5 * angle

    def area(depth: float) -> float:
        rounded = radius * (1.0 - sin(half))
        if depth < rounded:
            return 2.0 * height * sqrt(depth * (2.0 * radius - depth))
        return 2.0 * height * (radius * cos(half) + (depth - rounded) * tan(half))

    return area


def sphere_on_wall(radius: float) -> Callable[[float], float]:
    return lambda d: pi * d * (2.0 * radius - d)


def face_on_wall(height: float, width: float) -> Callable[[float], float]:
    return lambda d: height * width


def crushed_side(depth: float, height: float, radius: float) -> float:
    """Volume [m3] that a flat side on a pile has lost: a segment of a circle."""
    return height * (radius**2 * acos(1.0 - depth / radius) - (radius - depth) * sqrt(depth * (2.0 * radius - depth)))
