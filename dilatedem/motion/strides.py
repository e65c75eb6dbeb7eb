"""Strides: how many steps of the contacts a busy body takes in one.

The step of a run is made for the stiffest contact that there can be; most are softer. Bodies of near pairs hang together in
*islands*, and within a span no island meets another, so each goes at its own pace: in strides of as many steps as its contacts, as
they are now, allow. A stride is one step of the scheme of `motion.integrate`, only longer. It ends before anything new could
touch, so every contact begins with a single step, as stiff as it may be.

Verlet steps of one length keep an energy of their own, which differs from the true one by h^2 (k v^2/12 - F^2/(24 m)); where their
length changes, that difference is lost or won. So what is bounded are the phase that a contact goes through in a stride, this phase
times the speed at which it deepens, and what the loads on a body change its velocity by: the latter two against the speed of the
ice. Where a long stride would end the contacts are looked at beforehand, as their forces may have jumped. All that is looked at
stands in the state, so a run that is continued takes the same strides; at the end of a span all are together.
"""

from math import sqrt
from typing import NamedTuple

from dilatedem.contact.collide import gap_between
from dilatedem.contact.laws import force_change
from dilatedem.contact.turning import turn_shape
from dilatedem.jit import device, item
from dilatedem.motion.integrate import place_ahead
from dilatedem.motion.modal import bent_by, opening_of, shake
from dilatedem.numerics.vector import dot, load, sub
from dilatedem.state.clock import NEVER
from dilatedem.state.pairs import SIMPLEX
from dilatedem.state.response import is_free, is_joined, mobility, relative_velocity, stride_of, yielding

#: share of its overlap by which a contact may deepen or open in a stride
MOST_CHANGE = 0.3
#: what the loads on a body may change its velocity by in a stride, in units of the speed of the ice
MOST_KICK = 1.3e-2
#: phase [rad] of a contact in a stride times the speed at which it deepens or opens, in units of the speed of the ice
MOST_JOLT = 1.5e-3
#: how much faster bodies may come to approach each other within a stride than they do
HASTE = 1.25
#: what a stride is divided by in which something new would touch
SHORTER = 3.0
#: steps after which an island that must take single steps is looked at again
PATIENCE = 2


class Pace(NamedTuple):
    """How many steps bodies may take in one."""

    span: int  # those that nothing can touch
    frequency: float  # rad/s, angular frequency of contacts that single steps are made for; 0: all that are busy take single steps
    speed: float  # m/s, how fast ice goes; 0: no stride is longer, as nothing is small against it
    long: int  # steps of a stride from which on it is looked at what the contacts will press with where it ends


@item
def set_out(now, near, busy, solids, pairs, workspace):
    """All busy bodies stand at the step `now`, as if they had been due: who hangs together with whom, by the `near` pairs of them.

    Returns how many bodies were due.
    """
    island = workspace.island
    for w in range(busy):
        i = workspace.busy[w]
        workspace.last[i], workspace.look[i], workspace.stride[i], workspace.due_bodies[w] = now, now, 1, i
        island[i] = i if is_free(i, solids) or solids.carried[i] else -1
    for w in range(near):
        k = workspace.near[w]
        a, b = pairs.a[k], pairs.b[k]
        if island[a] >= 0 and island[b] >= 0:
            a, b = _first_of(a, island), _first_of(b, island)
            island[max(a, b)] = min(a, b)
    for w in range(busy):
        i = workspace.busy[w]
        if island[i] >= 0:
            island[i] = _first_of(i, island)
    return busy


@item
def _first_of(i, island):
    """The body of the lowest number in the island of body i, whose number the island has."""
    while island[i] != i:
        island[i] = island[island[i]]
        i = island[i]
    return i


@item
def _island_of(a, b, island):
    """The island of two bodies that may touch, one of which may be held."""
    return island[a] if island[a] >= 0 else island[b]


@item
def next_due(step, end, busy, workspace):
    """The next step after `step` at which bodies are due, or `step` where some are late, and how many; NEVER once all are at `end`.

    Their numbers go to `workspace.due_bodies`, and to `workspace.stride` how many steps they take. What is held comes along.
    """
    island, last, due = workspace.island, workspace.last, workspace.due
    now, found = (NEVER if step == end else end), 0
    for w in range(busy):
        i = workspace.busy[w]
        if island[i] >= 0 and last[i] < end:
            now = min(now, due[i], end)
    if now == NEVER:
        return now, found
    for w in range(busy):
        i = workspace.busy[w]
        workspace.stride[i] = 0
        if island[i] < 0 or (last[i] < now and (due[i] <= now or now == end)):
            workspace.due_bodies[found] = i
            workspace.stride[i] = now - last[i]
            last[i] = now
            found += 1
    return now, found


