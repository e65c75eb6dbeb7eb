"""Floes of several parts put together again: files hold each part as a body, eyes and counts are for floes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import shapely

from dilatedem.results.archive import FloeTable
from dilatedem.results.snapshots import Snapshot

#: m, up to twice which parts may lie apart in a snapshot, whose outlines are a little smaller than the floes
GAP = 0.05


def floes_of(table: FloeTable) -> np.ndarray | None:
    """(n,) number of the floe that each body of run.h5 is part of, that of its first part; None: every body is a floe."""
    return table.columns.get("floe")


def whole_table(table: FloeTable) -> FloeTable:
    """The table with a row for each floe: areas and masses of its parts added up."""
    floe = floes_of(table)
    if floe is None:
        return table
    first, owner = np.unique(floe, return_index=True, return_inverse=True)[1:]
    sums = [np.bincount(owner, values) for values in (table.plan_area, table.mass)]
    return FloeTable(together(table.outlines, owner), *sums, {name: values[first] for name, values in table.columns.items()})


def whole_snapshot(snapshot: Snapshot, table: FloeTable | None) -> Snapshot:
    """The snapshot with a row for each floe, of which its first part says how fast it is; table: that of the run's bodies."""
    floe = None if table is None else floes_of(table)
    if floe is None:
        return snapshot
    own = floe[np.searchsorted(table.columns["body"], snapshot.body)]
    first, owner = np.unique(own, return_index=True, return_inverse=True)[1:]
    moving = {name: getattr(snapshot, name)[first] for name in ("body", "speed", "velocity", "angular_velocity")}
    force = np.zeros((len(first), 3))
    np.add.at(force, owner, snapshot.contact_force)
    contacts = np.bincount(owner, snapshot.contacts).astype(np.int64)
    return replace(snapshot, outlines=together(snapshot.outlines, owner), contact_force=force, contacts=contacts, **moving)


def together(outlines: Sequence[np.ndarray], owner: np.ndarray) -> list[np.ndarray]:
    """One outline (k, 2) [m] of all that have one owner, the first of which is 0; a body seen edge-on has none."""
    found, count = [], np.bincount(owner)
    order = np.argsort(owner, kind="stable")
    for rows in np.split(order, np.cumsum(count)[:-1]):
        parts = [shapely.Polygon(outlines[k]) for k in rows if len(outlines[k]) > 2]
        found.append(outlines[rows[0]] if len(rows) == 1 else _merged(parts) if parts else np.zeros((0, 2)))
    return found


def _merged(parts: list[shapely.Polygon]) -> np.ndarray:
    """The outline (k, 2) [m] around parts that lie side by side."""
    grown = shapely.union_all(shapely.buffer(parts, GAP, join_style="mitre", mitre_limit=2.0))
    # bevelled, which cuts a corner that looks inward by less than GAP: mitred ones may leave nothing (GEOS 3.14)
    pieces = shapely.get_parts(shapely.buffer(grown, -GAP, join_style="bevel"))
    largest = pieces[shapely.area(pieces).argmax()]
    return shapely.get_coordinates(shapely.get_exterior_ring(largest))[:-1]
