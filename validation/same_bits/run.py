"""Whether two checkouts of the program give the same files, byte for byte: the proof of a change that should change no number.

`python validation/same_bits/run.py record OUT` runs every case under both contact models and writes a digest of each file;
`python validation/same_bits/run.py compare OLD NEW` says which digests differ. The program that runs is the one on PYTHONPATH.
"""

import argparse
import hashlib
import json
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CASES = (
    "cases/pile.toml", "cases/pile_small.toml", "tests/cases/crowded.toml", "tests/cases/mixed.toml", "tests/cases/soft_ball.toml",
)  # fmt: skip
MODELS = ("liu2015", "consistent")
#: what a simulation decides; run.h5, restart.h5 and summary.json hold versions and wall times besides
FILES = ("forces.csv", "energy.csv", "bodies.csv", "snapshots/*.vtu")
#: a case may stop under a model it was not made for: how far it came is compared as well
ENDS = (0, 3)


def record(out: Path, cases: list[str], settings: list[str]) -> None:
    """Run all cases into `out` and write digests.json there."""
    digests = {}
    for case in cases:
        for model in MODELS:
            folder = out / f"{Path(case).stem}-{model}"
            command = [sys.executable, "-m", "dilatedem.cli", "run", str(ROOT / case)]
            command += [word for setting in [f"contact.model={model}", *settings] for word in ("--set", setting)]
            ended = subprocess.run([*command, "--quiet", "--overwrite", "--out", str(folder)], check=False, env=os.environ)
            if ended.returncode not in ENDS:
                raise SystemExit(f"{case} with {model}: exit code {ended.returncode}")
            for file in sorted(file for pattern in FILES for file in folder.glob(pattern)):
                digests[f"{folder.name}/{file.relative_to(folder)}"] = hashlib.sha256(file.read_bytes()).hexdigest()
            print(f"{folder.name}: exit code {ended.returncode}", flush=True)
    (out / "digests.json").write_text(json.dumps(digests, indent=1), encoding="utf-8")


def compare(old: Path, new: Path) -> int:
    """Print what differs; returns how many files do."""
    before, after = (json.loads((folder / "digests.json").read_text(encoding="utf-8")) for folder in (old, new))
    runs = {name.split("/")[0] for name in after}
    before = {name: digest for name, digest in before.items() if name.split("/")[0] in runs}
    differing = sorted(name for name in before.keys() | after.keys() if before.get(name) != after.get(name))
    for name in differing:
        print(f"differs: {name}")
    print(f"{len(after)} files of {len(runs)} runs: {len(differing)} differ")
    return len(differing)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("action", choices=("record", "compare"))
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--case", action="append", help="only these cases; again for more")
    parser.add_argument(
        "--set", action="append", default=[], help="changes a key of all cases, as of `dilatedem run`; again for more"
    )
    given = parser.parse_args()
    if given.action == "record":
        record(given.folders[0], given.case or list(CASES), given.set)
    else:
        sys.exit(compare(*given.folders) > 0)


if __name__ == "__main__":
    main()
