"""What others answer counts on their own keys alone."""

from __future__ import annotations

from selfconf.bus.own_answers import own_answers
from selfconf.bus.port import Sample
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Free


def test_an_answer_counts_on_its_own_key_and_the_others_are_told() -> None:
    lamp, door = Free(IRI("urn:c:lamp"), "l"), Free(IRI("urn:c:door"), "l")
    samples = [Sample("urn:c:door", b"["), Sample("urn:c:lamp", encode(door)), Sample("urn:c:lamp", encode(lamp))]
    found, rejected = own_answers(samples, Free, lambda one: one.component)
    assert found == [lamp]
    broken, another = rejected
    assert another == "left out an answer on urn:c:lamp: it speaks of another"
    assert broken.startswith("left out an answer: ")
