"""Per-contact results summed per body, per structure and per mode, in the order of the pairs.

A fixed order makes every sum the same for any number of threads.
"""

from math import atan2, pi, sqrt

from dilatedem.jit import device, item
from dilatedem.numerics.vector import accumulate, add, cross, load, scale, sub
from dilatedem.state.record import ANGLE_BINS, HEIGHT_BINS


@device
def gather_contacts(awake, count, dt, floating, bodies, pairs, ledger, loads, clock):
    """Contact force and torque on every body; load on every structure; ledger and statistics of this step.

    Sleeping pairs have no contact, so the awake ones (`count` of them) are all there is.
    """
    for i in range(len(bodies.contact_count)):
        bodies.contact_count[i] = 0
        for m in range(3):
            bodies.contact_force[i, m] = 0.0
            bodies.contact_torque[i, m] = 0.0
    for s in range(len(loads.step_contacts)):
        loads.step_contacts[s] = 0
        for m in range(6):
            loads.step_load[s, m] = 0.0
    clock.evaluations[0] += count
    for w in range(count):
        k = awake[w]
        clock.rounds[0] += pairs.rounds[k]
        ledger.loss_friction[0] += pairs.loss_friction[k]
        ledger.loss_damping[0] += pairs.loss_damping[k]
        ledger.gain_law[0] += pairs.gain_law[k]
        if pairs.overlap[k] <= 0.0:
            # what the end of a contact cost is booked once
            pairs.loss_friction[k] = pairs.loss_damping[k] = pairs.gain_law[k] = 0.0
            continue
        a, b = pairs.a[k], pairs.b[k]
        force = load(pairs.force, k)
        couple = load(pairs.couple, k)
        torque_a = add(couple, cross(load(pairs.point, k), force))
        torque_b = add(couple, cross(load(pairs.arm, k), force))
        accumulate(bodies.contact_force, a, scale(-1.0, force))
        accumulate(bodies.contact_torque, a, scale(-1.0, torque_a))
        accumulate(bodies.contact_force, b, force)
        accumulate(bodies.contact_torque, b, torque_b)
        bodies.contact_count[a] += 1
        bodies.contact_count[b] += 1
        on_structure = 1 if b >= floating else 0
        mode = pairs.mode[k]
        loads.mode_steps[on_structure, mode] += 1.0
        loads.mode_impulse[on_structure, mode] += pairs.normal_force[k] * dt
        loads.mode_force[on_structure, mode] = max(loads.mode_force[on_structure, mode], pairs.normal_force[k])
        loads.mode_overlap[on_structure, mode] = max(loads.mode_overlap[on_structure, mode], pairs.overlap[k])
        if on_structure:
            _load_structure(b - floating, bodies, pairs, k, b, force, dt, loads)


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
