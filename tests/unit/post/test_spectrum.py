"""The figure of a response spectrum: densities against what is known of sines and of noise."""

import numpy as np
import pytest

from dilatedem.post.figures.spectrum import spectral_density, spectrum_figure

TIME = 0.01 * np.arange(4000)


def test_a_sine_has_its_power_at_its_frequency():
    frequency, density = spectral_density(TIME, 3.0 * np.sin(2.0 * np.pi * 1.5 * TIME) + 7.0)
    assert frequency[density.argmax()] == pytest.approx(1.5, abs=1.0 / 16.0)
    assert density.sum() * (frequency[1] - frequency[0]) == pytest.approx(0.5 * 3.0**2, rel=0.02)


def test_the_last_window_of_a_run_may_be_short():
    noise = np.random.default_rng(1).normal(size=len(TIME))
    whole = spectral_density(TIME, noise)
    longer = spectral_density(np.append(TIME, TIME[-1] + 0.003), np.append(noise, 1e6))
    assert (whole[0] == longer[0]).all() and (whole[1] == longer[1]).all()
    assert whole[1].mean() == pytest.approx(2.0 * 0.01, rel=0.1), "white: twice the variance over the rate"


def motion(rows: int) -> dict[str, np.ndarray]:
    time = TIME[:rows]
    swing = np.sin(2.0 * np.pi * 1.5 * time)
    return {"time_s": time, "x_m": 0.01 * swing, "y_m": 0.0 * time, "reaction_x_N": 1e4 * swing, "reaction_y_N": 0.0 * time}


def test_the_figure_names_what_it_shows():
    natural = {"along_x_Hz": [1.5, 9.0], "along_y_Hz": [1.5, 9.0]}
    drawing = spectrum_figure("leg", motion(4000), natural, {"time_s": TIME, "fx_N": 1e3 * np.sin(TIME)})
    assert drawing.name == "spectrum_leg" and "natural frequencies, 1.5, 9 Hz" in drawing.caption
    assert "strongest at 1.5 Hz" in drawing.caption
    assert spectrum_figure("leg", motion(20), natural) is None, "too short"
