"""The dashpots of the contact model `consistent`: how strong they are, and which damping gives both one restitution.

Both multiply the elastic force F by 1 + c v/F, never below 0, v the speed of approach. With s = sqrt(2 W/m*), which is the overlap
measured as a speed, m* v dv = -(1 + c v/F) dW is v dv/ds = -s (1 + c v/F) for every law of force: restitution is one number.

viscous  c = 2 xi F/s: a damped oscillator in s, ln e = -2 xi arccos(xi)/sqrt(1 - xi^2). Where F goes with the overlap, c is a
         constant, and the force is there at once.
touch    c = 2 z F/sqrt(v^2 + s^2), the same where the approach ends and none at touch. With v = r cos(t), s = r sin(t):
         d ln r = -a sin(t) cos(t)^2/(1 + a cos(t) sin(t)^2) dt, a = 2 z, until 1 + a cos(t) = 0 and nothing acts any more.
"""

from collections.abc import Callable
from math import fsum, sqrt

from dilatedem.contact.consistent.line import HEAVY, INNER, LIGHT, OUTER
from dilatedem.jit import item
from dilatedem.numerics.root import bracketed_root

#: places and weights of four points of Gauss and Legendre on 0..1
GAUSS = tuple((0.5 + 0.5 * x, 0.5 * w) for x, w in ((-OUTER, LIGHT), (-INNER, HEAVY), (INNER, HEAVY), (OUTER, LIGHT)))
#: how often the range of an integral is halved towards the end where its integrand is steep
HALVINGS = 40
#: bound of the damping z of `touch` over xi (1 + xi) of `viscous`: 3 pi/4 for weak ones, and the less, the stronger they are
MOST = 2.4
#: of the damping of `touch`, absolute and relative
TOLERANCE = 1e-12


@item
def dashpot(contact, elastic, stored, approach):
    """c [N s/m] of a contact setting, whose damping is xi or z; elastic: F [N]; stored: W/m* [m2/s2]; approach: (dW/dt)/F [m/s]."""
    if contact.touch:
        return 2.0 * contact.damping * elastic / sqrt(approach * approach + 2.0 * stored)
    return contact.damping * sqrt(2.0 * stored) * (1.0 / stored) * elastic  # root and division beside each other


def touch_damping(damping: float) -> float:
    """The damping z of `touch` with the restitution that `damping` gives with `viscous`."""
    if damping == 0.0:
        return 0.0
    loss = viscous_loss(damping)
    most = MOST * damping * (1.0 + damping)
    return bracketed_root(lambda z: touch_loss(z) - loss, 0.0, most, absolute=TOLERANCE * damping, relative=TOLERANCE)


def viscous_loss(damping: float) -> float:
    """-ln e of the law `viscous`: 2 xi arccos(xi)/sqrt(1 - xi^2) and what becomes of it above 1, as one integral."""
    return 4.0 * damping * _integral(lambda x: 1.0 / (1.0 + (2.0 * damping + x) * x))


def touch_loss(damping: float) -> float:
    """-ln e of the law `touch`, by c = cos(t) from 1 to -q, where it ends: integral of a c^2/(1 + a c (1 - c^2)), less ln q."""
    a = 2.0 * damping
    q = 1.0 / a if a > 1.0 else 1.0
    approach = _integral(lambda x: a * (1.0 - x) * (1.0 - x) / (1.0 + a * (1.0 - x) * x * (2.0 - x)))

    def returning(x):
        c = q * (1.0 - x)
        return q * a * c * c / (1.0 - a * c * (1.0 - c * c))

    left = _integral(lambda x: (a - 1.0) / (1.0 + (a - 1.0) * x)) if a > 1.0 else 0.0  # ln a
    return approach + _integral(returning) + left


def _integral(function: Callable[[float], float]) -> float:
    """Over 0..1, of a function that may be steep near 0. Of sums and products, which every processor rounds alike."""
    parts, high = [], 1.0
    for k in range(HALVINGS):
        low = 0.5 * high if k + 1 < HALVINGS else 0.0
        parts += [(high - low) * w * function(low + (high - low) * x) for x, w in GAUSS]
        high = low
    return fsum(parts)
