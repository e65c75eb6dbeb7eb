"""Separate load events of structures, told step by step: what came before the step is all that they depend on.

The horizontal force on a structure counts while it reaches a threshold. Two steps at which it counts belong to one event where
less than the gap lies between them, as peaks over a threshold are declustered: a floe that bounces, or grinds along, is one event.
"""

from math import sqrt

from dilatedem.contact.crushing.nominal import contact_area
from dilatedem.jit import item
from dilatedem.numerics.vector import add, load, store
from dilatedem.state.hits import (
    AREA,
    BODIES,
    BODY,
    CONTACTS,
    CRUSHED,
    FIRST,
    FLOES,
    IMPULSE,
    LAST,
    MODE,
    PEAK,
    PEAK_STEP,
    PRESSURE,
    SAMPLES,
    START,
    STRUCTURE,
    SUM,
)

#: share of the normal force of the leading contact from which on a contact counts as loaded, and its floes as pushing
LOADED = 0.05


@item
def watch_hits(step, near, at_structure, dt, model, ids, bodies, pairs, workspace, loads, hits, log):
    """Bring the loads of a step on the watched structures, the first so many, into their events; `near` pairs, `at_structure` of
    them with a structure. A step of no length is none."""
    if dt == 0.0:
        return
    samples = hits.recent.shape[1]
    for h in range(hits.recent.shape[0]):
        fx, fy = loads.step_load[h, 0], loads.step_load[h, 1]
        force = sqrt(fx * fx + fy * fy)
        if samples > 0:
            store(hits.recent[h], step % samples, load(loads.step_load, h))
        counts, figures = hits.counts[h], hits.figures[h]
        if counts[STRUCTURE] >= 0 and step - counts[LAST] >= log.gap:
            _end(h, step, model.whole_of[h] < 0, hits, log)
        counted = force >= log.threshold
        if counted and counts[STRUCTURE] < 0:
            counts[STRUCTURE], counts[START] = h, step
            figures[PEAK] = figures[SUM] = figures[IMPULSE] = 0.0
        if counts[STRUCTURE] < 0:
            continue
        figures[SUM] += force * dt
        if counted:
            counts[LAST], figures[IMPULSE] = step, figures[SUM]
            if force > figures[PEAK]:
                figures[PEAK], counts[PEAK_STEP], counts[SAMPLES] = force, step, 0
                _look_closely(h, near, at_structure, model, ids, bodies, pairs, workspace, hits)
        if step == counts[PEAK_STEP] + log.after:
            _keep_history(h, step, hits, log)
        if step == log.end:
            _end(h, step, model.whole_of[h] < 0, hits, log)


@item
def _end(h, step, may_keep, hits, log):
    """The event of structure h is over: it waits to be written, and takes the place of the lowest that is kept, if it is higher.

    may_keep: of a part of a structure no event is kept, as those of the structure are.
    """
    if hits.counts[h, SAMPLES] == 0:
        _keep_history(h, step, hits, log)
    w = log.waiting[0]
    if w < len(log.counts):  # else nobody fetches them
        for c in range(log.counts.shape[1]):
            log.counts[w, c] = hits.counts[h, c]
        for c in range(log.figures.shape[1]):
            log.figures[w, c] = hits.figures[h, c]
        log.waiting[0] += 1
    lowest = h
    for place in range(hits.recent.shape[0], len(hits.counts) if may_keep else 0):
        if hits.counts[place, STRUCTURE] < 0:
            lowest = place
            break
        if hits.figures[place, PEAK] < hits.figures[lowest, PEAK]:
            lowest = place
    if lowest != h:
        _copy(h, lowest, hits)
    hits.counts[h, STRUCTURE] = -1


@item
def _copy(h, place, hits):
    """Have the event of structure h stand in another place, too."""
    for c in range(hits.counts.shape[1]):
        hits.counts[place, c] = hits.counts[h, c]
    for c in range(hits.figures.shape[1]):
        hits.figures[place, c] = hits.figures[h, c]
    for i in range(hits.history.shape[1]):
        store(hits.history[place], i, load(hits.history[h], i))
    for i in range(hits.floe.shape[1]):
        hits.floe[place, i] = hits.floe[h, i]
        for m in range(7):
            hits.pose[place, i, m] = hits.pose[h, i, m]
    for i in range(hits.touch.shape[1]):
        for m in range(3):
            hits.touch[place, i, m] = hits.touch[h, i, m]
        for m in range(6):
            hits.arrow[place, i, m] = hits.arrow[h, i, m]


@item
def _keep_history(h, step, hits, log):
    """Keep the force on structure h at every step around the peak of its event, up to this one at most."""
    samples, peak = hits.recent.shape[1], hits.counts[h, PEAK_STEP]
    first, last = max(1, peak - log.before), min(step, peak + log.after)
    if samples == 0 or step - first >= samples:
        return
    for s in range(first, last + 1):
        store(hits.history[h], s - first, load(hits.recent[h], s % samples))
    for s in range(last + 1 - first, samples):
        store(hits.history[h], s, (0.0, 0.0, 0.0))
    hits.counts[h, FIRST], hits.counts[h, SAMPLES] = first, last + 1 - first


