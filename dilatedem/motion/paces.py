"""Two paces: floes that may touch take short steps, all others one long step beside them.

Contacts last milliseconds, the water's loads change over a second, and at most times most floes touch nothing. So the
steps of a run come in spans. At the start of a span all bodies stand at the same instant; each is given room for the way that its
present loads let it go and a quarter of that, and two bodies that could meet within their rooms are *busy*. Busy bodies take the
short steps of the contacts, *idle* ones the whole span in one step of the same scheme, of which the water's loads change over
hundreds. Nothing can be missed: a busy body that is about to leave its room (something hit it) ends the span early.
"""

from math import sqrt

from dilatedem.jit import item
from dilatedem.motion.carry import carried_travel
from dilatedem.motion.modal import travel
from dilatedem.state.response import is_free, is_joined

#: a body that moves farther than this share of the pair list's limit in one step has left the realm of the step size
LONGEST_MOVE = 0.1
#: the room of a body beyond the way that it will go if its loads stay as they are, as a share of that way and in short steps of
#: it: the larger of both; effect: how many bodies are busy for nothing
SPARE_WAY, SPARE_STEPS = 0.25, 2.0
#: what every room has besides, as a share of the pair list's limit: room to be hit from rest
SPARE_ROOM = 0.001
#: share of what a room has to spare that a body may use up before the span ends; the rest is for one more short step
HORIZON = 0.25


@item
def foresee(dt, span, model, bodies, pairs, workspace):
    """Who can meet whom within the next `span` steps of dt [s], fewer where some body is too fast for so many.

    Returns the number of steps, and how many entries `workspace.near`, `.busy` and `.idle` have: pairs that may touch, their
    bodies, and all others.
    """
    limit = LONGEST_MOVE * pairs.limit[0]
    while not _give_room(span, span * dt, model, bodies, pairs, workspace) <= limit and span > 1:
        span //= 2
    near = _near_pairs(model.solids, bodies, pairs, workspace)
    busy, idle = _by_pace(bodies, workspace)
    return span, near, busy, idle


@item
def _give_room(span, time, model, bodies, pairs, workspace):
    """Room for all bodies over a span that takes a time [s]; returns the longest way that one of them would go [m]."""
    solids, path, room, horizon = model.solids, bodies.path, workspace.room, workspace.horizon
    adrift = time * sqrt(pairs.frame[0] ** 2 + pairs.frame[1] ** 2)  # of what stands still, in the frame of the ice
    share, least = max(SPARE_WAY, SPARE_STEPS / span), SPARE_ROOM * pairs.limit[0]
    longest = 0.0
    for i in range(len(path)):
        way = adrift
        if is_free(i, solids):
            way = travel(i, time, solids, bodies, model.shapes.reach[i], pairs.frame)
            longest = way if not way <= longest else longest  # also where it is no number
        elif solids.carried[i]:
            way = carried_travel(i, time, bodies.velocity, bodies.angular_velocity, model.shapes.plan_reach, pairs.frame)
            longest = way if not way <= longest else longest
        spare = share * way + least
        room[i] = way + spare
        horizon[i] = path[i] + way + HORIZON * spare
    return longest


@item
def _near_pairs(solids, bodies, pairs, workspace):
    """Pairs whose gap both rooms together could close, to `workspace.near`; their bodies are marked. Returns how many.

    So are all parts of structures that move, and of floes of several: they share one motion, and one of them may be hit.
    """
    path, room, near, is_busy = bodies.path, workspace.room, workspace.near, workspace.is_busy
    for i in range(len(path)):
        is_busy[i] = solids.carried[i] or is_joined(i, solids)
    found = 0
    for k in range(pairs.count[0]):
        a, b = pairs.a[k], pairs.b[k]
        if path[a] + path[b] + (room[a] + room[b]) >= pairs.wake[k]:
            near[found] = k
            found += 1
            is_busy[a] = is_busy[b] = True
    return found


@item
def _by_pace(bodies, workspace):
    """Numbers of the busy and of the idle bodies, in order; returns how many of each."""
    busy = idle = 0
    for i in range(len(bodies.path)):
        if workspace.is_busy[i]:
            workspace.busy[busy] = i
            busy += 1
        else:
            workspace.idle[idle] = i
            workspace.stride[i] = 1  # of the whole span
            idle += 1
    return busy, idle
