"""The critical time step: how stiff contacts are against how light the bodies are at the point of contact (physics 6).

Before a run nothing touches yet, so two contacts are laid out for each body: its largest face at its worst corner (of a capsule its
whole length), and a corner hit at a likely speed; and what moves already, by its speed or its spin, must not outrun the list of
pairs. During a run `assembled_frequency` adds up the contacts there are.
"""

from math import sqrt

import numpy as np

from dilatedem.contact.laws import law_of
from dilatedem.contact.search.neighbours import SKIN, USABLE
from dilatedem.jit import item
from dilatedem.motion.paces import LONGEST_MOVE
from dilatedem.numerics.blocks import take
from dilatedem.numerics.plain import dot, norm, nth_root, turned
from dilatedem.numerics.vector import load
from dilatedem.state.response import is_free, mobility

#: impact speed, as a share of sqrt(gravity x reach), for which contacts are laid out where nothing moves yet
SETTLING_SPEED = 0.5
#: steps over the shortest contact at a point that the *critical* step stands for; the automatic step is a tenth of it
STEPS_PER_CONTACT = 8.0
#: bodies or faces that are worked together at most, so that their arrays take little memory
AT_ONCE = 4096


def critical_step(model, bodies) -> float:
    """Time step [s] to stay well below, estimated for one face and one corner contact of every body; docs/theory.md has its limits.

    A pair's 1/m_eff is the sum over both bodies, so omega^2 = k/m_eff is at most twice the largest k/m' of one body, with
    1/m' = 1/m + (r x n).I^-1.(r x n) at the worst corner; damping shortens the step by sqrt(1 + xi^2) - xi, xi the damping
    coefficient. Friction springs, crossing edges and contacts that act together are left to the share of it that is taken.
    Infinite without bodies.
    """
    shapes, solids, damping, law = model.shapes, model.solids, model.contact.damping, law_of(model.contact)
    free = np.flatnonzero(solids.inverse_mass > 0.0)
    if len(free) == 0:
        return np.inf
    held = np.flatnonzero(solids.inverse_mass == 0.0)  # structures and fixed bodies
    stiffest_held = solids.compliance[held].min(initial=np.inf)
    speed = _impact_speed(model, bodies, free)
    shrink = sqrt(1.0 + damping * damping) - damping
    mobility, area = _worst_mobility(shapes, solids)[free], _largest_face(shapes)[free]
    compliance, inverse_mass, radius = solids.compliance[free], solids.inverse_mass[free], shapes.radius[free]
    shortest = _outrunning(model, bodies, free)
    # against a body like itself (both give way), and against what does not move
    for moving, together in ((2.0, 2.0 * compliance), (1.0, compliance + stiffest_held)):
        modulus = 1.0 / together
        resting = moving * mobility * law.resting_stiffness(shapes, free, area, modulus, moving * inverse_mass, speed)
        if resting.max() > 0.0:
            shortest = min(shortest, 2.0 * shrink / sqrt(resting.max()))
        hertz = moving * inverse_mass * (4.0 / 3.0 * modulus * np.sqrt(radius))
        if hertz.max() > 0.0:
            depth = nth_root(1.25 * speed * speed / hertz.max(), 5) ** 2
            shortest = min(shortest, 2.943 * depth / speed / STEPS_PER_CONTACT)
    return shortest


def _impact_speed(model, bodies, free) -> float:
    """A speed [m/s] at which bodies may hit each other: the case's own velocities, or what gravity gives them."""
    setting = model.loads
    moving = (norm(bodies.velocity[free]) + norm(bodies.angular_velocity[free]) * model.shapes.reach[free]).max()
    current = norm([setting.current_x, setting.current_y])
    settling = SETTLING_SPEED * np.sqrt(setting.gravity * model.shapes.reach[free].max())
    return max(2.0 * moving, current, settling, 1e-6)


def _outrunning(model, bodies, free) -> float:
    """The step [s] in which the fastest point of a body, as it moves now, would go as far as a step may take it."""
    reach = model.shapes.reach[free]
    rate = (np.abs(bodies.velocity[free]).sum(axis=1) + np.abs(bodies.angular_velocity[free]).sum(axis=1) * reach).max()
    return LONGEST_MOVE * USABLE * SKIN * reach.max() / rate if rate > 0.0 else np.inf


def _worst_mobility(shapes, solids) -> np.ndarray:
    """(n,) largest 1/m' [1/kg] over each body's core vertices and the three axes of its frame."""
    most = np.zeros(len(shapes.radius))
    for bodies, corners in _rows_by_length(shapes.vertex_start, shapes.vertex):
        for axis in np.eye(3):
            lever = np.cross(corners, axis)
            turning = dot(lever, turned(solids.inverse_inertia[bodies][:, None], lever))
            most[bodies] = np.maximum(most[bodies], turning.max(axis=1))
    return solids.inverse_mass + most


def _largest_face(shapes) -> np.ndarray:
    """(n,) area [m2] of the largest face of each core; 0 for spheres, capsules and half spaces."""
    area = np.zeros(len(shapes.loop_start) - 1)
    for faces, loops in _rows_by_length(shapes.loop_start, shapes.loop):
        local = shapes.vertex[loops] - shapes.vertex[loops[:, :1]]
        vector = 0.5 * np.cross(local, np.roll(local, -1, axis=1)).sum(axis=1)
        area[faces] = norm(vector)
    largest = np.zeros(len(shapes.radius))
    np.maximum.at(largest, np.repeat(np.arange(len(largest)), np.diff(shapes.face_start)), area)
    return largest


def _rows_by_length(start, flat):
    """Rows of a flat array by their length, at most AT_ONCE: which (m,), and their entries (m, length, ...); empty ones never."""
    length = np.diff(start)
    for k in np.unique(length[length > 0]):
        rows = np.flatnonzero(length == k)
        for first in range(0, len(rows), AT_ONCE):
            some = rows[first : first + AT_ONCE]
            yield some, take(flat, start[some], k)


@item
def assembled_frequency(solids, bodies, pairs, workspace):
    """Upper bound of the highest angular frequency [rad/s] of the normal springs that are open now (friction springs left out).

    A body's contacts add up to s = sum c k_tan/m', c = 2, or 1 where the other side is held; no mode is
    faster than sqrt(max s), as (u_a x_a + u_b x_b)^2 <= 2 (u_a x_a)^2 + 2 (u_b x_b)^2 for each contact.
    """
    stiffness = workspace.stiffness
    for i in range(len(stiffness)):
        stiffness[i] = 0.0
    for k in range(pairs.count[0]):
        if pairs.overlap[k] > 0.0:
            tangent, normal, a, b = pairs.tangent[k], load(pairs.normal, k), pairs.a[k], pairs.b[k]
            both = 2.0 if is_free(a, solids) and is_free(b, solids) else 1.0
            stiffness[a] += both * tangent * mobility(a, solids, bodies.orientation, load(pairs.point, k), normal)
            stiffness[b] += both * tangent * mobility(b, solids, bodies.orientation, load(pairs.arm, k), normal)
    most = 0.0
    for i in range(len(stiffness)):
        most = max(most, stiffness[i])
    return sqrt(most)
