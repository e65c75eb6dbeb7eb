"""The decorators: kernels, and what kernels call.

Numba compiles every function on its own and once more, with all that it calls, in each layer of callers. So layers are few, and
what a kernel goes through at every step is merged into it by LLVM, which costs one call less and nothing else.
"""

import numba
from numba.core import event
from numba.extending import overload

from dilatedem.garbage import seldom_collected
from dilatedem.jit.cache import tend_cache
from dilatedem.jit.indices import IndicesAsTheyAre

_OPTIONS = {"error_model": "numpy", "_nrt": False}
#: Python never calls what kernels call: without the wrappers for that, compiling takes a third less
_INNER = {**_OPTIONS, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}


class _SeldomCollected(event.Listener):
    """Has Python look for garbage seldom while something is compiled, as `dilatedem.garbage` explains.

    What a kernel calls is compiled meanwhile, one compiling within the other; Numba holds a lock around all.
    """

    def __init__(self):
        self._open = []

    def on_start(self, event):
        self._open.append(seldom_collected())
        self._open[-1].__enter__()

    def on_end(self, event):
        if self._open:
            self._open.pop().__exit__(None, None, None)


event.register("numba:compile", _SeldomCollected())
event.register("numba:compile", IndicesAsTheyAre())


def kernel(function):
    """Compile a loop that Python calls; its machine code is kept on disk. Other threads of Python go on while it runs.

    No compiled function may call one: what is kept on disk holds nothing that could be merged into another.
    """
    dispatcher = numba.njit(cache=True, nogil=True, no_cfunc_wrapper=True, **_OPTIONS)(function)
    tend_cache(dispatcher)
    return dispatcher


def device(function):
    """Compile a function that kernels call; LLVM merges it into its callers where it is small, or called once and not large.

    What is seldom needed stays apart: what a loop runs through every time should fit into the processor's cache of instructions.
    """
    return numba.njit(**_INNER)(function)


def item(function):
    """Compile a stage of the step, or the work on one body or pair, merged into the loop that calls it.

    A call would hand over every array of every NamedTuple, which takes longer than the work itself. The merging is LLVM's;
    Numba's own `inline="always"` loses writes in parallel loops.
    """
    return numba.njit(**_INNER, forceinline=True)(function)



def shared_loop(function):
    """Compile a parallel loop: a `prange` over blocks whose body is one call of a device function."""
    return numba.njit(**_INNER, parallel=True)(function)


def by_type(usual, others, *, at=0):
    """A device function that runs one of several (compiled, same arguments) by the type of its first argument, or of number `at`.

    usual: the one that runs where that argument is no NamedTuple of `others`, a dictionary by class. The choice falls while a
    kernel is compiled: what is not chosen is not compiled.
    """

    def stage(*arguments):
        raise TypeError("chosen by type: only compiled code can call it")

    def offer(function):
        # the function itself rather than a call of it: every layer of calls is compiled once more
        @overload(stage, strict=False, jit_options=function.targetoptions)
        def choose(*arguments):
            chosen = others.get(getattr(arguments[at], "instance_class", None), usual)
            return chosen.py_func if chosen is function else None

    for function in dict.fromkeys((usual, *others.values())):
        offer(function)
    return stage
