import subprocess
import sys
from typing import NamedTuple

import h5py
import numpy as np
import pytest

from dilatedem.errors import CaseError
from dilatedem.output import checkpoint


class Motion(NamedTuple):
    position: np.ndarray
    count: np.ndarray
    awake: np.ndarray
    empty: np.ndarray
    short: np.ndarray


class Clock(NamedTuple):
    time: float
    step: int
    running: bool
    law: str


def state():
    rng = np.random.default_rng(3)
    odd = np.array([0.1, -0.0, np.inf, np.nan, 5e-324, np.nextafter(1.0, 2.0)])
    nan_with_payload = np.array([0x7FF8000000000123], dtype=np.uint64).view(np.float64)
    position = np.concatenate([rng.normal(size=44), odd, nan_with_payload]).reshape(17, 3)
    motion = Motion(
        position,
        np.array([2**62, -1], dtype=np.int64),
        np.array([[True, False]]),
        np.zeros((0, 3)),
        np.array([0.1], dtype=np.float32),
    )
    return motion, Clock(0.1 + 0.2, 2**53 + 1, True, "hertz, größer")


def test_round_trip_is_bit_exact(tmp_path):
    motion, clock = state()
    meta = {"step": 2**53 + 1, "offsets": {"forces.csv": 123}, "time": 0.1 + 0.2, "text": "é"}
    checkpoint.save(tmp_path / "restart.h5", {"motion": motion, "clock": clock}, meta)
    groups, found_meta = checkpoint.load(tmp_path / "restart.h5")
    assert found_meta == meta
    assert list(tmp_path.iterdir()) == [tmp_path / "restart.h5"]
    restored = checkpoint.restore(Motion, groups["motion"])
    for given, found in zip(motion, restored, strict=True):
        assert found.dtype == given.dtype and found.shape == given.shape
        assert found.tobytes() == given.tobytes()
    found = checkpoint.restore(Clock, groups["clock"])
    assert found == clock
    assert [type(value) for value in found] == [float, int, bool, str]


