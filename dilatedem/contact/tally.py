"""What contacts cost and showed: booked pair by pair in a fixed number of parts, so that sums do not depend on the threads."""

from dilatedem.contact.laws import deepest
from dilatedem.jit import item
from dilatedem.state.ledger import COSTS

#: of the ledger, that contacts have
TERMS = len(COSTS)
#: overlap, in units of the smaller dilated radius of the two, past which the run stops
DEEPEST = 4.0
#: overlap with what has crushed, over the sum of the two dilated radii, past which the run stops: the cores are about to touch
CRUSHED_THROUGH = 0.95


@item
def book_contact(k, part, dt, steps, structure_of, shapes, contact, pairs, tally):
    """Add what pair k cost and showed in a stride of so many steps of dt [s] to row `part` of the tally (`state.storage.Tally`)."""
    tally.work[part, 0] += 1
    tally.work[part, 1] += pairs.rounds[k]
    for term in range(TERMS):
        tally.cost[part, term] += pairs.cost[k, term]
    if pairs.overlap[k] <= 0.0:
        # what the end of a contact cost is booked once
        for term in range(TERMS):
            pairs.cost[k, term] = 0.0
        return
    on_structure, mode = 1 if structure_of[pairs.b[k]] >= 0 or structure_of[pairs.a[k]] >= 0 else 0, pairs.mode[k]
    tally.mode_steps[part, on_structure, mode] += steps
    tally.mode_impulse[part, on_structure, mode] += pairs.normal_force[k] * (dt * steps)
    tally.mode_force[part, on_structure, mode] = max(tally.mode_force[part, on_structure, mode], pairs.normal_force[k])
    tally.mode_overlap[part, on_structure, mode] = max(tally.mode_overlap[part, on_structure, mode], pairs.overlap[k])
    a, b = pairs.a[k], pairs.b[k]
    crushed = pairs.crushed[k]
    if tally.deep[part] < 0 and (
        pairs.overlap[k] > deepest_overlap(a, b, shapes, contact)
        or (crushed > 0.0 and crushed + pairs.overlap[k] > CRUSHED_THROUGH * (shapes.radius[a] + shapes.radius[b]))
    ):
        tally.deep[part] = k


@item
def close_tally(tally, ledger, loads, clock):
    """Bring a tally to the ledger, the contact statistics and the counts of work, part by part, and empty it."""
    for part in range(len(tally.deep)):
        clock.evaluations[0] += tally.work[part, 0]
        clock.rounds[0] += tally.work[part, 1]
        tally.work[part, 0] = tally.work[part, 1] = 0
        for term in range(TERMS):
            ledger.cost[term] += tally.cost[part, term]
            tally.cost[part, term] = 0.0
        for s in range(2):
            for mode in range(tally.mode_steps.shape[2]):
                loads.mode_steps[s, mode] += tally.mode_steps[part, s, mode]
                loads.mode_impulse[s, mode] += tally.mode_impulse[part, s, mode]
                loads.mode_force[s, mode] = max(loads.mode_force[s, mode], tally.mode_force[part, s, mode])
                loads.mode_overlap[s, mode] = max(loads.mode_overlap[s, mode], tally.mode_overlap[part, s, mode])
                tally.mode_steps[part, s, mode] = tally.mode_impulse[part, s, mode] = 0.0
                tally.mode_force[part, s, mode] = tally.mode_overlap[part, s, mode] = 0.0


@item
def too_deep(tally, pairs, clock):
    """Whether some overlap is past what the method can mean; its bodies go to `clock`."""
    for part in range(len(tally.deep)):
        k = tally.deep[part]
        if k >= 0:
            clock.culprit[0], clock.culprit[1] = pairs.a[k], pairs.b[k]
            clock.measure[0] = pairs.overlap[k] + pairs.crushed[k]
            return True
    return False


@item
def deepest_overlap(a, b, shapes, contact):
    """Overlap [m] past which rounded edges mean nothing any more, or the law does not."""
    smaller = shapes.radius[a] if shapes.kind[b] != 0 else min(shapes.radius[a], shapes.radius[b])
    return min(DEEPEST * smaller, deepest(contact, shapes.radius[a] + shapes.radius[b]))
