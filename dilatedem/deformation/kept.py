"""Modes kept on disk, by shape and material, so that each is computed once."""

from __future__ import annotations

import hashlib
import io
import os
import zipfile
from contextlib import suppress
from dataclasses import fields
from pathlib import Path

import numpy as np

from dilatedem.deformation.elements import Material, assembled
from dilatedem.deformation.mesh import meshed
from dilatedem.deformation.modes import Modes, free_modes
from dilatedem.files.atomic import write_bytes
from dilatedem.geometry.polyhedron import Polyhedron

#: what the files of a folder are made by: another version of these sources makes other files
_SOURCES = Path(__file__).parent
#: digits of a shape's coordinates, in units of its extent, that make it another one
DIGITS = 12


def modes_of(
    body: Polyhedron, material: Material, size: float, count: int, strains: bool = False, *, folder: Path | None = None
) -> Modes:
    """`free_modes` of a convex body with elements of `size` [m], computed unless they lie in `folder`.

    folder: the user's cache unless given. Raises ValueError where the body has no such modes, CaseError without scikit-fem.
    """
    path = (folder or cache_folder()) / f"{digest(body, material, size, count, strains)}.npz"
    known = _read(path)
    if known is None:
        known = free_modes(assembled(meshed(body, size), material), count, strains)
        _keep(path, known)
    return known


def cache_folder() -> Path:
    """Where modes are kept unless told otherwise: in the user's cache."""
    base = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    return Path(base, "dilatedem", "modes")


def digest(body: Polyhedron, material: Material, size: float, count: int, strains: bool = False) -> str:
    """Of all that modes follow from: shape, material, mesh, how many and with what, and these sources."""
    told = hashlib.sha256()
    for source in sorted(_SOURCES.glob("*.py")):
        told.update(source.read_bytes())
    extent = np.ptp(body.vertices, axis=0).max()
    for numbers in (np.round(body.vertices / extent, DIGITS) + 0.0, [extent, *material, size, count, strains]):
        told.update(np.asarray(numbers, dtype="<f8").tobytes())
    for face in body.faces:
        told.update(np.asarray(face, dtype="<i8").tobytes() + b"|")
    return told.hexdigest()[:32]


def _read(path: Path) -> Modes | None:
    """The modes of a file; None where there is none, or one that is damaged."""
    try:
        with np.load(path, allow_pickle=False) as file:
            return Modes(**{field.name: file[field.name] for field in fields(Modes)})
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        return None


def _keep(path: Path, modes: Modes) -> None:
    """Write modes to a file; where the disk does not take it, they are computed again the next time."""
    data = io.BytesIO()
    np.savez(data, **{field.name: getattr(modes, field.name) for field in fields(Modes)})
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        write_bytes(path, data.getvalue())
