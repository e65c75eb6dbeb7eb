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
from dilatedem.state.response import gives_way, mobility, yielding
from dilatedem.water.loads import fastest_water

#: impact speed, as a share of sqrt(gravity x reach), for which contacts are laid out where nothing moves yet
SETTLING_SPEED = 0.5
#: steps over the shortest contact at a point that the *critical* step stands for; the automatic step is a tenth of it
STEPS_PER_CONTACT = 8.0
#: the fastest that a cubic between two rows of a table which it follows without overshooting can be, over the mean of that time
STEEPEST = 1.5
#: bodies or faces that are worked together at most, so that their arrays take little memory
AT_ONCE = 4096


def critical_step(model, bodies, only=None) -> float:
    """Time step [s] to stay well below, estimated for one face and one corner contact of every body; docs/theory.md has its limits.

    A pair's 1/m_eff is the sum over both bodies, so omega^2 = k/m_eff is at most twice the largest k/m' of one body, with 1/m' =
    1/m + (r x n).I^-1.(r x n) at the worst corner, and what modes give way by; damping shortens the step by sqrt(1 + xi^2) - xi,
    xi the damping coefficient. Friction springs, crossing edges and contacts that act together are left to the share of it that
    is taken.
    Infinite where nothing can move. only: numbers of the bodies that count, all unless given.
    """
    shapes, solids, damping, law = model.shapes, model.solids, model.contact.damping, law_of(model.contact)
    free = np.flatnonzero(solids.inverse_mass > 0.0) if only is None else only
    if len(free) == 0:
        return _swinging(model.supports)
    held = np.flatnonzero(solids.inverse_mass == 0.0)  # structures and fixed bodies
    stiffest_held = solids.compliance[held].min(initial=np.inf)
    speed = _impact_speed(model, bodies, free)
    shrink = sqrt(1.0 + damping * damping) - damping
    mobility, area = _worst_mobility(shapes, solids)[free], _largest_face(shapes)[free]
    compliance, inverse_mass, radius = solids.compliance[free], _lightest(solids)[free], shapes.radius[free]
    shortest = min(_outrunning(model, bodies, free), _swinging(model.supports), _ringing(solids))
    # against a body like itself (both give way), against what does not move, and against structures that give way
    partners = [(2.0 * mobility, 2.0 * inverse_mass, 2.0 * compliance), (mobility, inverse_mass, compliance + stiffest_held)]
    partners += [(mobility + most, inverse_mass + most, compliance + own) for most, own in _giving(shapes, solids)]
    for together, mass, compliances in partners:
        modulus = 1.0 / compliances
        resting = together * law.resting_stiffness(shapes, free, area, modulus, mass, speed)
        if resting.max() > 0.0:
            shortest = min(shortest, 2.0 * shrink / sqrt(resting.max()))
        hertz = mass * (4.0 / 3.0 * modulus * np.sqrt(radius))
        if hertz.max() > 0.0:
            depth = nth_root(1.25 * speed * speed / hertz.max(), 5) ** 2
            shortest = min(shortest, 2.943 * depth / speed / STEPS_PER_CONTACT)
    return shortest


def _impact_speed(model, bodies, free) -> float:
    """A speed [m/s] at which bodies may hit each other: the case's own velocities, or what gravity gives them."""
    setting, driven = model.loads, _fastest_driven(model)
    moving = (norm(bodies.velocity[free]) + norm(bodies.angular_velocity[free]) * model.shapes.reach[free]).max()
    current = fastest_water(setting)
    settling = SETTLING_SPEED * np.sqrt(setting.gravity * model.shapes.reach[free].max())
    return max(2.0 * moving, moving + driven, current + driven, settling, 1e-6)


def usual_speed(model, bodies) -> float:
    """How fast [m/s] bodies, water or structures go at t = 0, whichever is fastest; 0 where all rests."""
    return max(float(norm(bodies.velocity).max(initial=0.0)), fastest_water(model.loads), _fastest_driven(model))


def _fastest_driven(model) -> float:
    """The speed [m/s] that no point of a driven structure is faster than."""
    supports, fastest = model.supports, 0.0
    for m, s in enumerate(supports.moving):
        rows = slice(supports.knot_start[s], supports.knot_start[s + 1])
        mean = np.abs(np.diff(supports.knot[rows], axis=0)) / np.diff(supports.knot_time[rows])[:, None]
        rate = np.concatenate([np.abs(supports.slope[rows]), STEEPEST * mean, np.zeros((1, 3))]).max(axis=0)
        parts = slice(supports.part_start[m], supports.part_start[m + 1])
        arm = norm(supports.seat[parts, :2]) + model.shapes.plan_reach[model.floating + supports.part[parts]]
        fastest = max(fastest, float(rate[0] + rate[1] + rate[2] * arm.max(initial=0.0)))
    return fastest


