import numpy as np

from dilatedem.numerics.blocks import offsets, place, take


def test_rows_are_read_where_they_were_written():
    start = offsets([2, 3, 0, 3])
    assert start.tolist() == [0, 2, 5, 5, 8]
    flat = np.zeros((8, 2))
    rows = np.arange(12.0).reshape(2, 3, 2)
    place(flat, start[[1, 3]], rows)
    np.testing.assert_array_equal(take(flat, start[[1, 3]], 3), rows)
    assert not flat[:2].any()


def test_one_row_for_all():
    flat = np.zeros(6, np.int64)
    place(flat, np.array([0, 3]), [7, 8, 9])
    assert flat.tolist() == [7, 8, 9, 7, 8, 9]


def test_no_rows():
    assert offsets([]).tolist() == [0]
