"""The work of each stage of a step on one of several equal parts of a list of bodies or pairs.

Every item writes its own rows only, so that results do not depend on how many parts there are.
"""

from math import sqrt

from dilatedem.contact.sums import sum_contacts
from dilatedem.contact.tally import book_contact
from dilatedem.contact.tangent import meet
from dilatedem.jit import device, item
from dilatedem.motion.carry import carried_travel
from dilatedem.motion.flexure import watch_stress
from dilatedem.motion.integrate import kick
from dilatedem.motion.modal import drift, load_modes, sum_pushes
from dilatedem.motion.paces import LONGEST_MOVE
from dilatedem.state.response import is_free, is_joined, stride_of
from dilatedem.step.ahead import AT_HAND, fetch_ahead
from dilatedem.water.bent import bent_loads
from dilatedem.water.loads import body_loads, wet_bodies


@device
def part(count, block, blocks):
    """Where one of `blocks` equal parts of a list begins, and where the next does."""
    return count * block // blocks, count * (block + 1) // blocks


@item
def drift_block(team, chosen, count, dt, shapes, solids, bodies, pairs, workspace, block=0, blocks=1):
    """Move the bodies of a part by their strides of steps of dt [s].

    One that moved too far, and whether one has passed its horizon, go to the block's places.

    Structures stand where they are; those that move, `motion.carry` has moved before.
    """
    path, horizon = bodies.path, workspace.horizon
    adrift = sqrt(pairs.frame[0] ** 2 + pairs.frame[1] ** 2)
    longest = LONGEST_MOVE * pairs.limit[0]
    fault, leap, surprise = -1, 0.0, False
    first, last = part(count, block, blocks)
    for w in range(first, last):
        i = chosen[w]
        time = dt * workspace.stride[i]
        moved = time * adrift
        if is_free(i, solids):
            moved = drift(i, time, solids, bodies, shapes.reach[i], pairs.frame)
            if not moved <= longest and fault < 0:  # also where it is no number
                fault, leap = i, moved
        elif solids.carried[i]:
            moved = carried_travel(i, time, bodies.middle_velocity, bodies.middle_angular_velocity, shapes.plan_reach, pairs.frame)
            if not moved <= longest and fault < 0:
                fault, leap = i, moved
        path[i] += moved
        surprise = surprise or path[i] > horizon[i]
    workspace.fault[block], workspace.leap[block], workspace.surprise[block] = fault, leap, surprise


@item
def collide_block(
    team, count, dt, structure_of, shapes, solids, contact, surroundings, bodies, pairs, workspace, tally, block=0, blocks=1
):
    """Evaluate and book the awake pairs of some parts of the tally, in a clipping workspace of this block's own."""
    first_part, last_part = part(len(tally.deep), block, blocks)
    last = part(count, last_part - 1, len(tally.deep))[1]
    for p in range(first_part, last_part):
        tally.deep[p] = -1
        start, end = part(count, p, len(tally.deep))
        for w in range(start, end):
            if count > AT_HAND:
                fetch_ahead(block, w, last, shapes, solids, bodies, pairs, workspace)
            k = workspace.awake[w]
            steps = stride_of(pairs.a[k], pairs.b[k], workspace)
            meet(block, k, dt * steps, shapes, solids, bodies, pairs, contact, surroundings, workspace)
            book_contact(k, p, dt, steps, structure_of, shapes, contact, pairs, tally)


@item
def float_block(
    team, chosen, count, awake, dt, time, floating, hulls, solids, setting, bodies, pairs, workspace, block=0, blocks=1
):
    """All loads on the bodies of a part, and the second half of the kick of their strides of steps of dt [s]; 0: the loads alone.

    Of floes of several parts, which are always busy, `motion.joined` ends the kick.
    """
    first, last = part(count, block, blocks)
    if first == last:
        return
    sum_contacts(chosen, first, last, awake, bodies, pairs, workspace)
    sum_pushes(chosen, first, last, awake, solids, bodies, pairs, workspace)
    while last > first and chosen[last - 1] >= floating:  # structures feel no water, nor are they kicked here
        last -= 1
    if setting.water:
        wet_bodies(setting, time, chosen, first, last, hulls, bodies, workspace, block)
    for w in range(first, last):
        i = chosen[w]
        stride = dt * workspace.stride[i]
        force, torque = body_loads(i, stride, time, setting, hulls, solids, bodies, workspace.wet)
        force, torque = bent_loads(i, stride, time, setting, hulls, solids, bodies, workspace, force, torque)
        for m in range(3):
            bodies.force[i, m] = force[m] + bodies.contact_force[i, m]
            bodies.torque[i, m] = torque[m] + bodies.contact_torque[i, m]
        load_modes(i, stride, solids, bodies)
        if stride > 0.0 and is_free(i, solids) and not is_joined(i, solids):
            kick(i, stride, solids, bodies)
        watch_stress(i, time, solids, bodies)
