"""ParaView without a window, and what is in a picture that it made."""

import os
import subprocess
from pathlib import Path

import numpy as np

#: s that a picture of a small run may take on a busy machine
LONGEST = 600
#: times that a picture is tried for where the X server was not up yet, as happens on a busy machine
TRIES = 3


def pvbatch(script: Path, *options) -> subprocess.CompletedProcess:
    """Run a script by ParaView's own Python: that of this process, and what is set for it, are not its."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "VIRTUAL_ENV"))}
    command = list(map(str, ["xvfb-run", "-a", "pvbatch", script, *options]))
    for _ in range(TRIES):
        done = subprocess.run(command, capture_output=True, text=True, timeout=LONGEST, env=environment, check=False)
        if "bad X server connection" not in done.stdout + done.stderr:
            break
    return done


def colours_of(image: np.ndarray) -> dict[str, float]:
    """Shares of the pixels (h, w, 3) that are white ground, water, floes (from violet to yellow), structures and arrows."""
    red, green, blue = (image[..., i].astype(int) for i in range(3))
    bright = np.minimum(np.minimum(red, green), blue)
    kinds = {
        "ground": bright >= 250,
        "water": (blue > red + 5) & (bright > 190) & (bright < 250),
        "structures": (red > green + 60) & (green > blue + 25),
        "arrows": (red > 60) & (green < 20) & (blue < 60) & (red > blue + 40),
    }
    taken = np.any(list(kinds.values()), axis=0)
    kinds["floes"] = ~taken & (np.maximum(green, blue) > red) & (np.ptp(image.astype(int), axis=-1) > 40)
    return {name: float(mask.mean()) for name, mask in kinds.items()}
