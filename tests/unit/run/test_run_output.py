"""The files of a run agree with its steps, with each other, and with what ParaView's own reader finds in them."""

import csv
import json
import time
from pathlib import Path
from xml.etree import ElementTree

import h5py
import numpy as np
import pytest

from dilatedem.case.load import load
from dilatedem.output.schedule import Schedule
from dilatedem.run import loop, observers, simulation
from dilatedem.run.ending import total_steps
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status

CROWDED = Path(__file__).parents[2] / "cases" / "crowded.toml"

#: the tables hold nine digits
DIGITS = 1e-8
#: simulated time that is looked at step by step, s: the first floes meet each other and the pile
CLOSE_LOOK = 0.4


def table(path: Path) -> dict[str, np.ndarray]:
    """A CSV file, column by column."""
    rows = list(csv.DictReader(path.open()))
    text = ("structure",)
    return {name: np.array([row[name] if name in text else float(row[name]) for row in rows]) for name in rows[0]}


@pytest.fixture(scope="module")
def short_run(tmp_path_factory) -> Path:
    """Of single steps, so that it can be told step by step (tests/unit/motion/test_strides.py looks at longer ones)."""
    case = load(CROWDED, [f"time.duration={CLOSE_LOOK}"])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(simulation, "STRIDE_PHASE", 0.0)
        return loop.run(case, tmp_path_factory.mktemp("short") / "run", quiet=True)


@pytest.fixture(scope="module")
def steps():
    """The same run, one step at a time: load on the pile (n, 6), contacts (n,), sum of normal forces (n,), and the time step."""
    run = Simulation.of_case(load(CROWDED, [f"time.duration={CLOSE_LOOK}"]))
    assert run.evaluate() == Status.DONE
    load_on_pile, contacts, pressed = [], [], []
    for _ in range(total_steps(run.case, run.dt)):
        assert run.advance(1) == Status.DONE
        loads, pairs = run.state.loads, run.state.pairs
        count = int(pairs.count[0])
        on_pile = (pairs.b[:count] >= run.model.floating) & (pairs.overlap[:count] > 0.0)
        load_on_pile.append(loads.step_load[0].copy())
        contacts.append(int(loads.step_contacts[0]))
        pressed.append(pairs.normal_force[:count][on_pile].sum())
    return np.array(load_on_pile), np.array(contacts), np.array(pressed), run.dt


def test_forces_hold_the_mean_and_the_extremes_of_every_step(short_run, steps):
    load_on_pile, contacts, _, dt = steps
    forces = table(short_run / "forces.csv")
    assert contacts.max() > 0 and np.abs(load_on_pile[:, :2]).max() > 1e3  # there is something to see
    schedule, first = Schedule(0.05, dt), 0
    assert len(forces["time_s"]) == 8
    for row, time_s in enumerate(forces["time_s"]):
        last = schedule.due_step(row + 1)
        window, horizontal = load_on_pile[first:last], np.hypot(*load_on_pile[first:last, :2].T)
        assert time_s == pytest.approx(last * dt, rel=DIGITS)
        mean = [forces[name][row] for name in ("fx_N", "fy_N", "fz_N", "mx_Nm", "my_Nm", "mz_Nm")]
        np.testing.assert_allclose(mean, window.mean(axis=0), rtol=DIGITS, atol=1e-9)
        extremes = [forces[name][row] for name in ("fx_min_N", "fx_max_N", "fy_min_N", "fy_max_N", "fh_max_N")]
        (fx_min, fy_min), (fx_max, fy_max) = window[:, :2].min(axis=0), window[:, :2].max(axis=0)
        np.testing.assert_allclose(extremes, [fx_min, fx_max, fy_min, fy_max, horizontal.max()], rtol=DIGITS)
        assert forces["contacts"][row] == pytest.approx(contacts[first:last].mean(), rel=DIGITS)
        first = last
    assert first == len(load_on_pile)


