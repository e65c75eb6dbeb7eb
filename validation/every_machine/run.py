"""Whether a case comes out the same on other processors: one answer, to the byte, on every x86-64 machine.

`python validation/every_machine/run.py OUT` runs 12 s of the paper's case under both contact models, again and again, each time
with the libraries below the program told to work as on another processor, and writes README.md beside this file.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
SAME_BITS = HERE.parent / "same_bits" / "run.py"
CASE, SECONDS = "cases/pile.toml", 12


def numpy_without_vectors() -> str:
    """What NumPy may be told not to use: all that it would choose at run time and that this processor has."""
    core = np._core._multiarray_umath
    return " ".join(name for name in core.__cpu_dispatch__ if core.__cpu_features__.get(name))


#: what is told, and how; the last line tells all at once
TOLD = {
    "nothing: this processor as it is": {},
    "OpenBLAS: Haswell": {"OPENBLAS_CORETYPE": "Haswell"},
    "OpenBLAS: Sandybridge": {"OPENBLAS_CORETYPE": "Sandybridge"},
    "OpenBLAS: Prescott": {"OPENBLAS_CORETYPE": "Prescott"},
    "NumPy: none of its vector code": {"NPY_DISABLE_CPU_FEATURES": numpy_without_vectors()},
    "C library: no AVX2, no FMA": {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F"},
    "Numba: code for Haswell": {"NUMBA_CPU_NAME": "haswell", "NUMBA_CPU_FEATURES": ""},
    "Numba: code for Nehalem": {"NUMBA_CPU_NAME": "nehalem", "NUMBA_CPU_FEATURES": ""},
}
TOLD["all of this: a processor of 2009"] = {name: value for told in TOLD.values() for name, value in told.items()}


def recorded(out: Path, told: dict[str, str]) -> tuple[dict[str, str], float]:
    """Digests of all files of both runs, and how long they took [s]."""
    begun = time.monotonic()
    command = [sys.executable, str(SAME_BITS), "record", str(out), "--case", CASE, "--set", f"time.duration={SECONDS}"]
    subprocess.run(command, check=True, env={**os.environ, **told})
    return json.loads((out / "digests.json").read_text(encoding="utf-8")), time.monotonic() - begun


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("out", type=Path, help="folder for the runs")
    out, first, lines = parser.parse_args().out, None, []
    for number, (text, told) in enumerate(TOLD.items()):
        digests, _ = recorded(out / str(number), told)
        first = first or digests
        differing = sum(digests.get(name) != digest for name, digest in first.items())
        lines.append(f"| {text} | {len(digests)} | {differing} |")
        print(lines[-1], flush=True)
    about = (
        "# One answer on every machine\n\n"
        f"`python validation/every_machine/run.py OUT`: {SECONDS} s of {CASE}, both contact models, with the libraries below\n"
        "the program told to work as on another processor; files compared byte for byte with those of the first line.\n\n"
        "| told | files | of them different |\n| --- | --- | --- |\n"
    )
    (HERE / "README.md").write_text(about + "\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
