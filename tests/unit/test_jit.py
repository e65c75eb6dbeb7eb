"""`jit.prefetch` reads and writes nothing, whatever the layout of the array; one process compiles for one thread and for two;
machine code is kept by one process after the other; an item is merged into what calls it."""

import fcntl
import gc
import os
import pickle
import shutil
import subprocess
import sys
import threading
from pathlib import Path
from types import FunctionType, SimpleNamespace

import numba
import numpy as np
import pytest
from llvmlite.binding import parse_bitcode
from numba.core.errors import NumbaError

import dilatedem
from dilatedem.jit import CACHE_LINE, LOCK, Team, by_type, cache, device, is_cached, item, kernel, prange, prefetch, shared_loop
from dilatedem.jit.cache import tend_cache
from dilatedem.state.pairs import empty_pairs
from dilatedem.step.ahead import PAIR_LINES

ROOT = Path(__file__).parents[2]


@kernel
def fetch_and_sum(array, rows):
    total = 0.0
    for i in range(rows):
        prefetch(array, min(i + 3, rows - 1), 0)
        prefetch(array, i, 2)  # a line beyond the row
        total += array[i, 0]
    return total


@pytest.mark.parametrize("columns", [slice(0, 3), slice(1, 8, 2)])
def test_a_prefetch_changes_nothing(columns):
    whole = np.random.default_rng(1).random((50, 8))
    array, before = whole[:, columns], whole.copy()
    assert fetch_and_sum(array, len(array)) == pytest.approx(array[:, 0].sum(), rel=1e-14)
    np.testing.assert_array_equal(whole, before)


def test_the_instruction_is_in_the_machine_code():
    fetch_and_sum(np.ones((4, 3)), 4)
    fetch_and_sum.recompile()  # code that comes from the disk cannot be read
    assert any("prefetch" in code for code in fetch_and_sum.inspect_asm().values())


def test_a_pairs_row_is_as_many_lines_as_are_fetched():
    pairs = empty_pairs(3)
    assert pairs.row.strides[0] == PAIR_LINES * CACHE_LINE and pairs.row.ctypes.data % CACHE_LINE == 0


@device
def _sum_of_block(array, blocks, block):
    """Too long to be merged into what calls it twice; `blocks` is an argument that optimising may take away."""
    total = 0.0
    for i in range(block, len(array), blocks):
        total += np.exp(np.sin(array[i])) / (1.0 + np.cosh(array[i])) ** 1.5
    for i in range(block, len(array), blocks):
        total -= np.exp(np.cos(array[i])) / (1.0 + np.sinh(array[i]) ** 2) ** 2.5
    return total


@item
def _sum_alone(team, array, sums):
    for block in range(2):
        sums[block] = _sum_of_block(array, 2, block)


@shared_loop
def _sum_shared(team, array, sums):
    for block in prange(2):
        sums[block] = _sum_of_block(array, 2, block)


_sum_blocks = by_type(_sum_alone, {Team: _sum_shared})


@kernel
def summed(team, array, sums):
    _sum_blocks(team, array, sums)
    return sums[0] + sums[1]


@pytest.mark.parametrize("order", [(1, 2), (2, 1)])
def test_one_process_compiles_for_one_thread_and_for_two(order, tmp_path):
    """Functions of one name, optimised as parts of one kernel, once were taken for those of the other: now and then a crash."""
    program = (
        "import numpy as np; from dilatedem.jit import Alone, Team, start_threads; from tests.unit.test_jit import summed; "
        f"teams = {{1: Alone(), 2: Team(2)}}; order = {order}; start_threads(2); array = np.linspace(0.0, 1.0, 1001); "
        "found = [summed(teams[n], array, np.zeros(2)) for n in order + order]; assert len(set(found)) == 1, found; "
        "assert len(summed.signatures) == 2; print(found[0])"
    )
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path), "NUMBA_NUM_THREADS": "2"}
    told = subprocess.run([sys.executable, "-c", program], cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    assert told.returncode == 0, told.stderr[-2000:]
    x = np.linspace(0.0, 1.0, 1001)
    expected = np.exp(np.sin(x)) / (1.0 + np.cosh(x)) ** 1.5 - np.exp(np.cos(x)) / (1.0 + np.sinh(x) ** 2) ** 2.5
    assert float(told.stdout) == pytest.approx(expected.sum(), rel=1e-12)


def test_two_processes_keep_machine_code_one_after_the_other(tmp_path, monkeypatch):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))

    @kernel
    def doubled(x):
        return 2.0 * x

    folder = Path(doubled.stats.cache_path)
    thread = threading.Thread(target=doubled, args=(1.0,))
    with (folder / LOCK).open("w") as other:
        fcntl.flock(other, fcntl.LOCK_EX)
        thread.start()
        thread.join(timeout=2.0)
        assert thread.is_alive() and not list(folder.glob("*.nb?")), "nothing is written while another process does"
    thread.join()
    assert len(list(folder.glob("*.nbc"))) == 1