def test_an_unfinished_write_leaves_the_old_checkpoint(tmp_path):
    motion, clock = state()
    path = tmp_path / "restart.h5"
    checkpoint.save(path, {"clock": clock}, {"step": 1})
    whole = path.read_bytes()
    leftover = tmp_path / "restart.h5.tmp"
    leftover.write_bytes(whole[: len(whole) // 2])  # killed while writing
    assert checkpoint.load(path)[1] == {"step": 1}
    checkpoint.save(path, {"clock": clock, "motion": motion}, {"step": 2})
    assert checkpoint.load(path)[1] == {"step": 2}
    assert not leftover.exists()


def test_a_failed_write_leaves_the_old_checkpoint(tmp_path):
    class Wrong(NamedTuple):
        names: list

    path = tmp_path / "restart.h5"
    checkpoint.save(path, {"clock": state()[1]}, {"step": 1})
    with pytest.raises(TypeError, match="names"):
        checkpoint.save(path, {"wrong": Wrong(["a"])}, {"step": 2})
    assert checkpoint.load(path)[1] == {"step": 1}
    assert list(tmp_path.iterdir()) == [path]


def test_killed_at_any_moment_the_checkpoint_is_whole(tmp_path):
    # A process that does nothing but save is killed while it does so.
    program = (
        "import sys\nfrom typing import NamedTuple\nimport numpy as np\n"
        "from dilatedem.output import checkpoint\n"
        "class A(NamedTuple):\n    x: np.ndarray\n"
        "n = 0\n"
        "while True:\n"
        "    checkpoint.save(sys.argv[1], {'a': A(np.full(20000, float(n)))}, {'n': n})\n"
        "    n += 1\n"
        "    if n == 3: print('ready', flush=True)\n"
    )
    path = tmp_path / "restart.h5"
    for _ in range(2):
        process = subprocess.Popen([sys.executable, "-c", program, str(path)], stdout=subprocess.PIPE)
        process.stdout.readline()
        process.kill()
        process.wait()
        process.stdout.close()
        groups, meta = checkpoint.load(path)
        assert np.all(groups["a"]["x"] == meta["n"])


def test_faults_are_one_sentence(tmp_path):
    path = tmp_path / "restart.h5"
    with pytest.raises(CaseError, match="no checkpoint"):
        checkpoint.load(path)
    checkpoint.save(path, {"clock": state()[1]}, {})
    whole = path.read_bytes()
    path.write_bytes(whole[:-200])
    with pytest.raises(CaseError, match="is damaged"):
        checkpoint.load(path)
    path.write_bytes(b"")
    with pytest.raises(CaseError, match="is damaged"):
        checkpoint.load(path)


def test_fields_of_another_version_are_named():
    with pytest.raises(CaseError, match="lacks law and has unknown laws: .*another version"):
        checkpoint.restore(Clock, {"time": 0.0, "step": 1, "running": True, "laws": "x"})


def test_a_file_of_another_format_is_refused_by_its_number(tmp_path):
    path = tmp_path / "restart.h5"
    with h5py.File(path, "w") as file:  # as the first format was
        file.attrs["format"] = 1
        file.attrs["meta"] = "{}"
        file["clock/step"] = np.zeros(1)
    with pytest.raises(CaseError, match="is damaged, or written by another version"):
        checkpoint.load(path)
    path.write_bytes(b"whatever it holds" + b"dilatedem checkpoint 5 sha256 " + 64 * b"0" + b"\n")
    with pytest.raises(CaseError, match="checkpoint format 5, but this version reads 4"):
        checkpoint.load(path)


def test_meta_may_be_long(tmp_path):
    snapshots = [[0.1 * n, f"snapshots/ice_{n:06d}.vtu"] for n in range(5000)]
    checkpoint.save(tmp_path / "restart.h5", {}, {"snapshots": snapshots})
    assert checkpoint.load(tmp_path / "restart.h5") == ({}, {"snapshots": snapshots})


def test_a_large_state_is_written_in_parts(tmp_path, monkeypatch):
    monkeypatch.setattr(checkpoint, "PART_BYTES", 100)
    motion, clock = state()
    checkpoint.save(tmp_path / "restart.h5", {"motion": motion, "clock": clock, "again": motion}, {})
    groups, _ = checkpoint.load(tmp_path / "restart.h5")
    for name in ("motion", "again"):
        for given, found in zip(motion, checkpoint.restore(Motion, groups[name]), strict=True):
            assert (found.dtype, found.shape, found.tobytes()) == (given.dtype, given.shape, given.tobytes())


def test_no_damaged_file_is_read_as_a_checkpoint(tmp_path):
    """Bits turned, ends cut off, blocks of zeros, bytes put in: 200 of them, none of which HDF5 ever sees."""
    motion, clock = state()
    path, random = tmp_path / "restart.h5", np.random.default_rng(7)
    checkpoint.save(path, {"motion": motion, "clock": clock}, {"step": 3})
    whole = path.read_bytes()
    for number in range(200):
        data, at = bytearray(whole), int(random.integers(len(whole)))
        match number % 4:
            case 0:
                data[at] ^= 1 << int(random.integers(8))
            case 1:
                del data[at:]
            case 2:
                data[at : at + 64] = bytes(b ^ 0xFF for b in data[at : at + 64])
            case 3:
                data.insert(at, 0)
        path.write_bytes(data)
        with pytest.raises(CaseError, match="restart.h5: (is damaged|checkpoint format)"):
            checkpoint.load(path)


def test_a_full_disk_never_meets_hdf5(tmp_path, monkeypatch):
    """The file is whole in memory before the first byte of it is written."""
    opened = []
    monkeypatch.setattr(checkpoint.h5py, "File", lambda name, *more, File=h5py.File: opened.append(name) or File(name, *more))
    checkpoint.save(tmp_path / "restart.h5", {"clock": state()[1]}, {})
    checkpoint.load(tmp_path / "restart.h5")
    assert len(opened) == 2 and not any(isinstance(name, str) or hasattr(name, "__fspath__") for name in opened)
