"""Tables come back as they were written, without a last line that was cut short."""

import csv

import numpy as np
import pytest

from dilatedem.errors import CaseError
from dilatedem.results.tables import read_frame, read_table, row_count


def test_table_leaves_out_a_line_that_was_cut_short(tmp_path):
    path = tmp_path / "forces.csv"
    path.write_text("time_s,structure,fx_N\n0.01,pile,12.5\n0.02,pile,13.5\n0.03,pile,1")
    table = read_table(path)
    assert table["time_s"].tolist() == [0.01, 0.02]
    assert table["fx_N"].tolist() == [12.5, 13.5]
    assert list(table["structure"]) == ["pile", "pile"]


def test_table_without_rows_or_without_a_file_is_empty(tmp_path):
    (tmp_path / "energy.csv").write_text("time_s,kinetic\n")
    assert row_count(read_table(tmp_path / "energy.csv")) == 0
    assert read_table(tmp_path / "missing.csv") == {}


def test_frame_leaves_out_a_line_that_was_cut_short(tmp_path):
    path = tmp_path / "forces.csv"
    path.write_text("time_s,structure,fx_N\n0.01,pile,12.5\n0.02,pile,13.5\n0.03,pile,1")
    frame = read_frame(path)
    assert frame.time_s.tolist() == [0.01, 0.02]
    path.write_text("time_s,struc")
    with pytest.raises(CaseError, match="nothing has been written to it yet"):
        read_frame(path)


def test_names_stay_names_and_numbers_are_numbers_whatever_they_look_like(tmp_path):
    path = tmp_path / "forces.csv"
    path.write_text("time_s,structure,body,contacts,peak_N,note\n1,1,3,0,,a\n2,NA,4,1,nan,b\n3,1.0,5,2,inf,\n")
    frame = read_frame(path)
    assert frame.structure.tolist() == ["1", "NA", "1.0"]
    assert [frame[name].dtype for name in ("time_s", "body", "contacts", "peak_N")] == [float, np.int64, float, float]
    assert np.array_equal(frame.peak_N, [np.nan, np.nan, np.inf], equal_nan=True)
    assert frame.note.tolist()[:2] == ["a", "b"]
    table = read_table(path)
    assert table["structure"].tolist() == ["1", "NA", "1.0"]
    assert table["time_s"].tolist() == [1.0, 2.0, 3.0]


def test_quoted_names_and_rows_of_another_length(tmp_path):
    path = tmp_path / "forces.csv"
    path.write_text('time_s,structure,fx_N\n1,"quay, north",2\n2,"quay, north",3\n')
    assert read_table(path)["structure"].tolist() == ["quay, north"] * 2
    path.write_text('time_s,structure,fx_N\n1,"quay, north",2\n2,pile\n3,pile,4\n')
    assert read_table(path)["time_s"].tolist() == [1.0, 3.0]


def test_header_alone_gives_columns_of_numbers(tmp_path):
    (tmp_path / "bodies.csv").write_text("time_s,body,x_m\n")
    frame = read_frame(tmp_path / "bodies.csv")
    assert len(frame) == 0
    assert frame.x_m.dtype == float and frame.body.dtype == np.int64
    assert np.isnan(frame.x_m.max())


@pytest.mark.parametrize("name", ["forces.csv", "energy.csv", "bodies.csv"])
def test_values_are_those_of_the_file_to_the_last_digit(crowded, name):
    with open(crowded / name, newline="") as file:
        rows = list(csv.DictReader(file))
    frame, columns = read_frame(crowded / name), read_table(crowded / name)
    assert list(frame.columns) == list(columns) == list(rows[0])
    for column in rows[0]:
        written = [row[column] if column == "structure" else float(row[column]) for row in rows]
        assert frame[column].tolist() == columns[column].tolist() == written
