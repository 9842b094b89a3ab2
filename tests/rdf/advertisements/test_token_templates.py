"""Filling in what is known of a form makes of a document what the careful reader makes of it."""

from __future__ import annotations

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from selfconf.errors import TurtleError
from selfconf.rdf.advertisements import loader
from selfconf.rdf.advertisements import reader as advertisements
from selfconf.rdf.advertisements.loader import LoadedAdvertisement
from selfconf.rdf.advertisements.segments import SegmentCache, inlined_document
from selfconf.rdf.advertisements.token_templates import OCCURRENCES, TokenTemplates, patterns_of
from selfconf.rdf.turtle import document as turtle
from tests.lab import PREFIXES
from tests.rdf.advertisements.test_loader import GOOD, told

MANY = OCCURRENCES + 3
STRINGS = st.sampled_from(
    (
        "a",
        "b",
        "",
        "7",
        "a ; b .",
        "# <x:y> [",
        "it's",
        "%s %b",
        "_:x",
        "é",
        "\t",
        "x()",
        "\u202ex",
        "s7310001",
        "<https://w3id.org/selfconf#name> ",
    )
)
DIGITS = st.sampled_from(("0", "1", "07", "10", "731", "7310000", "12345678901234567890"))
SAID = st.sampled_from(
    (
        'rdfs:label "{s}"', 'rdfs:label "{s}"@en', 'rdfs:label "{s}"@de-1996', ":serial {d}", ":lat -{d}.{d}",
        ":size {d}e{d}", ":at :room{d}", ":at :r{d}.x-{d}", ":at <urn:r:{d}>", ":at <http://a/{d}>, :near{d}",
        ":at <http://a:{d}/b%2{d}>", ':p "{s}"^^xsd:integer', ':p "{d}"^^:unit{d}', ":p{d} true", "rdfs:domain :d{d}",
        ':p """{s}"""', ":p '{d}'", ':p "\\\\{s}"', ':p "{s}" , "{s}"', ":p ( {d} :x{d} ) , [] , [ :q [ :r {d} ] ]",
        ':cal [ :x {d} ; :y "{s}" ; :z [ :date "{s}"^^xsd:date ] ]', "a :Kind{d}", "a owl:Kind{d}", "# {d}\n :p {d}",
        'sc:hasInput [ sc:name "{s}" ; sc:signalType :S{d} ]', "sc:preference {d}", "sc:preference {d}.{d}",
        'sc:hasInput [ sc:name "{s}" ; sc:signalType :S ] , [ sc:signalType :T{d} ; sc:name "/{d}/{s}" ]',
        'sc:hasOutput [ a :O ; sc:name "o{d}" ; sc:signalType :S ; sc:rate [ sc:value {d}.{d} ; sc:unit unit:HZ ] ]',
        'sc:hasInput [ sc:name "in{d}" ; sc:signalType :S ; sc:depth {d} ]', "sc:restarts {d}",
        "sc:deadline [ sc:value {d}.{d} ; sc:unit unit:SEC ]", "sc:tolerates :lasting{d}", "sc:shareable true",
        'sc:hasOutput [ sc:name "{s}" ; sc:name "o" ; sc:signalType :S ]', 'sc:hasOutput [ sc:name "o{d}"@en ]',
        'sc:hasOutput [ sc:name "n{d}" ; sc:signalType :S ; rdfs:label "{s}" ; rdfs:seeAlso sc:Component ]',
        'sc:hasParameter [ sc:name "m{d}" ; sc:parameterType :M{d} ]', 'sc:grounding [ sc:command "{s}" ]',
        "sc:hasInput :port{d}", "sc:hasOutput :port{d} , :port", "sc:grounding :ground{d}", 'sc:name "{s}"',
        '<https://w3id.org/selfconf#hasInput> [ <https://w3id.org/selfconf#name> "{s}" ; sc:signalType <urn:S{d}> ]',
        '<http://www.w3.org/1999/02/22-rdf-syntax-ns#type> <http://a/{d}/K{d}#L{d}> , :K{d}, <http://a{d}.b>',
        ':p {d},"a/{s}>" , 5,:x{d},<http://a/{d}>',
        '# say {d}\n :p "{s}"',
        '# so\n :p """{s}""""', ':p """{s}\n"{d}" \\"""', ':p "{s}\\"{s}" , "\\u00e{d}"',
        'sc:hasOutput [ rdfs:label "a\\"" ; sc:name "n{d}" ; sc:signalType :S ]',
        ':p "\\q{d}"', ':p "{s}" # "{d}\n , "{s}"',
        'sc:hasOutput [ sc:name """n{d}""" ; sc:signalType :S ]',
        'sc:hasOutput [ sc:name "a\\n{d}" ; sc:signalType :S ]',
        "sc:hasInput _:port{d}", ":near _:n , _:n{d}", "rdfs:seeAlso :c{d}", "sc:hasParameter ( {d} )",
    )
)  # fmt: skip
THINGS = st.sampled_from(
    (
        ':port{d} sc:name "in" ; sc:signalType :S .', ':port{d} a sc:Input ; sc:name "{s}" ; sc:signalType :S{d} .',
        '_:port{d} sc:name "in" ; sc:signalType :S .', "_:n :near _:n{d} .",
        ":room{d} rdfs:label 'room' ; :in [ :x {d} ] .",
        ':port sc:name "x" ; sc:signalType :S ; sc:rate :rate{d} .', ":rate{d} sc:value {d} ; sc:unit unit:HZ .",
        ":lasting{d} sc:value {d} ; sc:unit unit:SEC .",
        ':ground{d} sc:command "{s}" .', ":room{d} rdfs:seeAlso sc:Component, :port{d} .", "_:c{d} a sc:Component .",
        ':port{d} :p "{s}" .', ":kitchen :polygon ( {d} {d} ) .", '<c{d}> rdfs:label "{s}" .', "<#c{d}> a :Thing .",
    )
)  # fmt: skip


