"""The stages of a time step over all bodies or pairs, one thread or several.

A parallel loop's body is one call of an ordinary device function, and every item writes its own rows only: results do not depend
on the number of threads. (Writes through a NamedTuple *inside* a prange would be lost without an error.)
"""

from dilatedem.contact.collide import CONSISTENT, collide
from dilatedem.contact.consistent.press import DEEPEST_SHARE
from dilatedem.jit import by_team, device, item, prange, shared_loop
from dilatedem.motion.integrate import complete_spin, drift, kick
from dilatedem.state.clock import Status
from dilatedem.water.floating import submerge
from dilatedem.water.loads import body_loads

TOO_FAST, TOO_DEEP = int(Status.TOO_FAST), int(Status.TOO_DEEP)

#: a body that moves farther than this share of the pair list's limit in one step has left the realm of the step size
LONGEST_MOVE = 0.1
#: overlap, in units of the smaller dilated radius of the two, past which the run stops: rounded edges mean nothing any more
DEEPEST = 4.0


@item
def drift_bodies(dt, model, bodies, pairs, clock):
    """Move all bodies; True, or False with the culprit in `clock` where one moves too far in a step."""
    path, solids = bodies.path, model.solids
    for i in range(model.floating):
        if solids.inverse_mass[i] == 0.0:
            path[i] += dt * (pairs.frame[0] ** 2 + pairs.frame[1] ** 2) ** 0.5
            continue
        moved = drift(i, dt, solids, bodies, model.shapes.reach[i], pairs.frame)
        path[i] += moved
        if not moved <= LONGEST_MOVE * pairs.limit[0]:  # also where it is no number
            clock.status[0] = TOO_FAST
            clock.culprit[0] = i
            clock.culprit[1] = -1
            clock.measure[0] = moved
            return False
    for i in range(model.floating, len(path)):
        path[i] += dt * (pairs.frame[0] ** 2 + pairs.frame[1] ** 2) ** 0.5
    return True


@device
def complete_spins(model, bodies):
    """Angular velocities of all free bodies at this instant."""
    solids = model.solids
    for i in range(model.floating):
        if solids.inverse_mass[i] > 0.0:
            complete_spin(i, solids, bodies)


@device
def longest_path(bodies):
    longest = 0.0
    for i in range(len(bodies.path)):
        longest = max(longest, bodies.path[i])
    return longest


@device
def _collide_block(block, blocks, count, dt, shapes, solids, contact, surroundings, bodies, pairs, workspace):
    """Evaluate one of `blocks` equal parts of the awake pairs, in a clipping workspace of its own."""
    for w in range(count * block // blocks, count * (block + 1) // blocks):
        collide(
            workspace.awake[w], dt, shapes, workspace.vertex, workspace.face_normal, solids, bodies, pairs, contact, surroundings,
            workspace.clip[block],
        )  # fmt: skip


@device
def _collide_alone(team, count, dt, shapes, solids, contact, surroundings, bodies, pairs, workspace):
    _collide_block(0, 1, count, dt, shapes, solids, contact, surroundings, bodies, pairs, workspace)


@shared_loop
def _collide_shared(team, count, dt, shapes, solids, contact, surroundings, bodies, pairs, workspace):
    blocks = team.threads
    for block in prange(blocks):
        _collide_block(block, blocks, count, dt, shapes, solids, contact, surroundings, bodies, pairs, workspace)


_collide_all = by_team(_collide_alone, _collide_shared)


@device
def collide_pairs(team, count, dt, model, bodies, pairs, workspace):
    """Evaluate the awake pairs, `count` of them."""
    # unpacked here: a parallel loop takes NamedTuples only as arguments, and none inside another
    _collide_all(team, count, dt, model.shapes, model.solids, model.contact, model.surroundings, bodies, pairs, workspace)


@device
def _load_and_kick_block(block, blocks, floating, dt, hulls, solids, surroundings, bodies, workspace):
    """All loads on one of `blocks` equal parts of the bodies, and the second half of their kick; dt = 0: the loads alone."""
    first, last = floating * block // blocks, floating * (block + 1) // blocks
    if surroundings.water:
        submerge(first, last, hulls, bodies, workspace, block)
    for i in range(first, last):
        force, torque, power = body_loads(i, hulls, solids, surroundings, bodies, workspace.wet)
        for m in range(3):
            bodies.force[i, m] = force[m] + bodies.contact_force[i, m]
            bodies.torque[i, m] = torque[m] + bodies.contact_torque[i, m]
        bodies.work_drag[i] += 0.5 * dt * (power + bodies.drag_power[i])
        bodies.drag_power[i] = power
        if dt > 0.0 and solids.inverse_mass[i] > 0.0:
            kick(i, dt, solids, bodies)


@device
def _load_and_kick_alone(team, floating, dt, hulls, solids, surroundings, bodies, workspace):
    _load_and_kick_block(0, 1, floating, dt, hulls, solids, surroundings, bodies, workspace)


@shared_loop
def _load_and_kick_shared(team, floating, dt, hulls, solids, surroundings, bodies, workspace):
    blocks = team.threads
    for block in prange(blocks):
        _load_and_kick_block(block, blocks, floating, dt, hulls, solids, surroundings, bodies, workspace)


_load_and_kick_all = by_team(_load_and_kick_alone, _load_and_kick_shared)


@device
def load_and_kick(team, dt, model, bodies, workspace):
    """All loads on all bodies and the end of their kick."""
    _load_and_kick_all(team, model.floating, dt, model.hulls, model.solids, model.surroundings, bodies, workspace)


@device
def too_deep(count, shapes, contact, pairs, workspace, clock):
    """Whether some overlap is past what the method can mean; status and culprits go to `clock`."""
    for w in range(count):
        k = workspace.awake[w]
        a, b = pairs.a[k], pairs.b[k]
        radius = shapes.radius[a] if shapes.kind[b] != 0 else min(shapes.radius[a], shapes.radius[b])
        limit = DEEPEST * radius
        if contact.model == CONSISTENT:
            limit = min(limit, DEEPEST_SHARE * (shapes.radius[a] + shapes.radius[b]))
        if pairs.overlap[k] > limit:
            clock.status[0] = TOO_DEEP
            clock.culprit[0], clock.culprit[1] = a, b
            clock.measure[0] = pairs.overlap[k]
            return True
    return False
