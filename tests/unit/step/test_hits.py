"""Load events as the step tells them, beside what somebody finds who knows the whole history."""

from dataclasses import replace

import numpy as np
import pytest

from dilatedem.case.schema import Case
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status, clock_at_start
from dilatedem.state.hits import BODIES, COUNTS, FIGURES, FIRST, PEAK, PEAK_STEP, SAMPLES, STRUCTURE, no_hits, no_log
from dilatedem.step.hits import LOADED
from tests.kernels import watch_history
from tests.reference.declustering import events

DT = 1e-3  # s
DURATION = 1.6  # s
ONE = {"kind": "pile", "name": "one", "center": [1.0, -1.0], "radius": 0.4}
TWO = {"kind": "pile", "name": "two", "center": [0.0, 2.5], "radius": 0.5}


def crowd(**output) -> Simulation:
    """Twenty floes that are thrown against two piles."""
    return Simulation.of_case(Case.model_validate({
        "domain": {"size": [12.0, 12.0], "x_boundary": "periodic", "y_boundary": "periodic"},
        "field": {"floe_count": 20, "concentration": 0.8, "seed": 5},
        "ice": {"initial_velocity": [3.0, 0.8, 0.0], "dilated_radius": 0.06}, "water": {"velocity": [2.0, 0.5]},
        "structure": [ONE, TWO], "time": {"duration": DURATION, "step_fraction": 0.4},
        "output": {"force_interval": 0.05, "hit_gap": 0.02, "hits_in_full": 3, "moment_level": -1.5} | output,
    }))  # fmt: skip


@pytest.fixture(scope="module")
def resting() -> Simulation:
    """Whose arrays the kernel can be called with."""
    return crowd()


def told(force: np.ndarray, resting: Simulation, *, threshold: float, gap: int, kept: int = 0, cut: int = 0, end: int = 0):
    """(log, hits) of the kernel for forces (steps, w, 3) [N] at every step, in two calls at `cut`; end: step of the end."""
    structures, before, after = force.shape[1], 20, 30
    hits = no_hits(structures, kept, before + after + 1 if kept else 0)
    log = no_log(threshold, gap, before, after, end or len(force), structures)
    clock, state = clock_at_start(), resting.state
    for part in (force[:cut], force[cut:]):
        watch_history(
            part, DT, clock, resting.model, state.ids, state.bodies, state.pairs, resting.workspace, state.loads, hits, log
        )
    return log, hits


def rows(log) -> list[dict]:
    """Events that wait, as the oracle tells them."""
    return [
        dict(zip(COUNTS, counts, strict=True)) | dict(zip(FIGURES, figures, strict=True))
        for counts, figures in zip(log.counts.tolist(), log.figures.tolist(), strict=True)
    ][: int(log.waiting[0])]  # fmt: skip


def bursts(seed: int, steps: int = 3000) -> np.ndarray:
    """(steps, 2, 3) [N] forces that come and go: half-waves of random height, length and direction, on a shiver."""
    random = np.random.default_rng(seed)
    force = 20.0 * random.random((steps, 2, 3))
    for h in range(2):
        for start in random.integers(0, steps - 200, 25):
            length, angle = int(random.integers(1, 180)), random.uniform(0.0, 2.0 * np.pi)
            wave = random.uniform(50.0, 1000.0) * np.sin(np.pi * (np.arange(length) + 0.5) / length)
            force[start : start + length, h] += wave[:, None] * [np.cos(angle), np.sin(angle), 0.3]
    return force


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("gap", [2, 17, 150])
def test_events_are_those_of_the_whole_history(seed, gap, resting):
    force = bursts(seed)
    log, _ = told(force, resting, threshold=100.0, gap=gap, cut=1000 + 37 * seed)
    found = rows(log)
    assert [event["structure"] for event in found if event["last"] == len(force)] in ([], [0], [1], [0, 1])
    for h in range(2):
        horizontal = np.hypot(force[:, h, 0], force[:, h, 1])
        expected, mine = events(horizontal, 100.0, gap, DT), [event for event in found if event["structure"] == h]
        assert len(mine) == len(expected) > 2
        for event, wanted in zip(mine, expected, strict=True):
            assert {name: event[name] for name in wanted} == pytest.approx(wanted, rel=1e-12)


def test_where_calls_of_the_kernel_end_changes_no_bit(resting):
    force = bursts(3)
    whole, hits = told(force, resting, threshold=100.0, gap=50, kept=4)
    for cut in (1, 999, 2047):
        parts, again = told(force, resting, threshold=100.0, gap=50, kept=4, cut=cut)
        for one, other in ((whole, parts), (hits, again)):
            for name in one._fields:
                assert np.array_equal(getattr(one, name), getattr(other, name)), name


