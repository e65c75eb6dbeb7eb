"""HDF5 datasets that say what they are: units, a name in words, and dimensions with names (HDF5 dimension scales).

netCDF readers, xarray's h5netcdf among them, take these for the dimensions and coordinates of a group.
"""

from collections.abc import Sequence

import h5py
import numpy as np

#: NAME of a scale that is a dimension without coordinates, as netCDF-4 writes it
NO_COORDINATE = "This is a netCDF dimension but not a netCDF variable. {:10d}"


def write(group: h5py.Group, name: str, values, units: str, meaning: str, dimensions: Sequence[h5py.Dataset] = ()) -> h5py.Dataset:
    """A dataset along these dimensions (their scales), all of them."""
    dataset = group.create_dataset(name, data=values)
    dataset.attrs["units"] = units
    dataset.attrs["long_name"] = meaning
    for axis, scale in enumerate(dimensions):
        dataset.dims[axis].attach_scale(scale)
    return dataset


def coordinate(group: h5py.Group, name: str, values, units: str, meaning: str) -> h5py.Dataset:
    """A dimension with the values (n,) along it, numbers or names."""
    names = h5py.string_dtype() if np.asarray(values).dtype.kind == "U" else None
    scale = write(group, name, np.asarray(values, dtype=names), units, meaning)
    scale.make_scale(name)
    return scale


def dimension(group: h5py.Group, name: str, size: int) -> h5py.Dataset:
    """A dimension without values along it; it takes no room in the file."""
    scale = group.create_dataset(name, shape=(size,), dtype=np.int8)
    scale.make_scale(NO_COORDINATE.format(size))
    return scale
