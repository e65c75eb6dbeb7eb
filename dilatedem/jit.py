"""The only place that configures Numba.

Editing an imported module does not invalidate the cache of its callers, and stale machine code gives stale answers. So the
cache lives in a folder named by a digest of all sources of the package, set before any decorator runs (2 ms), unless the
user's NUMBA_CACHE_DIR says otherwise. Two decorators only: `kernel` for the compiled loops that Python calls (cached on
disk), `device` for the functions that kernels call.
"""

import hashlib
import os
import tempfile
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import NamedTuple

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

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
from llvmlite.binding import Linkage, parse_assembly  # noqa: E402
from numba.core import types  # noqa: E402
from numba.core.codegen import JITCodeLibrary  # noqa: E402
from numba.core.compiler import Compiler  # noqa: E402
from numba.extending import intrinsic, overload  # noqa: E402

from dilatedem.garbage import seldom_collected  # noqa: E402

# a program that imported Numba before has it configured already, with the cache beside the sources: there, code goes stale
numba.config.CACHE_DIR = os.environ["NUMBA_CACHE_DIR"]
# OpenMP starts a parallel loop in 2 us, the other layers in 35 us and more; workqueue is the fallback that is always there.
numba.config.THREADING_LAYER_PRIORITY = ["omp", "workqueue", "tbb"]

prange = numba.prange

#: bytes
CACHE_LINE = 64
#: file in a folder of machine code that the process which writes there holds
LOCK = "lock"


class Alone(NamedTuple):
    """One thread does all the work: no parallel loop is compiled or started."""

    threads: int = 1


class Team(NamedTuple):
    """Several threads share the loops over bodies and pairs."""

    threads: int


# --- compiling: a kernel is optimised once, as a whole --------------------------------------------------------------------
#
# Left to itself Numba optimises every function together with all that it calls, and again within each of its callers: at six layers
# of calls most of the time. So what kernels call is only written down; a kernel takes it all in and is optimised in one go.


class _NoEngine:
    """What an inner function has instead of machine code."""

    def set_env(self, name, environment):
        pass  # only code that goes back to Python would look at it


class _InnerLibrary(JITCodeLibrary):
    """Code of a function that kernels call, as it was written down: neither optimised nor turned into machine code."""

    codegen = property(lambda self: _NoEngine())

    def finalize(self):
        # what a parallel loop needs to have started where its machine code comes from disk: the kernel keeps the list
        for library in self._linking_libraries:
            self._reload_init.update(library._reload_init)
        self._finalized = True

    def get_pointer_to_function(self, name):
        self._ensure_finalized()
        return 0

    def _get_module_for_linking(self):
        if self._shared_module is None:
            self._shared_module = _shareable(self._final_module)
            met, waiting = {self}, list(self._linking_libraries)
            while waiting:
                library = waiting.pop()
                if library in met:
                    continue
                met.add(library)
                if isinstance(library, _InnerLibrary):
                    self._shared_module.link_in(_shareable(library._final_module))
                    waiting += library._linking_libraries
                else:
                    self._shared_module.link_in(library._get_module_for_linking(), preserve=True)
        return self._shared_module


def _shareable(module):
    """A copy whose functions may turn up in several others."""
    module = module.clone()
    for function in module.functions:
        if not function.is_declaration and function.linkage == Linkage.external:
            function.linkage = Linkage.weak_odr
    return module


class _RareLibrary(_InnerLibrary):
    """Code of a function that kernels seldom call: it stays apart from theirs."""

    def finalize(self):
        super().finalize()
        for function in self._final_module.functions:
            if not function.is_declaration:
                function.add_function_attribute("noinline")
                function.add_function_attribute("cold")


class _KernelLibrary(JITCodeLibrary):
    """A kernel with all that it calls."""

    def _optimize_final_module(self):
        # nobody else sees its functions: arguments that none of them uses may go, which makes a step a tenth faster and more.
        # Private, not internal: an internal function has a name in the machine code, and the linker of code that comes later takes
        # it for that of other functions of this name, whose callers hand over those arguments and await an answer.
        for function in self._final_module.functions:
            if not function.is_declaration and function.linkage in (Linkage.linkonce_odr, Linkage.weak_odr):
                function.linkage = Linkage.private
        super()._optimize_final_module()

    def serialize_using_object_code(self):
        # nothing is linked with a kernel: beside the machine code its names will do, and loading takes half the time
        names = [function.name for function in self.get_defined_functions() if function.linkage == Linkage.external]
        stubs = parse_assembly("\n".join(f'define void @"{name}"() {{ ret void }}' for name in names))
        return self.name, "object", (self._get_compiled_object(), stubs.as_bitcode())


