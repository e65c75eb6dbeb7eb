"""What of waves is hardly meant: waves that floes are too long for, and sides of the domain across which they do not fit."""

import math

import numpy as np

from dilatedem.case.schema import Case
from dilatedem.scene.recipe import periodic_axes
from dilatedem.state.model import Model

#: share of a wave's length up to which a floe lies in one plane of its surface: there the water under its ends rises and falls by
#: 0.7 of what is under its middle
LONGEST_FLOE = 0.25
#: share of a length by which crests may miss each other across a side
OUT_OF_STEP = 0.01


def about_waves(case: Case, model: Model) -> list[str]:
    """A sentence for each component that is too short for the longest floe, or that a periodic side breaks."""
    longest = 2.0 * float(model.shapes.reach[: model.floating].max(initial=0.0))
    found = []
    for number, wave in enumerate(case.wave if case.water.enabled else []):
        length = case.gravity.acceleration * wave.period * wave.period / (2.0 * math.pi)
        if longest > LONGEST_FLOE * length:
            found.append(
                f"wave.{number} is {length:.3g} m long, and floes are up to {longest:.3g} m: each is taken to lie in one plane of "
                f"the surface, which holds up to {LONGEST_FLOE:g} of a wave's length; longer floes feel less of the wave"
            )
        heading = math.radians(wave.direction)
        for axis, (name, wraps) in enumerate(zip("xy", periodic_axes(case), strict=True)):
            size = case.domain.size[axis]
            crests = size * abs(math.cos(heading) if axis == 0 else math.sin(heading)) / length
            whole = float(np.round(crests))
            if wraps and abs(crests - whole) > OUT_OF_STEP:
                found.append(
                    f"wave.{number} has {crests:.3g} crests along {name}, where the domain repeats: floes beside the seam "
                    f"are out of step; domain.size.{axis} = {size * max(1.0, whole) / crests:.5g} fits"
                )
    return found
