"""Room that kernels need and that holds nothing from one step to the next (kernels never allocate)."""

from typing import NamedTuple

import numpy as np

from dilatedem.state.ledger import COSTS
from dilatedem.state.modes import MODE_COUNT

#: parts of a `Tally`, and the most threads that can share the evaluation of pairs
PARTS = 32
#: corners of the largest face that fits into the clipping workspace, after clipping by another
MOST_CORNERS = 256


class Cells(NamedTuple):
    """The grid in which neighbours are searched."""

    most: int  # cells along one axis
    start: np.ndarray  # (most^2 + 2,)
    member: np.ndarray  # (n,)
    cell_of: np.ndarray  # (n,)


class Workspace(NamedTuple):
    vertex: np.ndarray  # (v, 3) core vertices in world directions, from their body's centroid
    face_normal: np.ndarray  # (f, 3) in world directions
    near: np.ndarray  # (m,) pairs that may touch before all bodies stand at one instant again
    awake: np.ndarray  # (m,) pairs to evaluate at this instant
    at_structure: np.ndarray  # (m,) near pairs with a structure
    loaded: np.ndarray  # (m,) those of the near that press hard, behind a load event
    pushing: np.ndarray  # (n,) floes that push on a structure
    is_pushing: np.ndarray  # (n,) False between two looks
    busy: np.ndarray  # (n,) bodies of near pairs, in order
    idle: np.ndarray  # (n,) all others, in order
    is_busy: np.ndarray  # (n,)
    everybody: np.ndarray  # (n,) all bodies, in order
    room: np.ndarray  # (n,) m, how far a body is taken to get at most
    island: np.ndarray  # (n,) of busy bodies: the first of those that they hang together with; -1 for what stands still
    last: np.ndarray  # (n,) step at which a busy body is
    due: np.ndarray  # (n,) step at which it will be next
    look: np.ndarray  # (n,) step before which the first of an island takes single steps
    most_steps: np.ndarray  # (n,) how many steps the bodies of an island may take in one
    stride: np.ndarray  # (n,) how many steps a body has taken in one to this instant, 0 = it is not there
    due_bodies: np.ndarray  # (n,) busy bodies that are due at this instant, in order
    looks: np.ndarray  # (1,) counts looks at where strides will bring the bodies
    looked: np.ndarray  # (n,) the last look at a body
    position_ahead: np.ndarray  # (n, 3) m, where its stride will bring it
    orientation_ahead: np.ndarray  # (n, 4)
    vertex_ahead: np.ndarray  # (v, 3) as `vertex`, then
    face_normal_ahead: np.ndarray  # (f, 3)
    horizon: np.ndarray  # (n,) m, path at which a body has got farther than it was taken to
    stiffness: np.ndarray  # (n,) 1/s2, of the contacts of a body over what it opposes to them
    instant: np.ndarray  # (1,) counts the instants at which pairs were evaluated
    turned: np.ndarray  # (threads, n) instant to which a thread has turned a body's shape; negative: asked for it
    fault: np.ndarray  # (threads,) body that moves too fast, -1 = none
    leap: np.ndarray  # (threads,) m, how far it moved
    surprise: np.ndarray  # (threads,) whether some body has passed its horizon
    clip: np.ndarray  # (threads, 8, MOST_CORNERS, 3) polygons being clipped, faces that look at each other
    wet: np.ndarray  # (floating, 5) submerged volume, centre of buoyancy (body frame), wetted area; at sea more: `water.sea`
    hull: np.ndarray  # (threads, h, 4) outer vertices of one body, and their heights


class Tally(NamedTuple):
    """What contacts cost and showed within one call of `advance`, in parts of the list of awake pairs; empty between calls.

    The number of parts is fixed, so that sums do not depend on the number of threads.
    """

    work: np.ndarray  # (PARTS, 2) pairs evaluated, rounds of their distance searches
    cost: np.ndarray  # (PARTS, COSTS) J of each of `state.ledger.COSTS`
    mode_steps: np.ndarray  # (PARTS, 2, MODE_COUNT) and so on as in `Loads`
    mode_impulse: np.ndarray
    mode_force: np.ndarray
    mode_overlap: np.ndarray
    deep: np.ndarray  # (PARTS,) first pair with an overlap past what the method can mean, -1 = none


def make_cells(floating: int) -> Cells:
    most = max(4, int(np.sqrt(4 * floating)) + 2)
    return Cells(most, np.zeros(most * most + 2, np.int64), np.zeros(floating, np.int64), np.zeros(floating, np.int64))


def make_workspace(shapes, hulls, capacity: int, threads: int, wet_columns: int = 5) -> Workspace:
    """Workspace for packed shapes and hulls, a list of `capacity` pairs and a number of threads; wet_columns: of `wet`."""
    most, bodies = int(np.diff(hulls.vertex_start).max(initial=1)), len(shapes.radius)
    return Workspace(
        vertex=shapes.vertex.copy(),
        face_normal=shapes.face_normal.copy(),
        near=np.zeros(capacity, np.int64),
        awake=np.zeros(capacity, np.int64),
        at_structure=np.zeros(capacity, np.int64),
        loaded=np.zeros(capacity, np.int64),
        pushing=np.zeros(bodies, np.int64),
        is_pushing=np.zeros(bodies, np.bool_),
        busy=np.zeros(bodies, np.int64),
        idle=np.zeros(bodies, np.int64),
        is_busy=np.zeros(bodies, np.bool_),
        everybody=np.arange(bodies),
        room=np.zeros(bodies),
        island=np.full(bodies, -1),
        last=np.zeros(bodies, np.int64),
        due=np.zeros(bodies, np.int64),
        look=np.zeros(bodies, np.int64),
        most_steps=np.zeros(bodies),
        stride=np.zeros(bodies, np.int64),
        due_bodies=np.zeros(bodies, np.int64),
        looks=np.zeros(1, np.int64),
        looked=np.zeros(bodies, np.int64),
        position_ahead=np.zeros((bodies, 3)),
        orientation_ahead=np.zeros((bodies, 4)),
        vertex_ahead=np.zeros_like(shapes.vertex),
        face_normal_ahead=np.zeros_like(shapes.face_normal),
        horizon=np.zeros(bodies),
        stiffness=np.zeros(bodies),
        instant=np.zeros(1, np.int64),
        turned=np.zeros((threads, bodies), np.int64),
        fault=np.full(threads, -1, np.int64),
        leap=np.zeros(threads),
        surprise=np.zeros(threads, np.bool_),
        clip=np.zeros((threads, 8, MOST_CORNERS, 3)),
        wet=np.zeros((len(hulls.prism), wet_columns)),
        hull=np.zeros((threads, most, 4)),
    )


def empty_tally() -> Tally:
    per_mode = (np.zeros((PARTS, 2, MODE_COUNT)) for _ in range(4))
    return Tally(np.zeros((PARTS, 2), np.int64), np.zeros((PARTS, len(COSTS))), *per_mode, np.full(PARTS, -1, np.int64))
