"""Prints digests of what a generated field and a short run come to, under the environment that `test_every_machine` gives."""

import hashlib
import sys

import numpy as np

from dilatedem.run.simulation import Simulation


def digest(*parts) -> str:
    """Of arrays, in NamedTuples or not."""
    found = hashlib.sha256()
    for part in parts:
        for array in part if isinstance(part, tuple) else (part,):
            found.update(np.ascontiguousarray(array).tobytes())
    return found.hexdigest()[:16]


def main(case: str, *models: str) -> None:
    for model in models:
        simulation = Simulation.from_case(case, **{"contact.model": model})
        built = simulation.model
        print(model, "built", digest(built.shapes, built.hulls, built.solids, np.float64(simulation.dt), simulation.state.bodies))
        simulation.run(until=2.0)
        bodies = simulation.state.bodies
        print(model, "after 2 s", digest(bodies.position, bodies.orientation, bodies.velocity, bodies.angular_momentum))


if __name__ == "__main__":
    main(*sys.argv[1:])