def test_the_highest_are_kept_at_every_step(resting):
    force = bursts(5)
    log, hits = told(force, resting, threshold=100.0, gap=50, kept=4)
    highest = sorted((event["peak_N"] for event in rows(log)), reverse=True)
    assert sorted(hits.figures[2:, PEAK], reverse=True) == highest[:4]
    for counts, history in zip(hits.counts[2:], hits.history[2:], strict=True):
        first, samples = counts[FIRST], counts[SAMPLES]
        assert first <= counts[PEAK_STEP] < first + samples
        assert first == max(1, counts[PEAK_STEP] - 20) and samples >= min(31, len(force) - counts[PEAK_STEP])
        np.testing.assert_array_equal(history[:samples], force[first - 1 : first - 1 + samples, counts[STRUCTURE]])


def test_events_that_nobody_fetches_overwrite_nothing(resting):
    force = np.zeros((1000, 1, 3))
    force[::3, 0, 0] = 200.0
    log, _ = told(force, resting, threshold=100.0, gap=2)
    assert log.waiting[0] == len(log.counts) < 333
    assert [event["start"] for event in rows(log)] == [1 + 3 * k for k in range(len(log.counts))]


def pushing(simulation: Simulation, h: int, least: float) -> set[int]:
    """Floes behind the load on structure h, by walking from contact to contact of `least` [N] or more."""
    pairs, structure_of = simulation.state.pairs, simulation.model.structure_of
    count = range(int(pairs.count[0]))
    links = [(int(pairs.a[k]), int(pairs.b[k])) for k in count if pairs.overlap[k] > 0.0 and pairs.normal_force[k] >= least]
    found = {a for a, b in links if structure_of[b] == h}
    while more := {i for link in links for i in link if structure_of[i] < 0 and set(link) & found} - found:
        found |= more
    return found


def test_a_run_tells_what_led_each_peak_and_who_pushed():
    """Step by step, and by one call: the same events, and those that their steps show."""
    stepped, whole = crowd(), crowd()
    stepped.span = whole.span = 1  # all bodies in step, or calls of one step would be others
    whole.evaluate()
    steps = round(DURATION / whole.dt)
    assert whole.advance(steps) == Status.DONE
    forces, seen = np.zeros((steps, 2)), {}
    for step in range(steps):
        assert stepped.advance(1) == Status.DONE
        forces[step] = np.hypot(*stepped.state.loads.step_load[:2, :2].T)
        pairs, count = stepped.state.pairs, int(stepped.state.pairs.count[0])
        for h in range(2):
            mine = [k for k in range(count) if stepped.model.structure_of[pairs.b[k]] == h and pairs.overlap[k] > 0.0]
            if mine and forces[step, h] > stepped.log.threshold:
                leading = max(mine, key=lambda k: pairs.normal_force[k])
                least = LOADED * pairs.normal_force[leading]
                seen[h, step + 1] = (int(pairs.a[leading]), int(pairs.mode[leading]), pushing(stepped, h, least))
    found = rows(whole.log)
    assert found == rows(stepped.log) and len(found) > 5
    for h in range(2):
        expected = events(forces[:, h], whole.log.threshold, whole.log.gap, whole.dt)
        mine = [event for event in found if event["structure"] == h]
        for event, wanted in zip(mine, expected, strict=True):
            assert {name: event[name] for name in wanted} == pytest.approx(wanted, rel=1e-9)
            body, mode, floes = seen[h, event["peak_step"]]
            assert (event["body"], event["mode"], event["bodies"]) == (body, mode, len(floes))
            assert 0.0 < event["area_m2"] < 0.5 and event["pressure_Pa"] * event["area_m2"] <= 1.2 * event["peak_N"]
    kept = whole.state.hits.counts[2:]
    for place, counts in enumerate(kept, start=2):
        floes = seen[counts[STRUCTURE], counts[PEAK_STEP]][2]
        assert set(whole.state.hits.floe[place, : counts[BODIES]]) == floes
    assert max(event["bodies"] for event in found) > 1


def test_the_arrows_of_a_peak_add_up_to_its_load():
    simulation = crowd()
    simulation.evaluate()
    assert simulation.advance(round(DURATION / simulation.dt)) == Status.DONE
    hits = simulation.state.hits
    assert (hits.counts[2:, STRUCTURE] >= 0).all()
    for counts, figures, touch, arrow in zip(hits.counts[2:], hits.figures[2:], hits.touch[2:], hits.arrow[2:], strict=True):
        on_it = arrow[touch[:, 1] == -1 - counts[STRUCTURE], 3:]
        assert np.hypot(*on_it.sum(axis=0)[:2]) == pytest.approx(figures[PEAK], rel=2.0 * LOADED)


def test_a_simulation_without_structures_watches_nothing():
    simulation = crowd()
    alone = replace(simulation, state=replace(simulation.state, hits=no_hits(0)))
    alone.evaluate()
    assert alone.advance(500) == Status.DONE and alone.log.waiting[0] == 0
