"""The hierarchy of classes and properties."""

from __future__ import annotations

from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.profile import Operation
from selfconf.model.term import IRI


def test_offered_matches_wanted_if_wanted_is_offered_itself_or_above_it() -> None:
    above = Hierarchy([(IRI("urn:a"), IRI("urn:b"))])
    assert above.matches(IRI("urn:a"), IRI("urn:b"))
    assert not above.matches(IRI("urn:b"), IRI("urn:a"))
    assert not NOTHING_ABOVE.matches(IRI("urn:a"), IRI("urn:b"))
    assert NOTHING_ABOVE.matches(IRI("urn:a"), IRI("urn:a"))


def test_what_lies_above_is_followed_to_its_end_and_a_circle_is_an_equivalence() -> None:
    a, b, c, d = (IRI(f"urn:{name}") for name in "abcd")
    above = Hierarchy([(a, b), (b, c), (c, b), (c, d)], [(a, c)])
    assert above.superclasses(a) == {a, b, c, d}
    assert above.superclasses(b) == above.superclasses(c) == {b, c, d}
    assert above.superclasses(d) == {d}
    assert above.superproperties(a) == {a, c}
    assert above.superproperties(b) == {b}


def test_what_is_of_some_types_is_of_every_class_above_each_of_them() -> None:
    a, b, c, d = (IRI(f"urn:{name}") for name in "abcd")
    above = Hierarchy([(a, b), (b, c)])
    for types in (frozenset[IRI](), frozenset((d,)), frozenset((a, d)), frozenset((c, d)), frozenset((a, b))):
        assert above.classes_of(types) == frozenset[IRI]().union(*map(above.superclasses, types))
        assert NOTHING_ABOVE.classes_of(types) == types


def test_an_operation_serves_where_what_it_answers_is_wanted() -> None:
    low, high = IRI("urn:low"), IRI("urn:high")
    above = Hierarchy([(low, high)])
    assert above.superclasses(Operation.of(low)) == {Operation.of(low), Operation.of(high)}
    assert above.matches(Operation.of(low), Operation.of(high))
    assert not above.matches(Operation.of(high), Operation.of(low))
    assert not above.matches(Operation.of(low), high)
    assert not above.matches(low, Operation.of(high))
    assert not NOTHING_ABOVE.matches(Operation.of(low), Operation.of(high))
    assert above.superclasses(Operation.of(None)) == {Operation.of(None)}


def test_a_hierarchy_of_properties_alone_is_flat() -> None:
    assert Hierarchy(properties=[(IRI("urn:a"), IRI("urn:b"))]).flat
    assert NOTHING_ABOVE.flat
    assert not Hierarchy([(IRI("urn:a"), IRI("urn:b"))]).flat


def test_a_chain_is_no_deeper_than_the_stack() -> None:
    chain = [(IRI(f"urn:{number}"), IRI(f"urn:{number + 1}")) for number in range(20_000)]
    assert len(Hierarchy(chain).superclasses(IRI("urn:0"))) == 20_001