def test_machine_code_is_kept_though_its_folder_was_removed_meanwhile(tmp_path, monkeypatch):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "cache"))

    @kernel
    def tripled(x):
        return 3.0 * x

    shutil.rmtree(tmp_path / "cache")
    assert tripled(2.0) == 6.0 and list((tmp_path / "cache").rglob("*.nbc"))


def test_a_kernel_from_the_disk_gives_what_it_gave_when_compiled_and_is_machine_code_alone(tmp_path, monkeypatch):
    module = tmp_path / "quadrupling.py"
    module.write_text("from dilatedem.jit import kernel\n\n\n@kernel\ndef quadrupled(x):\n    return 4.0 * x\n", encoding="utf-8")
    program = (
        "import sys\nfrom quadrupling import quadrupled as q\nprint(q(2.0), q(3.0), len(q.stats.cache_hits))\n"
        "print('compiles' if 'numba.np.linalg' in sys.modules else 'loads')"
    )
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "cache"), "PYTHONPATH": f"{tmp_path}{os.pathsep}{ROOT}"}
    told = [
        subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=True).stdout.split()
        for _ in range(2)
    ]
    assert told == [["8.0", "12.0", "0", "compiles"], ["8.0", "12.0", "1", "loads"]]
    (saved,) = (tmp_path / "cache").rglob("*.nbc")
    monkeypatch.syspath_prepend(tmp_path)
    code = pickle.loads(saved.read_bytes())[0]
    names = str(parse_bitcode(code[2][1]))
    assert "quadrupled" in names and "unreachable" in names and "fmul" not in names


def _one_before(array):
    """What stands before the first entry, where indices are taken as they are; the last one, where they are looked at."""
    return array[len(array) - 5]


@pytest.mark.parametrize(("module", "found"), [("dilatedem.somewhere", 10.0), ("elsewhere", 50.0)])
def test_indices_of_this_package_alone_are_taken_as_they_are(module, found):
    function = FunctionType(_one_before.__code__, globals(), f"one_before_{module.replace('.', '_')}")
    function.__module__ = module
    whole = np.array([10.0, 20.0, 30.0, 40.0, 50.0])
    assert numba.njit(function)(whole[1:]) == found
    assert numba.njit(lambda array: array[-2])(whole) == 40.0, "whatever was compiled before"


def _four_sums(array, i):
    """Too long for LLVM to merge it into a kernel that calls it twice, unless it must."""
    return (
        _sum_of_block(array, i + 1, i) + _sum_of_block(array, i + 2, i) + _sum_of_block(array, i + 3, i)
        + _sum_of_block(array, i + 4, i)
    )  # fmt: skip


@pytest.mark.parametrize(("decorator", "apart"), [(item, False), (device, True)])
def test_an_item_is_merged_into_what_calls_it_and_a_long_function_is_not(decorator, apart):
    four_sums = decorator(_four_sums)

    @kernel
    def twice(array, n):
        return four_sums(array, n) + four_sums(array, n + 1)

    twice(np.zeros(3), 1)
    twice.recompile()  # code that comes from the disk cannot be read
    labels = [line for code in twice.inspect_asm().values() for line in code.splitlines() if line.endswith(":")]
    assert any("10_four_sums" in label for label in labels) == apart


def test_garbage_is_looked_for_as_before_once_a_kernel_is_compiled():
    before = gc.get_threshold()

    @kernel
    def sound(x):
        return x + 1.0

    @kernel
    def broken(x):
        return x.no_such_field

    assert sound(1.0) == 2.0
    with pytest.raises(NumbaError):
        broken(1.0)
    assert gc.get_threshold() == before


def test_a_numba_with_another_cache_inside_is_left_as_it_is():
    """What has no public way is done without, not crashed over."""
    unknown = SimpleNamespace(_cache=SimpleNamespace(cache_path="nowhere"))
    tend_cache(unknown)
    tend_cache(SimpleNamespace())
    assert not hasattr(unknown._cache, "save_overload")
    assert not is_cached(unknown, 1.0) and not is_cached(SimpleNamespace(), 1.0)


