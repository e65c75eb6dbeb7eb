"""What follows from a case before it is run."""

import numpy as np

from dilatedem.case.schema import Case
from dilatedem.run.ending import total_steps
from dilatedem.run.observers import expected_size
from dilatedem.run.simulation import Simulation
from dilatedem.scene.facts import distribution_facts, file_facts, thickness_facts
from dilatedem.scene.room import memory


def check(case: Case) -> dict:
    """Floes, mass, time step, steps, expected size of the output; `warnings`: what is hardly meant, a sentence each.

    Raises CaseError for what only building a case can tell.
    """
    simulation = Simulation.of_case(case)
    simulation.require_apart()
    scene, floating = simulation.scene, simulation.model.floating
    areas = scene.field.floe_area
    facts = {
        "floes": len(areas),
        "explicit bodies": scene.explicit,
        "floes left out at structures": scene.field.left_out,
        "structures": len(scene.standing()),
        "mass, t": simulation.model.solids.mass[:floating].sum() / 1e3,
        "critical step, s": simulation.critical,
        "step, s": simulation.dt,
        "step / critical step": simulation.dt / simulation.critical,
        "steps": total_steps(case, simulation.dt),
        "memory, MB, about": memory(scene.count) / 1e6,
        "output, MB, about": expected_size(case, floating, len(scene.structures)) / 1e6,
    }
    if len(areas):
        facts |= {"concentration": scene.field.concentration, "floe size, m": float(np.sqrt(areas.mean()))}
        facts |= distribution_facts(case, scene) | file_facts(case, scene) | thickness_facts(case, scene)
    for number, wave in enumerate(case.wave):
        facts[f"length of wave.{number}, m"] = case.gravity.acceleration * wave.period**2 / (2.0 * np.pi)
    for structure in scene.structures:
        facts |= {f'structure "{structure.name}"': sentence for sentence in structure.about.remarks()}
    return facts | {"warnings": simulation.advice()}
