"""The asker of a question waits for nothing more once it is answered, and what others answer counts on its own key."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from selfconf.bus.answers import answering, own_answers
from selfconf.bus.memory import Network
from selfconf.bus.port import Replies, Request, Sample
from selfconf.errors import PeerError
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Free


def asked(answer: Callable[[Request], None]) -> Replies:
    """What a question comes to that is answered so."""
    network, found = Network(), list[Replies]()
    served, asker = network.node(), network.node()
    served.serve("lamp", answer)
    asker.ask("lamp", b"", 1.0, found.append)
    network.run(lambda: bool(found), 2.0)
    (replies,) = found
    return replies


def test_what_was_replied_before_a_refusal_counts_and_the_answer_is_over() -> None:
    def answer(request: Request) -> None:
        with answering(request):
            request.reply("lamp", b"on")
            raise PeerError("it is broken")

    assert asked(answer) == Replies((Sample("lamp", b"on"),), ("it is broken",))


def test_an_answer_that_breaks_is_over_as_well() -> None:
    def answer(request: Request) -> None:
        with pytest.raises(ZeroDivisionError), answering(request):
            request.reply("lamp", str(1 // 0).encode())

    assert asked(answer) == Replies()


def test_an_answer_counts_on_its_own_key_and_the_others_are_told() -> None:
    lamp, door = Free(IRI("urn:c:lamp"), "l"), Free(IRI("urn:c:door"), "l")
    samples = [Sample("urn:c:door", b"["), Sample("urn:c:lamp", encode(door)), Sample("urn:c:lamp", encode(lamp))]
    found, rejected = own_answers(samples, Free, lambda one: one.component)
    assert found == [lamp]
    broken, another = rejected
    assert another == "left out an answer on urn:c:lamp: it speaks of another"
    assert broken.startswith("left out an answer: ")
