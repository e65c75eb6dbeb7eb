"""Runs that several tests read: each made once a session, and never changed by a test."""

from pathlib import Path

import pytest

CASES = Path(__file__).parent / "cases"


def _completed_run(tmp_path_factory, name: str) -> Path:
    from dilatedem.case.load import load
    from dilatedem.run import loop

    return loop.run(load(CASES / f"{name}.toml"), tmp_path_factory.mktemp("runs") / name, quiet=True)


@pytest.fixture(scope="session")
def crowded(tmp_path_factory) -> Path:
    """Run folder of tests/cases/crowded.toml: floes against a pile, across a periodic seam."""
    return _completed_run(tmp_path_factory, "crowded")


@pytest.fixture(scope="session")
def mixed(tmp_path_factory) -> Path:
    """Run folder of tests/cases/mixed.toml: bodies of every shape, walls, a leaning plane, friction."""
    return _completed_run(tmp_path_factory, "mixed")
