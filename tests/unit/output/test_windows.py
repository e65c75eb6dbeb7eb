import csv
from pathlib import Path

import numpy as np
import pytest

from dilatedem.output.tables import FORCES_COLUMNS, Table
from dilatedem.output.windows import append, end_open_window, headline_loads, work_up
from dilatedem.state.loads import WINDOWS, empty_loads, no_windows

DT = 1e-3  # s
STEPS = 10  # of a window
FLOW = (0.6, -0.8)  # direction of the current


def kept(names: list[str], count: int, path: Path, every: int) -> dict[str, dict]:
    """`count` windows of made-up loads in forces.csv, worked up after every so many; returns the headline loads."""
    random, peaks = np.random.default_rng(4), {}
    windows, loads = no_windows(len(names)), empty_loads(len(names), len(names))
    with Table(path, FORCES_COLUMNS) as table:
        for number in range(1, count + 1):
            loads.steps[0] = STEPS
            loads.window_sum[:] = 1e4 * random.normal(size=loads.window_sum.shape)
            loads.window_extreme[:] = 1e3 * random.normal(size=loads.window_extreme.shape) * (number % 3 > 0)
            loads.contact_sum[:] = random.integers(0, 40, len(names))
            end_open_window(windows, loads, STEPS * number)
            assert loads.steps[0] == 0  # the next window is open
            if number % every == 0 or windows.count[0] == WINDOWS:
                append(work_up(windows, names, DT, peaks, FLOW), names, table)
        ended = work_up(windows, names, DT, peaks, FLOW)
        if ended:
            append(ended, names, table)
        assert work_up(windows, names, DT, peaks, FLOW) is None  # nothing is left
    return peaks


@pytest.mark.parametrize("names", [["pile"], ["pile", 'leg "B", north', "wall_x_min"], []])
@pytest.mark.parametrize("every", [7, 10**6])
def test_many_windows_at_once_come_out_as_one_by_one(names, every, tmp_path):
    count = WINDOWS + 5
    one_by_one = kept(names, count, tmp_path / "one.csv", 1)
    assert kept(names, count, tmp_path / "many.csv", every) == one_by_one
    assert (tmp_path / "many.csv").read_bytes() == (tmp_path / "one.csv").read_bytes()
    rows = list(csv.DictReader((tmp_path / "many.csv").open(newline="")))
    assert [row["structure"] for row in rows] == names * count
    for s, name in enumerate(names):
        mine, peak = rows[s :: len(names)], one_by_one[name]
        assert [float(row["time_s"]) for row in mine] == pytest.approx([0.01 * n for n in range(1, count + 1)])
        highest = max(mine, key=lambda row: float(row["fh_max_N"]))
        assert peak["fh_max_N"] == pytest.approx(float(highest["fh_max_N"]), rel=1e-8)
        assert peak["fh_max_time_s"] == pytest.approx(float(highest["time_s"]))
        assert peak["fx_min_N"] == pytest.approx(min(float(row["fx_min_N"]) for row in mine), rel=1e-8)
        assert peak["steps"] == STEPS * count
        assert peak["across_max_N"] == pytest.approx(max(float(row["across_max_N"]) for row in mine), rel=1e-8)
        overturning = max(mine, key=lambda row: float(row["mh_max_Nm"]))
        assert peak["mh_max_time_s"] == pytest.approx(float(overturning["time_s"]))
        along = [FLOW[0] * float(row["fx_N"]) + FLOW[1] * float(row["fy_N"]) for row in mine]
        assert [float(row["along_N"]) for row in mine] == pytest.approx(along, rel=1e-6, abs=1e-4)
        assert headline_loads(peak)["along_mean_N"] == pytest.approx(np.mean(along), rel=1e-6)
        assert peak["fx_sum"] / peak["steps"] == pytest.approx(np.mean([float(row["fx_N"]) for row in mine]), rel=1e-6)


def test_means_are_over_the_steps_of_each_window(tmp_path):
    windows, loads, peaks = no_windows(1), empty_loads(1, 1), {}
    with Table(tmp_path / "forces.csv", FORCES_COLUMNS) as table:
        for steps, end in ((4, 4), (2, 6)):  # the last window of a run may be shorter
            loads.steps[0], loads.window_sum[:], loads.contact_sum[:] = steps, 8.0, 6
            end_open_window(windows, loads, end)
        append(work_up(windows, ["pile"], DT, peaks, FLOW), ["pile"], table)
    rows = list(csv.DictReader((tmp_path / "forces.csv").open()))
    assert [(row["time_s"], row["fx_N"], row["mz_Nm"], row["contacts"]) for row in rows] == [
        ("0.004", "2", "2", "1.5"), ("0.006", "4", "4", "3"),
    ]  # fmt: skip
    assert (peaks["pile"]["fx_sum"], peaks["pile"]["steps"]) == (16.0, 6)