@item
def choose_strides(now, end, dt, pace, near, count, model, bodies, pairs, workspace):
    """When the bodies that were due at the step `now`, so many, are due next, `end` at the latest."""
    island, look, most, longer = workspace.island, workspace.look, workspace.most_steps, False
    for w in range(count):
        i = workspace.due_bodies[w]
        if island[i] == i:
            most[i] = float(end - now) if look[i] <= now and pace.frequency > 0.0 else 1.0
            longer = longer or most[i] > 1.0
    if longer:
        _bound_by_bodies(dt, pace, count, model.solids, model.shapes, bodies, pairs, workspace)
        _bound_by_contacts(dt, pace, near, model.solids, bodies, pairs, workspace)
        while _look_ahead(dt, near, model, bodies, pairs, workspace) or (
            _is_long(pace, count, workspace) and _look_at_contacts(dt, pace, near, model, bodies, pairs, workspace)
        ):
            pass
    for w in range(count):
        i = workspace.due_bodies[w]
        if island[i] >= 0:
            steps = most[island[i]]
            workspace.due[i] = now + max(1, int(steps))
            if steps < 2.0 and look[i] <= now:
                look[i] = now + PATIENCE


@item
def _bound_by_bodies(dt, pace, count, solids, shapes, bodies, pairs, workspace):
    """No body goes past its horizon in a longer stride or is kicked hard; what moves as a whole takes single steps."""
    island, most, path, horizon = workspace.island, workspace.most_steps, bodies.path, workspace.horizon
    for w in range(count):
        i = workspace.due_bodies[w]
        if island[i] < 0:
            continue
        workspace.stiffness[i], root = 0.0, island[i]
        if solids.carried[i] or is_joined(i, solids):
            most[root] = 1.0
        if most[root] < 2.0:
            continue
        v, spin = load(bodies.middle_velocity, i), load(bodies.middle_angular_velocity, i)
        way = abs(v[0] - pairs.frame[0]) + abs(v[1] - pairs.frame[1]) + abs(v[2])
        way = HASTE * dt * (way + (abs(spin[0]) + abs(spin[1]) + abs(spin[2])) * shapes.reach[i] + shake(i, solids, bodies))
        _bound(root, way, horizon[i] - path[i], most)
        force, torque, give = load(bodies.force, i), load(bodies.torque, i), solids.inverse_inertia
        turned = sqrt(dot(torque, torque)) * (give[i, 0, 0] + give[i, 1, 1] + give[i, 2, 2]) * shapes.reach[i]
        _bound(root, dt * max(sqrt(dot(force, force)) * solids.inverse_mass[i], turned), MOST_KICK * pace.speed, most)


@item
def _bound(root, each, limit, most):
    """Have the island `root` take no more steps than bring what is `each` a step to a limit."""
    if each * most[root] > limit:
        most[root] = limit / each


@item
def _bound_by_contacts(dt, pace, near, solids, bodies, pairs, workspace):
    """In a stride the phase of no contact goes on by more than in a single step at the frequency of `pace`, and none deepens or
    opens by much, or fast if it is stiff.

    The contacts of a body add up as in `motion.timestep.assembled_frequency`.
    """
    most, stiffness = workspace.most_steps, workspace.stiffness
    for w in range(near):
        k = workspace.near[w]
        a, b = pairs.a[k], pairs.b[k]
        root = _island_of(a, b, workspace.island)
        if pairs.overlap[k] <= 0.0 or most[root] < 2.0 or stride_of(a, b, workspace) == 0:
            continue
        point, arm, normal = load(pairs.point, k), load(pairs.arm, k), load(pairs.normal, k)
        opening = dot(relative_velocity(bodies.middle_velocity, bodies.middle_angular_velocity, a, b, point, arm), normal)
        opening = opening_of(k, solids, pairs, opening)
        _bound(root, dt * abs(opening), MOST_CHANGE * pairs.overlap[k], most)
        moved = workspace.island[a] >= 0 and workspace.island[b] >= 0
        tangent, highest, bent = (2.0 if moved else 1.0) * pairs.tangent[k], 0.0, yielding(k, solids, pairs)
        if workspace.island[a] >= 0:
            stiffness[a] += tangent * (mobility(a, solids, bodies.orientation, point, normal) + bent)
            highest = stiffness[a]
        if workspace.island[b] >= 0:
            stiffness[b] += tangent * (mobility(b, solids, bodies.orientation, arm, normal) + bent)
            highest = max(highest, stiffness[b])
        phase = sqrt(highest)
        _bound(root, phase, pace.frequency, most)
        _bound(root, dt * phase * abs(opening), MOST_JOLT * pace.speed, most)