@st.composite
def documents(draw: st.DrawFn) -> str:
    """Some components that say much the same, with other strings and digits, and things that they may speak of."""
    said = [GOOD, *draw(st.lists(SAID, min_size=1, max_size=3))]
    things = draw(st.lists(THINGS, max_size=2))
    lines = []
    for number in range(MANY):
        lines.append(f":c{number} " + " ; ".join(said) + " .")
        lines += things
    filled = ""
    for part in "\n".join(draw(st.permutations(lines))).split("{")[:]:
        kind, closing, rest = part.partition("}")
        if closing and kind in ("s", "d"):
            filled += draw(STRINGS if kind == "s" else DIGITS) + rest
        else:
            filled += part
    return f"@prefix owl: <http://www.w3.org/2002/07/owl#> .\n{PREFIXES}\n{filled}"


def each(said: str) -> str:
    """Components that say something with a number of their own."""
    return PREFIXES + "\n".join(f":c{k} {GOOD} ; {said.replace('{d}', str(k))} ." for k in range(MANY))


@given(documents())
@example(each("sc:hasInput :in . :in{d} sc:name 'in' ; sc:signalType :S . :in a :Port"))
@example(each("sc:hasInput :in{d} . :in{d} sc:name 'in' ; sc:signalType :S ; rdfs:seeAlso sc:Component"))
@example(each('sc:hasOutput [ sc:name "o" ; sc:signalType :S ; sc:rate [ sc:value {d} ; sc:unit unit:HZ ] ]'))
@example(each('sc:hasInput [ sc:name "{d}" ; sc:signalType :S ] ; sc:hasInput [ sc:name "{d}" ; sc:signalType :T ]'))
@example(each("sc:hasInput _:in{d} . _:in{d} sc:name 'in' ; sc:signalType _:s"))
@example(each('sc:hasInput [ sc:name "i" ; sc:signalType :S ; sc:depth {d} ]'))
@example(each("sc:restarts {d} ; sc:deadline [ sc:value {d} ; sc:unit unit:SEC ]"))
@example(each("sc:tolerates :lasting{d} . :lasting{d} sc:value {d} ; sc:unit unit:SEC"))
@example(each('sc:hasInput [ sc:name "i{d}()" ; sc:signalType :S ]'))
@example(each('sc:hasParameter [ sc:name "\u202e{d}" ; sc:parameterType :S ]'))
@example(each(f'sc:hasOutput [ sc:name "{"o" * 1_000}{{d}}" ; sc:signalType :S ]'))
def test_what_is_filled_in_says_what_the_careful_reader_reads(text: str) -> None:
    try:
        careful = told(advertisements.read_document(turtle.parse(text, "a.ttl", "file:///a.ttl")))
    except TurtleError:
        with pytest.raises(TurtleError):
            loader.read_advertisements(text.encode(), "a.ttl", "file:///a.ttl")
        return
    known = SegmentCache()
    for _ in range(2):  # what was learnt the first time is used the second
        found = loader.read_advertisements(text.encode(), "a.ttl", "file:///a.ttl", known)
        assert told(found) == careful
        for clause in (c for one in found[0] if isinstance(one, LoadedAdvertisement) for c in one.statements):
            assert clause.predicate == clause.text.partition(" ")[0]
            assert clause.bracketed == (clause.text[-1] in ")]")


@pytest.mark.parametrize(
    "said",
    [
        'rdfs:label "number {d}"@en', ":lat {d}.5", ":at :room{d} , <http://example.org/{d}>", ":polygon ( {d} {d}.0 )",
        'sc:grounding [ sc:command "drive {d}" ]', 'sc:hasInput [ sc:name "/robot{d}/odom" ; sc:signalType :S{d} ]',
    ],
)  # fmt: skip
def test_segments_that_differ_in_strings_and_digits_are_read_once(said: str) -> None:
    known = SegmentCache()
    inlined_document(each(said).encode(), "a.ttl", None, known)
    assert known.new <= GOOD.count(";") + 1


@pytest.mark.parametrize(
    "piece", [b" :p 'a1' ;", b' :p "a\\q" ;', b" p1:p 1 ;", b" :p <a%201> ;", b' :p "x"@en-1 ;', b" :p <http://a:1/> ;"]
)
def test_patterns_in_which_digits_do_not_mean_themselves_have_no_template(piece: bytes) -> None:
    assert not TokenTemplates().wanted(patterns_of([piece] * OCCURRENCES))


@pytest.mark.parametrize(
    "odd",
    [":room :polygon ( 1 2 3 ) .", ":room :near _:x .", ':room rdfs:comment "node_:x" .', ":c1 :near [] , [] .",
     "_:room a _:Kind ; :near _:room .", ":room :shape ( ( 1 2 ) [ :x ( ) ] ) ."],
)  # fmt: skip
def test_one_odd_statement_leaves_the_rest_to_the_segments(odd: str, monkeypatch: pytest.MonkeyPatch) -> None:
    text = f"{each(':serial {d}')}\n{odd}"
    careful = told(advertisements.read_document(turtle.parse(text, "a.ttl")))
    monkeypatch.setattr(advertisements, "read_document", None)
    assert told(loader.read_advertisements(text.encode(), "a.ttl")) == careful
