"""What is asked for many times is done once, and again for what asks for it afterwards, even while it is being done."""

from __future__ import annotations

from selfconf.bus.coalesced import Coalesced
from selfconf.bus.memory import Network


def test_an_action_is_done_once_for_all_that_ask_for_it_within_a_while() -> None:
    network = Network(1)
    bus, done = network.node(), list[float]()

    def act() -> None:
        done.append(bus.now())
        if len(done) == 1:
            coalesced()  # what is asked for by the action comes after it

    coalesced = Coalesced(bus, 1.0, act)
    began = bus.now()
    coalesced()
    bus.later(0.5, coalesced)
    network.let_pass(0.9)
    assert done == []
    network.let_pass(0.2)
    assert done == [began + 1.0]
    network.let_pass(5.0)
    assert done == [began + 1.0, began + 2.0]
    coalesced(0.2)
    coalesced()
    network.let_pass(0.5)
    assert len(done) == 3
