"""The time step: the whole method on one page."""

from dilatedem.contact.search.neighbours import awake_pairs, find_pairs, pairs_at_structures
from dilatedem.contact.sums import sum_on_held
from dilatedem.contact.tally import close_tally, too_deep
from dilatedem.jit import kernel, lap
from dilatedem.motion.carry import carry_structures, push_structures
from dilatedem.motion.energy import book_energies
from dilatedem.motion.joined import push_joined
from dilatedem.motion.paces import foresee
from dilatedem.motion.strides import choose_strides, next_due, set_out
from dilatedem.motion.timestep import assembled_frequency
from dilatedem.state.clock import NEVER, Status
from dilatedem.step.crushed import record_crushed
from dilatedem.step.launch import collide_pairs, complete_spins, drift_bodies, float_and_kick, longest_path, surprised, tick
from dilatedem.step.note import note_steps
from dilatedem.step.stages import COLLIDE, DRIFT, FLOAT, FORESEE, IDLE, RECORD, SEARCH, STRIDE, WAKE
from dilatedem.structures.record import begin_strides, load_structures

DONE, PAIRS_FULL, TOO_FAST, TOO_DEEP = int(Status.DONE), int(Status.PAIRS_FULL), int(Status.TOO_FAST), int(Status.TOO_DEEP)


@kernel
def advance(
    team, timer, model, ids, bodies, excursions, pairs, spare, cells, workspace, tally, ledger, loads, windows, hits, log, clock,
    pace, steps,
):  # fmt: skip
    """Advance all bodies by up to `steps` steps of `clock.dt`; returns a `Status`, its culprit in `clock`.

    The method of Liu, Long & Ji (2015): move, meet, float. Bodies hold positions, velocities and loads of one instant, before and
    after; a step of dt = 0 moves nothing and only evaluates the loads. team: `jit.Alone` or `jit.Team`; timer: `jit.NoTimer`, or
    `jit.Timer` for benchmarks; pace: `motion.strides.Pace`, how many steps bodies may take in one.
    """
    m, status, goal, dt = model, DONE, clock.step[0] + steps, clock.dt[0]
    while status == DONE and clock.step[0] < goal:
        lap(timer, -1)
        if longest_path(bodies) >= pairs.limit[0] and not find_pairs(model, bodies, pairs, spare, cells, clock):
            status = PAIRS_FULL
            break
        lap(timer, SEARCH)
        start = clock.step[0]
        ahead, near, busy, idle = foresee(dt, min(pace.span - start % pace.span, goal - start), model, bodies, pairs, workspace)
        clock.moves[0] += idle
        end, noted, at_structure = start + ahead, start, pairs_at_structures(near, m.structure_of, pairs, workspace)
        due = set_out(start, near, busy, m.solids, pairs, workspace)
        lap(timer, FORESEE)
        while True:
            choose_strides(clock.step[0], end, dt, pace, near, due, model, bodies, pairs, workspace)
            now, due = next_due(clock.step[0], end, busy, workspace)
            noted = note_steps(
                noted, min(now, end + 1) - 1, near, at_structure, dt, model, ids, bodies, pairs, workspace, loads, windows, hits,
                log,
            )  # fmt: skip
            lap(timer, STRIDE)
            if now == NEVER:
                break
            begin_strides(at_structure, m.structure_of, bodies, excursions, pairs, workspace, loads)
            later = now > clock.step[0]
            if later:
                carry_structures(dt, model, bodies, excursions, clock)
            if not drift_bodies(team, workspace.due_bodies, due, dt, model, bodies, pairs, workspace, clock):
                status = TOO_FAST
                break
            lap(timer, DRIFT)
            tick(now, clock, workspace)
            clock.moves[0] += due
            awake = awake_pairs(near, bodies, pairs, workspace)
            lap(timer, WAKE)
            collide_pairs(
                team, awake, dt, m.structure_of, m.shapes, m.solids, m.contact, m.surroundings, bodies, pairs, workspace, tally
            )
            lap(timer, COLLIDE)
            float_and_kick(
                team, workspace.due_bodies, due, awake, dt, clock.time[0], m.floating, m.hulls, m.solids, m.loads, bodies, pairs,
                workspace,
            )  # fmt: skip
            lap(timer, FLOAT)
            load_structures(at_structure, dt, model, bodies, excursions, pairs, workspace, loads)
            if later:
                push_joined(dt, model, bodies)
                push_structures(dt, model, bodies, excursions, loads)
            record_crushed(m.contact, at_structure, m.structure_of, m.records, pairs, workspace, loads)
            if too_deep(tally, pairs, clock):
                status = TOO_DEEP
            if status != DONE or surprised(team, workspace):
                end = now  # and the others come to this instant, too
            lap(timer, RECORD)
        spent = (clock.step[0] - start) * dt
        if not drift_bodies(team, workspace.idle, idle, spent, model, bodies, pairs, workspace, clock):
            status = TOO_FAST
        float_and_kick(
            team, workspace.idle, idle, 0, spent, clock.time[0], m.floating, m.hulls, m.solids, m.loads, bodies, pairs, workspace
        )
        lap(timer, IDLE)
    sum_on_held(bodies, pairs, model.solids)
    close_tally(tally, ledger, loads, clock)
    complete_spins(model, bodies)
    book_energies(model, bodies, pairs, workspace, ledger)
    clock.frequency[0] = assembled_frequency(m, bodies, pairs, workspace)
    return status
