"""CSV tables that only grow, and go on after a restart byte for byte as if the run had never stopped."""

import csv
import functools
import io
import os
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from dilatedem.errors import CaseError

FORCES_COLUMNS = (
    "time_s", "structure", "fx_N", "fy_N", "fz_N", "mx_Nm", "my_Nm", "mz_Nm",
    "fx_min_N", "fx_max_N", "fy_min_N", "fy_max_N", "fh_max_N", "contacts",
)  # fmt: skip
BODIES_COLUMNS = (
    "time_s", "body", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz", "vx_m_s", "vy_m_s", "vz_m_s",
    "wx_rad_s", "wy_rad_s", "wz_rad_s",
)  # fmt: skip

TEXT_COLUMNS = frozenset({"structure"})
# Nine digits: below the error of any figure in the tables; times stay readable (0.3, not 0.30000000000000004)
# and a row takes half the bytes of the shortest exact form. Body numbers and counts come out whole.
NUMBER_FORMAT = "%.9g"
BUFFER_BYTES = 1 << 20


class Table:
    """An append-only CSV file with a header row.

    Rows are kept in memory and handed to the system whole, at `flush` or when the buffer is full, so that a
    kill leaves no half row behind. `offset` counts the bytes of all rows appended so far: a checkpoint calls
    `flush`, then stores `offset`, and `Table.reopen` cuts off whatever was written after it.
    """

    def __init__(self, path, columns: Sequence[str]):
        """Start the table anew at `path` (an existing file is emptied: the caller has asked before)."""
        self._prepare(path, columns)
        self._file = open(self.path, "wb", buffering=0)
        self._write(self._header)

    @classmethod
    def reopen(cls, path, columns: Sequence[str], offset: int) -> "Table":
        """Go on with the table at `path` from byte `offset`.

        Raises CaseError if the file is not the one the checkpoint knew (missing, cut short, another header).
        """
        table = cls.__new__(cls)
        table._prepare(path, columns)
        header = table._header
        if not table.path.is_file():
            raise CaseError(f"{table.path}: is missing, so the run cannot be continued")
        with open(table.path, "rb") as existing:
            found = existing.read(len(header))
            existing.seek(max(0, offset - 1))
            last = existing.read(1)
        size = table.path.stat().st_size
        if found != header:
            raise CaseError(f"{table.path}: its header is not this version's, so it cannot be continued")
        if size < offset or offset < len(header) or last != b"\n":
            raise CaseError(
                f"{table.path}: holds {size} bytes, but the checkpoint was taken after {offset} whole ones: "
                "the file was changed since"
            )
        table._file = open(table.path, "r+b", buffering=0)
        table._file.truncate(offset)
        table._file.seek(offset)
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
        self._durable = 0  # bytes that are known to be on the disk

    @property
    def offset(self) -> int:
        """Bytes of the header and of all rows appended so far, flushed or not."""
        return self._offset

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
        if self._pending:
            _write_whole(self._file, b"".join(self._pending))
            self._pending.clear()
            self._pending_bytes = 0
        if durable and self._offset > self._durable:
            os.fsync(self._file.fileno())
            self._durable = self._offset

    def close(self) -> None:
        """Flush and close; closing twice does no harm."""
        if not self._file.closed:
            self.flush()
            self._file.close()

    def __enter__(self) -> "Table":
        return self

    def __exit__(self, *exception) -> None:
        self.close()

    def _write(self, data: bytes) -> None:
        self._pending.append(data)
        self._pending_bytes += len(data)
        self._offset += len(data)
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


def _write_whole(file, data: bytes) -> None:
    # An unbuffered write may take only a part of the data (a signal, a nearly full disk).
    view = memoryview(data)
    while view:
        view = view[file.write(view) :]
