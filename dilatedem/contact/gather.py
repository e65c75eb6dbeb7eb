"""Per-contact results summed per body, per structure and per mode.

Every sum is taken in the order of the pairs, those of the ledger and of the statistics in a fixed number of parts: results are the
same for any number of threads.
"""

from math import atan2, pi, sqrt

from dilatedem.contact.collide import CONSISTENT
from dilatedem.contact.consistent.press import DEEPEST_SHARE
from dilatedem.jit import device, item, prefetch
from dilatedem.numerics.vector import accumulate, add, cross, load, scale, sub
from dilatedem.state.record import ANGLE_BINS, HEIGHT_BINS

#: overlap, in units of the smaller dilated radius of the two, past which the run stops
DEEPEST = 4.0
#: pairs between the one whose results are asked for and the one that is summed
AHEAD = 24


@device
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


@item
def book_contact(k, part, dt, floating, shapes, contact, pairs, tally):
    """Add what pair k cost and showed in this step to row `part` of the tally (`state.record.Tally`)."""
    tally.work[part, 0] += 1
    tally.work[part, 1] += pairs.rounds[k]
    tally.loss_damping[part] += pairs.loss_damping[k]
    tally.loss_friction[part] += pairs.loss_friction[k]
    tally.gain_law[part] += pairs.gain_law[k]
    if pairs.overlap[k] <= 0.0:
        # what the end of a contact cost is booked once
        pairs.loss_friction[k] = pairs.loss_damping[k] = pairs.gain_law[k] = 0.0
        return
    on_structure, mode = 1 if pairs.b[k] >= floating else 0, pairs.mode[k]
    tally.mode_steps[part, on_structure, mode] += 1.0
    tally.mode_impulse[part, on_structure, mode] += pairs.normal_force[k] * dt
    tally.mode_force[part, on_structure, mode] = max(tally.mode_force[part, on_structure, mode], pairs.normal_force[k])
    tally.mode_overlap[part, on_structure, mode] = max(tally.mode_overlap[part, on_structure, mode], pairs.overlap[k])
    if pairs.overlap[k] > deepest_overlap(pairs.a[k], pairs.b[k], shapes, contact) and tally.deep[part] < 0:
        tally.deep[part] = k


@device
def close_tally(tally, ledger, loads, clock):
    """Bring a tally to the ledger, the contact statistics and the counts of work, part by part, and empty it."""
    for part in range(len(tally.deep)):
        clock.evaluations[0] += tally.work[part, 0]
        clock.rounds[0] += tally.work[part, 1]
        tally.work[part, 0] = tally.work[part, 1] = 0
        ledger.loss_damping[0] += tally.loss_damping[part]
        ledger.loss_friction[0] += tally.loss_friction[part]
        ledger.gain_law[0] += tally.gain_law[part]
        tally.loss_damping[part] = tally.loss_friction[part] = tally.gain_law[part] = 0.0
        for s in range(2):
            for mode in range(tally.mode_steps.shape[2]):
                loads.mode_steps[s, mode] += tally.mode_steps[part, s, mode]
                loads.mode_impulse[s, mode] += tally.mode_impulse[part, s, mode]
                loads.mode_force[s, mode] = max(loads.mode_force[s, mode], tally.mode_force[part, s, mode])
                loads.mode_overlap[s, mode] = max(loads.mode_overlap[s, mode], tally.mode_overlap[part, s, mode])
                tally.mode_steps[part, s, mode] = tally.mode_impulse[part, s, mode] = 0.0
                tally.mode_force[part, s, mode] = tally.mode_overlap[part, s, mode] = 0.0


@device
def too_deep(tally, pairs, clock):
    """Whether some overlap is past what the method can mean; its bodies go to `clock`."""
    for part in range(len(tally.deep)):
        k = tally.deep[part]
        if k >= 0:
            clock.culprit[0], clock.culprit[1] = pairs.a[k], pairs.b[k]
            clock.measure[0] = pairs.overlap[k]
            return True
    return False


