"""The stages of a time step over lists of bodies or pairs, one thread or several.

A parallel loop's body is one call of an ordinary device function, and every item writes its own rows only: results do not depend
on the number of threads. (Writes through a NamedTuple *inside* a prange would be lost without an error.)
"""

from dilatedem.contact.collide import collide
from dilatedem.contact.sums import sum_contacts
from dilatedem.contact.tally import book_contact
from dilatedem.contact.turning import turn_shape
from dilatedem.jit import Team, by_type, device, item, prange, prefetch, shared_loop
from dilatedem.motion.integrate import complete_spin, drift, kick
from dilatedem.motion.paces import LONGEST_MOVE
from dilatedem.water.floating import submerge
from dilatedem.water.loads import body_loads

#: cache lines of a pair's row
PAIR_LINES = 6
#: pairs between the one that is evaluated and the one whose data are asked for
AHEAD = 64
#: the same, of what says where a body's corners and faces lie
FAR_AHEAD = 2 * AHEAD
#: cache lines that the vertices, the face normals and the faces' corners of a floe fill; of larger ones the rest is waited for
VERTEX_LINES, NORMAL_LINES, LOOP_LINES = 5, 4, 3


@device
def part(count, block, blocks):
    """Where one of `blocks` equal parts of a list begins, and where the next does."""
    return count * block // blocks, count * (block + 1) // blocks


@device
def tick(clock):
    """A step is done, and it is later."""
    clock.step[0] += 1
    clock.time[0] = clock.since_time[0] + (clock.step[0] - clock.since_step[0]) * clock.dt[0]


@device
def longest_path(bodies):
    longest = 0.0
    for i in range(len(bodies.path)):
        longest = max(longest, bodies.path[i])
    return longest


@device
def complete_spins(model, bodies):
    """Angular velocities of all free bodies at this instant."""
    solids = model.solids
    for i in range(model.floating):
        if solids.inverse_mass[i] > 0.0:
            complete_spin(i, solids, bodies)


# --- move --------------------------------------------------------------------------------------------------------------------


@device
def _drift_block(block, blocks, chosen, count, dt, reach, solids, bodies, pairs, workspace):
    path, horizon = bodies.path, workspace.horizon
    adrift = dt * (pairs.frame[0] ** 2 + pairs.frame[1] ** 2) ** 0.5
    longest = LONGEST_MOVE * pairs.limit[0]
    fault, leap, surprise = -1, 0.0, False
    first, last = part(count, block, blocks)
    for w in range(first, last):
        i = chosen[w]
        moved = adrift
        if solids.inverse_mass[i] > 0.0:
            moved = drift(i, dt, solids, bodies, reach[i], pairs.frame)
            if not moved <= longest and fault < 0:  # also where it is no number
                fault, leap = i, moved
        path[i] += moved
        surprise = surprise or path[i] > horizon[i]
    workspace.fault[block], workspace.leap[block], workspace.surprise[block] = fault, leap, surprise


@device
def _drift_alone(team, chosen, count, dt, reach, solids, bodies, pairs, workspace):
    _drift_block(0, 1, chosen, count, dt, reach, solids, bodies, pairs, workspace)


@shared_loop
def _drift_shared(team, chosen, count, dt, reach, solids, bodies, pairs, workspace):
    blocks = team.threads
    for block in prange(blocks):
        _drift_block(block, blocks, chosen, count, dt, reach, solids, bodies, pairs, workspace)


_drift_all = by_type(_drift_alone, {Team: _drift_shared})


@device
def drift_bodies(team, chosen, count, dt, model, bodies, pairs, workspace, clock):
    """Move the first `count` of the bodies in `chosen`; True, or False with the culprit in `clock` where one moves too far."""
    # unpacked here: a parallel loop takes NamedTuples only as arguments, and none inside another
    _drift_all(team, chosen, count, dt, model.shapes.reach, model.solids, bodies, pairs, workspace)
    for block in range(len(workspace.fault)):
        i = workspace.fault[block]
        if i >= 0:
            clock.culprit[0], clock.culprit[1] = i, -1
            clock.measure[0] = workspace.leap[block]
            return False
    return True


