"""Ice that crushes: what it has lost at a contact, and how much more it loses where elasticity asks for more than it can bear.

A contact remembers its crushed depth d. The elastic law sees the reach of both dilations less d, and d grows exactly where its
force would exceed the pressure p of crushed ice on the nominal area A (`nominal`):

    F(pose, d) <= p A(pose, d),    d' >= 0,    d' (p A - F) = 0,    p = C (A/1 m2)^q.

F falls and p A rises with d: there is one root, and the contact never gets stiffer. What crushing costs is the integral of p A dd;
with an energy W of the pose it is that of -dW/dd, which is more by (overlap/reach)^2/2.
The depth stays with the pair, through all modes, until the bodies are GONE apart; where they come off and turn to another place of
the floe, what is left of it there is what still overlaps.
"""

from math import atan2, exp, inf, log, pi, sqrt
from typing import NamedTuple

from dilatedem.contact.crushing.nominal import nominal_area
from dilatedem.jit import by_type, item
from dilatedem.numerics.rotation import rotation_matrix, to_body
from dilatedem.numerics.vector import along, cross, dot, load, norm, sub
from dilatedem.state.setting import CRUSHING_SETTINGS

#: gap of what has not crushed [m] at which a contact forgets its crushed depth: the next hit will be at another place
GONE = 0.1
#: difference of force and limit, over the limit, at which the crushed depth is found; what does not exceed it crushes nothing
CLOSE = 2e-5
#: evaluations of a contact in which it is found: two or three but for the first step of a hit
MOST = 40


class Search(NamedTuple):
    """On the way to the crushed depth at which force and limit are equal."""

    tries: int
    low: float  # m, where the force is above the limit
    high: float  # m, where it is below
    first: float  # m, the crushed depth of the last step
    last: float  # m, the depth that was tried last
    force: float  # N, there
    stored: float  # J, there


class Crushed(NamedTuple):
    """What crushing says of a contact."""

    limit: float  # N, of the elastic force and damping together
    lost: float  # J in this step


#: of a contact that was not looked at yet
UNTRIED = Search(0, 0.0, inf, 0.0, 0.0, 0.0, 0.0)
#: of a contact that bears everything
WHOLE = Crushed(inf, 0.0)


@item
def _nothing_worn(contact, k, pairs):
    return 0.0


@item
def _worn(contact, k, pairs):
    """Crushed depth of pair k [m]."""
    return pairs.crushed[k]


@item
def _never_settles(
    contact, k, dt, velocity, search, crushed, force, damped, stored, overlap, vertex, face_normal, shapes, bodies, pairs, offset,
    normal, pa, pb, scratch,
):  # fmt: skip
    return True, crushed, search, WHOLE


@item
def _settle(
    contact, k, dt, velocity, search, crushed, force, damped, stored, overlap, vertex, face_normal, shapes, bodies, pairs, offset,
    normal, pa, pb, scratch,
):  # fmt: skip
    """Whether the crushed depth [m] of pair k is found; the depth, to be tried next where it is not; the search; what it means.

    dt [s]: the step that led here; velocity [m/s]: of b against a where they touch; force [N], stored [J], overlap [m]: of the
    elastic law at `crushed`; damped [N]: that force with its dashpot; the rest as of `nominal_area`.
    """
    a, b = pairs.a[k], pairs.b[k]
    if search.tries == 0:
        remembered = _remembered(k, dt, velocity, bodies.angular_velocity, pairs, normal)
        if damped <= (1.0 + CLOSE) * remembered:
            return True, crushed, search, Crushed(remembered, 0.0)
    area, rate, extent = nominal_area(vertex, face_normal, shapes, a, b, offset, normal, pa, pb, crushed, scratch)
    limit, limit_rate = _limit(contact, area, rate)
    _note_losses(k, area, rate, extent, limit, pairs)
    tries, low, high, first = search.tries, search.low, search.high, search.first
    excess = force - limit
    if tries == 0:
        if excess <= CLOSE * limit:
            return True, crushed, search, Crushed(limit, 0.0)
        low, high, first = crushed, crushed + overlap, crushed
    elif abs(excess) <= CLOSE * limit or tries > MOST:
        # as a trapezoid in time: what the bodies paid for it, also in the step in which it begins
        return True, crushed, search, Crushed(max(limit, force), 0.5 * (pairs.normal_force[k] + force) * (crushed - first))
    elif excess > 0.0:
        low = crushed
    else:
        high = crushed
    further = high
    if tries < MOST:
        further = crushed + _step(excess, force, stored, overlap, limit, limit_rate)
        if not low < further < high:
            further = 0.5 * (low + high)
    return False, further, Search(tries + 1, low, high, first, crushed, force, stored), Crushed(limit, 0.0)


@item
def _remembered(k, dt, velocity, spin, pairs, normal):
    """What pair k still bears at least [N], by what it bore when it was last looked at; 0: it must be looked at.

    Less by what the contact can lose as its normal turns in either body, and as the one slides along the other. A contact that is
    new, or to which no step has led, may be at another place.
    """
    if dt == 0.0 or pairs.overlap[k] <= 0.0:
        return 0.0
    last, spin_a, spin_b = load(pairs.normal, k), load(spin, pairs.a[k]), load(spin, pairs.b[k])
    swing = sub(normal, last)
    in_a, in_b = along(swing, -dt, cross(spin_a, last)), along(swing, -dt, cross(spin_b, last))
    turned = norm(in_a) + norm(in_b) + dt * abs(dot(sub(spin_b, spin_a), normal))
    slid = dt * norm(along(velocity, -dot(velocity, normal), normal))
    return max(pairs.bears[k] - pairs.turn_loss[k] * turned - pairs.slide_loss[k] * slid, 0.0)


