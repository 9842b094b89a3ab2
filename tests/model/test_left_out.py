"""What was left out of an ecology says of itself where it stood and why."""

from __future__ import annotations

from selfconf.model.left_out import LeftOut
from selfconf.model.profile import Place
from selfconf.model.term import IRI, BlankNode


def test_what_was_left_out_says_where_it_stood_and_why() -> None:
    assert (
        str(LeftOut(Place("a.ttl", 4), IRI("urn:lamp"), "it has no type"))
        == "a.ttl:4: left out urn:lamp: it has no type"
    )
    assert str(LeftOut(Place("a.ttl"), BlankNode("_:b"), "it has no IRI")) == "a.ttl: left out _:b: it has no IRI"
