"""What every step leaves behind: the extremes of the loads on structures, windows that end, load events."""

from dilatedem.jit import item
from dilatedem.step.hits import watch_hits
from dilatedem.structures.record import end_window, record_loads


@item
def note_steps(noted, until, near, at_structure, dt, model, ids, bodies, pairs, workspace, loads, windows, hits, log):
    """Note the steps after `noted` up to `until`, all with the loads there are; returns the last one that is noted.

    Between two instants at which something is due nothing changes that is known.
    """
    while noted < until:
        noted += 1
        record_loads(model.records, loads)
        end_window(noted, loads, windows)
        watch_hits(noted, near, at_structure, dt, model, ids, bodies, pairs, workspace, loads, hits, log)
    return noted
