"""Compiled code allocates nothing, and every function of it was compiled by the decorators of `dilatedem.jit`."""

import importlib
import os
import pkgutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from numba.core.errors import NumbaError
from numba.core.registry import CPUDispatcher

import dilatedem
from dilatedem.jit import Alone, Team, by_type, device, is_cached, kernel

KERNEL_PACKAGES = ("numerics", "state", "contact", "water", "motion", "step", "structures")


def compiled_functions() -> dict[str, CPUDispatcher]:
    found = {}
    for package in KERNEL_PACKAGES:
        for module in pkgutil.walk_packages([f"{dilatedem.__path__[0]}/{package}"], f"dilatedem.{package}."):
            for name, item in vars(importlib.import_module(module.name)).items():
                if isinstance(item, CPUDispatcher) and item.py_func.__module__ == module.name:
                    found[f"{module.name}.{name}"] = item
    return found


def test_every_kernel_is_compiled_without_the_runtime_that_allocates():
    functions = compiled_functions()
    assert len(functions) > 50 and "dilatedem.step.advance.advance" in functions
    allocating = [name for name, function in functions.items() if function.targetoptions.get("_nrt", True)]
    assert not allocating, "compile them by dilatedem.jit: kernel, device, item or shared_loop"


def test_kernels_trade_no_exactness_for_speed_and_divide_like_numpy():
    for name, function in compiled_functions().items():
        assert not function.targetoptions.get("fastmath"), name
        assert function.targetoptions.get("error_model") == "numpy", name
        assert function.targetoptions.get("inline", "never") == "never", f'{name}: inline="always" loses writes'


def test_no_compiled_function_calls_a_kernel():
    functions = compiled_functions()
    kernels = {name: function for name, function in functions.items() if function._cache.cache_path is not None}
    assert "dilatedem.step.advance.advance" in kernels and len(kernels) < 10
    for name, function in functions.items():
        called = [function.py_func.__globals__.get(word) for word in function.py_func.__code__.co_names]
        assert not [other for other, each in kernels.items() if any(each is word for word in called)], name


def test_a_kernel_that_allocates_does_not_compile():
    @kernel
    def copies(values):
        return values.copy()[0]

    with pytest.raises(NumbaError, match="NRT"):
        copies(np.ones(3))


@pytest.mark.parametrize("before", ["", "import numba; ", "import numba.core.registry; "])
def test_compiled_code_lies_in_the_folder_of_its_sources_whoever_imports_numba_first(before, tmp_path):
    """Beside the sources it would outlive a change in what a kernel calls, and give the answers of yesterday."""
    program = f"{before}from dilatedem import jit; from dilatedem.step.advance import advance; print(advance.stats.cache_path)"
    environment = {name: value for name, value in os.environ.items() if name != "NUMBA_CACHE_DIR"}
    environment |= {"XDG_CACHE_HOME": str(tmp_path), "PYTHONPATH": str(Path(dilatedem.__path__[0]).parent)}
    told = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=True)
    assert told.stdout.startswith(f"{tmp_path}/dilatedem/")


@kernel
def _threads(team):
    return team.threads


def test_machine_code_counts_as_there_only_for_the_same_kinds_of_arguments(tmp_path, monkeypatch):
    """The message that something is being compiled comes where it is, not only where nothing was ever compiled."""
    monkeypatch.setattr(_threads._cache._cache_file, "_index_path", str(tmp_path / "index.nbi"))
    monkeypatch.setattr(_threads._cache._cache_file, "_cache_path", str(tmp_path))
    _threads(Alone())
    assert is_cached(_threads, Alone()) and not is_cached(_threads, Team(2))


def test_what_runs_is_chosen_by_the_type_of_the_first_argument():
    @device
    def one(team):
        return 1

    @device
    def several(team):
        return 2

    chosen = by_type(one, {Team: several})

    @kernel
    def runs(team):
        return chosen(team)

    assert (runs(Alone()), runs(Team(1))) == (1, 2)
    with pytest.raises(TypeError, match="only compiled code"):
        chosen(Alone())


def test_kernels_say_in_their_first_lines_what_they_do():
    """Names that the method is made of carry a docstring; small private functions may go without."""
    silent = [
        name for name, function in compiled_functions().items()
        if not function.py_func.__doc__ and not name.rsplit(".", 1)[1].startswith("_") and ".numerics." not in name
    ]  # fmt: skip
    assert len(silent) <= len(compiled_functions()) // 4, silent