def test_the_load_map_holds_the_whole_normal_impulse(short_run, steps):
    _, _, pressed, dt = steps
    with h5py.File(short_run / "run.h5") as file:
        impulse, edges = file["load_map/pile/impulse_Ns"][()], file["load_map/pile/angle_edges_deg"][()]
        assert file["load_map/pile"].attrs["duration_s"] == pytest.approx(CLOSE_LOOK)
        by_mode = file["contacts/ice_structure/impulse_Ns"][()]
    assert impulse.sum() == pytest.approx(pressed.sum() * dt, rel=1e-12)
    assert by_mode.sum() == pytest.approx(pressed.sum() * dt, rel=1e-12)
    # ice comes from upstream, -x: at least nine tenths press on that half
    upstream = np.abs(0.5 * (edges[:-1] + edges[1:])) > 90.0
    assert impulse[upstream].sum() > 0.9 * impulse.sum()


def test_tables_begin_and_end_where_the_run_does(crowded):
    for name, interval, first in (("forces.csv", 0.05, 1), ("energy.csv", 0.05, 0), ("bodies.csv", 0.03, 0)):
        times = np.unique(table(crowded / name)["time_s"])
        expected = np.arange(first, round(4.0 / interval - 0.5) + 1) * interval
        np.testing.assert_allclose(times, expected, atol=4e-5, err_msg=name)  # due at the first step after it


def test_the_residual_is_the_sum_of_the_other_columns(crowded):
    energy = table(crowded / "energy.csv")
    stored = sum(energy[name] for name in ("kinetic", "gravity", "buoyancy", "elastic"))
    received = sum(energy[name] for name in ("work_drag", "work_structure", "gain_law"))
    lost = sum(energy[name] for name in ("loss_damping", "loss_friction"))
    residual = (stored - stored[0]) - received + lost
    # every number is rounded to nine digits, by 5e-9 of itself at most; large sums are compared with small differences
    rounded = 5e-9 * sum(np.abs(values) + np.abs(values[0]) for name, values in energy.items() if name != "time_s")
    assert np.all(np.abs(energy["residual"] - residual) <= rounded)
    assert energy["residual"][0] == 0.0
    assert np.abs(energy["residual"]).max() < 1e-3 * energy["work_drag"][-1]
    for loss in ("loss_damping", "loss_friction"):
        assert np.all(np.diff(energy[loss]) >= 0.0) and energy[loss][-1] > 0.0


def test_the_summary_agrees_with_the_tables(crowded):
    summary = json.loads((crowded / "summary.json").read_text())
    forces, energy = table(crowded / "forces.csv"), table(crowded / "energy.csv")
    assert (summary["status"], summary["message"]) == ("completed", "")
    assert summary["steps"] * summary["dt_s"] == pytest.approx(4.0) == summary["simulated_s"]
    assert summary["dt_s"] < 0.1 * summary["dt_critical_s"] + 1e-12
    assert 0.0 < summary["dt_over_critical_of_open_contacts"] < 1.0
    loads = summary["loads"]["pile"]
    for name, extreme in (("fx_max_N", max), ("fx_min_N", min), ("fy_max_N", max), ("fy_min_N", min), ("fh_max_N", max)):
        assert loads[name] == pytest.approx(extreme(forces[name]), rel=DIGITS)
    assert loads["fh_max_time_s"] == pytest.approx(forces["time_s"][forces["fh_max_N"].argmax()])
    # all windows are of one length, to a step
    assert loads["fx_mean_N"] == pytest.approx(forces["fx_N"].mean(), rel=1e-3)
    assert summary["energy"]["residual_J"] == pytest.approx(np.abs(energy["residual"]).max(), rel=DIGITS)
    for name in ("kinetic", "work_drag", "loss_friction", "gain_law"):
        assert summary["energy"][f"{name}_J"] == pytest.approx(energy[name][-1], rel=DIGITS)
    with h5py.File(crowded / "run.h5") as file:
        assert summary["floes"] == len(file["floes/body"])
        deepest = max(file[f"contacts/{partners}/max_overlap_m"][()].max() for partners in ("ice_ice", "ice_structure"))
    assert summary["contact"]["largest_overlap_m"] == deepest


