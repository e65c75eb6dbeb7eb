import json
import math

import numpy as np
import pytest

from dilatedem.output.folder import holds_run, snapshot_name
from dilatedem.output.summary import versions, write_summary


def test_numbers_of_all_kinds(tmp_path):
    path = tmp_path / "summary.json"
    write_summary(
        path,
        {
            "status": "running",
            "title": "Eis am Pfahl, größer",
            "steps": np.int64(3),
            "loads": {"pile": {"fx_max_N": np.float64(1.5), "fh_max_time_s": math.nan}},
            "mean": np.array([1.0, np.inf]),
            "open": np.bool_(True),
            "range": (0, 1),
        },
    )
    found = json.loads(path.read_text(encoding="utf-8"))
    assert found["steps"] == 3 and found["open"] is True and found["range"] == [0, 1]
    assert found["loads"]["pile"] == {"fx_max_N": 1.5, "fh_max_time_s": None}
    assert found["mean"] == [1.0, None]
    assert found["title"] == "Eis am Pfahl, größer"


def test_failure_leaves_the_old_summary(tmp_path):
    path = tmp_path / "summary.json"
    write_summary(path, {"status": "running"})
    with pytest.raises(TypeError):
        write_summary(path, {"status": "completed", "x": object()})
    with pytest.raises(ValueError, match="status"):
        write_summary(path, {"status": "finished"})
    assert json.loads(path.read_text()) == {"status": "running"}
    assert list(tmp_path.iterdir()) == [path]


def test_versions_name_the_libraries():
    assert {"python", "numpy", "numba", "meshio"} <= set(versions())
    assert versions()["numpy"] == np.__version__


def test_a_folder_that_holds_a_run(tmp_path):
    assert not holds_run(tmp_path / "none")
    (tmp_path / "field.json").touch()
    assert not holds_run(tmp_path)
    (tmp_path / "forces.csv").touch()
    assert holds_run(tmp_path)


def test_snapshot_name():
    assert snapshot_name(7) == "snapshots/ice_000007.vtu"
