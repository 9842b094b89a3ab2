"""The shape that an input accepts: what may stand in it, and that its text is its identity."""

from __future__ import annotations

import pytest

from selfconf.model.term import IRI
from selfconf.rdf.advertisements import ShapeNotAccepted, accepted_shape, read_advertisements
from selfconf.rdf.turtle import parse
from selfconf.rdf.vocabulary import SC, SH
from tests.lab import PREFIXES

INPUT = IRI("https://example.org/peis-home#input")


def text_of(shape: str) -> str:
    """The text of a shape as the reader keeps it."""
    document = parse(f"{PREFIXES}:input sc:accepts {shape} .", "test")
    return accepted_shape(document, document.values(INPUT, SC.accepts)[0])


def test_the_order_of_statements_and_the_labels_of_blank_nodes_do_not_matter() -> None:
    one = "[ sh:property [ sh:path sc:unit ; sh:in ( unit:M unit:KiloM ) ] ; sh:class :Good ]"
    other = "_:s . _:s sh:class :Good ; sh:property _:p . _:p sh:in ( unit:M unit:KiloM ) ; sh:path sc:unit"
    assert text_of(one) == text_of(other)


def test_the_order_of_a_list_matters() -> None:
    assert text_of("[ sh:in ( 1 2 ) ]") != text_of("[ sh:in ( 2 1 ) ]")


def test_the_text_is_turtle_and_says_what_was_said() -> None:
    text = text_of('[ sh:property [ sh:path ( sc:rate sc:value ) ; sh:minInclusive 5 ; sh:message "slow"@en ] ]')
    document = parse(f"<urn:s> {text[1:-1]} .", "text")
    (inner,) = document.values(IRI("urn:s"), SH.property)
    assert {predicate for predicate, _ in document.about(inner)} == {SH.path, SH.minInclusive, SH.message}
    assert text_of(text) == text


@pytest.mark.parametrize(
    "said",
    [
        "sh:defaultValue 3",
        'rdfs:comment "c"',
        'rdfs:label "l"@en',
        "rdfs:seeAlso <urn:x>",
        "rdfs:isDefinedBy <urn:x>",
        'sh:name "n"',
        'sh:group [ a sh:PropertyGroup ; rdfs:label "g" ]',
        'sh:description "d" ; sh:message "m" ; sh:order 1',
    ],
)
def test_an_annotation_of_a_shape_keeps_no_component_out(said: str) -> None:
    shape = f"[ sh:property [ sh:path sc:name ; sh:minCount 1 ; {said} ] ]"
    text = PREFIXES + (
        ':a a sc:Component, :A ; rdfs:seeAlso :b ; sc:hasInput [ sc:name "i" ; sc:signalType :S ;'
        f" sc:accepts {shape} ] . :b a sc:Component, :B ."
    )
    good, left_out = read_advertisements(text.encode(), "x")
    assert (len(good), left_out) == (2, [])
    condition = next(one for one in good if one.profile.inputs).profile.inputs[0].condition
    assert condition is not None
    assert condition.accepts == text_of(shape)


@pytest.mark.parametrize(
    ("shape", "problem"),
    [
        ("[ sh:targetNode :a ]", "sh:targetNode is not of SHACL Core"),
        ('[ sh:sparql [ sh:ask "ASK {}" ] ]', "sh:sparql is not of SHACL Core"),
        ("[ :weight 5 ]", "#weight> is not of SHACL Core"),
        ("( [ sh:class :Good ] )", "a list, not a shape"),
        ("[ sh:or ( :secret ) ]", "the value of sh:or stands in brackets"),
        (f"[ sh:property [ sh:path sc:name ; sh:minCount {'9' * 5000} ] ]", "longer than 300 characters"),
        ("[ ]", "say nothing"),
        ("[ sh:property [ ] ]", "say nothing"),
        ("[ sh:node :other ]", "the value of sh:node stands in brackets"),
        ("_:s . _:s sh:not _:s", "stands in brackets, once"),
        (f"[ sh:in ( {' '.join(map(str, range(150)))} ) ]", "more than 200 statements"),
        ("[ sh:not " * 20 + "[ sh:nodeKind sh:IRI ]" + " ]" * 20, "nests too deeply"),
    ],
)
def test_what_has_no_place_in_an_advertisement_is_refused(shape: str, problem: str) -> None:
    with pytest.raises(ShapeNotAccepted, match=problem):
        text_of(shape)


def test_a_shape_may_be_described_elsewhere_by_labels_and_more_than_once() -> None:
    text = PREFIXES + (
        ":a a sc:Component, :A ; sc:hasInput _:i . _:s sh:property _:p . _:p sh:path sc:unit ; sh:minCount 1 .\n"
        '_:s sh:property _:p . _:i sc:accepts _:s ; sc:signalType :S ; sc:name "i" .'
    )
    brackets = PREFIXES + (
        ':a a sc:Component, :A ; sc:hasInput [ sc:name "i" ; sc:signalType :S ;'
        " sc:accepts [ sh:property [ sh:path sc:unit ; sh:minCount 1 ] ] ] ."
    )
    (one,), (other,) = (read_advertisements(each.encode(), "x")[0] for each in (text, brackets))
    assert one.profile.inputs == other.profile.inputs
    assert len(set(one.triples)) == len(set(other.triples))
