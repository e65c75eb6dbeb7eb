"""Load maps as xarray Datasets, under the names that run.h5 has for them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from dilatedem.results.archive import LoadMap
from dilatedem.results.packages import imported

if TYPE_CHECKING:
    import xarray

UNITS = {"deg": "degree", "m": "m"}


def as_dataset(load_map: LoadMap) -> xarray.Dataset:
    """`impulse_Ns` over ("angle", "height") around a pile, ("distance", "height") along a plane.

    Coordinates lie at the centres of the bins; their bounds, each on a dimension of its own, are coordinates too
    (`angle_edges_deg` or `distance_edges_m`, `height_edges_m`). Attributes: structure, kind, duration_s, first_axis (where the
    first axis is zero) and what else run.h5 says. Around a pile `angle` counts from +x; where there is a current, the coordinate
    `angle_from_upstream` along it counts, in the same sense, from the side that the current comes from, as the figures do.
    """
    xarray = imported("xarray")
    place, unit = load_map.place, load_map.unit
    coordinates = {}
    for name, edges, short in ((place, load_map.place_edges, unit), ("height", load_map.height_edges, "m")):
        bounds, attributes = f"{name}_edges_{short}", {"units": UNITS.get(short, short)}
        zero = load_map.attributes.get("first_axis", "") if name == place else "above the water level"
        coordinates[name] = (name, 0.5 * (edges[1:] + edges[:-1]), attributes | {"long_name": name, "description": zero})
        coordinates[bounds] = (bounds, np.asarray(edges), attributes | {"long_name": f"bounds of the bins of {name}"})
    upstream = float(load_map.attributes.get("upstream_deg", np.nan))
    if place == "angle" and np.isfinite(upstream):
        turned = (coordinates["angle"][1] - upstream + 180.0) % 360.0 - 180.0
        said = {"units": "degree", "long_name": "angle from upstream", "description": "0 = the side that the current comes from"}
        coordinates["angle_from_upstream"] = ("angle", turned, said)
    impulse = ((place, "height"), load_map.impulse, {"units": "N s", "long_name": "normal impulse since t = 0"})
    said = {"structure": load_map.structure, "kind": load_map.kind, "duration_s": load_map.duration}
    return xarray.Dataset({"impulse_Ns": impulse}, coordinates, load_map.attributes | said)
