"""`jit.prefetch` reads and writes nothing, whatever the layout of the array; kernels hide their functions from each other;
`jit.rare` keeps a function out of those that call it."""

import fcntl
import re
import shutil
import threading
from pathlib import Path

import numba
import numpy as np
import pytest

from dilatedem.jit import CACHE_LINE, LOCK, device, item, kernel, prange, prefetch, rare, shared_loop
from dilatedem.state.pairs import empty_pairs
from dilatedem.step.blocks import PAIR_LINES


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
    for i in range(block, len(array), 2):
        total += np.exp(np.sin(array[i])) / (1.0 + np.cosh(array[i])) ** 1.5
    for i in range(block, len(array), 2):
        total -= np.exp(np.cos(array[i])) / (1.0 + np.sinh(array[i]) ** 2) ** 2.5
    return total


@shared_loop
def _sum_blocks(array, sums):
    for block in prange(2):
        sums[block] = _sum_of_block(array, 2, block)


@kernel
def summed_together(array, sums):
    _sum_blocks(array, sums)
    return sums[0] + sums[1]


def test_a_kernel_shows_the_linker_nothing_but_itself():
    """The linker takes functions of one name for the same: optimised as parts of their kernels they no longer are."""
    summed_together(np.ones(4), np.zeros(2))
    summed_together.recompile()  # code that comes from the disk cannot be read
    (code,) = summed_together.inspect_asm().values()
    functions = re.findall(r"\.type\s+(\S+),@function", code)
    shown = [name for name in functions if not name.startswith(".L")]
    assert len(functions) > len(shown) == 3 and all("summed_together" in name for name in shown)


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


@rare
def seldom(x):
    return x * x


@device
def often(x):
    return 2.0 * x


@item
def halved(x):
    return seldom(x) if x < 0.0 else often(0.5 * x)


@kernel
def sum_halved(array):
    total = 0.0
    for i in range(len(array)):
        total += halved(array[i])
    return total


def test_what_is_rare_stays_out_of_the_code_that_calls_it():
    assert sum_halved(np.array([1.0, -3.0])) == 10.0
    sum_halved.recompile()
    labels = [line for code in sum_halved.inspect_asm().values() for line in code.splitlines() if line.endswith(":")]
    assert any("6seldom" in label for label in labels) and not any("5often" in label for label in labels)
