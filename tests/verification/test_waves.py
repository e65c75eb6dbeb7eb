"""Airy waves of deep water: their lengths g T^2/(2 pi), and floes much shorter than a wave, which go with its surface.

A floe of draught d on a wave of amplitude a and wave number k: heave a; surge a exp(-k d/2), the orbit at half its depth, which is
a within k d/2 (here 4.5e-4). Both are read from the first harmonic, at the pace at which the floe, which drifts, meets the wave.
With water that it takes along it does the same, for that is as fast as the water around; as this is five times its own mass, what
is of second order in k a shows sooner (0.2 % of the surge at k a = 0.04), so the wave is a quarter as high there.
"""

from math import cos, exp, pi, radians, sin

import numpy as np

from tests.verification.comparison import Comparison, check, follow, start

CASE = "wave_rider"
GRAVITY, PERIOD, AMPLITUDE, DIRECTION, CURRENT, DRAUGHT = 9.81, 20.0, 3.975843, 30.0, (0.5, 0.2), 0.1 * 915.0 / 1025.0
#: a wave a quarter as high, and the floe on its crest
QUARTER = (
    "wave.0.amplitude=0.99396075", "body.0.position=[0.0, 0.0, 0.954693]", "body.0.velocity=[0.770306, 0.356061, 0.0]",
    "body.0.angular_velocity=[0.001571, -0.002721, 0.0]",
)  # fmt: skip
LENGTHS = {3.0: 14.0518, 5.0: 39.0327, 8.0: 99.9238}


def harmonic(times: np.ndarray, values: np.ndarray, rate: float) -> float:
    """Amplitude of cos and sin of rate t [rad/s] in a history with a drift and a second harmonic."""
    columns = [np.ones_like(times), times]
    for n in (1, 2):
        columns += [np.cos(n * rate * times), np.sin(n * rate * times)]
    found = np.linalg.lstsq(np.column_stack(columns), values, rcond=None)[0]
    return float(np.hypot(found[2], found[3]))


def lengths() -> list[Comparison]:
    rows = []
    for period, target in LENGTHS.items():
        wave = start(CASE, f"wave.0.period={period}", "wave.0.amplitude=0.1").model.loads.wave[0]
        found = 2 * pi / float(np.hypot(wave[1], wave[2]))
        rows.append(Comparison(CASE, f"length of a wave of {period:g} s, m", target, found, 1e-5))
    return rows


def ride(how: str, amplitude: float, *overrides: str) -> list[Comparison]:
    simulation = start(CASE, *overrides)
    times, seen = follow(simulation, 100.0, lambda s: s.state.bodies.position[0].copy(), every=200)
    omega = 2 * pi / PERIOD
    k, heading = omega**2 / GRAVITY, radians(DIRECTION)
    along = (seen[:, :2] - np.outer(times, CURRENT)) @ [cos(heading), sin(heading)]
    rate = omega - k * np.polyfit(times, along, 1)[0]
    surge, heave = harmonic(times, along, rate), harmonic(times, seen[:, 2], rate)
    across = (seen[:, :2] - np.outer(times, CURRENT)) @ [-sin(heading), cos(heading)]
    return [
        Comparison(CASE, f"surge amplitude{how}, m", amplitude, surge),
        Comparison(CASE, f"surge amplitude at half the draught{how}, m", amplitude * exp(-0.5 * k * DRAUGHT), surge),
        Comparison(CASE, f"heave amplitude{how}, m", amplitude, heave),
        Comparison(CASE, f"way across the wave{how}, m", 0.0, float(np.abs(across).max()), 1e-3, scale=amplitude),
    ]


def compare() -> list[Comparison]:
    return lengths() + ride("", AMPLITUDE) + ride(" with its water", 0.25 * AMPLITUDE, "water.added_mass=true", *QUARTER)


def test_waves():
    check(compare())
