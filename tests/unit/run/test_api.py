"""A simulation in Python: what it gives is what a run writes, in copies, and no call takes it back."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import dilatedem
from dilatedem.errors import CaseError, SimulationStopped

CROWDED = Path(__file__).parents[2] / "cases" / "crowded.toml"


def test_the_package_is_light_until_it_is_used():
    program = (
        "import sys, dilatedem; assert {'load', 'Simulation', 'run'} <= set(dir(dilatedem));"
        "assert not {'numba', 'numpy', 'pandas', 'pydantic'} & set(sys.modules); assert callable(dilatedem.run)"
    )
    subprocess.run([sys.executable, "-c", program], check=True, cwd=Path(__file__).parents[3])


def test_it_does_what_a_run_does(crowded):
    simulation = dilatedem.Simulation.from_case(CROWDED)
    run = dilatedem.load(crowded)
    for time in (0.25, 1.0):
        simulation.run(until=time)
        snapshot = run.snapshot(time)
        np.testing.assert_allclose(simulation.floes.velocity, snapshot.velocity, rtol=1e-9, atol=1e-12)
        assert simulation.time == pytest.approx(time)
    row = run.energy[np.isclose(run.energy.time_s, 1.0)].iloc[0]
    for name, value in simulation.energy.items():
        assert value == pytest.approx(row[name], rel=1e-8, abs=1e-9), name


def test_paths_dictionaries_and_cases_are_taken_with_values_laid_over_them():
    from_file = dilatedem.Simulation.from_case(CROWDED, water={"velocity": [0.5, 0.0]}, **{"structure.pile.radius": 1.0})
    assert from_file.case.water.velocity == (0.5, 0.0) and from_file.case.structure[0].radius == 1.0
    again = dilatedem.Simulation.from_case(from_file.case, **{"water.velocity": np.array([0.6, 0.0])})
    assert again.case.water.velocity == (0.6, 0.0) and again.case.structure == from_file.case.structure
    given = {"field": {"floe_count": 20}, "domain": {"size": [12.0, 12.0]}}
    assert dilatedem.Simulation.from_case(given, field={"floe_size": 3.0}).case.field.floe_count is None
    assert given == {"field": {"floe_count": 20}, "domain": {"size": [12.0, 12.0]}}, "what was given stays as it was"
    with pytest.raises(CaseError, match='ice.densty: unknown key; did you mean "density"'):
        dilatedem.Simulation.from_case({"ice": {"densty": 900.0}})
    with pytest.raises(CaseError, match="override contact.friction: contact.friction = -1.0: must be at least 0"):
        dilatedem.Simulation.from_case(CROWDED, contact={"friction": -1.0})


def test_what_it_gives_are_copies_of_the_moment():
    simulation = dilatedem.Simulation.from_case(CROWDED)
    simulation.run(until=0.1)
    position, energy = simulation.floes.position, simulation.energy
    before = position.copy()
    position += 1.0
    simulation.step(100)
    np.testing.assert_array_equal(position, before + 1.0)
    assert simulation.energy != energy
    assert np.abs(simulation.floes.position - before).max() < 0.1
    outlines = simulation.floes.outline
    assert len(outlines) == len(simulation.floes) and all(len(outline) > 2 for outline in outlines)
    middles = np.array([outline.mean(axis=0) for outline in outlines])
    assert np.abs(middles - simulation.floes.position[:, :2]).max() < 1.0


def test_no_order_of_calls_takes_it_back():
    steady, restless = (dilatedem.Simulation.from_case(CROWDED) for _ in range(2))
    steady.run(until=0.2)
    restless.run(until=0.1)
    restless.run(until=0.05)  # is past already
    restless.evaluate()
    assert restless.time == pytest.approx(0.1)
    restless.step(0)
    restless.run(until=0.2)
    assert restless.time == steady.time
    np.testing.assert_allclose(restless.floes.position, steady.floes.position, rtol=0.0, atol=1e-9)
    assert steady.state.loads.mode_steps.sum() == restless.state.loads.mode_steps.sum()


def test_structures_are_found_by_name_and_what_stops_a_simulation_is_said():
    spike = [[-3.0, -3.0, -3.0], [3.0, -3.0, -3.0], [0.0, 3.0, -3.0], [0.0, 0.0, 3.0]]
    simulation = dilatedem.Simulation.from_case({
        "field": {"source": "bodies"}, "structure": [{"kind": "pile", "name": "leg", "center": [1.0, 0.0], "radius": 0.3}],
        "body": [{"vertices": spike, "dilated_radius": 0.1, "position": [1.0, 0.0, 0.0]}],
    })  # fmt: skip
    assert list(simulation.structures) == ["leg"] and "pile" not in simulation.structures
    with pytest.raises(SimulationStopped, match=r'body 0 at \(1\.00, 0\.00\) and structure "leg" overlap by \S+ m'):
        simulation.step()


def test_a_run_comes_back_opened(tmp_path):
    run = dilatedem.run(CROWDED, tmp_path / "run", time={"duration": 0.1})
    assert run.summary["status"] == "completed" and run.case["time"]["duration"] == 0.1
    written = (tmp_path / "run" / "summary.json").stat().st_mtime_ns
    again = dilatedem.run(CROWDED, tmp_path / "run", time={"duration": 0.1})
    assert again.summary == run.summary and (tmp_path / "run" / "summary.json").stat().st_mtime_ns == written
    with pytest.raises(CaseError, match=r"run: holds a run already, of a case with another ice.density; replace it with --over"):
        dilatedem.run(CROWDED, tmp_path / "run", time={"duration": 0.1}, ice={"density": 900.0})
