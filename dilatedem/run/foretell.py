"""What follows from a case before it is run."""

import re
import time
from dataclasses import asdict

import numpy as np

from dilatedem.case.schema import Case
from dilatedem.run.arrivals import presence
from dilatedem.run.ending import total_steps
from dilatedem.run.observers import expected_size
from dilatedem.run.simulation import Simulation
from dilatedem.scene.facts import distribution_facts, file_facts, thickness_facts
from dilatedem.scene.room import memory
from dilatedem.state.clock import Status

#: s of wall time for which a case is tried to foretell how long it takes
TRIAL_S = 0.5
#: steps that are tried at first, then twice as many each time
FIRST_TRIAL = 64
#: s that a step takes where nothing was tried, at a few contacts and for each drifting floe, and how much longer in a jam
#: (docs/performance.md, whole runs and time per step)
USUAL_STEP, USUAL_FLOE, JAMMED = 5e-6, 1e-8, 4.0


def check(case: Case, *, trial_s: float = 0.0) -> dict:
    """Floes, mass, time step, steps, wall time, size of the output; `warnings`: what is hardly meant, a sentence each.

    trial_s: wall time [s] for which the first steps are tried, where machine code for them is there; nothing is written.
    Raises CaseError for what only building a case can tell.
    """
    simulation = Simulation.of_case(case)
    simulation.require_apart()
    scene, floating = simulation.scene, simulation.model.floating
    areas = scene.field.floe_area
    steps = total_steps(case, simulation.dt)
    facts = {
        "floes": len(areas),
        "explicit bodies": scene.explicit,
        "floes left out at structures": scene.field.left_out,
        "structures": len(scene.standing()),
        "mass, t": simulation.model.solids.mass[:floating].sum() / 1e3,
        "critical step, s": simulation.critical,
        "step, s": simulation.dt,
        "step / critical step": simulation.dt / simulation.critical,
        "steps": steps,
        "memory, MB, about": memory(scene.count) / 1e6,
        "output, MB, about": expected_size(case, floating, len(scene.structures)) / 1e6,
    }
    if len(areas):
        facts |= {"concentration": scene.field.concentration, "floe size, m": float(np.sqrt(areas.mean()))}
        facts |= distribution_facts(case, scene) | file_facts(case, scene) | thickness_facts(case, scene)
    if case.bends:
        facts |= modal_facts(simulation)
    for number, wave in enumerate(case.wave):
        facts[f"length of wave.{number}, m"] = case.gravity.acceleration * wave.period**2 / (2.0 * np.pi)
    for structure in scene.structures:
        facts |= {f'structure "{structure.name}"': sentence for sentence in structure.about.remarks()}
        told = {} if structure.whole else structure.support.remarks(simulation.dt)
        facts |= {f'modes of "{structure.name}" {about}': sentence for about, sentence in told.items()}
    facts["ice at"] = presence(simulation)
    facts["warnings"] = simulation.advice()
    return facts | _wall_time(simulation, steps, trial_s)  # last: it moves the ice


def modal_facts(simulation: Simulation) -> dict:
    """The highest frequency of all modes that bend bodies, how many steps its period takes, and what stays rigid."""
    highest = float(np.sqrt(simulation.model.solids.mode_square.max())) / (2.0 * np.pi)
    counts, free = simulation.model.solids.mode_count, simulation.model.solids.inverse_mass > 0.0
    rigid = int(np.count_nonzero(free & (counts == 0)))
    return {"highest mode, Hz": highest, "steps in its period": 1.0 / (highest * simulation.dt), "floes that stay rigid": rigid}


def _wall_time(simulation: Simulation, steps: int, trial_s: float) -> dict:
    """How long the steps of a run take [s], by trying the first of them, else by what floes usually take; and in a jam."""
    cost = _step_cost(simulation, trial_s) if trial_s > 0.0 and simulation.is_compiled() else None
    seconds = steps * (USUAL_STEP + USUAL_FLOE * simulation.model.floating if cost is None else cost)
    return {
        "wall time, s, about": seconds, "wall time in a jam, s, about": JAMMED * seconds, "wall time was tried": cost is not None,
    }  # fmt: skip


def _step_cost(simulation: Simulation, trial_s: float) -> float | None:
    """Wall time of a step [s] of those tried last, the first apart, which loads machine code; None where the ice cannot move."""
    count, taken = FIRST_TRIAL, 0.0
    if simulation.advance(1) != Status.DONE:
        return None
    began = time.perf_counter()
    while time.perf_counter() - began < trial_s:
        started = time.perf_counter()
        if simulation.advance(count) != Status.DONE:
            return None
        taken = (time.perf_counter() - started) / count
        count *= 2
    return taken


def told(facts: dict) -> dict:
    """The facts of `check` as people read them: words instead of records."""
    found = {label: fact for label, fact in facts.items() if label != "ice at" and not label.startswith("wall time")}
    least, most = facts["wall time, s, about"], facts["wall time in a jam, s, about"]
    how = "its first steps tried" if facts["wall time was tried"] else "untried, and one to two minutes to compile, once"
    found["wall time, about"] = f"{duration(least)}, in a jam up to {duration(most)} ({how})"
    return found | {f"ice at {name}": there.words() for name, there in facts["ice at"].items()}


def as_json(facts: dict) -> dict:
    """The facts of `check` for other programs: labels as names of one word, with units at their ends."""
    plain = {_word(label): _plain(fact) for label, fact in facts.items() if label != "ice at"}
    return plain | {"ice_at": {name: asdict(there) for name, there in facts["ice at"].items()}}


def _word(label: str) -> str:
    """`critical step, s` as `critical_step_s`, `step / critical step` as `step_over_critical_step`."""
    return re.sub(r"\W+", "_", label.removesuffix(", about").replace(" / ", " over ").replace('"', "")).strip("_")


def _plain(fact):
    """A number of NumPy as one of Python; nested facts likewise."""
    if isinstance(fact, dict):
        return {_word(label): _plain(inner) for label, inner in fact.items()}
    return fact.item() if isinstance(fact, np.generic) else fact


def duration(seconds: float) -> str:
    """A wall time that is known by its size: 4 s, 12 min, 3 h, 2 days."""
    for unit, length in (("days", 86400.0), ("h", 3600.0), ("min", 60.0)):
        if seconds >= 1.95 * length:
            return f"{seconds / length:.2g} {unit}" if seconds < 10.0 * length else f"{seconds / length:.0f} {unit}"
    return f"{seconds:.2g} s" if seconds < 10.0 else f"{seconds:.0f} s"