def test_only_tracked_bodies_are_in_their_table(mixed):
    bodies = table(mixed / "bodies.csv")
    assert sorted(set(bodies["body"])) == [0, 3]
    quaternions = np.array([bodies[name] for name in ("qw", "qx", "qy", "qz")])
    np.testing.assert_allclose(np.linalg.norm(quaternions, axis=0), 1.0, atol=DIGITS)
    ball = bodies["body"] == 0
    start = [bodies[name][ball][0] for name in ("x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s")]
    assert start == [-3.0, 2.0, 0.4, 1.5, 0.0, 0.0]
    lowest, rest = bodies["z_m"][ball].min(), bodies["z_m"][ball][-1]
    assert lowest < 0.3 and rest < 0.3  # it fell into the water


def read_by_vtk(path: Path):
    vtk = pytest.importorskip("vtk")
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0
    return reader.GetOutput()


def cell_arrays(grid) -> dict[str, np.ndarray]:
    from vtk.util.numpy_support import vtk_to_numpy

    data = grid.GetCellData()
    return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}


def volume_and_centroid(cell) -> tuple[float, np.ndarray]:
    """Of a polyhedron as VTK holds it, by tetrahedra between its faces and one of its points."""
    corners = cell.GetPoints()
    apex, volume, moment = np.array(corners.GetPoint(0)), 0.0, np.zeros(3)
    for f in range(cell.GetNumberOfFaces()):
        points = cell.GetFace(f).GetPoints()
        face = np.array([points.GetPoint(i) for i in range(points.GetNumberOfPoints())]) - apex
        for b, c in zip(face[1:], face[2:], strict=False):
            part = np.dot(face[0], np.cross(b, c)) / 6.0
            volume += part
            moment += part * (face[0] + b + c) / 4.0
    return abs(volume), apex + moment / volume


def test_paraviews_reader_finds_every_floe_with_its_volume_place_and_data(crowded):
    with h5py.File(crowded / "run.h5") as file:
        volume = file["floes/volume_m3"][()]
    bodies = table(crowded / "bodies.csv")
    wraps = 0
    for number in (0, 3, 9, 15):  # at multiples of 0.75 s, when bodies.csv has rows too
        arrays = cell_arrays(grid := read_by_vtk(crowded / f"snapshots/ice_{number:06d}.vtu"))
        assert set(arrays) == {"body", "velocity", "speed", "angular_velocity", "contact_force", "contacts"}
        assert sorted(arrays["body"]) == list(range(len(volume)))
        now = np.abs(bodies["time_s"] - 0.25 * number) < 4e-5
        row = {name: column[now] for name, column in bodies.items()}
        assert list(row["body"]) == list(range(len(volume)))
        wrapped_y = row["y_m"] - 15.0 * np.round(row["y_m"] / 15.0)
        wraps += np.count_nonzero(wrapped_y != row["y_m"])
        place = np.column_stack([row["x_m"], wrapped_y, row["z_m"]])
        velocity = np.column_stack([row["vx_m_s"], row["vy_m_s"], row["vz_m_s"]])
        found = np.zeros(len(volume))
        for cell, body in enumerate(arrays["body"]):
            found[body], centroid = volume_and_centroid(grid.GetCell(cell))
            np.testing.assert_allclose(centroid, place[body], atol=1e-6)
            np.testing.assert_allclose(arrays["velocity"][cell], velocity[body], rtol=DIGITS, atol=1e-12)
            assert arrays["speed"][cell] == pytest.approx(np.linalg.norm(velocity[body]))
        np.testing.assert_allclose(found, volume, rtol=1e-9)
    assert wraps > 0, "no floe crossed the seam"