@device
def surprised(workspace):
    """Whether some body has got farther than it was taken to: others may meet it now that nobody looks at."""
    for block in range(len(workspace.surprise)):
        if workspace.surprise[block]:
            return True
    return False


# --- meet --------------------------------------------------------------------------------------------------------------------


@item
def _fetch_places(block, w, last, shapes, solids, bodies, pairs, workspace):
    """Ask for what `_fetch` must know of a pair's bodies, and for the numbers that a body has one of.

    Of body b alone: pairs are sorted by body a, whose numbers come in order, which the processor foresees by itself.
    """
    if w >= last:
        return
    b, turned = pairs.b[workspace.awake[w]], workspace.turned[block]
    prefetch(turned, b, 0)
    prefetch(shapes.vertex_start, b, 0)
    prefetch(shapes.face_start, b, 0)
    prefetch(shapes.radius, b, 0)
    prefetch(shapes.kind, b, 0)
    prefetch(solids.inverse_mass, b, 0)
    prefetch(solids.compliance, b, 0)
    prefetch(bodies.path, b, 0)


@item
def _fetch_loops(w, last, shapes, pairs, workspace):
    """Ask for where the loops of a pair's faces begin."""
    if w >= last:
        return
    k = workspace.awake[w]
    prefetch(shapes.loop_start, shapes.face_start[pairs.a[k]], 0)
    prefetch(shapes.loop_start, shapes.face_start[pairs.b[k]], 0)


@item
def _fetch(block, w, last, shapes, bodies, pairs, workspace):
    """Ask for what awake pair w and its bodies will need, while others are evaluated.

    With some thousand bodies a step's data no longer fit into the processor's cache, and a pair would wait for each part of them in
    turn. Nothing here may wait either: where a body's corners lie was asked for before, and how many lines they fill is not asked.
    """
    if w >= last:
        return
    k, instant, turned = workspace.awake[w], workspace.instant[0], workspace.turned
    for line in range(PAIR_LINES):
        prefetch(pairs.row, k, line)
    for body in (pairs.a[k], pairs.b[k]):
        if abs(turned[block, body]) != instant:
            turned[block, body] = -instant  # asked for, not yet turned
            _fetch_body(body, shapes, bodies, workspace)


@item
def _fetch_body(body, shapes, bodies, workspace):
    prefetch(bodies.position, body, 0)
    prefetch(bodies.orientation, body, 0)
    prefetch(bodies.velocity, body, 0)
    prefetch(bodies.angular_velocity, body, 0)
    prefetch(bodies.middle_velocity, body, 0)
    prefetch(bodies.middle_angular_velocity, body, 0)
    vertex, face = shapes.vertex_start[body], shapes.face_start[body]
    for line in range(VERTEX_LINES):
        prefetch(shapes.vertex, vertex, line)
        prefetch(workspace.vertex, vertex, line)
    for line in range(NORMAL_LINES):
        prefetch(shapes.face_normal, face, line)
        prefetch(workspace.face_normal, face, line)
    for line in range(LOOP_LINES):
        prefetch(shapes.loop, shapes.loop_start[face], line)


@item
def _turn_shapes(block, k, shapes, orientation, pairs, workspace):
    """Have the shapes of pair k turned to this instant by this thread.

    Just before they are looked at, while they are in the processor's cache. A body that two threads look at is turned by both, and
    both write the same.
    """
    instant, turned = workspace.instant[0], workspace.turned
    for body in (pairs.a[k], pairs.b[k]):
        if turned[block, body] != instant:
            turned[block, body] = instant
            turn_shape(body, shapes, orientation, workspace.vertex, workspace.face_normal)


