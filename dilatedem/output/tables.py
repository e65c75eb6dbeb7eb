"""CSV tables that only grow, and go on after a restart byte for byte as if the run had never stopped."""

import csv
import functools
import hashlib
import io
import os
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from dilatedem.errors import CaseError
from dilatedem.files.atomic import open_file, write_whole

FORCES_COLUMNS = (
    "time_s", "structure", "fx_N", "fy_N", "fz_N", "mx_Nm", "my_Nm", "mz_Nm",
    "fx_min_N", "fx_max_N", "fy_min_N", "fy_max_N", "fh_max_N", "contacts",
    "along_N", "across_N", "along_min_N", "along_max_N", "across_min_N", "across_max_N",
    "mx_min_Nm", "mx_max_Nm", "my_min_Nm", "my_max_Nm", "mz_min_Nm", "mz_max_Nm", "mh_max_Nm",
)  # fmt: skip
HITS_COLUMNS = (
    "structure", "start_s", "rise_s", "duration_s", "peak_N", "peak_time_s", "impulse_Ns", "body", "mode", "area_m2", "pressure_Pa",
    "crushed_m", "bodies",
)  # fmt: skip
BODIES_COLUMNS = (
    "time_s", "body", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz", "vx_m_s", "vy_m_s", "vz_m_s",
    "wx_rad_s", "wy_rad_s", "wz_rad_s",
)  # fmt: skip
STRUCTURES_COLUMNS = ("time_s", "structure", "x_m", "y_m", "yaw_rad", "vx_m_s", "vy_m_s", "reaction_x_N", "reaction_y_N")
#: and of cases with a beam
BEAM_COLUMNS = ("base_moment_x_Nm", "base_moment_y_Nm", "base_force_max_N", "base_moment_max_Nm")
FLEXURE_COLUMNS = (
    "body", "tension_Pa", "time_s", "place_x_m", "place_y_m", "place_z_m", "above_strength", "above_at_s", "above_x_m", "above_y_m",
    "above_z_m",
)  # fmt: skip

TEXT_COLUMNS = frozenset({"structure", "mode"})
# Nine digits: below the error of any figure in the tables; times stay readable (0.3, not 0.30000000000000004)
# and a row takes half the bytes of the shortest exact form. Body numbers and counts come out whole.
NUMBER_FORMAT = "%.9g"
BUFFER_BYTES = 1 << 20


def whole(columns: Sequence[str], rows: Iterable[Sequence]) -> str:
    """A table that is written anew each time; what is no number comes out as it is."""
    lines = [columns, *([value if isinstance(value, str) else NUMBER_FORMAT % value for value in row] for row in rows)]
    return "".join(",".join(line) + "\n" for line in lines)


