"""Where machine code is kept: a folder named by a digest of the sources that kernels are made of.

Imported before all else that knows Numba.
"""

import atexit
import hashlib
import os
import shutil
import stat
import tempfile
from contextlib import contextmanager, suppress
from pathlib import Path

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

_PACKAGE = Path(__file__).parents[1]
#: the folders and modules of the package that a kernel can be made of: whatever they import lies in them, too (a test counts)
KERNEL_SOURCES = (
    "contact", "errors.py", "garbage.py", "geometry", "jit", "motion", "numerics", "state", "step", "structures/record.py", "water",
)  # fmt: skip

#: file in a folder of machine code that the process which writes there holds
LOCK = "lock"
#: whether files belong to users, and modes say who may write to them
_HAS_OWNERS = os.name == "posix"


def source_digest() -> str:
    """Digest of every source file that may be part of a kernel; names the cache folder."""
    digest = hashlib.sha256()
    places = [_PACKAGE / name for name in KERNEL_SOURCES]
    for path in sorted(path for place in places for path in (place.rglob("*.py") if place.is_dir() else [place])):
        digest.update(path.relative_to(_PACKAGE).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _cache_folder() -> Path:
    """A folder for compiled code that nobody else can write to, for what lies there is run.

    In the user's cache; where there is no usable home, in the temporary folder under the user's number; where somebody else was
    there before, a fresh one, gone when the program ends.
    """
    base = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    user = os.getuid() if _HAS_OWNERS else ""
    for place in (Path(base, "dilatedem"), Path(tempfile.gettempdir(), f"dilatedem-{user}")):
        folder = place / source_digest()
        try:
            place.parent.mkdir(parents=True, exist_ok=True)
            _make_private(place)
            if _is_private(place) and _is_beyond_others(place.parent):
                _make_private(folder)
                if _is_private(folder) and os.access(folder, os.W_OK):
                    return folder
        except OSError:
            continue
    fresh = Path(tempfile.mkdtemp(prefix="dilatedem-"))
    atexit.register(shutil.rmtree, fresh, ignore_errors=True)
    return fresh


def _make_private(folder: Path) -> None:
    """Make a folder for its owner alone, and one that an earlier version made for more readers that, too."""
    try:
        folder.mkdir(mode=0o700)
    except FileExistsError:
        found = os.lstat(folder)
        if folder.name == "dilatedem" and _is_own_folder(found) and found.st_mode & 0o022:
            folder.chmod(0o700)


def _is_private(folder: Path) -> bool:
    """Whether it is a folder, no link to one, which belongs to this user and which no other may write to."""
    found = os.lstat(folder)
    return _is_own_folder(found) and not (_HAS_OWNERS and found.st_mode & 0o022)


def _is_own_folder(found: os.stat_result) -> bool:
    return stat.S_ISDIR(found.st_mode) and not (_HAS_OWNERS and found.st_uid != os.getuid())


def _is_beyond_others(parent: Path) -> bool:
    """Whether others can put no folder in the place of one that lies in here: they may not write, or not to what is not theirs."""
    mode = os.stat(parent).st_mode
    return not (_HAS_OWNERS and mode & 0o002) or bool(mode & stat.S_ISVTX)


def _chosen_folder(place: str) -> Path:
    """The folder for compiled code in a place that the user chose; a parent process may have named the folder itself."""
    digest = source_digest()
    return Path(place) if Path(place).name == digest else Path(place, digest)


if "NUMBA_CACHE_DIR" in os.environ:
    os.environ["NUMBA_CACHE_DIR"] = str(_chosen_folder(os.environ["NUMBA_CACHE_DIR"]))
else:
    os.environ["NUMBA_CACHE_DIR"] = str(_cache_folder())

import numba  # noqa: E402  (the cache folder must be known first)
from llvmlite.binding import parse_assembly, parse_bitcode  # noqa: E402

from dilatedem.garbage import seldom_collected  # noqa: E402
from dilatedem.jit.inside import inside  # noqa: E402

# a program that imported Numba before has it configured already, with the cache beside the sources: there, code goes stale
numba.config.CACHE_DIR = os.environ["NUMBA_CACHE_DIR"]


@contextmanager
def turn(folder: Path):
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


def _without_intermediate_code(payload):
    """What Numba saves of a kernel, less the code from which LLVM could merge it into others: nobody calls a kernel but Python, and
    reading a megabyte of it takes as long as all else of the first step. The names that it defines stay, and nothing behind them.
    """
    try:
        (name, kind, (machine_code, code)), *rest = payload
        module = parse_bitcode(code)
        lines = [f'target triple = "{module.triple}"', f'target datalayout = "{module.data_layout}"']
        lines += [f'define void @"{code.name}"() {{ unreachable }}' for code in module.functions if not code.is_declaration]
        lines += [f'@"{value.name}" = constant i8 0' for value in module.global_variables if not value.is_declaration]
        return ((name, kind, (machine_code, parse_assembly("\n".join(lines)).as_bitcode())), *rest)
    except (TypeError, ValueError, RuntimeError):
        return payload


def _loaded(cache, load, signature, context):
    """Machine code from the disk as `load` finds it, without all that Numba makes ready for compiling first, a third of a second:
    code that is there needs no more than Numba's memory of arrays. Numba makes ready for compiling where something is compiled.
    """
    memory, straight = getattr(inside("core.runtime"), "rtsys", None), getattr(cache, "_load_overload", None)
    if not hasattr(memory, "initialize") or straight is None:
        return load(signature, context)
    memory.initialize(context)
    return straight(signature, context)


def tend_cache(dispatcher) -> None:
    """Have a kernel's machine code saved in `turn`, that alone, and loaded while Python looks for garbage seldom.

    There is no public way to get in between: a Numba whose cache looks otherwise inside saves and loads as it likes.
    """
    cache = getattr(dispatcher, "_cache", None)
    save, load, folder = (getattr(cache, name, None) for name in ("save_overload", "load_overload", "cache_path"))
    if None in (save, load, folder):
        return

    def save_overload(*arguments):
        with suppress(OSError), turn(Path(folder)):  # a full disk: the next run compiles again
            save(*arguments)

    def load_overload(signature, context):
        with suppress(OSError), seldom_collected():  # a disk that cannot be read: compiled again
            return _loaded(cache, load, signature, context)
        return None

    cache.save_overload, cache.load_overload = save_overload, load_overload
    if (reduce := getattr(getattr(cache, "_impl", None), "reduce", None)) is not None:
        cache._impl.reduce = lambda result: _without_intermediate_code(reduce(result))


def is_cached(dispatcher, *arguments) -> bool:
    """Whether machine code of a kernel for arguments like these lies on disk; False where this Numba does not tell."""
    # there is no other way to ask without loading or compiling: the index of what Numba keeps on disk, by kinds of arguments
    signature = tuple(numba.typeof(argument) for argument in arguments)
    try:
        cache = dispatcher._cache
        return cache._index_key(signature, dispatcher.targetctx.codegen()) in cache._cache_file._load_index()
    except (AttributeError, TypeError, OSError):
        return False