def test_vtks_own_volumes_add_up_in_every_snapshot(crowded):
    vtk = pytest.importorskip("vtk")
    with h5py.File(crowded / "run.h5") as file:
        total = file["floes/volume_m3"][()].sum()
    paths = sorted(crowded.glob("snapshots/*.vtu"))
    assert len(paths) == 17
    for path in paths:
        sizes = vtk.vtkCellSizeFilter()
        sizes.SetInputData(read_by_vtk(path))
        sizes.Update()
        assert cell_arrays(sizes.GetOutput())["Volume"].sum() == pytest.approx(total, rel=0.01)


def test_every_snapshot_is_in_the_collection_with_its_time(crowded):
    entries = [entry.attrib for entry in ElementTree.parse(crowded / "ice.pvd").iter("DataSet")]
    assert [entry["file"] for entry in entries] == [f"snapshots/ice_{number:06d}.vtu" for number in range(17)]
    np.testing.assert_allclose([float(entry["timestep"]) for entry in entries], np.arange(17) * 0.25, atol=4e-5)


def test_structures_are_drawn_for_paraview(mixed):
    grid = read_by_vtk(mixed / "structures.vtu")
    assert grid.GetNumberOfCells() == 6  # the post, the slope, four walls


class PullTheCable(Exception):
    pass


@pytest.mark.parametrize(("refresh_s", "there"), [(0.0, True), (1e9, False)])
def test_rows_and_snapshots_reach_their_files_while_a_run_goes_on(refresh_s, there, monkeypatch, tmp_path):
    """All of them a second after they came at the latest, whenever the next checkpoint may be."""
    monkeypatch.setattr(observers, "REFRESH_S", refresh_s)
    out, advance, given_up = tmp_path / "run", Simulation.advance, time.monotonic() + 30.0

    def stop_at_a_third(self, steps, **more):
        if self.model.floating > 1 and self.time_s > 0.33:
            while there and listed(out) < 4 and time.monotonic() < given_up:  # the background may be at it still
                time.sleep(0.01)
            forces = table_or_none(out / "forces.csv")
            assert (forces is not None and forces["time_s"][-1] > 0.29) == there
            assert listed(out) == (4 if there else 1)  # the first checkpoint is at t = 0
            raise PullTheCable
        return advance(self, steps, **more)

    monkeypatch.setattr(Simulation, "advance", stop_at_a_third)
    with pytest.raises(PullTheCable):
        loop.run(load(CROWDED, ["output.snapshot_interval=0.1"]), out, quiet=True)
    # what a fault of the program itself leaves: everything up to then
    assert table(out / "forces.csv")["time_s"][-1] > 0.29
    entries = [entry.attrib["file"] for entry in ElementTree.parse(out / "ice.pvd").iter("DataSet")]
    assert entries == [f"snapshots/ice_{number:06d}.vtu" for number in range(4)]


def listed(out: Path) -> int:
    """Snapshots in ice.pvd."""
    return (out / "ice.pvd").read_text().count("<DataSet")


def table_or_none(path: Path) -> dict[str, np.ndarray] | None:
    return table(path) if path.read_text().count("\n") > 1 else None


def test_how_often_files_are_brought_up_to_date_changes_no_byte(short_run, monkeypatch, tmp_path):
    monkeypatch.setattr(observers, "REFRESH_S", 0.0)
    monkeypatch.setattr(simulation, "STRIDE_PHASE", 0.0)  # as that of the other run
    again = loop.run(load(CROWDED, [f"time.duration={CLOSE_LOOK}"]), tmp_path / "again", quiet=True)
    for name in ("forces.csv", "energy.csv", "bodies.csv", "ice.pvd", "run.h5"):
        assert (again / name).read_bytes() == (short_run / name).read_bytes(), name
    told, expected = (json.loads((out / "summary.json").read_text()) for out in (again, short_run))
    assert told["loads"] == expected["loads"]
