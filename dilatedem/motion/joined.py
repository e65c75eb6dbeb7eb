"""Floes of several parts: one rigid body each. Every part has the whole's place, motion, mass and inertia in its rows, its core and
its hull lie off the origin that they share, and what acts on one part acts on all."""

from dilatedem.jit import item
from dilatedem.motion.integrate import kick
from dilatedem.numerics.vector import add, load, store
from dilatedem.state.response import is_free


@item
def push_joined(dt, model, bodies):
    """Have all loads of this instant on the parts of a floe act on each of them, and end the kick of all; dt = 0: the loads alone.

    Before, the rows hold the loads on each part alone. All parts are given the same, to the last bit, and so move alike.
    """
    for j in range(len(model.joined)):
        first, last = model.joined[j, 0], model.joined[j, 1]
        force = torque = (0.0, 0.0, 0.0)
        for i in range(first, last):
            force, torque = add(force, load(bodies.force, i)), add(torque, load(bodies.torque, i))
        for i in range(first, last):
            store(bodies.force, i, force)
            store(bodies.torque, i, torque)
            if dt > 0.0 and is_free(i, model.solids):
                kick(i, dt, model.solids, bodies)
