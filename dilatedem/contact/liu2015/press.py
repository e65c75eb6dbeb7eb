"""Contact model `liu2015`: the normal laws of Liu, Long & Ji (2015), mode by mode, as printed where they can be used.

F = K overlap^kappa, kappa = 1 face on face and 3/2 in all other modes. Where the paper's formulas slip, and what that means for
results, is said in docs/theory.md.
"""

from math import pi, sqrt

from dilatedem.contact.crushing.depth import UNTRIED, WHOLE, note_crushed, settle, worn
from dilatedem.contact.liu2015.cone import patch_of, radius_under
from dilatedem.contact.liu2015.patch import (
    EDGE_CROSSING,
    EDGE_FACE,
    EDGE_PARALLEL,
    FACE_FACE,
    VERTEX_EDGE,
    VERTEX_FACE,
    VERTEX_VERTEX,
)
from dilatedem.contact.pressed import Pressed
from dilatedem.jit import device, item
from dilatedem.numerics.vector import dot, sub
from dilatedem.state.response import mobility, pressed_mass, relative_velocity

#: shape factor of a polygonal face, Liu 2015 below Eq. (24)
BETA = 1.02


@device
def normal_stiffness(mode, modulus, first, second, size, sine):
    """Stiffness K [N/m^kappa] and exponent kappa of a contact mode.

    modulus: effective modulus, Eq. (7) [Pa]; first, second: dilated radius [m] of the body with the lower feature (corner, then
    edge, then face) and of the other; size: patch length [m] or area [m2]; sine: of the angle of two crossing edges.
    """
    if mode == FACE_FACE:
        return 2.0 * modulus * BETA * sqrt(size / pi), 1.0  # Eq. (24)
    if mode == VERTEX_FACE:
        root = sqrt(first)  # Eq. (11)
    elif mode == EDGE_FACE:
        root = size * sqrt(first)  # Eq. (19): L stands for L / 1 m
    elif mode == EDGE_CROSSING:
        # what Eqs. (14)-(17) give once a has its factors 1/2 and R' = 1/(2 lambda): R~ = sqrt(R1 R2)/sin(theta)
        root = sqrt(sqrt(first * second) / sine)  # Eq. (13)
    else:
        radius = first * second / (first + second)  # Eq. (8)
        if mode == VERTEX_VERTEX:
            root = sqrt(radius)  # Eq. (10)
        elif mode == VERTEX_EDGE:
            root = sqrt(sqrt(first * radius))  # Eq. (12)
        else:
            root = size * sqrt(radius)  # Eq. (18): L stands for L / 1 m
    return 4.0 / 3.0 * modulus * root, 1.5


@device
def damping_coefficient(damping, mass, stiffness):
    """C_n of Eq. (4): zeta sqrt(2 M K). Its units fit Eq. (3) only in SI for kappa = 3/2."""
    return damping * sqrt(2.0 * mass * stiffness)


@device
def power(overlap, exponent):
    """overlap^exponent; the exponents that occur need no general power."""
    if exponent == 1.5:
        return overlap * sqrt(overlap)
    if exponent == 0.5:
        return sqrt(overlap)
    if exponent == 1.0:
        return overlap
    if exponent == 0.0:
        return 1.0
    return overlap**exponent


@device
def stored_energy(stiffness, exponent, overlap):
    """Elastic energy [J] of F = K overlap^kappa."""
    return stiffness * overlap * power(overlap, exponent) / (exponent + 1.0)


@item
def _law_gain(pairs, k, dt, mode, overlap, stiffness, exponent, elastic, elastic_power, crumbled):
    """Energy that the normal law made in the last step [J]: more is stored than the bodies' approach has paid for, less what
    crushing took.

    The stiffness may change at one overlap (mode, size of the patch), and the centroid of a patch may wander to where the overlap
    is another. For a contact at a point only the first can happen; its overlap is left to the approach, so that an error
    of the distance would show in the ledger's residual.
    """
    old, old_stiffness, old_exponent = pairs.overlap[k], pairs.stiffness[k], pairs.exponent[k]
    paid = 0.5 * dt * (elastic_power + pairs.elastic_power[k]) - crumbled
    if mode != pairs.mode[k]:
        # each mode measures the overlap at a place of its own
        return stored_energy(stiffness, exponent, overlap) - stored_energy(old_stiffness, old_exponent, old) - paid
    middle = 0.5 * (overlap + old)
    gain = stored_energy(stiffness, exponent, middle) - stored_energy(old_stiffness, old_exponent, middle)
    if mode >= EDGE_PARALLEL:  # a patch
        gain += 0.5 * (elastic + old_stiffness * power(old, old_exponent)) * (overlap - old) - paid
    return gain


