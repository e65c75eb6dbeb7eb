"""Run folders made up for the tests, file by file as the contract describes them, without any simulation."""

import json
import math
from pathlib import Path

import h5py
import meshio
import numpy as np
import pytest
import tomli_w

from dilatedem.structures.kinds import BY_NAME

SIZE = (20.0, 16.0)  # m
MODES = [
    "vertex-vertex", "vertex-edge", "vertex-face", "edge-edge crossing", "edge-edge parallel", "edge-face",
    "face-face",
]  # fmt: skip
PILE = {
    "kind": "pile",
    "name": "pile",
    "center": [4.0, 0.0],
    "radius": 1.5,
    "elastic_modulus": 210e9,
    "poisson_ratio": 0.3,
}
FORCES = "time_s,structure,fx_N,fy_N,fz_N,mx_Nm,my_Nm,mz_Nm,fx_min_N,fx_max_N,fy_min_N,fy_max_N,fh_max_N,contacts\n"
ENERGY = "time_s,kinetic,gravity,buoyancy,elastic,work_drag,work_structure,loss_damping,loss_friction,gain_law,residual\n"


@pytest.fixture(scope="session")
def make_run():
    return write_run


def case_of(structures=(PILE,), current=(0.3, 0.0), duration=10.0, seed=1, floe_size=2.0) -> dict:
    return {
        "title": "Made-up ice against a made-up pile",
        "domain": {"size": list(SIZE), "x_boundary": "open", "y_boundary": "periodic"},
        "field": {"source": "voronoi", "floe_size": floe_size, "concentration": 0.6, "seed": seed},
        "ice": {"density": 915.0, "thickness": 0.5, "dilated_radius": 0.04},
        "water": {"enabled": True, "density": 1025.0, "velocity": list(current)},
        "structure": [dict(structure) for structure in structures],
        "contact": {"model": "liu2015", "damping": 0.36, "friction": 0.1},
        "time": {"duration": duration, "step": "auto"},
        "output": {"snapshot_interval": 5.0, "force_interval": 0.01},
        "body": [],
    }


def write_run(
    folder: Path, *, structures=(PILE,), current=(0.3, 0.0), duration=10.0, seed=1, floe_size=2.0, scale=1.0,
    snapshots=True, status="completed",
) -> Path:  # fmt: skip
    """A whole run folder. scale: factor on the forces, to tell runs apart."""
    folder.mkdir(parents=True)
    case = case_of(structures, current, duration, seed, floe_size)
    (folder / "case.toml").write_text(f"# dilatedem 0.1.0, seed {seed}\n\n{tomli_w.dumps(case)}")
    random = np.random.default_rng(seed)
    outlines = floes(random, floe_size)
    (folder / "forces.csv").write_text(FORCES + "".join(force_rows(structures, duration, random, scale)))
    (folder / "energy.csv").write_text(ENERGY + "".join(energy_rows(duration)))
    if snapshots:
        write_snapshots(folder, outlines, current, duration)
    write_archive(folder / "run.h5", structures, outlines, duration)
    summary = {
        "status": status, "message": "", "title": case["title"], "version": "0.1.0", "seed": seed,
        "versions": {"python": "3.11", "numpy": "2.4"}, "floes": len(outlines), "steps": 20000, "dt_s": 5e-4,
        "dt_critical_s": 5e-3, "simulated_s": duration, "duration_s": duration, "wall_s": 12.5, "threads": 1,
        "loads": {}, "energy": {"residual_J": 1.0, "residual_over_work": 2e-4},
    }  # fmt: skip
    (folder / "summary.json").write_text(json.dumps(summary))
    return folder


def floes(random, floe_size) -> list[np.ndarray]:
    """Octagons on a jittered grid, the ones on the pile left out; some stick out across the periodic side."""
    outlines = []
    pitch = floe_size / 0.8
    angle = np.arange(8) * math.pi / 4.0
    for x in np.arange(-SIZE[0] / 2 + pitch / 2, SIZE[0] / 2, pitch):
        for y in np.arange(-SIZE[1] / 2, SIZE[1] / 2 - pitch / 2, pitch):
            radius = 0.4 * pitch * random.uniform(0.8, 1.1, 8)[:, None]
            outline = np.array([x, y]) + radius * np.column_stack([np.cos(angle), np.sin(angle)])
            if math.hypot(x - 4.0, y) > 1.5 + pitch / 2:
                outlines.append(outline)
    return outlines


