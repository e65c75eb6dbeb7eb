"""What all tests share: threads that wait asleep, kernels compiled once, and runs that several tests read but never change."""

import os
import sys
from functools import partial
from pathlib import Path

import pytest

# before any thread starts: two even on a machine of one core, and asleep while they wait; as many processes as cores run tests, and
# threads that spin would take the core from the thread they wait for
os.environ.setdefault("NUMBA_NUM_THREADS", str(max(2, os.cpu_count() or 1)))
os.environ.setdefault("OMP_WAIT_POLICY", "PASSIVE")

CASES = Path(__file__).parent / "cases"


@pytest.fixture(scope="session", autouse=True)
def kernels_compiled_once(request, tmp_path_factory):
    """Of several processes that need a kernel one compiles it, and the others load it.

    A session of all tests needs the step in all its kinds: the processes share them out at its start, where none has to wait.
    """
    if "numba" not in sys.modules:  # nor will it be but for the runs below, which one process makes
        yield
        return
    from dilatedem.run.loop import compile_kernels
    from dilatedem.state.setting import CONTACT_SETTINGS
    from tests.shared_work import common_folder, compiled_in_turn, share_out

    folder = common_folder(tmp_path_factory) / "compiling"
    with compiled_in_turn(folder):
        if any(item.path.name == "test_resume_matrix.py" for item in request.session.items):
            kinds = [(threads, model) for threads in (1, 2) for model in sorted({name for name, _ in CONTACT_SETTINGS})]
            share_out({f"{model}-{threads}": partial(compile_kernels, threads, model) for threads, model in kinds}, folder)
        yield


def _completed_run(tmp_path_factory, name: str) -> Path:
    from dilatedem.case.load import load
    from dilatedem.run import loop
    from tests.shared_work import common_folder, made_once

    return made_once(
        common_folder(tmp_path_factory) / "runs" / name, lambda out: loop.run(load(CASES / f"{name}.toml"), out, quiet=True)
    )


@pytest.fixture(scope="session")
def crowded(tmp_path_factory) -> Path:
    """Run folder of tests/cases/crowded.toml: floes against a pile, across a periodic seam."""
    return _completed_run(tmp_path_factory, "crowded")


@pytest.fixture(scope="session")
def mixed(tmp_path_factory) -> Path:
    """Run folder of tests/cases/mixed.toml: bodies of every shape, walls, a leaning plane, friction."""
    return _completed_run(tmp_path_factory, "mixed")
