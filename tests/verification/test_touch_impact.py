"""Central impacts with the dashpot that vanishes at touch (contact.damping_law = "touch").

With s = sqrt(2 W/m) the overlap measured as a speed, m v dv = -dW (1 + a v/sqrt(v^2 + s^2)) while that is above 0: the speed after
over the speed before is that of `viscous` with the damping of the case, whatever the body, the speed and the law W of the overlap.
The highest force is 0.983 of the elastic one for F = K d^(3/2) and 1.084 for F = K d (damping 0.36), and it rises from 0: at
first 1 + a = 2.26 times as fast as the elastic one.
"""

import pytest

from tests.verification.normal_impact import restitution_of_oscillator
from validation.contact_lab import rises
from validation.contact_lab.restitution import MEETINGS

DAMPING = 0.36
#: peak over the elastic one; an edge lies between a point and a face, nearer to the face
PEAKS = {"sphere on sphere": (0.983, 0.004), "vertical edge on side": (1.07, 0.05), "side on side": (1.084, 0.004)}
#: share of the peak early in a hit, over that of the elastic one
FASTER = 2.5


@pytest.mark.parametrize("speed", [0.01, 0.3, 2.0])
@pytest.mark.parametrize("meeting", MEETINGS, ids=lambda meeting: meeting[0])
def test_one_restitution_and_a_force_that_rises_from_nothing(meeting, speed):
    touch = rises.measure(meeting, "touch", DAMPING, speed)
    elastic = rises.measure(meeting, "touch", 0.0, speed, touch.step)
    assert touch.restitution == pytest.approx(restitution_of_oscillator(DAMPING), rel=0.002)
    assert elastic.restitution == pytest.approx(1.0, abs=1e-3)
    peak, tolerance = PEAKS[meeting[0]]
    assert touch.peak / elastic.peak == pytest.approx(peak, abs=tolerance)
    assert touch.first < FASTER * elastic.first
    assert touch.share_at(rises.SOON) < FASTER * elastic.share_at(rises.SOON)


@pytest.mark.parametrize("damping", [0.05, 0.2, 0.7, 1.0, 4.0])
def test_restitution_of_any_damping(damping):
    # from 1 + a cos(t) < 0 on nothing acts while the bodies part
    touch = rises.measure(MEETINGS[0], "touch", damping, 0.3)
    assert touch.restitution == pytest.approx(restitution_of_oscillator(damping), rel=0.005)
