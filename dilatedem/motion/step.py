"""The time step: the whole method on one page."""

from dilatedem.contact.gather import gather_contacts, record_loads
from dilatedem.contact.neighbours import awake_pairs, find_pairs
from dilatedem.contact.turning import turn_awake
from dilatedem.jit import kernel
from dilatedem.motion.stages import collide_pairs, complete_spins, drift_bodies, load_and_kick, longest_path, too_deep
from dilatedem.state.clock import Status

DONE, PAIRS_FULL = int(Status.DONE), int(Status.PAIRS_FULL)


@kernel
def advance(team, model, bodies, pairs, spare, cells, workspace, ledger, loads, clock, dt, steps):
    """Advance all bodies by up to `steps` steps of dt [s]; returns a `Status`, its culprit in `clock`.

    team: `jit.Alone` or `jit.Team`. The method of Liu, Long & Ji (2015): move, meet, float. Bodies hold positions, velocities and
    loads of one instant, before and after; a step of dt = 0 moves nothing and only evaluates the loads, as a run needs at its
    start.
    """
    status = DONE
    for _ in range(steps):
        if longest_path(bodies) >= pairs.limit[0] and not find_pairs(model, bodies, pairs, spare, cells, clock):
            status = PAIRS_FULL
            break
        if not drift_bodies(dt, model, bodies, pairs, clock):
            status = clock.status[0]
            break
        clock.step[0] += 1
        awake = awake_pairs(bodies, pairs, workspace.awake)
        turn_awake(clock.step[0], awake, model.shapes, bodies, pairs, workspace)
        collide_pairs(team, awake, dt, model, bodies, pairs, workspace)
        gather_contacts(workspace.awake, awake, dt, model.floating, bodies, pairs, ledger, loads, clock)
        load_and_kick(team, dt, model, bodies, workspace)
        record_loads(loads)
        if too_deep(awake, model.shapes, model.contact, pairs, workspace, clock):
            status = clock.status[0]
            break
    complete_spins(model, bodies)
    return status
