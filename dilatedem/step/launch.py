"""The stages of a step over whole lists: alone, or shared by a team of threads.

A parallel loop's body is one call of an ordinary function: writes through a NamedTuple *inside* a prange would be lost without an
error. It takes NamedTuples only as arguments, and none inside another, so `advance` hands on the parts of the model. Every layer of
calls above the stages is compiled once more with all that is below it, so `advance` calls the stages themselves (`jit.by_type`):
alone, a stage is one block of one.
"""

from dilatedem.jit import Team, by_type, item, prange, shared_loop
from dilatedem.motion.integrate import complete_spin
from dilatedem.state.response import is_free
from dilatedem.step.blocks import collide_block, drift_block, float_block


@item
def tick(step, clock, workspace):
    """It is the instant of a step, and no shape is turned to it yet."""
    workspace.instant[0] += 1
    clock.step[0] = step
    clock.time[0] = clock.since_time[0] + (clock.step[0] - clock.since_step[0]) * clock.dt[0]


@item
def longest_path(bodies):
    """The longest of all bodies' paths [m] since the list of pairs was made."""
    longest = 0.0
    for i in range(len(bodies.path)):
        longest = max(longest, bodies.path[i])
    return longest


@item
def complete_spins(model, bodies):
    """Angular velocities of all free bodies at this instant."""
    for i in range(model.floating):
        if is_free(i, model.solids):
            complete_spin(i, model.solids, bodies)


@shared_loop
def _drift_shared(team, chosen, count, dt, shapes, solids, bodies, pairs, workspace):
    parts = team.threads
    for each in prange(parts):
        drift_block(team, chosen, count, dt, shapes, solids, bodies, pairs, workspace, each, parts)


_drift_all = by_type(drift_block, {Team: _drift_shared})


@item
def drift_bodies(team, chosen, count, dt, model, bodies, pairs, workspace, clock):
    """Move the first `count` of the bodies in `chosen`; True, or False with the culprit in `clock` where one moves too far."""
    _drift_all(team, chosen, count, dt, model.shapes, model.solids, bodies, pairs, workspace)
    for block in range(team.threads):
        i = workspace.fault[block]
        if i >= 0:
            clock.culprit[0], clock.culprit[1] = i, -1
            clock.measure[0] = workspace.leap[block]
            return False
    return True


@item
def surprised(team, workspace):
    """Whether some body has got farther than it was taken to: others may meet it now that nobody looks at."""
    for block in range(team.threads):
        if workspace.surprise[block]:
            return True
    return False


@shared_loop
def _collide_shared(
    team, count, dt, structure_of, shapes, solids, contact, surroundings, bodies, pairs, workspace, tally
):
    parts = team.threads
    for each in prange(parts):
        collide_block(
            team, count, dt, structure_of, shapes, solids, contact, surroundings, bodies, pairs, workspace, tally, each, parts
        )


#: Evaluate the awake pairs, `count` of them; what they cost and showed goes to the tally.
collide_pairs = by_type(collide_block, {Team: _collide_shared})


@shared_loop
def _float_shared(
    team, chosen, count, awake, dt, time, floating, hulls, solids, setting, bodies, pairs, workspace
):
    parts = team.threads
    for each in prange(parts):
        float_block(
            team, chosen, count, awake, dt, time, floating, hulls, solids, setting, bodies, pairs, workspace, each, parts
        )


#: All loads at `time` on the first `count` bodies in `chosen`, contacts among the `awake` pairs; the end of their kick.
float_and_kick = by_type(float_block, {Team: _float_shared})