def test_the_digest_tells_sources_of_kernels_from_others(tmp_path, monkeypatch):
    package = tmp_path / "dilatedem"
    shutil.copytree(Path(dilatedem.__file__).parent, package, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(cache, "_PACKAGE", package)
    before = cache.source_digest()
    for other in ("post/report/page.py", "cli.py", "structures/pile.py"):
        (package / other).write_text("")
    assert cache.source_digest() == before
    digests = {before}
    for source in ("contact/friction.py", "structures/record.py", "errors.py"):
        (package / source).write_text("")
        digests.add(cache.source_digest())
    assert len(digests) == 4


def test_a_place_that_the_user_chose_has_a_folder_per_state_of_the_sources_too(tmp_path):
    """Code of other sources once was taken from there: numba looks at the file of the outermost function alone."""
    program = "from dilatedem.jit import cache; import numba, os; print(numba.config.CACHE_DIR, os.environ['NUMBA_CACHE_DIR'])"
    folder = tmp_path / cache.source_digest()
    for given in (tmp_path, folder):  # the second: by a parent process, which had chosen already
        environment = os.environ | {"NUMBA_CACHE_DIR": str(given)}
        told = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=True)
        assert told.stdout.split() == [str(folder)] * 2


SHOW = (
    "import os, sys, tempfile\ntempfile.tempdir = sys.argv[1]\n"
    "from dilatedem.jit import cache\nprint(os.environ['NUMBA_CACHE_DIR'])"
)


def chosen_folder(temporary: Path, home: str = "/dev/null") -> Path:
    """Where a new process keeps machine code; without a usable home unless one is given."""
    left_out = ("NUMBA_CACHE_DIR", "XDG_CACHE_HOME")
    told = {name: value for name, value in os.environ.items() if name not in left_out} | {"HOME": home}
    command = [sys.executable, "-c", SHOW, str(temporary)]
    return Path(subprocess.run(command, env=told, capture_output=True, text=True, check=True).stdout.strip())


def test_without_a_home_machine_code_lies_in_a_folder_of_this_user_alone(tmp_path):
    tmp_path.chmod(0o1777)
    folder = chosen_folder(tmp_path)
    assert folder == tmp_path / f"dilatedem-{os.getuid()}" / cache.source_digest()
    assert [path.stat().st_mode & 0o777 for path in (folder, folder.parent)] == [0o700, 0o700]
    assert chosen_folder(tmp_path) == folder


@pytest.mark.parametrize("trap", ["open to all", "link", "code open to all", "link to code", "file", "shared without sticky bit"])
def test_a_folder_that_anybody_may_have_made_is_not_used(trap, tmp_path):
    temporary, elsewhere = tmp_path / "tmp", tmp_path / "elsewhere"
    place = temporary / f"dilatedem-{os.getuid()}"
    for folder in (temporary, elsewhere):
        folder.mkdir()
    temporary.chmod(0o777 if trap == "shared without sticky bit" else 0o1777)
    elsewhere.chmod(0o700)
    code = place / cache.source_digest()
    if trap == "open to all":
        place.mkdir()
        place.chmod(0o777)
    elif trap == "link":
        place.symlink_to(elsewhere)
    elif trap == "code open to all":
        place.mkdir(mode=0o700)
        code.mkdir()
        code.chmod(0o777)
    elif trap == "link to code":
        place.mkdir(mode=0o700)
        code.symlink_to(elsewhere)
    elif trap == "file":
        place.write_text("mine")
    folder = chosen_folder(temporary)
    assert place not in (folder, *folder.parents) and elsewhere not in (folder, *folder.parents)
    assert not folder.exists()  # it was fresh, and went with its process
    assert list(elsewhere.iterdir()) == []


def test_a_folder_of_somebody_else_is_not_used(tmp_path, monkeypatch):
    monkeypatch.setattr(cache.tempfile, "gettempdir", lambda: str(tmp_path))
    monkeypatch.setattr(cache.tempfile, "mkdtemp", lambda prefix: str(tmp_path / "fresh"))
    monkeypatch.setenv("XDG_CACHE_HOME", "/dev/null")
    user = os.getuid()
    (tmp_path / f"dilatedem-{user + 1}").mkdir(mode=0o700)  # of `user`, where `user + 1` looks for his own
    monkeypatch.setattr(cache.os, "getuid", lambda: user + 1)
    assert cache._cache_folder() == tmp_path / "fresh"


def test_the_folder_in_the_users_cache_is_closed_to_others(tmp_path):
    place = tmp_path / ".cache" / "dilatedem"
    place.mkdir(parents=True)
    place.chmod(0o775)  # as an earlier version made it for a user whose new files are his group's
    folder = chosen_folder(tmp_path / "none", str(tmp_path))
    assert folder == place / cache.source_digest()
    assert place.stat().st_mode & 0o777 == 0o700 == folder.stat().st_mode & 0o777


def test_a_disk_that_takes_no_machine_code_costs_the_next_run_its_time(monkeypatch, tmp_path):
    def fail(*arguments):
        raise OSError(28, "No space left on device")

    kept = SimpleNamespace(save_overload=fail, load_overload=fail, cache_path=str(tmp_path / "code"))
    tend_cache(SimpleNamespace(_cache=kept))
    assert kept.save_overload(1, 2) is None and kept.load_overload(1, 2) is None
