"""Fields of all recipes come out alike to the last digit on every processor, as `test_every_machine` has it for runs."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from test_every_machine import numpy_without_vectors


@pytest.mark.skipif(sys.platform != "linux", reason="other C libraries")
def test_fields_of_all_recipes_are_alike_without_vector_code():
    told = {"NPY_DISABLE_CPU_FEATURES": numpy_without_vectors(), "OPENBLAS_CORETYPE": "Prescott"}
    child = str(Path(__file__).parent / "every_field.py")
    found = [
        subprocess.run([sys.executable, child], env={**os.environ, **more}, capture_output=True, text=True, check=True).stdout
        for more in ({}, told)
    ]
    assert found[0] == found[1] and len(found[0].splitlines()) == 6
