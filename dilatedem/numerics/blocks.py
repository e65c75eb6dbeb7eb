"""Rows of unequal length in one flat array, one after the other: where each begins, and how rows of one length are read and
written together."""

import numpy as np
from numpy.typing import ArrayLike


def offsets(counts: ArrayLike) -> np.ndarray:
    """(n + 1,) where each of n rows of `counts` (n,) entries begins, and where the last ends."""
    return np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)


def take(flat: np.ndarray, start: np.ndarray, width: int) -> np.ndarray:
    """The rows (m, width, ...) that begin at `start` (m,)."""
    return flat[start[:, None] + np.arange(width)]


def place(flat: np.ndarray, start: np.ndarray, rows: ArrayLike) -> None:
    """Write `rows` (m, width, ...), or one row (width, ...) for all, to where they begin, `start` (m,), in place."""
    rows = np.asarray(rows)
    width = rows.shape[1 if rows.ndim > flat.ndim else 0]
    flat[start[:, None] + np.arange(width)] = rows