@device
def _look_ahead(dt, near, model, bodies, pairs, workspace):
    """Shorten strides in which something new would touch; returns whether there were any, at whose new ends nobody has looked.

    Bodies are brought, beside the state, to where the stride will bring them, and the gaps of those that could touch are measured.
    """
    most, path, shapes, shortened = workspace.most_steps, bodies.path, model.shapes, False
    workspace.looks[0] += 1
    for w in range(near):
        k = workspace.near[w]
        a, b = pairs.a[k], pairs.b[k]
        root = _island_of(a, b, workspace.island)
        if pairs.overlap[k] > 0.0 or most[root] < 2.0 or stride_of(a, b, workspace) == 0:
            continue
        time = dt * int(most[root])
        apart = sub(load(bodies.middle_velocity, b), load(bodies.middle_velocity, a))
        spin_a, spin_b = load(bodies.middle_angular_velocity, a), load(bodies.middle_angular_velocity, b)
        rate = sqrt(dot(apart, apart)) + sqrt(dot(spin_a, spin_a)) * shapes.reach[a] + sqrt(dot(spin_b, spin_b)) * shapes.reach[b]
        shaken = shake(a, model.solids, bodies) + shake(b, model.solids, bodies)
        rate += shaken
        if HASTE * time * rate <= pairs.wake[k] - path[a] - path[b]:
            continue
        _place(a, time, model, bodies, workspace)
        _place(b, time, model, bodies, workspace)
        gap = gap_between(
            k, shapes, workspace.vertex_ahead, workspace.face_normal_ahead, workspace.position_ahead, pairs, model.contact,
            model.surroundings,
        )[0]  # fmt: skip
        if gap < bent_by(a, model.solids, bodies) + bent_by(b, model.solids, bodies) + time * shaken:
            most[root] = int(most[root]) / SHORTER
            shortened = True
    return shortened


@device
def _look_at_contacts(dt, pace, near, model, bodies, pairs, workspace):
    """Shorten long strides at whose ends a contact would press quite differently; returns whether there were any, as `_look_ahead`.

    Within a stride a contact may deepen many times over although it hardly does now, where faces close as they tilt; and its mode
    may change, and its force jump.
    """
    most, shortened = workspace.most_steps, False
    workspace.looks[0] += 1
    for w in range(near):
        k = workspace.near[w]
        a, b = pairs.a[k], pairs.b[k]
        root = _island_of(a, b, workspace.island)
        if pairs.overlap[k] <= 0.0 or most[root] < pace.long or stride_of(a, b, workspace) == 0:
            continue
        time = dt * int(most[root])
        _place(a, time, model, bodies, workspace)
        _place(b, time, model, bodies, workspace)
        if time * _force_ahead(k, model, bodies, pairs, workspace) > MOST_KICK * pace.speed:
            most[root] = int(most[root]) / SHORTER
            shortened = True
    return shortened


@device
def _force_ahead(k, model, bodies, pairs, workspace):
    """By how much the elastic force of contact k would differ where the look has placed its bodies, over what these oppose to it,
    m/s2: the larger of both."""
    a, b, solids, q = pairs.a[k], pairs.b[k], model.solids, bodies.orientation
    corners, of_a, of_b = pairs.corners[k], _corners(pairs.corner_a, k), _corners(pairs.corner_b, k)
    gap, offset, normal, pa, pb, _ = gap_between(
        k, model.shapes, workspace.vertex_ahead, workspace.face_normal_ahead, workspace.position_ahead, pairs, model.contact,
        model.surroundings,
    )  # fmt: skip
    change = 0.0
    if gap < 0.0:
        change = force_change(
            model.contact, k, model.shapes, workspace.vertex_ahead, workspace.face_normal_ahead, solids, pairs, offset, normal, pa,
            pb, gap, workspace.clip[0],
        )  # fmt: skip
    # the next evaluation begins its search where the last one ended, whether somebody has looked ahead or not
    pairs.corners[k] = corners
    for c in range(SIMPLEX):
        pairs.corner_a[k, c], pairs.corner_b[k, c] = of_a[c], of_b[c]
    point, arm = load(pairs.point, k), load(pairs.arm, k)
    return change * max(mobility(a, solids, q, point, normal), mobility(b, solids, q, arm, normal))


@item
def _corners(corner, k):
    """Row k of `Pairs.corner_a` or `corner_b`."""
    return corner[k, 0], corner[k, 1], corner[k, 2], corner[k, 3]


@item
def _is_long(pace, count, workspace):
    """Whether some island that is due may take a long stride."""
    for w in range(count):
        i = workspace.due_bodies[w]
        if workspace.island[i] == i and workspace.most_steps[i] >= pace.long:
            return True
    return False


@item
def _place(i, time, model, bodies, workspace):
    """Where body i will be after a stride that takes a time [s], its shape turned, unless that was done in this look."""
    if workspace.looked[i] != workspace.looks[0]:
        workspace.looked[i] = workspace.looks[0]
        place_ahead(i, time, model.solids, bodies, workspace.position_ahead, workspace.orientation_ahead)
        turn_shape(i, model.shapes, workspace.orientation_ahead, workspace.vertex_ahead, workspace.face_normal_ahead)