class Table:
    """An append-only CSV file with a header row.

    Rows are kept in memory and handed to the system whole, at `flush` or when the buffer is full, so that a
    kill leaves no half row behind. `offset` counts the bytes of all rows appended so far, and `digest` is theirs: a checkpoint
    calls `flush`, then stores both, and `Table.reopen` cuts off whatever was written after it.
    """

    def __init__(self, path, columns: Sequence[str]):
        """Start the table anew at `path` (an existing file is emptied: the caller has asked before)."""
        self._prepare(path, columns)
        self._open(os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        self._write(self._header)

    @classmethod
    def reopen(cls, path, columns: Sequence[str], offset: int, digest: str) -> "Table":
        """Go on with the table at `path` from byte `offset`, up to where its digest is `digest`.

        Raises CaseError if the file is not the one the checkpoint knew (missing, cut short, another header, other bytes).
        """
        table = cls.__new__(cls)
        table._prepare(path, columns)
        table._digest = verified(table.path, offset, digest)
        with open(table.path, "rb") as existing:
            if existing.read(len(table._header)) != table._header:
                raise CaseError(f"{table.path}: its header is not this version's, so it cannot be continued")
        table._open(os.O_WRONLY)
        os.ftruncate(table._file, offset)
        os.lseek(table._file, offset, os.SEEK_SET)
        table._offset = offset
        return table

    def _prepare(self, path, columns: Sequence[str]) -> None:
        self.path = Path(path)
        self.columns = tuple(columns)
        self._header = (",".join(self.columns) + "\n").encode()
        self._text = [i for i, name in enumerate(self.columns) if name in TEXT_COLUMNS]
        self._line = ",".join(_column_format(name) for name in self.columns) + "\n"
        self._pending: list[bytes] = []
        self._pending_bytes = 0
        self._offset = 0
        self._digest = hashlib.sha256()
        self._durable = 0  # bytes that are known to be on the disk

    def _open(self, flags: int) -> None:
        self._file: int | None = open_file(self.path, flags)

    @property
    def offset(self) -> int:
        """Bytes of the header and of all rows appended so far, flushed or not."""
        return self._offset

    @property
    def digest(self) -> str:
        """SHA-256 of the first `offset` bytes."""
        return self._digest.hexdigest()

    def append(self, rows: Iterable[Sequence]) -> None:
        """Add rows, one entry a column each; an array (rows, columns) will do where no column is text."""
        if isinstance(rows, np.ndarray):
            rows = rows.tolist()  # Python floats: formatted five times faster than NumPy scalars
        line = self._line
        if self._text:
            lines = [line % self._quoted(row) for row in rows]
        else:
            lines = [line % tuple(row) for row in rows]
        if lines:
            self._write("".join(lines).encode())

    def append_columns(self, columns: Sequence[list]) -> None:
        """Add rows given column by column, in half the time that many rows take."""
        width, count = len(self.columns), len(columns[0])
        entries = [None] * (width * count)
        for i, column in enumerate(columns):
            entries[i::width] = map(_quoted_text, column) if i in self._text else column
        self._write((self._line * count % tuple(entries)).encode())

    def flush(self, *, durable: bool = False) -> None:
        """Hand all rows to the system; `durable`: wait until they are on the disk (before a checkpoint)."""
        pending, self._pending, self._pending_bytes = self._pending, [], 0
        with self._named_faults():
            if pending:  # given away before: after a fault nobody knows how much of it the file has, so it is not written again
                write_whole(self._file, b"".join(pending))
            if durable and self._offset > self._durable:
                os.fsync(self._file)
                self._durable = self._offset

    def close(self) -> None:
        """Flush and close; closing twice does no harm."""
        if self._file is not None:
            try:
                self.flush()
            finally:
                descriptor, self._file = self._file, None
                with self._named_faults():
                    os.close(descriptor)

    @contextmanager
    def _named_faults(self) -> Iterator[None]:
        """A descriptor has no name for a fault to tell."""
        try:
            yield
        except OSError as fault:
            raise OSError(fault.errno, os.strerror(fault.errno or 0), str(self.path)) from fault

    def __enter__(self) -> "Table":
        return self

    def __exit__(self, *exception) -> None:
        self.close()

    def _write(self, data: bytes) -> None:
        self._pending.append(data)
        self._pending_bytes += len(data)
        self._offset += len(data)
        self._digest.update(data)
        if self._pending_bytes >= BUFFER_BYTES:
            self.flush()

    def _quoted(self, row: Sequence) -> tuple:
        row = list(row)
        for column in self._text:
            row[column] = _quoted_text(row[column])
        return tuple(row)


def _column_format(name: str) -> str:
    return "%s" if name in TEXT_COLUMNS else NUMBER_FORMAT


@functools.cache
def _quoted_text(text: str) -> str:
    """`text` as a CSV field: quoted only where it has to be."""
    if not any(mark in text for mark in ',"\r\n'):
        return text
    field = io.StringIO()
    csv.writer(field, lineterminator="").writerow([text])
    return field.getvalue()


def verified(path: Path, offset: int, digest: str):
    """The hash of the first `offset` bytes of a table, to be gone on with.

    Raises CaseError if the file is missing, shorter, or holds other bytes than those that a checkpoint noted.
    """
    if not path.is_file():
        raise CaseError(f"{path}: is missing, so the run cannot be continued")
    found, left = hashlib.sha256(), offset
    with open(path, "rb") as existing:
        while left > 0 and (part := existing.read(min(left, BUFFER_BYTES))):
            found.update(part)
            left -= len(part)
    if left > 0 or found.hexdigest() != digest:
        short = f"holds {offset - left} bytes of the {offset}" if left > 0 else f"its first {offset} bytes are not those"
        raise CaseError(f"{path}: {short} that the checkpoint was taken after: the file was changed since")
    return found