def force_rows(structures, duration, random, scale):
    count = round(duration / 0.01)
    for structure in structures:
        pulse = np.zeros(count)
        for start in random.integers(count // 5, count - 8, 12):
            pulse[start : start + 5] += random.uniform(5e3, 60e3) * np.sin(np.linspace(0.3, 2.8, 5))
        side = 0.4 * pulse * np.sign(np.sin(np.arange(count) / 40.0))
        for i in range(count):
            fx, fy = scale * pulse[i], scale * side[i]
            high, low_y, high_y = 1.3 * fx, min(0.0, 1.4 * fy), max(0.0, 1.4 * fy)
            horizontal = math.hypot(high, max(-low_y, high_y))
            values = [fx, fy, 0, 0, 0, 0, 0, high, low_y, high_y, horizontal, int(fx > 0)]
            numbers = ",".join(f"{value:.9g}" for value in values)
            yield f"{0.01 * (i + 1):.9g},{structure['name']},{numbers}\n"


def energy_rows(duration):
    for time in np.linspace(0.0, duration, 101):
        work = 900.0 * time
        row = [
            2e4 + 300.0 * time,
            -1e6,
            1e6,
            5.0 * math.sin(time),
            work,
            0.0,
            500.0 * time,
            100.0 * time,
            0.0,
        ]
        yield ",".join(f"{value:.9g}" for value in [time, *row, 0.05 * math.sin(time) * time]) + "\n"


def write_snapshots(folder, outlines, current, duration):
    (folder / "snapshots").mkdir()
    entries = ""
    for number, time in enumerate(np.linspace(0.0, duration, 3)):
        shift = np.array(current) * time
        write_vtu(folder / f"snapshots/ice_{number:06d}.vtu", [outline + shift for outline in outlines], current)
        entries += f'<DataSet timestep="{time:g}" group="" part="0" file="snapshots/ice_{number:06d}.vtu"/>\n'
    head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1"><Collection>\n'
    (folder / "ice.pvd").write_text(f"{head}{entries}</Collection></VTKFile>\n")


def write_vtu(path, outlines, current):
    """Every outline as an upright prism; two in three lack their last corner, and these come first."""
    body = sorted(range(len(outlines)), key=lambda index: index % 3 == 0)
    points, cells, start = [], [], 0
    for index in body:
        ring = outlines[index] if index % 3 == 0 else outlines[index][:-1]
        n = len(ring)
        points += [np.column_stack([ring, np.full(n, z)]) for z in (-0.45, 0.05)]
        bottom, top = start + np.arange(n), start + n + np.arange(n)
        sides = [np.array([bottom[i], bottom[(i + 1) % n], top[(i + 1) % n], top[i]]) for i in range(n)]
        cells.append([bottom[::-1], top, *sides])
        start += 2 * n
    count = len(outlines)
    middle = np.array([outlines[index].mean(axis=0) for index in body])
    speed = math.hypot(*current) * np.where(np.hypot(middle[:, 0] - 2.0, middle[:, 1]) < 4.0, 0.3, 1.0)
    data = {
        "body": np.array(body),
        "velocity": np.outer(speed, [1.0, 0.0, 0.0]),
        "speed": speed,
        "angular_velocity": np.zeros((count, 3)),
        "contact_force": np.zeros((count, 3)),
        "contacts": np.zeros(count, dtype=np.int64),
    }
    cell_data = {name: [array] for name, array in data.items()}
    mesh = meshio.Mesh(np.concatenate(points), [("polyhedron", cells)], cell_data=cell_data)
    meshio.write(path, mesh, file_format="vtu", binary=True, compression="zlib")


def write_archive(path, structures, outlines, duration):
    with h5py.File(path, "w") as file:
        for structure in structures:
            group = file.create_group(f"load_map/{structure['name']}")
            heights = np.linspace(-0.6, 0.2, 9)
            pile = structure["kind"] == "pile"
            edges = np.linspace(-180.0, 180.0, 73) if pile else np.linspace(-20.0, 20.0, 41)
            middle = 0.5 * (edges[1:] + edges[:-1])
            around = np.maximum(0.0, -np.cos(np.radians(middle))) ** 3 if pile else np.exp(-((middle / 5.0) ** 2))
            group["impulse_Ns"] = 400.0 * np.outer(around, [0, 1, 2, 3, 3, 2, 1, 0])
            group["angle_edges_deg" if pile else "distance_edges_m"] = edges
            group["height_edges_m"] = heights
            group.attrs["kind"], group.attrs["duration_s"] = structure["kind"], duration
            if pile:
                group.attrs["radius_m"] = structure["radius"]
            group = file.create_group(f"structures/{structure['name']}")
            sketch = BY_NAME[structure["kind"]].model_validate(as_typed(structure)).sketch(30.0)
            group["outline_m"] = sketch.outline if sketch else np.zeros((0, 2))
            group.attrs["kind"], group.attrs["bounded"] = structure["kind"], int(bool(sketch and sketch.bounded))
        contacts = file.create_group("contacts")
        contacts.attrs["mode_names"] = MODES
        for pair in ("ice_ice", "ice_structure"):
            part = contacts.create_group(pair)
            part["steps"] = np.array([10, 0, 5, 3, 2, 50, 1])
            part["impulse_Ns"], part["max_force_N"] = np.arange(7.0), 1e4 * np.arange(7.0)
            part["max_overlap_m"] = np.full(7, 2e-4)
        areas = np.array([polygon_area(outline) for outline in outlines])
        group = file.create_group("floes")
        group["plan_area_m2"], group["mass_kg"] = areas, 457.5 * areas
        group["outline_points"] = np.concatenate(outlines)
        group["outline_start"] = np.concatenate([[0], np.cumsum([len(outline) for outline in outlines])])


def as_typed(structure: dict) -> dict:
    """With a name that a case file may have: those of some tests are chosen to be awkward."""
    return {**structure, "name": "any"}


def polygon_area(outline):
    x, y = outline.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
