"""Contact forces summed per body.

Every sum is taken in the order of the pairs, so that results are the same for any number of threads.
"""

from dilatedem.jit import item, prefetch
from dilatedem.numerics.vector import accumulate, add, cross, load, scale
from dilatedem.state.response import is_free

#: pairs between the one whose results are asked for and the one that is summed
AHEAD = 24


@item
def sum_on_held(bodies, pairs, solids):
    """Contact force and torque on the bodies that nothing moves, of all contacts there are."""
    for i in range(len(bodies.contact_count)):
        if not is_free(i, solids):
            bodies.contact_count[i] = 0
            for m in range(3):
                bodies.contact_force[i, m] = 0.0
                bodies.contact_torque[i, m] = 0.0
    for k in range(pairs.count[0]):
        a, b = pairs.a[k], pairs.b[k]
        if pairs.overlap[k] <= 0.0 or (is_free(a, solids) and is_free(b, solids)):
            continue
        force, couple = load(pairs.force, k), load(pairs.couple, k)
        if not is_free(a, solids):
            torque = add(couple, cross(load(pairs.point, k), force))
            accumulate(bodies.contact_force, a, scale(-1.0, force))
            accumulate(bodies.contact_torque, a, scale(-1.0, torque))
            bodies.contact_count[a] += 1
        if not is_free(b, solids):
            accumulate(bodies.contact_force, b, force)
            accumulate(bodies.contact_torque, b, add(couple, cross(load(pairs.arm, k), force)))
            bodies.contact_count[b] += 1


@item
def sum_contacts(chosen, first, last, awake, bodies, pairs, workspace):
    """Contact force and torque on the bodies chosen[first:last] (numbers in order).

    Sleeping pairs have no contact, so the `awake` ones (their number) are all there is; every part of a list goes through them.
    """
    low, high = chosen[first], chosen[last - 1]
    for w in range(first, last):
        i = chosen[w]
        bodies.contact_count[i] = 0
        for m in range(3):
            bodies.contact_force[i, m] = 0.0
            bodies.contact_torque[i, m] = 0.0
    for w in range(awake):
        k, later = workspace.awake[w], workspace.awake[min(w + AHEAD, awake - 1)]
        if pairs.b[later] >= low and pairs.a[later] <= high:
            prefetch(pairs.overlap, later, 0)
            prefetch(pairs.overlap, later, 1)
        a, b = pairs.a[k], pairs.b[k]
        if a > high:
            break  # pairs are sorted by a, and b > a
        # whose pair it is comes first: rows that another thread has just written are far away
        if b < low or pairs.overlap[k] <= 0.0:
            continue
        force, couple = load(pairs.force, k), load(pairs.couple, k)
        if a >= low:
            torque = add(couple, cross(load(pairs.point, k), force))
            accumulate(bodies.contact_force, a, scale(-1.0, force))
            accumulate(bodies.contact_torque, a, scale(-1.0, torque))
            bodies.contact_count[a] += 1
        if b <= high:
            accumulate(bodies.contact_force, b, force)
            accumulate(bodies.contact_torque, b, add(couple, cross(load(pairs.arm, k), force)))
            bodies.contact_count[b] += 1
