"""Files that are replaced as a whole."""

import errno
import os

import pytest

from dilatedem.files import atomic
from dilatedem.files.atomic import write_bytes, write_text


def test_the_new_file_takes_the_place_of_the_old_one(tmp_path):
    path = tmp_path / "summary.json"
    write_text(path, "größer")
    write_bytes(path, b"new", durable=True)
    assert path.read_bytes() == b"new" and list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("call", ["open", "write", "fsync", "replace"])
def test_a_fault_leaves_the_old_file_and_names_it(call, tmp_path, monkeypatch):
    path = tmp_path / "restart.h5"
    path.write_text("old")

    def fail(*arguments, **more):
        raise OSError(errno.ENOSPC, "a paragraph")

    monkeypatch.setattr(atomic.os, call, fail)
    with pytest.raises(OSError) as fault:
        write_bytes(path, b"new", durable=True)
    monkeypatch.undo()
    assert (fault.value.errno, fault.value.filename) == (errno.ENOSPC, str(path))
    assert path.read_text() == "old" and list(tmp_path.iterdir()) == [path]


def test_a_write_that_takes_a_part_is_gone_on_with(tmp_path, monkeypatch):
    write = os.write
    monkeypatch.setattr(atomic.os, "write", lambda descriptor, data: write(descriptor, data[:3]))
    write_bytes(tmp_path / "a", b"0123456789")
    assert (tmp_path / "a").read_bytes() == b"0123456789"


def test_nothing_is_written_through_a_link(tmp_path):
    (tmp_path / "mine").write_text("mine")
    (tmp_path / "restart.h5.tmp").symlink_to(tmp_path / "mine")
    with pytest.raises(OSError) as fault:
        write_bytes(tmp_path / "restart.h5", b"new")
    assert fault.value.errno == errno.ELOOP
    assert (tmp_path / "mine").read_text() == "mine" and (tmp_path / "restart.h5.tmp").is_symlink()
