"""The only place that configures Numba.

Editing an imported module does not invalidate the cache of its callers, and stale machine code gives stale answers. So the
cache lives in a folder named by a digest of all sources of the package, set before any decorator runs (2 ms), unless the
user's NUMBA_CACHE_DIR says otherwise. Two decorators only: `kernel` for the compiled loops that Python calls (cached on
disk), `device` for the functions that kernels call.
"""

import hashlib
import os
import tempfile
from pathlib import Path
from typing import NamedTuple

_OPTIONS = {"error_model": "numpy", "_nrt": False}

_PACKAGE = Path(__file__).parent


def source_digest() -> str:
    """Digest of every source file of the package; names the cache folder."""
    digest = hashlib.sha256()
    for path in sorted(_PACKAGE.rglob("*.py")):
        digest.update(path.relative_to(_PACKAGE).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _cache_folder() -> Path:
    """A writable folder for compiled code: the user's cache, or a temporary folder where there is no usable home."""
    base = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    for root in (Path(base), Path(tempfile.gettempdir())):
        folder = root / "dilatedem" / source_digest()
        try:
            folder.mkdir(parents=True, exist_ok=True)
            if os.access(folder, os.W_OK):
                return folder
        except OSError:
            continue
    return Path(tempfile.mkdtemp(prefix="dilatedem-"))


if "NUMBA_CACHE_DIR" not in os.environ:
    os.environ["NUMBA_CACHE_DIR"] = str(_cache_folder())

import numba  # noqa: E402  (the cache folder must be known first)
from llvmlite import ir  # noqa: E402
from numba.core import types  # noqa: E402
from numba.extending import intrinsic, overload  # noqa: E402

# a program that imported Numba before has it configured already, with the cache beside the sources: there, code goes stale
numba.config.CACHE_DIR = os.environ["NUMBA_CACHE_DIR"]
# OpenMP starts a parallel loop in 2 us, the other layers in 35 us and more; workqueue is the fallback that is always there.
numba.config.THREADING_LAYER_PRIORITY = ["omp", "workqueue", "tbb"]

prange = numba.prange


#: bytes
CACHE_LINE = 64


class Alone(NamedTuple):
    """One thread does all the work: no parallel loop is compiled or started."""

    threads: int = 1


class Team(NamedTuple):
    """Several threads share the loops over bodies and pairs."""

    threads: int


#: Python never calls what kernels call: without the wrappers for that, compiling takes a third less
_INNER = {**_OPTIONS, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}


def kernel(function):
    """Compile a loop that Python calls; its machine code is kept on disk."""
    return numba.njit(cache=True, **_OPTIONS)(function)


def device(function):
    """Compile a function that kernels call."""
    return numba.njit(**_INNER)(function)


def item(function):
    """Compile the work on one body or pair, merged into the loop that calls it.

    A call would hand over every array of every NamedTuple, which takes longer than the work itself. The merging is LLVM's;
    Numba's own `inline="always"` loses writes in parallel loops.
    """
    return numba.njit(**_INNER, forceinline=True)(function)


def shared_loop(function):
    """Compile a parallel loop: a `prange` over blocks whose body is one call of a device function."""
    return numba.njit(**_INNER, parallel=True)(function)


def by_team(alone, shared):
    """A device function that runs `alone` or `shared` (both compiled, same arguments), by the type of its first argument.

    The choice falls while a kernel is compiled: a run on one thread neither compiles nor starts anything parallel.
    """

    def stage(*arguments):
        raise TypeError("a stage of a time step: only compiled code can call it")

    @overload(stage, strict=False)
    def choose(*arguments):
        chosen = shared if getattr(arguments[0], "instance_class", None) is Team else alone

        def run(*arguments):
            return chosen(*arguments)

        return run

    return stage


def start_threads(count: int) -> str:
    """Make `count` threads ready for parallel loops; returns the name of the threading layer, "" for one thread.

    Raises ValueError where the machine (or NUMBA_NUM_THREADS) has fewer.
    """
    if count == 1:
        return ""
    most = numba.config.NUMBA_NUM_THREADS
    if count > most:
        raise ValueError(f"threads = {count}: this machine offers {most}")
    numba.set_num_threads(count)
    return numba.threading_layer()


def is_cached(dispatcher) -> bool:
    """Whether machine code of a kernel lies on disk, for some kind of arguments."""
    folder = Path(os.environ["NUMBA_CACHE_DIR"])
    return any(folder.rglob(f"*{dispatcher.py_func.__name__}*.nbi"))


@intrinsic
def prefetch(typingctx, array, row, line):
    """Have the cache line number `line` of a row of an array brought into the cache; nothing waits for it, and nothing is read.

    The row begins where `array[row]` does; lines beyond it are fetched as well, if only they are mapped.
    """
    signature = types.void(array, types.intp, types.intp)

    def code(context, builder, signature, arguments):
        held = context.make_array(signature.args[0])(context, builder, arguments[0])
        stride = builder.extract_value(held.strides, 0)
        lines = builder.mul(arguments[2], ir.Constant(arguments[2].type, CACHE_LINE))
        offset = builder.add(builder.mul(arguments[1], stride), lines)
        byte = ir.IntType(8)
        start = builder.bitcast(held.data, byte.as_pointer())
        address = builder.gep(start, [offset], source_etype=byte)
        flag = ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [address.type, flag, flag, flag])
        call = builder.module.globals.get("llvm.prefetch.p0") or ir.Function(builder.module, kind, "llvm.prefetch.p0")
        builder.call(call, [address, flag(0), flag(2), flag(1)])
        return context.get_dummy_value()

    return signature, code
