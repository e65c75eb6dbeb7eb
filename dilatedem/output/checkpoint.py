"""restart.h5: every field of the varying state, dumped without knowing what the fields mean.

All arrays lie one after the other in one dataset of bytes, `state`; a text in JSON beside it, `contents`, tells where, and holds
what is no array. Fields added to the state by new physics are saved, and asked for on restart, without a change here, so a restart
cannot lag behind the model. A dataset per field would be friendlier to foreign eyes, but HDF5 takes 80 us for each: with some 200
fields that was 3 % of a run.

The file is made in memory, and behind its last byte stand the format's number and the digest of all bytes before: what is damaged
never reaches HDF5, whose reader may crash on it, and never becomes a state.
"""

import hashlib
import io
import json
import math
import re
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple, TypeVar

import h5py
import numpy as np

from dilatedem.errors import CaseError
from dilatedem.files.atomic import write_bytes

FORMAT = 4  # raised when the layout of the file changes
ALIGNMENT = 8  # bytes; every array begins at a multiple
PART_BYTES = 1 << 20  # so much is put together before it goes into the file
SEAL = re.compile(rb"dilatedem checkpoint (\d+) sha256 ([0-9a-f]{64})\n")  # the end of the file
SEAL_BYTES = 200  # it is shorter

State = TypeVar("State", bound=tuple)


def save(path, groups: dict[str, NamedTuple], meta: dict) -> None:
    """Replace the checkpoint at `path` by `groups` and `meta`, atomically and durably.

    groups  name -> NamedTuple of arrays (float, int, bool of any shape and width) and Python scalars
    meta    anything JSON can hold: step, offsets of the tables, version, ...

    Raises TypeError for a field that is neither.
    """
    arrays: list[np.ndarray] = []
    size, fields = 0, {}
    for name, state in groups.items():
        fields[name] = entries = {}
        for field, value in state._asdict().items():
            if isinstance(value, np.ndarray | np.generic) and value.dtype.kind in "fiub":
                entries[field] = [size, value.dtype.str, value.shape]
                arrays.append(value)
                size += _padded(value.nbytes)
            elif isinstance(value, bool | int | float | str):
                entries[field] = value
            else:
                kind = getattr(value, "dtype", type(value).__name__)
                raise TypeError(f"{name}/{field}: cannot be saved: it is no number, no text and no array of numbers, but {kind}")
    contents = json.dumps({"fields": fields, "meta": meta}).encode()
    image = io.BytesIO()
    with h5py.File(image, "w") as file:
        file.attrs["format"] = FORMAT
        file["contents"] = np.frombuffer(contents, np.uint8)
        state = file.create_dataset("state", (size,), np.uint8)
        start = 0
        for part in _parts(arrays):
            state[start : start + len(part)] = np.frombuffer(part, np.uint8)
            start += len(part)
    digest = hashlib.sha256(image.getbuffer()).hexdigest()
    image.seek(0, io.SEEK_END)
    image.write(f"dilatedem checkpoint {FORMAT} sha256 {digest}\n".encode())
    write_bytes(path, image.getbuffer(), durable=True)


def load(path) -> tuple[dict[str, dict[str, object]], dict]:
    """Read a checkpoint: (group -> field -> array or Python scalar, meta), each as it was saved, bit for bit.

    Raises CaseError with one sentence if there is no such file or it is not a whole checkpoint.
    """
    image = memoryview(image_and_seal(path))
    image = image[: SEAL.search(image, max(0, len(image) - SEAL_BYTES)).start()]
    try:
        with h5py.File(io.BytesIO(image), "r") as file:
            contents = json.loads(file["contents"][()].tobytes())
            groups = {
                name: {field: _loaded(entry, file["state"]) for field, entry in entries.items()}
                for name, entries in contents["fields"].items()
            }
        return groups, contents["meta"]
    except (OSError, KeyError, TypeError, ValueError) as fault:
        raise CaseError(f"{path}: is not a readable checkpoint ({fault})") from fault


def image_and_seal(path) -> bytes:
    """The bytes of a whole checkpoint.

    Raises CaseError with one sentence if there is no such file, or a byte of it is another than was written.
    """
    path = Path(path)
    if not path.exists():
        raise CaseError(f"{path}: there is no checkpoint to resume from")
    data = path.read_bytes()
    seal = SEAL.search(data, max(0, len(data) - SEAL_BYTES))
    if not seal or seal.end() != len(data):
        raise CaseError(f"{path}: is damaged, or written by another version (format {FORMAT} is read); start anew with --overwrite")
    if int(seal[1]) != FORMAT:
        raise CaseError(f"{path}: checkpoint format {int(seal[1])}, but this version reads {FORMAT}; start anew with --overwrite")
    if hashlib.sha256(memoryview(data)[: seal.start()]).hexdigest() != seal[2].decode():
        raise CaseError(f"{path}: is damaged: its digest is not that of its contents; start anew with --overwrite")
    return data


def restore(kind: type[State], fields: dict[str, object], *, where: str = "the checkpoint") -> State:
    """A NamedTuple of class `kind` from the fields of one loaded group.

    Raises CaseError that names the fields if they are not those of `kind` (another version wrote them).
    """
    missing = [name for name in kind._fields if name not in fields]
    unknown = [name for name in fields if name not in kind._fields]
    if missing or unknown:
        parts = [f"lacks {', '.join(missing)}"] if missing else []
        parts += [f"has unknown {', '.join(unknown)}"] if unknown else []
        raise CaseError(
            f"{where}: {kind.__name__} {' and '.join(parts)}: it was written by another version of dilatedem"
        )
    return kind(**fields)


def _padded(size: int) -> int:
    return -(-size // ALIGNMENT) * ALIGNMENT


def _parts(arrays: Iterable[np.ndarray]) -> Iterable[bytes]:
    """The bytes of all arrays, each padded, in parts of PART_BYTES or a little more: a large state is not held twice."""
    part: list[bytes] = []
    held = 0
    for array in arrays:
        part.append(array.tobytes().ljust(_padded(array.nbytes), b"\0"))
        held += len(part[-1])
        if held >= PART_BYTES:
            yield b"".join(part)
            part, held = [], 0
    yield b"".join(part)


def _loaded(entry, state: h5py.Dataset):
    """A field from its entry in `contents`: itself, or where in `state` its array begins, of what type and shape it is."""
    if not isinstance(entry, list):
        return entry
    start, kind, shape = entry[0], np.dtype(entry[1]), entry[2]
    array = state[start : start + kind.itemsize * math.prod(shape)].view(kind).reshape(shape)
    return array[()]  # an array of no dimension is a number
