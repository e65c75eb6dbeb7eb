import csv

import numpy as np
import pytest

from dilatedem.errors import CaseError
from dilatedem.output.tables import BODIES_COLUMNS, FORCES_COLUMNS, Table

RNG = np.random.default_rng(7)
FORCE_ROWS = [
    [
        0.01 * (i // 2 + 1), ("pile", 'leg "B", north')[i % 2], *RNG.normal(size=11) * 1e4, int(RNG.integers(9)),
        *RNG.normal(size=13) * 1e4,
    ]
    for i in range(40)
]

#: numbers alone
ENERGY_COLUMNS = ("time_s", "kinetic", "gravity", "residual")


def test_header_and_values_come_back(tmp_path):
    with Table(tmp_path / "forces.csv", FORCES_COLUMNS) as table:
        table.append(FORCE_ROWS)
    with open(tmp_path / "forces.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert tuple(rows[0]) == FORCES_COLUMNS
    assert [row["structure"] for row in rows] == [row[1] for row in FORCE_ROWS]
    assert rows[0]["contacts"] == str(FORCE_ROWS[0][13])
    assert rows[5]["time_s"] == "0.03"
    for found, given in zip(rows, FORCE_ROWS, strict=True):
        numbers = [float(found[name]) for name in FORCES_COLUMNS[2:13]]
        np.testing.assert_allclose(numbers, given[2:13], rtol=1e-8)


def test_array_rows(tmp_path):
    rows = RNG.normal(size=(5, len(BODIES_COLUMNS)))
    rows[:, 1] = np.arange(5)
    with Table(tmp_path / "a.csv", BODIES_COLUMNS) as table:
        table.append(rows)
        table.append(np.zeros((0, len(BODIES_COLUMNS))))
    with Table(tmp_path / "b.csv", BODIES_COLUMNS) as table:
        table.append(rows.tolist())
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()
    np.testing.assert_allclose(np.loadtxt(tmp_path / "a.csv", delimiter=",", skiprows=1), rows, rtol=1e-8)
    assert (tmp_path / "a.csv").read_text().splitlines()[4].split(",")[1] == "3"


def test_columns_make_the_same_rows(tmp_path):
    with Table(tmp_path / "a.csv", FORCES_COLUMNS) as table:
        table.append_columns([list(column) for column in zip(*FORCE_ROWS, strict=True)])
        table.append_columns([[]] * len(FORCES_COLUMNS))
    with Table(tmp_path / "b.csv", FORCES_COLUMNS) as table:
        table.append(FORCE_ROWS)
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()


@pytest.mark.parametrize("rows_after_checkpoint", [0, 1, 17])
@pytest.mark.parametrize("torn", [b"", b"12.3,pi"])
def test_resumed_table_equals_the_uninterrupted_one(tmp_path, rows_after_checkpoint, torn):
    with Table(tmp_path / "whole.csv", FORCES_COLUMNS) as whole:
        whole.append(FORCE_ROWS)

    path = tmp_path / "killed.csv"
    killed = Table(path, FORCES_COLUMNS)
    killed.append(FORCE_ROWS[:11])
    killed.flush(durable=True)
    offset, digest = killed.offset, killed.digest
    assert path.stat().st_size == offset
    killed.append(FORCE_ROWS[11 : 11 + rows_after_checkpoint])
    killed.flush()
    with open(path, "ab") as file:
        file.write(torn)  # what a full disk or a foreign kill could leave

    with Table.reopen(path, FORCES_COLUMNS, offset, digest) as resumed:
        assert (resumed.offset, resumed.digest) == (offset, digest)
        resumed.append(FORCE_ROWS[11:])
    assert path.read_bytes() == (tmp_path / "whole.csv").read_bytes()


def test_rows_reach_the_file_whole(tmp_path, monkeypatch):
    monkeypatch.setattr("dilatedem.output.tables.BUFFER_BYTES", 500)
    table = Table(tmp_path / "e.csv", ENERGY_COLUMNS)
    for i in range(50):
        table.append([[i / 3] * len(ENERGY_COLUMNS)])
        written = (tmp_path / "e.csv").read_bytes()
        assert not written or written.endswith(b"\n")
    assert 0 < len(written) < table.offset
    table.close()
    assert (tmp_path / "e.csv").stat().st_size == table.offset


def test_a_file_changed_since_the_checkpoint_is_refused(tmp_path):
    path = tmp_path / "energy.csv"
    with Table(path, ENERGY_COLUMNS) as table:
        table.append([[1.0] * len(ENERGY_COLUMNS)] * 3)
    with pytest.raises(CaseError, match=f"holds {table.offset} bytes of the {table.offset + 1} .* changed since"):
        Table.reopen(path, ENERGY_COLUMNS, table.offset + 1, table.digest)
    with pytest.raises(CaseError, match="changed since"):
        Table.reopen(path, ENERGY_COLUMNS, table.offset - 1, table.digest)  # not the end of a row
    with pytest.raises(CaseError, match="header"):
        Table.reopen(path, BODIES_COLUMNS, table.offset, table.digest)
    with pytest.raises(CaseError, match="missing"):
        Table.reopen(tmp_path / "none.csv", ENERGY_COLUMNS, 10, table.digest)
    path.write_bytes(path.read_bytes().replace(b"1,1,1", b"1,2,1", 1))  # as long as before
    with pytest.raises(CaseError, match="are not those that the checkpoint was taken after: the file was changed since"):
        Table.reopen(path, ENERGY_COLUMNS, table.offset, table.digest)
