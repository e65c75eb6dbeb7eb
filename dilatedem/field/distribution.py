"""How large floes are: distributions of their sizes, the square roots of their plan areas, and of their thicknesses.

A field of n floes does not draw from a distribution but takes the mean of each of n equal shares of it, so that the moments of even
a small field are those asked for.
"""

import math
from abc import abstractmethod
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from dilatedem.keys import Fault, Positive, Table, key

#: digits behind the point to which a floe's share of the ice is rounded: what the functions of the C library give beyond depends on
#: the processor, and a last digit is another history of contacts a minute later
DIGITS = 10


@dataclass(frozen=True)
class Moments:
    """Of floe sizes [m]: their mean, the root of the mean area, and their standard deviation."""

    mean: float
    root_of_mean_area: float
    deviation: float

    @classmethod
    def of_areas(cls, areas: np.ndarray) -> "Moments":
        """Of floes with plan areas (n,) [m2]."""
        size = np.sqrt(areas)
        return cls(float(size.mean()), float(np.sqrt(areas.mean())), float(size.std()))


class SizeDistribution(Table):
    """The table `field.size_distribution`."""

    @property
    @abstractmethod
    def floe_size(self) -> float | None:
        """Root of the mean area [m], where the distribution says it by itself."""

    @abstractmethod
    def moments(self, floe_size: float) -> Moments:
        """Of the distribution with this root of the mean area [m]."""

    @abstractmethod
    def shares(self, count: int) -> np.ndarray:
        """(count,) areas of as many floes over their mean, ascending: the means of equal shares of the distribution."""


class PowerLaw(SizeDistribution):
    """As many floes are larger than D as D^-exponent says, between two bounds: what is seen where ice has broken by itself."""

    kind: Literal["power_law"] = key(..., "", "N(>D) falls with a power of D.")
    exponent: Annotated[float, Field(ge=0.1, le=10)] = key(
        1.9, "", "Exponent of the number of floes larger than D; 1 to 3 is usual."
    )
    min: Positive = key(..., "m", "Size of the smallest floe.")
    max: Positive = key(..., "m", "Size of the largest floe.")

    def faults(self) -> list[Fault]:
        return [(("max",), f"must be more than min, {self.min:g} m")] if self.max <= self.min else []

    @property
    def floe_size(self) -> float:
        return round(self._moment(2, self.min, self.max) ** 0.5, DIGITS)

    def moments(self, floe_size: float) -> Moments:
        mean, square = (self._moment(k, self.min, self.max) for k in (1, 2))
        return Moments(mean, square**0.5, (square - mean * mean) ** 0.5)

    def shares(self, count: int) -> np.ndarray:
        most, least = self.min**-self.exponent, self.max**-self.exponent
        bounds = [(most + k / count * (least - most)) ** (-1.0 / self.exponent) for k in range(count + 1)]
        areas = [count * self._moment(2, low, high) for low, high in zip(bounds[:-1], bounds[1:], strict=True)]
        return np.round(np.array(areas) / self._moment(2, self.min, self.max), DIGITS)

    def _moment(self, power: int, low: float, high: float) -> float:
        """The integral of D^power over the density of sizes from `low` to `high`: of all floes the mean of D^power."""
        a = self.exponent
        scale = a / (self.min**-a - self.max**-a)
        # expm1 and log keep the digits where the bounds are near, and where power = exponent
        steepness, ratio = power - a, math.log1p((high - low) / low)
        return scale * low**steepness * (ratio if steepness == 0.0 else math.expm1(steepness * ratio) / steepness)


class Lognormal(SizeDistribution):
    """The logarithm of the size has a normal distribution about a mean that `field.floe_size` or `field.floe_count` says."""

    kind: Literal["lognormal"] = key(..., "", "The logarithm of the size is normally distributed.")
    spread: Annotated[float, Field(gt=0, le=1.5)] = key(
        0.4, "", "Standard deviation of the logarithm of the size; with 0.4, 19 of 20 floes are 0.45 to 2.2 times the median."
    )

    @property
    def floe_size(self) -> None:
        return None

    def moments(self, floe_size: float) -> Moments:
        mean = floe_size * math.exp(-0.5 * self.spread**2)
        return Moments(mean, floe_size, (floe_size**2 - mean**2) ** 0.5)

    def shares(self, count: int) -> np.ndarray:
        return lognormal_shares(count, 2.0 * self.spread)


DISTRIBUTIONS = (PowerLaw, Lognormal)
BY_NAME = {"power_law": PowerLaw, "lognormal": Lognormal}


def lognormal_shares(count: int, spread: float) -> np.ndarray:
    """(count,) means of equal shares of a lognormal distribution over its mean, ascending; spread: deviation of the logarithm."""
    from scipy.special import ndtr, ndtri  # it takes a third of a second to load, and few fields need it

    bounds = ndtri(np.arange(count + 1) / count)
    return np.round(count * np.diff(ndtr(bounds - spread)), DIGITS)


def thicknesses(count: int, mean: float, spread: float, generator: np.random.Generator) -> np.ndarray:
    """(count,) thicknesses [m] of floes in random order: lognormal, `spread` their standard deviation over their `mean` [m]."""
    if spread == 0.0:
        return np.full(count, mean)
    shares = lognormal_shares(count, math.sqrt(math.log1p(spread * spread)))
    return mean * generator.permutation(shares * (count / shares.sum()))