@device
def _collide_block(block, blocks, count, dt, structure_of, shapes, solids, contact, surroundings, bodies, pairs, workspace, tally):
    """Evaluate and book the awake pairs of some parts of the tally, in a clipping workspace of this block's own."""
    first_part, last_part = part(len(tally.deep), block, blocks)
    last = part(count, last_part - 1, len(tally.deep))[1]
    for p in range(first_part, last_part):
        tally.deep[p] = -1
        start, end = part(count, p, len(tally.deep))
        for w in range(start, end):
            _fetch_places(block, w + FAR_AHEAD, last, shapes, solids, bodies, pairs, workspace)
            _fetch_loops(w + (AHEAD + FAR_AHEAD) // 2, last, shapes, pairs, workspace)
            _fetch(block, w + AHEAD, last, shapes, bodies, pairs, workspace)
            k = workspace.awake[w]
            _turn_shapes(block, k, shapes, bodies.orientation, pairs, workspace)
            collide(
                k, dt, shapes, workspace.vertex, workspace.face_normal, solids, bodies, pairs, contact, surroundings,
                workspace.clip[block],
            )  # fmt: skip
            book_contact(k, p, dt, structure_of, shapes, contact, pairs, tally)


@device
def _collide_alone(team, count, dt, structure_of, shapes, solids, contact, surroundings, bodies, pairs, workspace, tally):
    _collide_block(0, 1, count, dt, structure_of, shapes, solids, contact, surroundings, bodies, pairs, workspace, tally)


@shared_loop
def _collide_shared(team, count, dt, structure_of, shapes, solids, contact, surroundings, bodies, pairs, workspace, tally):
    blocks = team.threads
    for block in prange(blocks):
        _collide_block(
            block, blocks, count, dt, structure_of, shapes, solids, contact, surroundings, bodies, pairs, workspace, tally
        )


_collide_all = by_type(_collide_alone, {Team: _collide_shared})


@device
def collide_pairs(team, count, dt, model, bodies, pairs, workspace, tally):
    """Evaluate the awake pairs, `count` of them; what they cost and showed goes to the tally."""
    m = model
    workspace.instant[0] += 1
    _collide_all(team, count, dt, m.structure_of, m.shapes, m.solids, m.contact, m.surroundings, bodies, pairs, workspace, tally)


# --- float -------------------------------------------------------------------------------------------------------------------


@device
def _load_and_kick_block(
    block, blocks, chosen, count, awake, dt, time, floating, hulls, solids, setting, bodies, pairs, workspace
):
    """All loads on one of `blocks` equal parts of the bodies, and the second half of their kick; dt = 0: the loads alone."""
    first, last = part(count, block, blocks)
    if first == last:
        return
    sum_contacts(chosen, first, last, awake, bodies, pairs, workspace)
    while last > first and chosen[last - 1] >= floating:  # structures feel no water and never move
        last -= 1
    if setting.water:
        submerge(chosen, first, last, hulls, bodies, workspace, block)
    for w in range(first, last):
        i = chosen[w]
        force, torque = body_loads(i, dt, time, setting, hulls, solids, bodies, workspace.wet)
        for m in range(3):
            bodies.force[i, m] = force[m] + bodies.contact_force[i, m]
            bodies.torque[i, m] = torque[m] + bodies.contact_torque[i, m]
        if dt > 0.0 and solids.inverse_mass[i] > 0.0:
            kick(i, dt, solids, bodies)


@device
def _load_and_kick_alone(team, chosen, count, awake, dt, time, floating, hulls, solids, setting, bodies, pairs, workspace):
    _load_and_kick_block(0, 1, chosen, count, awake, dt, time, floating, hulls, solids, setting, bodies, pairs, workspace)


@shared_loop
def _load_and_kick_shared(team, chosen, count, awake, dt, time, floating, hulls, solids, setting, bodies, pairs, workspace):
    blocks = team.threads
    for block in prange(blocks):
        _load_and_kick_block(
            block, blocks, chosen, count, awake, dt, time, floating, hulls, solids, setting, bodies, pairs, workspace
        )


_load_and_kick_all = by_type(_load_and_kick_alone, {Team: _load_and_kick_shared})


@device
def load_and_kick(team, chosen, count, awake, dt, time, model, bodies, pairs, workspace):
    """All loads at `time` on the first `count` bodies in `chosen`, contacts among the `awake` pairs; the end of their kick."""
    _load_and_kick_all(
        team, chosen, count, awake, dt, time, model.floating, model.hulls, model.solids, model.loads, bodies, pairs, workspace
    )
