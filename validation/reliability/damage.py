"""Run folders as no run leaves them: files cut, stirred, emptied, of another kind; values of other types; times that go back."""

import json
import random
from collections.abc import Callable, Iterator
from pathlib import Path

import h5py
import numpy as np

Damage = Callable[[Path], None]
CELLS = ["nan", "inf", "-inf", "1e999", "", "x", "-1", "0", "1e308", '"', "\x00", "\x1b[31m"]
VALUES = ["x", -1, 0, 10**30, 1e300, None, True, [], {}, [1], {"a": 1}, float("nan"), float("inf"), [[[]]], "\u001b[31m"]
WORDS = ['"x"', "-1", "0", "1e300", "nan", "inf", "true", "[]", "[1]", "{}", "{a = 1}", "[{a = 1}]", '"\\u001b[31m"', "9" * 18]


def damages(count: int, seed: int) -> Iterator[tuple[str, Damage]]:
    """Ways to damage a folder, and what each does, in words; the same for one seed."""
    rng = random.Random(seed)
    for number in range(count):
        yield KINDS[number % len(KINDS)](random.Random(rng.random()))


def _file(rng: random.Random) -> str:
    return rng.choice(["case.toml", "summary.json", "forces.csv", "energy.csv", "run.h5", "ice.pvd", "snapshots/ice_000001.vtu"])


def _cut(rng: random.Random) -> tuple[str, Damage]:
    name, share = _file(rng), rng.random()

    def damage(folder: Path) -> None:
        content = (folder / name).read_bytes()
        (folder / name).write_bytes(content[: int(share * len(content))])

    return f"{name} cut at {share:.2f}", damage


def _junk(rng: random.Random) -> tuple[str, Damage]:
    contents = [b"", b"\n", b"\x00" * 100, b"[" * 3000, b"{" * 3000, rng.randbytes(2000), b"a,b\n1,2\n", b"[]"]
    name, content = _file(rng), rng.choice(contents)
    return f"{name} replaced by {content[:12]!r}", lambda folder: (folder / name).write_bytes(content) and None


def _cell(rng: random.Random) -> tuple[str, Damage]:
    name, cell, row, column = rng.choice(["forces.csv", "energy.csv"]), rng.choice(CELLS), rng.random(), rng.random()

    def damage(folder: Path) -> None:
        lines = (folder / name).read_text().splitlines()
        i = 1 + int(row * (len(lines) - 1))
        cells = lines[i].split(",")
        cells[int(column * len(cells))] = cell
        lines[i] = ",".join(cells)
        (folder / name).write_text("\n".join(lines) + "\n")

    return f"{name}: a cell of {cell!r}", damage


def _column(rng: random.Random) -> tuple[str, Damage]:
    name, column, rename = rng.choice(["forces.csv", "energy.csv"]), rng.random(), rng.random() < 0.5

    def damage(folder: Path) -> None:
        rows = [line.split(",") for line in (folder / name).read_text().splitlines()]
        k = int(column * len(rows[0]))
        if rename:
            rows[0][k] = rng.choice(["x", rows[0][0], ""])
        else:
            rows = [row[:k] + row[k + 1 :] for row in rows]
        (folder / name).write_text("\n".join(map(",".join, rows)) + "\n")

    return f"{name}: a column {'renamed' if rename else 'missing'}", damage


def _backwards(rng: random.Random) -> tuple[str, Damage]:
    name, whole = rng.choice(["forces.csv", "energy.csv"]), rng.random() < 0.5

    def damage(folder: Path) -> None:
        header, *rows = (folder / name).read_text().splitlines()
        i = len(rows) // 2
        rows = rows[::-1] if whole else [*rows[:i], rows[0], *rows[i:]]
        (folder / name).write_text("\n".join([header, *rows]) + "\n")

    return f"{name}: times go back", damage


def _case_value(rng: random.Random) -> tuple[str, Damage]:
    place, word = rng.random(), rng.choice(WORDS)

    def damage(folder: Path) -> None:
        lines = (folder / "case.toml").read_text().splitlines()
        keys = [i for i, line in enumerate(lines) if " = " in line]
        i = keys[int(place * len(keys))]
        lines[i] = f"{lines[i].partition(' = ')[0]} = {word}"
        (folder / "case.toml").write_text("\n".join(lines) + "\n")

    return f"case.toml: a value of {word}", damage


def _summary_value(rng: random.Random) -> tuple[str, Damage]:
    place, value = rng.random(), rng.choice(VALUES)

    def damage(folder: Path) -> None:
        summary = json.loads((folder / "summary.json").read_text())
        owners = [summary, *(item for item in summary.values() if isinstance(item, dict)), *summary["loads"].values()]
        keys = [(owner, name) for owner in owners for name in owner]
        owner, name = keys[int(place * len(keys))]
        owner[name] = value
        (folder / "summary.json").write_text(json.dumps(summary))

    return f"summary.json: a value of {value!r}", damage


def _hdf5(rng: random.Random) -> tuple[str, Damage]:
    place, act = rng.random(), rng.choice(["gone", "text", "nan", "shape"])

    def damage(folder: Path) -> None:
        with h5py.File(folder / "run.h5", "a") as file:
            names: list[str] = []
            file.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
            name = sorted(names)[int(place * len(names))]
            values = file[name][()]
            del file[name]
            if act == "text":
                file[name] = "x"
            elif act == "nan":
                file[name] = np.full(np.shape(values), np.nan)
            elif act == "shape":
                file[name] = np.zeros((3, 1, 2))

    return f"run.h5: a data set {act}", damage


#: in turn, those with more variants more often
KINDS = (
    _cut, _junk, _cell, _cell, _cell, _column, _backwards, _case_value, _case_value, _summary_value, _summary_value, _hdf5, _hdf5,
)  # fmt: skip