@item
def _note_losses(k, area, rate, extent, limit, pairs):
    """Write by how much at most the limit of pair k falls as the contact turns and slides.

    A turn lifts the corners of the area, the farthest one `extent` [m] away, and the area falls by `rate` a metre of that; a slide,
    or a turn about the normal, moves the ends of one body along the other's. With q <= 0 the limit falls by no more than its share.
    """
    pressure = limit / area if area > 0.0 else 0.0
    pairs.turn_loss[k] = pressure * (rate + 2.0 * extent) * extent
    pairs.slide_loss[k] = pressure * 2.0 * extent


@item
def _limit(contact, area, rate):
    """What crushed ice bears on an area [N], and its derivative by the depth [N/m], from that of the area [m]."""
    if contact.crushing_exponent == 0.0:
        return contact.crushing_pressure * area, contact.crushing_pressure * rate
    if area == 0.0:
        return 0.0, inf
    pressure = contact.crushing_pressure * exp(contact.crushing_exponent * log(area))
    return pressure * area, (1.0 + contact.crushing_exponent) * pressure * rate


@item
def bearing_pressure(contact, limit):
    """Pressure [Pa] of crushed ice that bears `limit` [N], as `_limit` has it."""
    q = contact.crushing_exponent
    if q == 0.0 or limit == 0.0:
        return contact.crushing_pressure
    return contact.crushing_pressure * exp(q / (1.0 + q) * log(limit / contact.crushing_pressure))


@item
def _step(excess, force, stored, overlap, limit, limit_rate):
    """How much deeper [m] the force is equal to the limit: by a power law of the overlap, and a limit that rises evenly."""
    if not (force > 0.0 and limit_rate < inf):
        return 0.0
    power = max(force * overlap / stored - 1.0, 0.5)
    rise = limit_rate * overlap
    share = excess / (power * force + rise)
    if 0.0 < share < 1.0:
        left = force * exp(power * log(1.0 - share))
        share += (left - limit - rise * share) / (power * left / (1.0 - share) + rise)
    return share * overlap


@item
def _as_much(contact, search, crushed, force, stored, overlap):
    return 1.0


@item
def _dearer(contact, search, crushed, force, stored, overlap):
    """What the energy of a pose falls by with its crushed depth, -dW/dd, over its force.

    As found: crushed depth and overlap [m], force [N], energy [J]. It is taken between the depth that was tried last and this one,
    with a force that is a power of the overlap.
    """
    if search.tries == 0 or search.force == force:
        return 1.0
    last = overlap + crushed - search.last
    power = log(search.force / force) / log(last / overlap)
    return (power + 1.0) * (search.stored - stored) / (search.force * last - force * overlap)


@item
def _keeps(contact, k, gap, reach, bodies, pairs, pa):
    return gap


@item
def _remember(contact, k, gap, reach, bodies, pairs, pa):
    """The gap [m] of pair k, which has come off, with what it still remembers of its crushed depth.

    reach [m]: of both dilations; pa: place on a's core that is nearest, from a's centroid. A dent reaches as far from its middle as
    the other body's curvature lets it.
    """
    crushed = pairs.crushed[k]
    if crushed == 0.0:
        return gap
    whole = gap - crushed
    turn = abs(_place(bodies.orientation, pairs.a[k], pa) - pairs.dent[k])
    aside = min(turn, 2.0 * pi - turn) * sqrt(dot(pa, pa))
    left = crushed
    if whole > GONE:
        left = 0.0
    elif aside * aside > 2.0 * reach * crushed:
        left = min(crushed, max(-whole, 0.0))
    pairs.crushed[k] = left
    return whole + left


@item
def _place(orientation, body, point):
    """Where around its vertical axis a point of a body lies [rad]; point: from its centroid, in world directions."""
    R = rotation_matrix(orientation[body, 0], orientation[body, 1], orientation[body, 2], orientation[body, 3])
    x, y, _ = to_body(R, point)
    return atan2(y, x)


@item
def _note_nothing(contact, k, crushed, found, bodies, pairs, pa):
    pass


@item
def _note(contact, k, crushed, found, bodies, pairs, pa):
    """Write the crushed depth of pair k and what it bears to the pair."""
    if crushed > pairs.crushed[k]:
        pairs.dent[k] = _place(bodies.orientation, pairs.a[k], pa)
    pairs.crushed[k], pairs.bears[k] = crushed, found.limit


def _where_ice_crushes(otherwise, function):
    """`function` with the settings of contact whose ice crushes."""
    return by_type(otherwise, dict.fromkeys(CRUSHING_SETTINGS, function))


worn = _where_ice_crushes(_nothing_worn, _worn)
settle = _where_ice_crushes(_never_settles, _settle)
dearer = _where_ice_crushes(_as_much, _dearer)
remember = _where_ice_crushes(_keeps, _remember)
note_crushed = _where_ice_crushes(_note_nothing, _note)
