"""What makes an event: one that does not answer all that is asked of it cannot be made."""

import pytest

from dilatedem.events.event import Event
from dilatedem.events.kinds import EVENTS


class Unfinished(Event):
    @classmethod
    def interval(cls, case) -> float:
        return 0.0


def test_an_event_that_leaves_a_question_open_cannot_be_made():
    assert Unfinished.__abstractmethods__ == {"happen"}
    with pytest.raises(TypeError, match="happen"):
        Unfinished(None)
    assert not any(event.__abstractmethods__ for event in EVENTS)
