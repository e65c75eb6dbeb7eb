"""Loads on structures: summed in every step, gathered in windows and maps."""

from math import atan2, pi, sqrt

from dilatedem.jit import device, item
from dilatedem.numerics.vector import add, cross, load, sub
from dilatedem.state.loads import ANGLE_BINS, HEIGHT_BINS


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
