"""Stress of bodies that bend, step by step: the largest tension at their surfaces so far, and when it first passed what ice bears.

Where nothing presses on it, a surface has stress in its own plane alone; the larger principal one is looked at in points of it, of
the modes' own stress. Most steps need no look: since the last one no tension has changed by more than the root of sum w_i^2 dxi_i^2
times a number of the body (Cauchy).
"""

from math import sqrt

from dilatedem.jit import by_type, item
from dilatedem.numerics.rotation import rotation_matrix, to_world
from dilatedem.numerics.vector import add, load, store
from dilatedem.state.modal import ModalSolids


@item
def _watch_nothing(i, time, solids, bodies):
    pass


@item
def _most_tension(i, solids, bodies):
    """The largest principal stress [Pa] at the surface of body i, and the number of the point where it is."""
    out, shape, most, place = bodies.coordinate, solids.stress_shape, 0.0, -1
    for p in range(solids.stress_start[i], solids.stress_start[i + 1]):
        along, across, shear = 0.0, 0.0, 0.0
        for m in range(solids.mode_count[i]):
            own = out[i, m]
            along += own * shape[p, m, 0]
            across += own * shape[p, m, 1]
            shear += own * shape[p, m, 2]
        half = 0.5 * (along - across)
        tension = 0.5 * (along + across) + sqrt(half * half + shear * shear)
        if tension > most:
            most, place = tension, p
    return most, place


@item
def _watch(i, time, solids, bodies):
    square, out, seen = 0.0, bodies.coordinate, bodies.seen_coordinate
    for m in range(solids.mode_count[i]):
        square += solids.mode_square[i, m] * (out[i, m] - seen[i, m]) ** 2
    spare = bodies.peak_tension[i] - bodies.seen_tension[i]
    if square * solids.stress_bound[i] ** 2 <= spare * spare:
        return
    for m in range(solids.mode_count[i]):
        seen[i, m] = out[i, m]
    tension, place = _most_tension(i, solids, bodies)
    bodies.seen_tension[i] = tension
    if tension <= bodies.peak_tension[i]:
        return
    bodies.peak_tension[i], bodies.peak_time[i], bodies.peak_place[i] = tension, time, place
    if tension > solids.strength[i] and bodies.failed_at[i] > time:
        q = bodies.orientation
        R = rotation_matrix(q[i, 0], q[i, 1], q[i, 2], q[i, 3])
        bodies.failed_at[i] = time
        store(bodies.failed_place, i, add(load(bodies.position, i), to_world(R, load(solids.stress_point, place))))


#: watch_stress(i, time, solids, bodies): note what pulls the surface of body i most, where that is more than before.
watch_stress = by_type(_watch_nothing, {ModalSolids: _watch}, at=2)
