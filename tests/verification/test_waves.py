"""Airy waves of deep water: their lengths g T^2/(2 pi), and floes much shorter than a wave, which go with its surface.

A floe of draught d on a wave of amplitude a and wave number k: heave a; surge a exp(-k d/2), the orbit at half its depth, which is
a within k d/2 (here 4.5e-4). Both are read from the first harmonic, at the pace at which the floe, which drifts, meets the wave.
"""

from math import cos, exp, pi, radians, sin

import numpy as np

from tests.verification.comparison import Comparison, check, follow, start

CASE = "wave_rider"
GRAVITY, PERIOD, AMPLITUDE, DIRECTION, CURRENT, DRAUGHT = 9.81, 20.0, 3.975843, 30.0, (0.5, 0.2), 0.1 * 915.0 / 1025.0
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


def ride() -> list[Comparison]:
    simulation = start(CASE)
    times, seen = follow(simulation, 100.0, lambda s: s.state.bodies.position[0].copy(), every=200)
    omega = 2 * pi / PERIOD
    k, heading = omega**2 / GRAVITY, radians(DIRECTION)
    along = (seen[:, :2] - np.outer(times, CURRENT)) @ [cos(heading), sin(heading)]
    rate = omega - k * np.polyfit(times, along, 1)[0]
    surge, heave = harmonic(times, along, rate), harmonic(times, seen[:, 2], rate)
    across = (seen[:, :2] - np.outer(times, CURRENT)) @ [-sin(heading), cos(heading)]
    return [
        Comparison(CASE, "surge amplitude, m", AMPLITUDE, surge),
        Comparison(CASE, "surge amplitude at half the draught, m", AMPLITUDE * exp(-0.5 * k * DRAUGHT), surge),
        Comparison(CASE, "heave amplitude, m", AMPLITUDE, heave),
        Comparison(CASE, "way across the wave, m", 0.0, float(np.abs(across).max()), 1e-3, scale=AMPLITUDE),
    ]


def compare() -> list[Comparison]:
    return lengths() + ride()


def test_waves():
    check(compare())
