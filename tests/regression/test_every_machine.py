"""One answer on every x86-64 machine: the libraries below the program are told to work as on other processors, and nothing changes.

On another processor OpenBLAS and NumPy's vector code round the last digit in another way, and a minute later the floes stand
elsewhere. validation/every_machine has the same for 12 s of the paper's case, and for the C library and Numba's machine code.
"""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

CHILD = Path(__file__).parent / "every_machine.py"
CASE = Path(__file__).parents[1] / "cases" / "crowded.toml"
MODELS = ("liu2015", "consistent")
#: what `every_machine.py` prints, recorded; a change of the numbers, which CHANGELOG tells of, records it anew
RECORDED = (Path(__file__).parent / "every_machine.txt").read_text(encoding="utf-8")


def numpy_without_vectors() -> str:
    """What NumPy may be told not to use: all that it would choose at run time and that this processor has."""
    core = np._core._multiarray_umath
    return " ".join(name for name in core.__cpu_dispatch__ if core.__cpu_features__.get(name))


@pytest.mark.skipif(sys.platform != "linux", reason="other C libraries")
@pytest.mark.parametrize(
    "told",
    [
        {},
        {"OPENBLAS_CORETYPE": "Haswell"},
        {"OPENBLAS_CORETYPE": "Sandybridge"},
        {"OPENBLAS_CORETYPE": "Prescott"},
        {"NPY_DISABLE_CPU_FEATURES": numpy_without_vectors(), "OPENBLAS_CORETYPE": "Prescott"},
    ],
    ids=["as it is", "Haswell", "Sandybridge", "Prescott", "no vectors"],
)
def test_the_field_and_two_seconds_of_both_models_are_what_they_were_recorded_to_be(told):
    environment = {**os.environ, **told}
    done = subprocess.run(
        [sys.executable, str(CHILD), str(CASE), *MODELS], env=environment, capture_output=True, text=True, check=True
    )  # fmt: skip
    assert done.stdout == RECORDED
