"""Figures for every eye: colours that are used together stay apart for the colour-blind, or dashes, markers, hatches differ."""

import matplotlib
import numpy as np
import pytest
from test_post_ensembles import write_sweep
from test_post_hits import archive  # noqa: F401  (a fixture)

from dilatedem.post.ensembles.laws import extremes
from dilatedem.post.ensembles.study import study
from dilatedem.post.ensembles.sweeps import read_sweep
from dilatedem.post.figures.canvas import new_figure
from dilatedem.post.figures.energy import TERMS, energy_figure
from dilatedem.post.figures.field import SPEED_MAP
from dilatedem.post.figures.hits import hit_figure
from dilatedem.post.figures.motion import motion_figure
from dilatedem.post.folders import run_drawings, sweep_drawings
from dilatedem.post.read import open_run
from tests.colour_blind import LEAST_DISTANCE, SEEN, clashes, distance, lab


def energies():
    """A ledger with every term that there may be."""
    time = np.linspace(0.0, 10.0, 50)
    names = [name for _, columns, *_ in TERMS for name in columns]
    names += ["loss_crushing", "work_wind", "work_wave", "kinetic_water", "structure_elastic", "carried_in", "modal"]
    return {"time_s": time, "residual": 0.0 * time} | {name: 100.0 * (k + 1.0) * time for k, name in enumerate(names)}


def motion():
    time = np.linspace(0.0, 10.0, 50)
    return {"time_s": time} | {name: np.sin(time) for name in ("x_m", "y_m", "yaw_rad", "reaction_x_N", "reaction_y_N")}


def test_distances_are_those_of_cie_1976():
    assert lab([1.0, 1.0, 1.0]) == pytest.approx([100.0, 0.0, 0.0], abs=0.02)
    assert lab([1.0, 0.0, 0.0]) == pytest.approx([53.24, 80.09, 67.20], abs=0.05)
    assert distance([0.0, 0.0, 1.0], [0.0, 0.0, 0.0]) == pytest.approx(np.sqrt(32.30**2 + 79.19**2 + 107.86**2), abs=0.1)


def test_red_and_green_of_one_lightness_are_one_colour_to_some():
    red, green = [0.70, 0.42, 0.20], [0.50, 0.50, 0.20]
    assert distance(red, green) > 25.0
    assert min(distance(red, green, sight) for sight in ("protanopia", "deuteranopia")) < 0.5 * distance(red, green)
    for sight in SEEN:  # what is grey stays grey
        assert lab([0.5, 0.5, 0.5], sight)[1:] == pytest.approx([0.0, 0.0], abs=0.05)


def test_a_figure_that_some_cannot_read_is_found():
    figure = new_figure(3.0, 3.0)
    axes = figure.add_subplot()
    for colour in ("#b36b33", "#80802f"):
        axes.plot([0.0, 1.0], [0.0, 1.0], color=colour)
    assert any("anopia" in clash for clash in clashes(figure))
    axes.lines[1].set_linestyle("--")
    assert clashes(figure) == []


def test_figures_of_a_run(make_run, tmp_path):
    drawings = run_drawings(open_run(make_run(tmp_path / "run")))
    assert len(drawings) > 6
    assert {drawing.name: found for drawing in drawings if (found := clashes(drawing.figure))} == {}


def test_figures_of_ledger_and_motion():
    assert clashes(energy_figure(energies()).figure) == []
    history = {"time_s": np.linspace(0.0, 10.0, 50), "fx_N": np.ones(50)}
    assert clashes(motion_figure("pile", motion(), history).figure) == []


def test_figure_of_a_load_event(archive, make_run, tmp_path):  # noqa: F811
    run = open_run(make_run(tmp_path / "run", snapshots=False))
    shown = type(run)(**(vars(run) | {"floes": archive.floes, "kept_hits": archive.hits, "outlines": archive.outlines}))
    assert clashes(hit_figure(shown, archive.hits[0], 1).figure) == []


def test_figures_of_a_sweep(make_run, tmp_path):
    turns = {"[0.3, 0.0]": (0.3, 0.0), "[0.0, 0.3]": (0.0, 0.3), "[-0.3, 0.0]": (-0.3, 0.0)}
    points = [
        ({"water.velocity": velocity, "water.friction": friction}, seed, {"current": current})
        for velocity, current in turns.items() for friction in ("0.1", "0.2") for seed in range(1, 3)
    ]  # fmt: skip
    grid = study(read_sweep(write_sweep(tmp_path / "grid", make_run, points)))
    seeds = study(read_sweep(write_sweep(tmp_path / "seeds", make_run, [({}, n, {"scale": 0.5 + 0.1 * n}) for n in range(1, 9)])))
    laws = {(0, "pile"): extremes(seeds, seeds.ensembles[0], "pile")}
    drawings = [*sweep_drawings(grid, {}), *sweep_drawings(seeds, laws)]
    assert len(drawings) >= 5, [d.name for d in drawings]
    for drawing in drawings:
        assert clashes(drawing.figure) == [], drawing.name


def test_scales_go_from_dark_to_light_for_every_eye():
    for name in (SPEED_MAP, "viridis_r"):
        shades = matplotlib.colormaps[name](np.linspace(0.0, 1.0, 16))[:, :3]
        for sight in SEEN:
            steps = np.diff(lab(shades, sight)[:, 0])
            assert (steps > 0.0).all() or (steps < 0.0).all()
            assert distance(shades[0], shades[-1], sight) > 4.0 * LEAST_DISTANCE
