"""Descriptions as Turtle: what is written says the same when it is read, and can be read by people."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
from rdflib import Graph

from selfconf.importing.imported import Description, ImportedDocument, NestedNode, TermList, grouped
from selfconf.importing.naming import absolute
from selfconf.importing.turtle_text import WIDTH, turtle
from selfconf.model.term import IRI, BlankNode, Literal
from selfconf.rdf.turtle import parse
from selfconf.rdf.vocabulary import RDF, ROB, SC, TYPE, XSD
from tests.harness.effort import examples, thorough

LAMP = IRI("urn:x:lamp")


def written(*descriptions: Description, prefixes: dict[str, str] | None = None) -> str:
    return turtle(ImportedDocument("lamp", "lamp.json", descriptions, prefixes or {}), "wot")


def test_a_file_says_what_it_was_made_from_and_declares_only_what_it_needs() -> None:
    text = written(Description(LAMP, ((TYPE, (SC.Component, ROB.Lamp)),)))
    assert (
        text.splitlines()[0]
        == "# Imported by `selfconf import wot` from lamp.json; importing again replaces this file."
    )
    assert [line.split()[1] for line in text.splitlines() if line.startswith("@prefix")] == ["sc:", "rob:"]


def test_each_of_several_ports_has_a_line() -> None:
    ports = tuple(NestedNode(((SC.name, (Literal(name),)),)) for name in ("a", "b"))
    assert written(Description(LAMP, ((SC.hasInput, ports),))).endswith(
        '<urn:x:lamp> sc:hasInput\n        [ sc:name "a" ] ,\n        [ sc:name "b" ] .\n'
    )


def test_no_line_is_too_long_where_a_node_can_be_broken() -> None:
    nested = NestedNode(tuple((ROB[f"property{number}"], (Literal("x" * 60),)) for number in range(6)))
    deep = NestedNode(((SC.accepts, (nested,)),))
    text = written(Description(LAMP, ((SC.hasInput, (deep,)),)))
    assert max(map(len, text.splitlines())) <= WIDTH
    assert len(Graph().parse(data=text)) == 8


def test_prefixes_of_the_source_are_used_and_bad_ones_are_not() -> None:
    saref = "https://w3id.org/saref#"
    text = written(
        Description(LAMP, ((TYPE, (IRI(saref + "Lamp"), IRI("urn:y:Lamp"), IRI(SC.base + "Role"))),)),
        prefixes={"saref": saref, "bad prefix": "urn:y:", "sc": "urn:z:", "": "urn:q:"},
    )
    assert "saref:Lamp, <urn:y:Lamp>, sc:Role" in text


def test_shared_blank_nodes_have_labels_in_the_order_of_the_text() -> None:
    shape = BlankNode("_:x9f")
    text = written(Description(LAMP, ((SC.accepts, (shape,)),)), Description(shape, ((TYPE, (SC.Role,)),)))
    assert "<urn:x:lamp> sc:accepts _:n1 ." in text
    assert "_:n1 a sc:Role ." in text


def test_a_source_cannot_write_a_line_of_its_own() -> None:
    document = ImportedDocument("x", "a\n<urn:evil> a <urn:x> .", (Description(LAMP, ((TYPE, (ROB.Lamp,)),)),))
    assert len(Graph().parse(data=turtle(document, "wot"))) == 1


iris = st.from_regex(r"urn:[a-zé0-9:/#._~%-]{1,12}", fullmatch=True).filter(absolute).map(IRI) | st.sampled_from(
    [SC.name, ROB["a.b"], ROB["a."], ROB["a/b"], ROB["é"], ROB["-"]]
)
texts = st.text(st.characters(exclude_categories=["Cs"]), max_size=12)
literals = st.builds(Literal, texts) | st.builds(
    lambda words, tag: Literal(words, RDF.langString, tag), texts, st.sampled_from(["en", "de-CH"])
)
numbers = st.integers().map(lambda number: Literal(str(number), XSD.integer))
values = st.recursive(
    iris | literals | numbers,
    lambda inner: (
        st.lists(inner, max_size=3).map(lambda members: TermList(tuple(members)))
        | st.lists(st.tuples(iris, inner), max_size=3).map(lambda pairs: NestedNode(grouped(pairs)))
    ),
    max_leaves=5,
)


@thorough
@settings(max_examples=examples(60), deadline=None)
@given(st.lists(st.tuples(iris, values), min_size=1, max_size=4))
def test_what_is_written_is_read_as_what_was_said(pairs: list[tuple[IRI, object]]) -> None:
    description = Description(LAMP, grouped(pairs))  # type: ignore[arg-type]  # the strategies make values
    document = parse(written(description), "x")
    said = [value for _, found in description.statements for value in found]
    assert len(document.about(LAMP)) == len(said)
    plain = {(p, v) for p, found in description.statements for v in found if isinstance(v, IRI | Literal)}
    assert plain <= set(document.about(LAMP))
