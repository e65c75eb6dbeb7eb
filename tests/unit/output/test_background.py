import pytest

from dilatedem.output.background import Background


def test_calls_are_made_in_their_order_and_none_after_a_fault():
    made, background = [], Background()
    background.put(made.append, 1)
    background.put(made.append, 2)
    background.wait()
    background.put([].pop)
    with pytest.raises(IndexError):
        for number in range(3, 6):
            background.put(made.append, number)
        background.close()
    background.close()
    assert made == [1, 2]