class _InnerCompiler(Compiler):
    """Compiles what kernels call."""

    library_class = _InnerLibrary

    def define_pipelines(self):
        if self.state.library is None:
            self.state.library = self.library_class(self.state.targetctx.codegen(), self.state.func_id.func_qualname)
            self.state.library.enable_object_caching()
        return super().define_pipelines()


def _with_room(function, *arguments):
    """Call a function; the frames of all that it calls find room behind this one's own."""
    return function(*arguments)


# Python keeps its frames in chunks of 16 kB and unmaps each as soon as it is empty: a loop that calls across the end of one maps
# and unmaps it every time, 400 000 times while a kernel is compiled, a sixth of the time. One frame that says it needs 2.4 MB gets
# a chunk of 4 MB (no more of it is used than frames fill), in which the rest is theirs.
_with_room.__code__ = _with_room.__code__.replace(co_stacksize=300_000)


class _RareCompiler(_InnerCompiler):
    """Compiles what kernels seldom call."""

    library_class = _RareLibrary


class _KernelCompiler(_InnerCompiler):
    """Compiles kernels."""

    library_class = _KernelLibrary

    def compile_extra(self, function):
        codegen = self.state.targetctx.codegen()
        usual = codegen._library_class
        # what Numba adds by itself, as the bodies of parallel loops, is inner code too
        codegen._library_class = _InnerLibrary
        try:
            with seldom_collected():
                return _with_room(super().compile_extra, function)
        finally:
            codegen._library_class = usual


#: Python never calls what kernels call: without the wrappers for that, compiling takes a third less
_INNER = {**_OPTIONS, "no_cpython_wrapper": True, "no_cfunc_wrapper": True, "pipeline_class": _InnerCompiler}


def kernel(function):
    """Compile a loop that Python calls; its machine code is kept on disk. Other threads of Python go on while it runs."""
    dispatcher = numba.njit(cache=True, nogil=True, pipeline_class=_KernelCompiler, **_OPTIONS)(function)
    cache, save = dispatcher._cache, dispatcher._cache.save_overload

    def save_in_turn(*arguments):
        with _turn(Path(cache.cache_path)):
            save(*arguments)

    cache.save_overload = save_in_turn
    return dispatcher


@contextmanager
def _turn(folder: Path):
    """Wait until no other process saves machine code in a folder.

    Numba numbers the files of one kernel by a list that each process reads, adds to and writes: two that add at once would take the
    same number, and one kind of arguments could get the machine code of the other.
    """
    folder.mkdir(parents=True, exist_ok=True)  # it may have been removed since the program began
    with (folder / LOCK).open("w") as file:
        if fcntl:
            with suppress(OSError):  # there are file systems without locks
                fcntl.flock(file, fcntl.LOCK_EX)
        yield


def device(function):
    """Compile a function that kernels call."""
    return numba.njit(**_INNER)(function)


def item(function):
    """Compile the work on one body or pair, merged into the loop that calls it.

    A call would hand over every array of every NamedTuple, which takes longer than the work itself. The merging is LLVM's;
    Numba's own `inline="always"` loses writes in parallel loops.
    """
    return numba.njit(**_INNER, forceinline=True)(function)


def rare(function):
    """Compile a function that kernels seldom call, kept out of the code that calls it.

    What a loop runs through every time should fit into the processor's cache of instructions.
    """
    return numba.njit(**{**_INNER, "pipeline_class": _RareCompiler}, forceinline=False)(function)


def shared_loop(function):
    """Compile a parallel loop: a `prange` over blocks whose body is one call of a device function."""
    return numba.njit(**_INNER, parallel=True)(function)


def by_type(usual, others):
    """A device function that runs one of several (compiled, same arguments) by the type of its first argument.

    usual: the one that runs where that argument is no NamedTuple of `others`, a dictionary by class. The choice falls while a
    kernel is compiled: what is not chosen is not compiled.
    """

    def stage(*arguments):
        raise TypeError("chosen by type: only compiled code can call it")

    @overload(stage, strict=False, jit_options=_INNER)
    def choose(*arguments):
        chosen = others.get(getattr(arguments[0], "instance_class", None), usual)

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


def is_cached(dispatcher, *arguments) -> bool:
    """Whether machine code of a kernel for arguments like these lies on disk."""
    # there is no other way to ask without loading or compiling: the index of what Numba keeps on disk, by kinds of arguments
    cache = dispatcher._cache
    signature = tuple(numba.typeof(argument) for argument in arguments)
    return cache._index_key(signature, dispatcher.targetctx.codegen()) in cache._cache_file._load_index()


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
