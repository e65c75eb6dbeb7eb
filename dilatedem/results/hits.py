"""The highest load events of a run, as run.h5 keeps them: the force at every step, and the floes that pushed."""

from __future__ import annotations

from dataclasses import dataclass

import h5py
import numpy as np

from dilatedem.results.soundness import require_array

#: numbers of an event, as run.h5 calls them
FIGURES = ("start_s", "end_s", "peak_time_s", "peak_N", "impulse_Ns", "area_m2", "pressure_Pa", "crushed_m", "first_s")
COUNTS = ("structure", "body", "mode", "bodies", "samples", "floes", "contacts")
#: arrays of an event, and what they have a row for
ROWS = {
    "force_N": "samples", "floe": "floes", "position_m": "floes", "turned_rad": "floes", "contact_body": "contacts",
    "contact_mode": "contacts", "contact_point_m": "contacts", "contact_force_N": "contacts",
}  # fmt: skip


@dataclass(frozen=True)
class KeptHit:
    """A load event at every step around its peak.

    figures: by their names in run.h5; time (n,) [s], force (n, 3) [N] on the structure; floes: numbers (k,) of those that pushed,
    position (k, 3) [m] of each, turned (k,) [rad] about z since t = 0; of their contacts (c,) both bodies (c, 2) (of a structure -1
    less its number), point (c, 3) [m] and force on the second (c, 3) [N].
    """

    structure: str
    figures: dict[str, float]
    mode: str
    time: np.ndarray
    force: np.ndarray
    floe: np.ndarray
    position: np.ndarray
    turned: np.ndarray
    contact_body: np.ndarray
    contact_point: np.ndarray
    contact_force: np.ndarray


def read_hits(group: h5py.Group, modes: list[str]) -> list[KeptHit]:
    """The events of run.h5, the highest first; modes: names of the contact modes. Raises ValueError for what no run writes."""
    names, dt = [str(name) for name in group.attrs["structures"]], float(group.attrs["dt_s"])
    places = len(group["structure"])
    counts = {name: require_array(group[name][()], (places,), f"hits: {name}") for name in COUNTS}
    figures = {name: require_array(group[name][()], (places,), f"hits: {name}") for name in FIGURES}
    arrays = {name: group[name][()] for name in ROWS}
    for name, array in arrays.items():
        require_array(array, (places, *(None,) * (array.ndim - 1)), f"hits: {name}")
        if (counts[ROWS[name]] > array.shape[1]).any() or (counts[ROWS[name]] < 0).any():
            raise ValueError(f"hits: {name} holds fewer rows than {ROWS[name]} says")
    found = []
    for k in np.flatnonzero(counts["structure"] >= 0):
        rows = {name: array[k, : counts[ROWS[name]][k]] for name, array in arrays.items()}
        found.append(KeptHit(
            structure=names[counts["structure"][k]],
            figures={name: float(values[k]) for name, values in figures.items()} | {
                name: int(counts[name][k]) for name in ("body", "bodies")
            },
            mode=modes[counts["mode"][k]], time=figures["first_s"][k] + dt * np.arange(counts["samples"][k]),
            force=rows["force_N"], floe=rows["floe"], position=rows["position_m"], turned=rows["turned_rad"],
            contact_body=rows["contact_body"], contact_point=rows["contact_point_m"], contact_force=rows["contact_force_N"],
        ))  # fmt: skip
    return found