@device
def load_structures(count, dt, floating, bodies, pairs, workspace, loads):
    """Loads on all structures at this step, from the awake pairs with one, `count` of them."""
    for s in range(len(loads.step_contacts)):
        loads.step_contacts[s] = 0
        for m in range(6):
            loads.step_load[s, m] = 0.0
    for w in range(count):
        k = workspace.at_structure[w]
        if pairs.overlap[k] > 0.0:
            b = pairs.b[k]
            _load_structure(b - floating, bodies, pairs, k, b, load(pairs.force, k), dt, loads)


@item
def deepest_overlap(a, b, shapes, contact):
    """Overlap [m] past which rounded edges mean nothing any more."""
    smaller = shapes.radius[a] if shapes.kind[b] != 0 else min(shapes.radius[a], shapes.radius[b])
    if contact.model == CONSISTENT:
        return min(DEEPEST * smaller, DEEPEST_SHARE * (shapes.radius[a] + shapes.radius[b]))
    return DEEPEST * smaller


@item
def _load_structure(s, bodies, pairs, k, b, force, dt, loads):
    """Add contact k to the load and the map of structure s (body b)."""
    # moments are about the structure's centre at z = 0; arm is from the centroid of b
    arm = load(pairs.arm, k)
    height = bodies.position[b, 2] + arm[2]
    lever = (arm[0], arm[1], height)
    moment = add(load(pairs.couple, k), cross(lever, force))
    loads.step_contacts[s] += 1
    for m in range(3):
        loads.step_load[s, m] += force[m]
        loads.step_load[s, 3 + m] += moment[m]
    half = loads.map_span[s, 0]
    if half > 0.0:
        point = sub((bodies.position[b, 0] + arm[0], bodies.position[b, 1] + arm[1], height), load(loads.map_origin, s))
        place = (point[0] * loads.map_origin[s, 3] + point[1] * loads.map_origin[s, 4]) / half
    else:
        place = atan2(arm[1], arm[0]) / pi
    low, high = loads.map_span[s, 1], loads.map_span[s, 2]
    i = min(max(int((place + 1.0) * 0.5 * ANGLE_BINS), 0), ANGLE_BINS - 1)
    j = min(max(int((height - low) / (high - low) * HEIGHT_BINS), 0), HEIGHT_BINS - 1)
    loads.impulse_map[s, i, j] += pairs.normal_force[k] * dt


@device
def record_loads(loads):
    """Add this step's structure loads to the open window: sums and extremes."""
    first = loads.steps[0] == 0
    loads.steps[0] += 1
    for s in range(len(loads.step_contacts)):
        fx, fy = loads.step_load[s, 0], loads.step_load[s, 1]
        fh = sqrt(fx * fx + fy * fy)
        for m in range(6):
            loads.window_sum[s, m] = loads.step_load[s, m] + (0.0 if first else loads.window_sum[s, m])
        loads.contact_sum[s] = loads.step_contacts[s] + (0 if first else loads.contact_sum[s])
        extreme = loads.window_extreme
        extreme[s, 0] = fx if first else min(extreme[s, 0], fx)
        extreme[s, 1] = fx if first else max(extreme[s, 1], fx)
        extreme[s, 2] = fy if first else min(extreme[s, 2], fy)
        extreme[s, 3] = fy if first else max(extreme[s, 3], fy)
        extreme[s, 4] = fh if first else max(extreme[s, 4], fh)


@device
def end_window(step, loads, windows):
    """Put the open window down if it is due to end at this step; then the next one is open."""
    w = windows.count[0]
    if windows.due[w] != step:
        return
    windows.steps[w] = loads.steps[0]
    for s in range(len(loads.step_contacts)):
        windows.contacts[w, s] = loads.contact_sum[s]
        for m in range(6):
            windows.sum[w, s, m] = loads.window_sum[s, m]
        for m in range(5):
            windows.extreme[w, s, m] = loads.window_extreme[s, m]
    windows.count[0] += 1
    loads.steps[0] = 0
