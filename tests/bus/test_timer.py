"""What is asked for many times is done once, and again for what asks for it afterwards, even while it is being done."""

from __future__ import annotations

from selfconf.bus.memory import Network
from selfconf.bus.timer import Timer


def test_an_action_is_done_once_for_all_that_ask_for_it_within_a_while() -> None:
    network = Network(1)
    bus, done = network.node(), list[float]()

    def act() -> None:
        done.append(bus.now())
        assert not timer.is_set
        if len(done) == 1:
            timer.set()  # what is asked for by the action comes after it

    timer = Timer(bus, 1.0, act)
    began = bus.now()
    timer.set()
    assert timer.is_set
    bus.later(0.5, timer.set)
    network.let_pass(0.9)
    assert done == []
    network.let_pass(0.2)
    assert done == [began + 1.0]
    network.let_pass(5.0)
    assert done == [began + 1.0, began + 2.0]
    timer.set(0.2)
    timer.set()
    network.let_pass(0.5)
    assert len(done) == 3


def test_an_action_that_is_put_off_is_done_once_at_the_time_that_was_set_last() -> None:
    network = Network(1)
    bus, done = network.node(), list[float]()
    timer = Timer(bus, 1.0, lambda: done.append(bus.now()))
    began = bus.now()
    timer.reset()
    network.let_pass(0.5)
    timer.reset(2.0)
    network.let_pass(5.0)
    assert done == [began + 2.5]


def test_an_action_that_is_taken_back_is_not_done_before_it_is_asked_for_anew() -> None:
    network = Network(1)
    bus, done = network.node(), list[float]()
    timer = Timer(bus, 1.0, lambda: done.append(bus.now()))
    timer.stop()
    timer.set()
    timer.stop()
    assert not timer.is_set
    network.let_pass(5.0)
    assert done == []
    timer.set()
    network.let_pass(1.0)
    assert len(done) == 1
