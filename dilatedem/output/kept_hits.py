"""The highest load events of a run in run.h5: their force at every step around the peak, and the floes that pushed."""

import math
from collections.abc import Mapping, Sequence

import h5py
import numpy as np

from dilatedem.numerics.frames import matrix_from_quaternion
from dilatedem.output import dimensions
from dilatedem.state.hits import (
    AREA,
    BODIES,
    BODY,
    CONTACTS,
    CRUSHED,
    FIRST,
    FLOES,
    IMPULSE,
    LAST,
    MODE,
    PEAK,
    PEAK_STEP,
    PRESSURE,
    SAMPLES,
    START,
    STRUCTURE,
    Hits,
)

#: dimensions behind the first, which counts the events: their names
FORCE, FLOE, CONTACT, PAIR, AXIS = "sample", "place", "contact", "side", "xyz"
#: orientation of a floe that lies as it was made
UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])
#: datasets: units, meaning, dimensions behind the first
DATASETS: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "structure": ("1", "number of the structure, in the attribute structures of the group; -1: no event", ()),
    "start_s": ("s", "first step at which the load counts", ()),
    "end_s": ("s", "last step at which the load counts", ()),
    "peak_time_s": ("s", "step of the highest horizontal force", ()),
    "peak_N": ("N", "highest horizontal force of any step", ()),
    "impulse_Ns": ("N s", "horizontal force times time step from start to end", ()),
    "body": ("1", "number of the leading floe at the peak", ()),
    "mode": ("1", "mode of its contact, in contacts/mode_names", ()),
    "area_m2": ("m2", "nominal area of its contact", ()),
    "pressure_Pa": ("Pa", "its normal force over that area", ()),
    "crushed_m": ("m", "depth to which it has crushed there", ()),
    "bodies": ("1", "floes that pushed", ()),
    "first_s": ("s", "time of the first sample", ()),
    "samples": ("1", "samples, one a step; what follows is empty", ()),
    "force_N": ("N", "force on the structure at every step", (FORCE, AXIS)),
    "floes": ("1", "floes that follow; what follows is empty", ()),
    "floe": ("1", "numbers of the floes that pushed, from the structure outward", (FLOE,)),
    "position_m": ("m", "their centroids at the peak", (FLOE, AXIS)),
    "turned_rad": ("rad", "angle by which each is turned about z since t = 0, counter-clockwise seen from above", (FLOE,)),
    "contacts": ("1", "contacts that follow; what follows is empty", ()),
    "contact_body": ("1", "numbers of the two bodies; of a structure -1 less its number", (CONTACT, PAIR)),
    "contact_mode": ("1", "mode, in contacts/mode_names", (CONTACT,)),
    "contact_point_m": ("m", "where the force acts at the peak", (CONTACT, AXIS)),
    "contact_force_N": ("N", "force on the second body", (CONTACT, AXIS)),
}


def kept_hits(hits: Hits, dt: float, orientation: np.ndarray) -> dict[str, np.ndarray]:
    """The events that are kept, the highest first, by the names of DATASETS; nothing where none is to be kept.

    dt: time step [s]; orientation (n, 4): of every body at t = 0, unit quaternions.
    """
    watched = len(hits.recent)
    if len(hits.counts) == watched:
        return {}
    counts, figures = hits.counts[watched:], hits.figures[watched:]
    there = counts[:, STRUCTURE] >= 0
    # of equal ones that which began first, of the structure that stands first
    order = np.lexsort((counts[:, STRUCTURE], counts[:, START], -figures[:, PEAK], ~there))
    counts, figures, rows = counts[order], figures[order], watched + order
    times = {name: counts[:, which] * dt for name, which in (
        ("start_s", START), ("end_s", LAST), ("peak_time_s", PEAK_STEP), ("first_s", FIRST)
    )}  # fmt: skip
    numbers = {name: counts[:, which].copy() for name, which in (
        ("structure", STRUCTURE), ("body", BODY), ("mode", MODE), ("bodies", BODIES), ("samples", SAMPLES), ("floes", FLOES),
        ("contacts", CONTACTS),
    )}  # fmt: skip
    measured = {name: figures[:, which].copy() for name, which in (
        ("peak_N", PEAK), ("impulse_Ns", IMPULSE), ("area_m2", AREA), ("pressure_Pa", PRESSURE), ("crushed_m", CRUSHED)
    )}  # fmt: skip
    arrays = {
        "force_N": hits.history[rows], "floe": hits.floe[rows], "position_m": hits.pose[rows, :, :3],
        "turned_rad": np.array([_turned(*each, orientation) for each in zip(
            hits.floe[rows], hits.pose[rows, :, 3:], numbers["floes"], strict=True
        )]),
        "contact_body": hits.touch[rows, :, :2], "contact_mode": hits.touch[rows, :, 2],
        "contact_point_m": hits.arrow[rows, :, :3], "contact_force_N": hits.arrow[rows, :, 3:],
    }  # fmt: skip
    found = times | numbers | measured | arrays
    return {name: found[name] for name in DATASETS}


def _turned(floe: np.ndarray, orientation: np.ndarray, count: int, initial: np.ndarray) -> list[float]:
    """Angles [rad] about z by which the first `count` floes are turned since t = 0; 0 for the others."""
    found = [0.0] * len(floe)
    for k in range(count):
        start = initial[floe[k]] if floe[k] < len(initial) else UPRIGHT  # as ice enters
        before, now = matrix_from_quaternion(start), matrix_from_quaternion(orientation[k])
        # of the matrix now before^T, entries (1, 0) and (0, 0): plain sums, that round alike everywhere
        sine, cosine = (sum(now[row, m] * before[0, m] for m in range(3)) for row in (1, 0))
        found[k] = math.atan2(sine, cosine)
    return found


def write_hits(group: h5py.Group, hits: Mapping[str, np.ndarray], structures: Sequence[str], dt: float) -> None:
    """Lay the events out; structures: names by number; dt: time step [s]."""
    group.attrs["structures"] = list(structures)
    group.attrs["dt_s"] = dt
    sizes = {"hit": len(hits["structure"]), FORCE: hits["force_N"].shape[1]}
    sizes |= {FLOE: hits["floe"].shape[1], CONTACT: hits["contact_mode"].shape[1]}
    axes = {name: dimensions.dimension(group, name, size) for name, size in sizes.items()}
    axes[AXIS] = dimensions.coordinate(group, AXIS, ["x", "y", "z"], "1", "component")
    axes[PAIR] = dimensions.coordinate(group, PAIR, ["first", "second"], "1", "which of the two bodies")
    for name, (units, meaning, along) in DATASETS.items():
        dimensions.write(group, name, hits[name], units, meaning, [axes[axis] for axis in ("hit", *along)])
