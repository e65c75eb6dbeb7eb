"""Why a simulation could not go on, in words."""

import math

from dilatedem.motion.paces import LONGEST_MOVE
from dilatedem.scene.overlaps import body_name
from dilatedem.state.clock import Status
from dilatedem.state.setting import CRUSHING_SETTINGS


def fault(simulation, status: Status) -> str:
    """Which bodies, when and why."""
    clock = simulation.state.clock
    scene, model, state = simulation.scene, simulation.model, simulation.state
    names = [body_name(int(i), scene, model, state.bodies, state.ids.body) for i in clock.culprit if i >= 0]
    measure = float(clock.measure[0])
    if status == Status.TOO_DEEP:
        cause = f"{names[0]} and {names[1]} overlap by {measure:.3g} m, more than their rounded edges can mean"
        if isinstance(model.contact, CRUSHING_SETTINGS):
            cause = (
                f"{names[0]} and {names[1]} have crushed into each other by {measure:.3g} m, farther than their dilated radii "
                "reach together; larger ones take more"
            )
    else:
        cause = f"{names[0]} moved without bound in one step"
        if math.isfinite(measure):
            limit = LONGEST_MOVE * float(simulation.state.pairs.limit[0])
            cause = (
                f"{names[0]} moved {measure:.3g} m in one step, farther than {limit:.3g} m, a step's most; where such speeds "
                f"(spins) are meant, set time.step to at most {simulation.dt * limit / measure:.2g} s"
            )
    return f"stopped at t = {simulation.time_s:.6g} s: {cause}"
