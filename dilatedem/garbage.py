"""Python's search for garbage, made rare where objects are made by the million and stay; and memory that is free, handed back.

Numba makes half a million objects as it is imported, and millions as it compiles: to look through them again and again takes a
tenth of the start and a quarter of the compiling, and once more as the program ends a sixth of a second.
"""

import atexit
import ctypes
import gc
import os
from collections.abc import Iterator
from contextlib import contextmanager

#: objects made between two searches; fewer: slower, more: memory for what has become garbage
SELDOM = 50_000
#: searches among new objects between two among older ones
SELDOM_AGAIN = 50


def left_at_the_end() -> None:
    """Search for no garbage as the program ends: its memory goes back by itself, and what must be closed is closed before."""
    atexit.register(gc.freeze)


@contextmanager
def seldom_collected() -> Iterator[None]:
    """Search for garbage every SELDOM new objects only."""
    thresholds = gc.get_threshold()
    gc.set_threshold(SELDOM, SELDOM_AGAIN, SELDOM_AGAIN)
    try:
        yield
    finally:
        gc.set_threshold(*thresholds)


def hand_back() -> None:
    """Give the system back what the C library keeps of memory that was freed; where that has no such call, nothing happens.

    What one thread copies and another writes and frees leaves holes between what stays. The library keeps them for later, each
    thread's apart, as many as there were at the busiest moment so far: in a long run its memory would creep up.
    """
    if os.name == "posix" and (trim := getattr(ctypes.CDLL(None), "malloc_trim", None)):
        trim(0)
