"""Several threads, or one: the choice as types, by which kernels are compiled, and the layer that runs them."""

import os
from typing import NamedTuple

import numba

# OpenMP starts a parallel loop in 2 us, the other layers in 35 us and more; workqueue is the fallback that is always there.
numba.config.THREADING_LAYER_PRIORITY = ["omp", "workqueue", "tbb"]

#: How often a thread that waits for the others looks again before it gives its core away: half a millisecond. The OpenMP library's
#: own choice, 300 000, is many of them, lost where the core has other work; none at all makes every loop wait for the system.
SPINS = "10000"

prange = numba.prange


class Alone(NamedTuple):
    """One thread does all the work: no parallel loop is compiled or started."""

    threads: int = 1


class Team(NamedTuple):
    """Several threads share the loops over bodies and pairs."""

    threads: int


def start_threads(count: int) -> str:
    """Make `count` threads ready for parallel loops; returns the name of the threading layer, "" for one thread.

    Raises ValueError where the machine (or NUMBA_NUM_THREADS) has fewer.
    """
    if count == 1:
        return ""
    most = numba.config.NUMBA_NUM_THREADS
    if count > most:
        raise ValueError(f"threads = {count}: this machine offers {most}")
    if "OMP_WAIT_POLICY" not in os.environ:  # which says the same in other words
        os.environ.setdefault("GOMP_SPINCOUNT", SPINS)  # read when the library is loaded, by the next line
    numba.set_num_threads(count)
    return numba.threading_layer()


def share_among(count: int) -> None:
    """From now on so many threads share the parallel loops, or as many as there are: blocks that are more wait for their turn."""
    count = min(count, numba.config.NUMBA_NUM_THREADS)
    if count != numba.get_num_threads():
        numba.set_num_threads(count)
