"""The time step: the whole method on one page."""

from dilatedem.contact.gather import gather_contacts, record_loads
from dilatedem.contact.neighbours import awake_pairs, find_pairs
from dilatedem.contact.turning import turn_awake
from dilatedem.jit import kernel
from dilatedem.motion.stages import collide_pairs, drift_bodies, load_and_kick, longest_path, too_deep
from dilatedem.state.clock import Status

DONE, PAIRS_FULL = int(Status.DONE), int(Status.PAIRS_FULL)


@kernel
def advance(team, model, bodies, pairs, spare, cells, workspace, ledger, loads, clock, dt, steps):
    """Advance all bodies by up to `steps` steps of dt [s]; returns a `Status`, its culprit in `clock`.

    team: `jit.Alone` or `jit.Team`. The method of Liu, Long & Ji (2015): move, meet, float. Bodies hold positions, velocities and
    loads of one instant, before and after; a step of dt = 0 moves nothing and only evaluates the loads, as a run needs at its start.
    """
    for _ in range(steps):
        if longest_path(bodies) >= pairs.limit[0] and not find_pairs(model, bodies, pairs, spare, cells):
            return PAIRS_FULL
        if not drift_bodies(dt, model, bodies, pairs, clock):
            return clock.status[0]
        clock.step[0] += 1
        awake = awake_pairs(bodies, pairs, workspace.awake)
        turn_awake(clock.step[0], awake, model.shapes, bodies, pairs, workspace)
        collide_pairs(team, awake, dt, model, bodies, pairs, workspace)
        gather_contacts(workspace.awake, awake, dt, model.floating, bodies, pairs, ledger, loads)
        load_and_kick(team, dt, model, bodies, workspace)
        too_deep(awake, model.shapes, pairs, workspace, clock)
        record_loads(loads)
        if clock.status[0] != DONE:
            return clock.status[0]
    return DONE
