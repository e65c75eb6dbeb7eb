"""restart.h5: every field of the varying state, dumped without knowing what the fields mean.

A group per NamedTuple, a dataset per field. Fields added to the state by new physics are saved, and asked for
on restart, without a change here, so a restart cannot lag behind the model.
"""

import json
from pathlib import Path
from typing import NamedTuple, TypeVar

import h5py
import numpy as np

from dilatedem.errors import CaseError
from dilatedem.output.atomic import replacing

FORMAT = 1  # raised when the layout of the file changes
PYTHON_TYPE = "python_type"  # attribute on scalars that were plain Python numbers or text

State = TypeVar("State", bound=tuple)


def save(path, groups: dict[str, NamedTuple], meta: dict) -> None:
    """Replace the checkpoint at `path` by `groups` and `meta`, atomically and durably.

    groups  name -> NamedTuple of arrays (float, int, bool of any shape and width) and Python scalars
    meta    anything JSON can hold: step, offsets of the tables, version, ...

    Raises TypeError for a field that is neither.
    """
    with replacing(path, durable=True) as temporary:
        with h5py.File(temporary, "w") as file:
            file.attrs["format"] = FORMAT
            file.attrs["meta"] = json.dumps(meta)
            for name, state in groups.items():
                group = file.create_group(name, track_order=True)
                for field, value in state._asdict().items():
                    _save_field(group, field, value)


def load(path) -> tuple[dict[str, dict[str, object]], dict]:
    """Read a checkpoint: (group -> field -> array or Python scalar, meta), each as it was saved, bit for bit.

    Raises CaseError with one sentence if there is no such file or it is not a whole checkpoint.
    """
    path = Path(path)
    if not path.exists():
        raise CaseError(f"{path}: there is no checkpoint to resume from")
    try:
        with h5py.File(path, "r") as file:
            found = int(file.attrs["format"])
            if found != FORMAT:
                raise CaseError(f"{path}: checkpoint format {found}, but this version reads {FORMAT}")
            groups = {
                name: {field: _load_field(dataset) for field, dataset in group.items()}
                for name, group in file.items()
            }
            return groups, json.loads(file.attrs["meta"])
    except (OSError, KeyError, ValueError) as fault:
        raise CaseError(f"{path}: is not a readable checkpoint ({fault})") from fault


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


def _save_field(group: h5py.Group, field: str, value) -> None:
    if isinstance(value, np.ndarray | np.generic):
        if value.dtype.kind not in "fiub":
            raise TypeError(f"{group.name}/{field}: cannot be saved as it holds {value.dtype}, not numbers")
        group.create_dataset(field, data=value)
    elif isinstance(value, bool | int | float | str):
        dataset = group.create_dataset(field, data=value)
        dataset.attrs[PYTHON_TYPE] = type(value).__name__
    else:
        raise TypeError(f"{group.name}/{field}: cannot be saved as it is a {type(value).__name__}")


def _load_field(dataset: h5py.Dataset):
    python_type = dataset.attrs.get(PYTHON_TYPE)
    if python_type == "str":
        return dataset.asstr()[()]
    value = dataset[()]
    return value if python_type is None else value.item()
