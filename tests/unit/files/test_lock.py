"""One process at a time in a folder."""

import errno
import pathlib
import subprocess
import sys
import time

import pytest

from dilatedem.errors import CaseError
from dilatedem.files import lock
from dilatedem.files.lock import LOCK, Lock, in_use, was_used

HOLD = (
    "import sys, time\nfrom dilatedem.files.lock import Lock\n"
    "with Lock(sys.argv[1]) as lock:\n    lock.keep()\n    print('held', flush=True)\n    time.sleep(60)\n"
)


def test_a_second_process_is_refused_until_the_first_one_is_killed(tmp_path):
    holder = subprocess.Popen([sys.executable, "-c", HOLD, str(tmp_path / "run")], stdout=subprocess.PIPE)
    assert holder.stdout.readline() == b"held\n"
    assert in_use(tmp_path / "run")
    with pytest.raises(CaseError, match="run: another process is at work in it; wait for its end or choose another --out"):
        with Lock(tmp_path / "run"):
            pass
    holder.kill()
    holder.communicate()
    assert not in_use(tmp_path / "run") and was_used(tmp_path / "run")
    with Lock(tmp_path / "run"):
        assert in_use(tmp_path / "run")  # another descriptor in this process is another owner


def test_what_was_not_used_is_left_as_it_was(tmp_path):
    with Lock(tmp_path / "a" / "b"):
        assert (tmp_path / "a" / "b" / LOCK).exists() and not was_used(tmp_path / "a" / "b")
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(ZeroDivisionError), Lock(tmp_path / "a" / "b"):
        raise ZeroDivisionError
    assert list(tmp_path.iterdir()) == []
    with Lock(tmp_path / "a") as held:
        held.keep()
    with Lock(tmp_path / "a"):
        pass
    assert [path.name for path in (tmp_path / "a").iterdir()] == [LOCK]


def test_a_lock_file_that_its_owner_removed_is_made_anew(tmp_path, monkeypatch):
    """Between opening and locking it: the lock of a file that is gone keeps nobody out."""
    opened, calls = lock.open_file, []

    def open_then_lose(path, flags):
        descriptor = opened(path, flags)
        if not calls:
            path.unlink()
        calls.append(path)
        return descriptor

    monkeypatch.setattr(lock, "open_file", open_then_lose)
    with Lock(tmp_path):
        assert len(calls) == 2 and (tmp_path / LOCK).exists()


def test_a_folder_that_its_owner_removed_is_made_anew(tmp_path, monkeypatch):
    """Between the attempt to make it and the look at what is there."""
    make, calls = pathlib.Path.mkdir, []

    def make_late(path, *arguments, **options):
        calls.append(path)
        if len(calls) == 1:
            raise FileExistsError(errno.EEXIST, "it was there", str(path))
        make(path, *arguments, **options)

    monkeypatch.setattr(pathlib.Path, "mkdir", make_late)
    with Lock(tmp_path / "run"):
        assert len(calls) > 1 and (tmp_path / "run" / LOCK).exists()


@pytest.mark.parametrize("there", ["a", "a/b"])
def test_a_file_in_place_of_a_folder_is_no_folder(tmp_path, there):
    (tmp_path / there).parent.mkdir(exist_ok=True)
    (tmp_path / there).write_text("mine")
    with pytest.raises(OSError), Lock(tmp_path / "a" / "b"):
        pass
    assert (tmp_path / there).read_text() == "mine"


def test_a_file_system_without_locks_is_worked_on_without(tmp_path, monkeypatch):
    def no_locks(descriptor, what):
        raise OSError(errno.ENOLCK, "no locks")

    monkeypatch.setattr(lock.fcntl, "flock", no_locks)
    with Lock(tmp_path), Lock(tmp_path):
        assert not in_use(tmp_path)


def test_a_link_is_no_lock(tmp_path):
    (tmp_path / "mine").write_text("mine")
    (tmp_path / LOCK).symlink_to(tmp_path / "mine")
    with pytest.raises(OSError), Lock(tmp_path):
        pass
    assert (tmp_path / "mine").read_text() == "mine" and not was_used(tmp_path)


def test_of_many_processes_one_at_a_time_works(tmp_path):
    program = (
        "import sys, time, pathlib\nfrom dilatedem.errors import CaseError\nfrom dilatedem.files.lock import Lock\n"
        "folder, end = pathlib.Path(sys.argv[1]), time.monotonic() + 1.5\n"
        "while time.monotonic() < end:\n"
        "    try:\n"
        "        with Lock(folder / 'run'):\n"
        "            (folder / 'here').mkdir()\n            time.sleep(0.001)\n            (folder / 'here').rmdir()\n"
        "    except CaseError:\n        pass\n"
    )
    began = time.monotonic()
    crowd = [subprocess.Popen([sys.executable, "-c", program, str(tmp_path)], stderr=subprocess.PIPE) for _ in range(3)]
    said = [process.communicate()[1].decode() for process in crowd]
    assert time.monotonic() - began > 1.0
    assert said == ["", "", ""]