@item
def _law_at(k, shapes, vertex, face_normal, solids, pairs, offset, normal, pa, pb, overlap, crushed, scratch):
    """Mode of contact k at a pose, point of application, overlap there [m], size, K [N/m^kappa] and kappa.

    Arguments as of `press_liu2015`; overlap [m]: the deepest, where a has lost the depth `crushed` [m].
    """
    a, b = pairs.a[k], pairs.b[k]
    mode, a_lower, point, overlap, size, sine = patch_of(
        vertex, face_normal, shapes, pairs.corners[k], pairs.corner_a[k], pairs.corner_b[k], a, b, offset, normal, pa, pb,
        overlap, crushed, scratch,
    )  # fmt: skip
    first, second = shapes.radius[a], radius_under(shapes, vertex, b, sub(point, offset))
    if not a_lower:
        first, second = second, first
    modulus = 1.0 / (solids.compliance[a] + solids.compliance[b])
    stiffness, exponent = normal_stiffness(mode, modulus, first, second, size, sine)
    return mode, point, overlap, size, stiffness, exponent


@device
def force_change_liu2015(contact, k, shapes, vertex, face_normal, solids, pairs, offset, normal, pa, pb, gap, scratch):
    """By how much [N] the elastic force of contact k at a pose differs from what it is now; nothing is written.

    Arguments as of `press_liu2015`.
    """
    _, _, overlap, _, stiffness, exponent = _law_at(
        k, shapes, vertex, face_normal, solids, pairs, offset, normal, pa, pb, -gap, worn(contact, k, pairs), scratch
    )
    now = pairs.stiffness[k] * power(pairs.overlap[k], pairs.exponent[k])
    return abs(stiffness * power(overlap, exponent) - now)


@device
def _jump_gain(k, dt, jump, solids, bodies, pairs, point, arm, normal):
    """Energy [J] that contact k makes in a step in which its force jumps by `jump` [N], beside what trapezoids in time tell.

    Those see the velocity that the step predicts, by the force at its start. That of the bodies has half a kick by the force at its
    end, too: jump^2 dt^2/(4 m') more in all (docs/theory.md, the energy ledger).
    """
    q = bodies.orientation
    give = mobility(pairs.a[k], solids, q, point, normal) + mobility(pairs.b[k], solids, q, arm, normal)
    return 0.25 * give * (dt * jump) ** 2


@item
def press_liu2015(contact, k, dt, shapes, vertex, face_normal, solids, bodies, pairs, offset, normal, pa, pb, gap, scratch):
    """The normal part of contact k by the paper's laws, as `Pressed`. Writes the memory of its law, and the tangent.

    Arguments as in `collide`; offset, normal, pa, pb: centroid of b, unit normal, witness points, from a's centroid; gap < 0 [m].
    """
    a, b = pairs.a[k], pairs.b[k]
    crushed = worn(contact, k, pairs)
    whole = crushed - gap  # overlap of what has not crushed [m]
    search, found, settled = UNTRIED, WHOLE, False
    while not settled:
        mode, point, overlap, size, stiffness, exponent = _law_at(
            k, shapes, vertex, face_normal, solids, pairs, offset, normal, pa, pb, whole - crushed, crushed, scratch
        )
        velocity = relative_velocity(bodies.velocity, bodies.angular_velocity, a, b, point, sub(point, offset))
        approach = -dot(velocity, normal)
        mass = pressed_mass(k, a, b, solids, pairs)
        elastic = stiffness * power(overlap, exponent)
        viscous = damping_coefficient(contact.damping, mass, stiffness) * power(overlap, exponent - 1.0) * approach
        settled, crushed, search, found = settle(
            contact, k, dt, velocity, search, crushed, elastic, elastic + viscous, stored_energy(stiffness, exponent, overlap),
            whole - crushed, vertex, face_normal, shapes, bodies, pairs, offset, normal, pa, pb, scratch,
        )  # fmt: skip
    note_crushed(contact, k, crushed, found, bodies, pairs, pa)
    normal_force = min(max(elastic + viscous, 0.0), found.limit)  # Eq. (3)
    shear_stiffness = contact.stiffness_ratio * stiffness * power(overlap, exponent - 1.0)
    elastic_power = elastic * approach
    damping_power = (normal_force - elastic) * approach
    gain = 0.0
    if pairs.overlap[k] > 0.0:
        gain = _law_gain(pairs, k, dt, mode, overlap, stiffness, exponent, elastic, elastic_power, found.lost)
        if mode != pairs.mode[k]:
            jump = normal_force - pairs.normal_force[k]
            gain += _jump_gain(k, dt, jump, solids, bodies, pairs, point, sub(point, offset), normal)
    pairs.stiffness[k] = stiffness
    pairs.exponent[k] = exponent
    pairs.tangent[k] = exponent * stiffness * power(overlap, exponent - 1.0)
    at_rest = (0.0, 0.0, 0.0)
    return Pressed(
        mode=mode, size=size, overlap=overlap, point=point, direction=normal, normal_force=normal_force,
        elastic_power=elastic_power, damping_power=damping_power, shear_stiffness=shear_stiffness, dashpot=0.0,
        stored=stored_energy(stiffness, exponent, overlap), gain=gain, crumbled=found.lost, velocity=at_rest, turning=at_rest,
    )  # fmt: skip
