"""Processes that carry out orders: copies of this one, or started anew, they answer alike, and die alone."""

import os
import signal
import sys
import time

import pytest

from dilatedem.processes import children
from dilatedem.processes.children import Answer, Children


def work(order, tell) -> Answer:
    tell(("has", order))
    match order:
        case "die":
            os.write(2, b"last words")
            os.kill(os.getpid(), signal.SIGKILL)
        case "end":
            sys.exit(7)
        case "sleep":
            time.sleep(60)
        case "who":
            return Answer(0, str(os.getpid()))
    return Answer(0, f"did {order}")


@pytest.fixture(params=["fork", "spawn"])
def way(request, monkeypatch):
    monkeypatch.setattr(children, "way_to_start", lambda: request.param)


def answers(orders, count=2, tell=lambda *_: None) -> dict[int, Answer]:
    with Children(work, count) as some:
        return dict(some.carry_out(orders, tell))


def test_every_order_has_its_answer_and_a_word_before(way):
    told = []
    assert answers(["a", "b", "c"], tell=lambda *what: told.append(what)) == {i: Answer(0, f"did {x}") for i, x in enumerate("abc")}
    assert [what for what in sorted(told) if what] == [(i, ("has", x)) for i, x in enumerate("abc")]


def test_one_that_dies_takes_its_order_and_no_other(way):
    found = answers(["a", "die", "end", "b", "c"])
    assert found == {
        0: Answer(0, "did a"), 1: Answer(-signal.SIGKILL, "last words"), 2: Answer(7), 3: Answer(0, "did b"), 4: Answer(0, "did c"),
    }  # fmt: skip


def test_as_many_processes_as_asked_for_and_each_of_them_again(way):
    assert len({answer.said for answer in answers(["who"] * 6, count=1).values()}) == 1


def test_those_that_are_told_to_stop_end_and_no_other_begins(way):
    with Children(work, 1) as some:

        def tell(*what) -> None:
            if what == (0, ("has", "sleep")):
                some.interrupt()

        assert list(some.carry_out(["sleep", "a"], tell)) == [(0, Answer(130))]


def test_after_a_fault_nobody_is_left(way):
    with pytest.raises(OSError), Children(work, 2) as some:
        for _ in some.carry_out(["a", "sleep"], lambda *_: None):
            processes = [child.process for child, _ in some._busy.values()]
            raise OSError("the disk is full")
    assert processes and not any(process.is_alive() for process in processes)


def test_a_copy_of_a_process_with_other_threads_is_not_made(monkeypatch):
    monkeypatch.setattr(children.threading, "active_count", lambda: 2)
    assert children.way_to_start() == "spawn"
