"""The asker of a question waits for nothing more once it is answered, whatever came of that."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from selfconf.bus.answering import answering
from selfconf.bus.memory import Network
from selfconf.bus.port import Replies, Request, Sample
from selfconf.errors import PeerError


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
