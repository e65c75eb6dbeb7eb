"""Data of pairs brought into the processor's cache ahead of time.

With some thousand bodies a step's data no longer fit into the cache, and a pair would wait for each part of them in turn. What is
asked for here is not read: it changes no number, and nothing may wait.
"""

from dilatedem.jit import item, prefetch

#: pairs whose data the processor has at hand by itself: 0.4 MB of rows, and as much of their bodies
AT_HAND = 1000
#: cache lines of a pair's row
PAIR_LINES = 6
#: pairs between the one that is evaluated and the one whose data are asked for
AHEAD = 64
#: the same, of what says where a body's corners and faces lie
FAR_AHEAD = 2 * AHEAD
#: cache lines that the vertices, the face normals and the faces' corners of a floe fill; of larger ones the rest is waited for
VERTEX_LINES, NORMAL_LINES, LOOP_LINES = 5, 4, 3


@item
def fetch_ahead(block, w, last, shapes, solids, bodies, pairs, workspace):
    """While awake pair w is evaluated, ask for what later ones before `last` will need, the farther the less is known of them."""
    _fetch_places(block, w + FAR_AHEAD, last, shapes, solids, bodies, pairs, workspace)
    _fetch_loops(w + (AHEAD + FAR_AHEAD) // 2, last, shapes, pairs, workspace)
    _fetch_pair(block, w + AHEAD, last, shapes, bodies, pairs, workspace)


@item
def _fetch_places(block, w, last, shapes, solids, bodies, pairs, workspace):
    """Ask for what `_fetch_pair` must know of a pair's bodies, and for the numbers that a body has one of.

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
def _fetch_pair(block, w, last, shapes, bodies, pairs, workspace):
    """Ask for what awake pair w and its bodies will need.

    Where a body's corners lie was asked for before, and how many lines they fill is not asked.
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