@item
def _is_of(i, h, model):
    """Whether body i belongs to structure h or to a part of it."""
    s = model.structure_of[i]
    return s == h or (s >= 0 and model.whole_of[s] == h)


@item
def _look_closely(h, near, at_structure, model, ids, bodies, pairs, workspace, hits):
    """Note what leads the highest load of an event so far: the contact of the largest normal force, and who pushes behind it."""
    structure_of, leading, most = model.structure_of, -1, 0.0
    for w in range(at_structure):
        k = workspace.at_structure[w]
        if (_is_of(pairs.a[k], h, model) or _is_of(pairs.b[k], h, model)) and pairs.normal_force[k] > most:
            leading, most = k, pairs.normal_force[k]
    if leading < 0:
        return
    counts, figures = hits.counts[h], hits.figures[h]
    floe = pairs.a[leading] if _is_of(pairs.b[leading], h, model) else pairs.b[leading]
    counts[BODY], counts[MODE] = ids.body[floe], pairs.mode[leading]
    area = contact_area(leading, workspace.vertex, workspace.face_normal, model.shapes, pairs, workspace.clip[0])
    figures[AREA], figures[PRESSURE] = area, most / area if area > 0.0 else 0.0
    figures[CRUSHED] = pairs.crushed[leading]
    loaded = _loaded_pairs(near, LOADED * most, pairs, workspace)
    counts[BODIES] = _pushing(h, loaded, model, pairs, workspace)
    if hits.recent.shape[1] > 0:
        _keep_floes(h, ids, bodies, workspace, hits)
        _keep_contacts(h, loaded, structure_of, ids, bodies, pairs, workspace, hits)
    for w in range(counts[BODIES]):
        workspace.is_pushing[workspace.pushing[w]] = False


@item
def _loaded_pairs(near, least, pairs, workspace):
    """Numbers of the near pairs whose normal force is `least` [N] or more, to `workspace.loaded`; returns how many."""
    found = 0
    for w in range(near):
        k = workspace.near[w]
        if pairs.overlap[k] > 0.0 and pairs.normal_force[k] >= least:
            workspace.loaded[found] = k
            found += 1
    return found


@item
def _pushing(h, loaded, model, pairs, workspace):
    """Floes that push on structure h: through a loaded contact, or through one on a floe that does.

    Their numbers go to `workspace.pushing`, from the structure outward, and marks to `workspace.is_pushing`; returns how many.
    """
    found, marks, structure_of = 0, workspace.is_pushing, model.structure_of
    for w in range(loaded):
        a, b = pairs.a[workspace.loaded[w]], pairs.b[workspace.loaded[w]]
        floe = a if _is_of(b, h, model) else (b if _is_of(a, h, model) else -1)
        if floe >= 0 and not marks[floe]:
            found = _mark(floe, found, workspace)
    before = -1
    while found > before:
        before = found
        for w in range(loaded):
            a, b = pairs.a[workspace.loaded[w]], pairs.b[workspace.loaded[w]]
            if structure_of[a] < 0 and structure_of[b] < 0 and marks[a] != marks[b]:
                found = _mark(b if marks[a] else a, found, workspace)
    return found


@item
def _mark(floe, found, workspace):
    """Put a floe behind the `found` ones that push; returns how many there are."""
    workspace.pushing[found] = floe
    workspace.is_pushing[floe] = True
    return found + 1


@item
def _keep_floes(h, ids, bodies, workspace, hits):
    """Keep numbers and places of the floes that push, the first so many."""
    kept = min(hits.counts[h, BODIES], hits.floe.shape[1])
    for w in range(kept):
        i = workspace.pushing[w]
        hits.floe[h, w] = ids.body[i]
        for m in range(3):
            hits.pose[h, w, m] = bodies.position[i, m]
        for m in range(4):
            hits.pose[h, w, 3 + m] = bodies.orientation[i, m]
    hits.counts[h, FLOES] = kept


@item
def _keep_contacts(h, loaded, structure_of, ids, bodies, pairs, workspace, hits):
    """Keep the loaded contacts of the floes that push, those with structures first."""
    kept, marks = 0, workspace.is_pushing
    for among_floes in range(2):
        for w in range(loaded):
            k = workspace.loaded[w]
            a, b = pairs.a[k], pairs.b[k]
            apart = structure_of[a] < 0 and structure_of[b] < 0
            if apart == (among_floes == 1) and (marks[a] or marks[b]) and kept < hits.touch.shape[1]:
                point, force = add(load(bodies.position, a), load(pairs.point, k)), load(pairs.force, k)
                hits.touch[h, kept, 0] = _number(a, structure_of, ids)
                hits.touch[h, kept, 1] = _number(b, structure_of, ids)
                hits.touch[h, kept, 2] = pairs.mode[k]
                for m in range(3):
                    hits.arrow[h, kept, m], hits.arrow[h, kept, 3 + m] = point[m], force[m]
                kept += 1
    hits.counts[h, CONTACTS] = kept


@item
def _number(i, structure_of, ids):
    """Number of a body as users know it; of a structure -1 less its number."""
    return ids.body[i] if structure_of[i] < 0 else -1 - structure_of[i]
