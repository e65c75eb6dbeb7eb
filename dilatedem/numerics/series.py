"""Tables of one variable (of time, of depth) in kernels: linear between two rows, beyond the first and the last held as there."""

import numpy as np

from dilatedem.jit import device


def sums_from(origin: float, places: np.ndarray, values: np.ndarray) -> np.ndarray:
    """(k, c) integrals of a table's columns `values` (k, c) from `origin` to each of its rows at `places` (k,), for `integral`."""
    rises = 0.5 * np.diff(places)[:, None] * (values[1:] + values[:-1])
    sums = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(rises, axis=0)])
    low = np.clip(np.searchsorted(places, origin, side="right") - 1, 0, None)
    there = [np.interp(origin, places, column) for column in values.T]
    return sums - (sums[low] + 0.5 * (origin - places[low]) * (values[low] + there))


@device
def row_before(places, place):
    """Number of the last row of `places` (k,) at or before a place; 0 where there is none."""
    low, high = 0, len(places)
    while high - low > 1:
        middle = (low + high) // 2
        if places[middle] <= place:
            low = middle
        else:
            high = middle
    return low


@device
def linear(places, values, column, place):
    """Column of a table `values` (k, c) at a place between its rows at `places` (k,)."""
    k = row_before(places, place)
    if place <= places[k] or k + 1 == len(places):
        return values[k, column]
    share = (place - places[k]) / (places[k + 1] - places[k])
    return values[k, column] + share * (values[k + 1, column] - values[k, column])


@device
def integral(places, values, sums, column, place):
    """Integral of `linear` from the origin of `sums` (see `sums_from`) to a place."""
    k = row_before(places, place)
    return sums[k, column] + 0.5 * (place - places[k]) * (values[k, column] + linear(places, values, column, place))
