"""Floe size and floe count: the mean plan area of a floe is its size squared (physics 7)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike


def floe_count(domain_size: ArrayLike, concentration: float, floe_size: float) -> int:
    """Number of floes of mean plan area `floe_size`**2 [m2] that cover `concentration` of the domain (2,)
    [m].

    Raises ValueError when a single floe would be larger than all the ice there is.
    """
    ice_area = concentration * float(np.prod(domain_size))
    count = round(ice_area / floe_size**2)
    if count < 1:
        raise ValueError(
            f"floe size = {floe_size:g} m: must be at most {math.sqrt(ice_area):g} m, the size of one floe "
            "of all the ice in the domain"
        )
    return count


def floe_size(domain_size: ArrayLike, concentration: float, count: int) -> float:
    """Square root of the mean plan area [m] of `count` floes that cover `concentration` of the domain."""
    return math.sqrt(concentration * float(np.prod(domain_size)) / count)
