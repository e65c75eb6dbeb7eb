"""Files that are replaced as a whole."""

import pytest

from dilatedem.output.atomic import replacing


def test_a_fault_leaves_the_old_file_and_names_it(tmp_path):
    path = tmp_path / "restart.h5"
    path.write_text("old")
    with pytest.raises(OSError, match="restart.h5") as fault, replacing(path) as temporary:
        temporary.write_text("new")
        raise OSError(28, "No space left on device")
    assert fault.value.filename == str(path)
    assert path.read_text() == "old" and list(tmp_path.iterdir()) == [path]
