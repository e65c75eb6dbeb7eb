"""How much a thousand steps of the fixed scenes do, counted: a slower program shows here on any machine, idle or not.

The bounds are the counts of 2026-11-30 and a tenth more. A change that lowers a count lowers its bound; one that raises it needs a
reason.
"""

import os
import tracemalloc
from pathlib import Path

import pytest

from benchmarks.scenes import MODELS, SCENES, scene_simulation
from dilatedem.state.clock import Status
from dilatedem.step.advance import advance

STEPS = 1000

#: what is counted, and what to look at where it has grown
MEANING = {
    "moves": "bodies moved: are bodies busy that nothing can touch (motion/paces.py)?",
    "evaluations": "pairs evaluated: do pairs sleep too short (`Pairs.wake`, contact/search/neighbours.py)?",
    "rounds": "rounds of the search for closest points: are last step's corners still its start (contact/search/closest.py)?",
    "rebuilds": "lists of pairs made: is a path overestimated, or SKIN too small (contact/search/neighbours.py)?",
    "listed": "pairs in the list: is SKIN too large, or the test for entry too weak (contact/search/neighbours.py)?",
}

#: moves, evaluations, rounds, rebuilds in STEPS steps (that at t = 0 included), and listed pairs at their end
COUNTED = {
    ("drift", "liu2015"): (8077, 832, 3772, 1, 832),
    ("drift", "consistent"): (8077, 832, 3772, 1, 832),
    ("jam", "liu2015"): (40398, 28451, 31867, 1, 854),
    ("jam", "consistent"): (31237, 14660, 18101, 1, 854),
    ("packed", "liu2015"): (188516, 406177, 414571, 1, 1154),
    ("packed", "consistent"): (188516, 411303, 419778, 1, 1154),
}
#: share by which a count may exceed what was counted
MARGIN = 0.1
#: traced memory that a call of `advance` may take meanwhile, bytes: its Python arguments
MOST_TRACED = 64_000
#: growth of the process's memory over STEPS steps, bytes: none but for the odd page of others
MOST_GROWTH = 4_000_000


def counts(simulation) -> dict[str, int]:
    """Totals of a simulation since its start."""
    clock, pairs = simulation.state.clock, simulation.state.pairs
    totals = {name: int(getattr(clock, name)[0]) for name in ("moves", "evaluations", "rounds", "rebuilds")}
    return totals | {"listed": int(pairs.count[0])}


@pytest.mark.parametrize(("name", "model"), COUNTED)
def test_a_thousand_steps_do_no_more_than_they_did(name, model):
    simulation = scene_simulation(name, model)
    simulation.evaluate()
    assert simulation.advance(STEPS) == Status.DONE
    found = counts(simulation)
    print(f'    ("{name}", "{model}"): {tuple(found.values())},')
    for (what, now), before in zip(found.items(), COUNTED[name, model], strict=True):
        bound = before + int(MARGIN * before)
        assert now <= bound, f"{name}, {model}: {what} grew from {before} to {now}, the bound is {bound}; {MEANING[what]}"


def test_every_scene_and_model_is_counted():
    assert set(COUNTED) == {(name, model) for name in SCENES for model in MODELS}


def resident() -> int:
    """Memory of this process, bytes; 0 where the system does not tell."""
    try:
        return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except OSError:
        return 0


def test_steps_take_no_memory():
    """Of compiled code tests/architecture/test_kernels.py says the same; this is about all of a call."""
    simulation = scene_simulation("packed")
    simulation.evaluate()
    simulation.advance(STEPS)  # touches every array once
    grown = resident()
    tracemalloc.start()
    try:
        simulation.advance(STEPS)
        _, traced = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    grown = resident() - grown
    assert traced <= MOST_TRACED, f"{traced} bytes were allocated from Python during {STEPS} steps, the bound is {MOST_TRACED}"
    assert grown <= MOST_GROWTH, f"the process grew by {grown} bytes during {STEPS} steps, the bound is {MOST_GROWTH}"


def test_the_step_is_compiled_once_for_all_scenes_of_a_model():
    def step(name, model):
        simulation = scene_simulation(name, model)
        simulation.evaluate()
        simulation.advance(2)
        return set(advance.signatures)

    first = step("drift", "liu2015") | step("drift", "consistent")
    again = step("packed", "consistent") | step("jam", "liu2015")
    assert again == first, f"advance was compiled again for the same kinds of arguments: {len(again) - len(first)} times more"