def _swinging(supports) -> float:
    """The critical step [s] of springs and dashpots under sprung structures: as of contacts, xi the damping ratio."""
    stiffness, half_rate = supports.stiffness * supports.inverse_mass, 0.5 * supports.damping * supports.inverse_mass
    fastest = (np.sqrt(stiffness + half_rate * half_rate) + half_rate).max(initial=0.0)
    return 2.0 / fastest if fastest > 0.0 else np.inf


def _ringing(solids) -> float:
    """The critical step [s] of the modes of bodies that bend, as of the springs under structures."""
    half_rate = 0.5 * getattr(solids, "mode_damping", np.zeros(1))
    fastest = (np.sqrt(getattr(solids, "mode_square", np.zeros(1)) + half_rate * half_rate) + half_rate).max(initial=0.0)
    return 2.0 / fastest if fastest > 0.0 else np.inf


def _giving(shapes, solids) -> list[tuple[float, float]]:
    """Of each part of a sprung structure its 1/m' [1/kg] at most, and its compliance [1/Pa]."""
    parts = np.flatnonzero(solids.give[:, 0] > 0.0)
    arm = norm(solids.seat[parts, :2]) + shapes.plan_reach[parts]
    most = solids.give[parts, 0] + solids.give[parts, 1] * arm * arm
    return list(zip(most.tolist(), solids.compliance[parts].tolist(), strict=True))


def _outrunning(model, bodies, free) -> float:
    """The step [s] in which the fastest point of a body, as it moves now, would go as far as a step may take it."""
    reach = model.shapes.reach[free]
    rate = (np.abs(bodies.velocity[free]).sum(axis=1) + np.abs(bodies.angular_velocity[free]).sum(axis=1) * reach).max()
    rate = max(rate, _fastest_driven(model))
    return LONGEST_MOVE * USABLE * SKIN * reach.max() / rate if rate > 0.0 else np.inf


def _worst_mobility(shapes, solids) -> np.ndarray:
    """(n,) largest 1/m' [1/kg] over each body's core vertices and the three axes of its frame."""
    most = np.zeros(len(shapes.radius))
    for bodies, corners in _rows_by_length(shapes.vertex_start, shapes.vertex):
        for axis in np.eye(3):
            lever = np.cross(corners, axis)
            turning = dot(lever, turned(solids.inverse_inertia[bodies][:, None], lever))
            most[bodies] = np.maximum(most[bodies], turning.max(axis=1))
    return _lightest(solids) + most + getattr(solids, "mode_mobility", 0.0)


def _lightest(solids) -> np.ndarray:
    """(n,) largest 1/m [1/kg] with which each body as a whole gives way; water that it takes along makes it heavier alone."""
    return np.maximum(solids.inverse_mass, getattr(solids, "inverse_heave_mass", 0.0))


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
def assembled_frequency(model, bodies, pairs, workspace):
    """Upper bound of the highest angular frequency [rad/s] of the normal springs that are open now (friction springs left out).

    A body's contacts add up to s = sum c k_tan/m', c = 2, or 1 where the other side is held; no mode is
    faster than sqrt(max s), as (u_a x_a + u_b x_b)^2 <= 2 (u_a x_a)^2 + 2 (u_b x_b)^2 for each contact. Those of all parts of a
    sprung structure add up to one s, and so do the springs that carry it; so do those of all parts of a floe.
    """
    solids, supports, stiffness = model.solids, model.supports, workspace.stiffness
    for i in range(len(stiffness)):
        stiffness[i] = 0.0
    for k in range(pairs.count[0]):
        if pairs.overlap[k] > 0.0:
            tangent, normal, a, b = pairs.tangent[k], load(pairs.normal, k), pairs.a[k], pairs.b[k]
            both = 2.0 if gives_way(a, solids) and gives_way(b, solids) else 1.0
            bent = yielding(k, solids, pairs)
            stiffness[a] += both * tangent * (mobility(a, solids, bodies.orientation, load(pairs.point, k), normal) + bent)
            stiffness[b] += both * tangent * (mobility(b, solids, bodies.orientation, load(pairs.arm, k), normal) + bent)
    most = 0.0
    for i in range(len(stiffness)):
        most = max(most, stiffness[i])
    for j in range(len(model.joined)):
        together = 0.0
        for i in range(model.joined[j, 0], model.joined[j, 1]):
            together += stiffness[i]
        most = max(most, together)
    for m in range(len(supports.moving)):
        s, together = supports.moving[m], 0.0
        for c in range(3):
            together = max(together, supports.stiffness[s, c] * supports.inverse_mass[s, c])
        for p in range(supports.part_start[m], supports.part_start[m + 1]):
            together += stiffness[model.floating + supports.part[p]]
        most = max(most, together)
    return sqrt(most)
