"""The time step: the whole method on one page."""

from dilatedem.contact.search.neighbours import awake_pairs, find_pairs
from dilatedem.contact.tally import close_tally, too_deep
from dilatedem.jit import kernel
from dilatedem.motion.energy import book_energies
from dilatedem.motion.paces import foresee
from dilatedem.motion.timestep import assembled_frequency
from dilatedem.state.clock import Status
from dilatedem.step.blocks import collide_pairs, complete_spins, drift_bodies, load_and_kick, longest_path, surprised, tick
from dilatedem.structures.record import end_window, load_structures, record_loads

DONE, PAIRS_FULL, TOO_FAST, TOO_DEEP = int(Status.DONE), int(Status.PAIRS_FULL), int(Status.TOO_FAST), int(Status.TOO_DEEP)


@kernel
def advance(team, model, bodies, pairs, spare, cells, workspace, tally, ledger, loads, windows, clock, span, steps):
    """Advance all bodies by up to `steps` steps of `clock.dt`; returns a `Status`, its culprit in `clock`.

    team: `jit.Alone` or `jit.Team`. The method of Liu, Long & Ji (2015): move, meet, float. Bodies hold positions, velocities and
    loads of one instant, before and after; a step of dt = 0 moves nothing and only evaluates the loads, as a run needs at its
    start. span: bodies that nothing can touch take up to so many steps in one; 1 for the plain scheme.
    """
    status, goal, dt = DONE, clock.step[0] + steps, clock.dt[0]
    while status == DONE and clock.step[0] < goal:
        if longest_path(bodies) >= pairs.limit[0] and not find_pairs(model, bodies, pairs, spare, cells, clock):
            status = PAIRS_FULL
            break
        start = clock.step[0]
        ahead, near, busy, idle = foresee(dt, min(span - start % span, goal - start), model, bodies, pairs, workspace)
        clock.moves[0] += idle
        while clock.step[0] < start + ahead:
            if not drift_bodies(team, workspace.busy, busy, dt, model, bodies, pairs, workspace, clock):
                status = TOO_FAST
                break
            tick(clock)
            clock.moves[0] += busy
            awake, at_structure = awake_pairs(near, model.structure_of, bodies, pairs, workspace)
            collide_pairs(team, awake, dt, model, bodies, pairs, workspace, tally)
            load_and_kick(team, workspace.busy, busy, awake, dt, clock.time[0], model, bodies, pairs, workspace)
            load_structures(at_structure, dt, model.structure_of, model.charts, bodies, pairs, workspace, loads)
            record_loads(loads)
            end_window(clock.step[0], loads, windows)
            if too_deep(tally, pairs, clock):
                status = TOO_DEEP
            if status != DONE or surprised(workspace):
                break
        spent = (clock.step[0] - start) * dt
        if not drift_bodies(team, workspace.idle, idle, spent, model, bodies, pairs, workspace, clock):
            status = TOO_FAST
        load_and_kick(team, workspace.idle, idle, 0, spent, clock.time[0], model, bodies, pairs, workspace)
    close_tally(tally, ledger, loads, clock)
    complete_spins(model, bodies)
    book_energies(model, bodies, pairs, workspace, ledger)
    clock.frequency[0] = assembled_frequency(model.solids, bodies, pairs, workspace)
    return status
