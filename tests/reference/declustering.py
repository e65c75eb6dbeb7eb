"""Load events of a force history, all of it known: the slow and obvious way."""

import numpy as np


def events(force: np.ndarray, threshold: float, gap: int, dt: float) -> list[dict]:
    """Events of the horizontal force (steps,) [N], that of step 1 first.

    Steps at which it reaches the threshold form one event as long as less than `gap` steps lie from one to the next.
    """
    counted = np.flatnonzero(force >= threshold) + 1
    groups = np.split(counted, np.flatnonzero(np.diff(counted) >= gap) + 1) if len(counted) else []
    found = []
    for steps in groups:
        start, last = int(steps[0]), int(steps[-1])
        inside = force[start - 1 : last]
        found.append({
            "start": start, "last": last, "peak_step": start + int(np.argmax(inside)), "peak_N": float(inside.max()),
            "impulse_Ns": float(np.sum(inside) * dt),
        })  # fmt: skip
    return found
