"""`template`: what a task asks for, what can be bound, and where a mistake is."""

from __future__ import annotations

from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest
import rdflib

from selfconf import template
from selfconf.api.task import pairs
from selfconf.errors import AuthorError, BindingError, TemplateError, TurtleError
from selfconf.model.term import IRI, XSD_NAMESPACE, BlankNode, Literal
from tests.lab import NAVIGATE, PREFIXES, iri

LINE = PREFIXES.count("\n")
ROLE = ":r a sc:Role ; sh:class rob:Encoder ."
FREE = (
    PREFIXES + ":t a sc:Template ; sc:parameter :p ; sc:roles ( :r ) . :p a sc:Parameter ; sc:name 'p' .\n"
    ":r a sc:Role ; sh:class :C ; sc:sets [ sc:parameterType :P ; sc:value :p ] ."
)


def xsd(lexical: str, datatype: str) -> Literal:
    """A literal of one of XML Schema's datatypes."""
    return Literal(lexical, IRI(XSD_NAMESPACE + datatype))


def test_a_template_has_its_name_roles_and_parameters() -> None:
    task = template(NAVIGATE)
    assert task.iri == iri("navigate")
    assert [role.iri.short for role in task.roles] == ["sonar", "encoder", "position", "control", "drive"]
    assert [parameter.name for parameter in task.parameters] == ["goal", "robot"]
    assert task.bindings == {}
    assert ":sonar" in repr(task)
    assert "(free)" in repr(task)
    assert "<table>" in task._repr_html_()


def test_a_template_comes_from_a_file_from_text_or_from_a_graph(tmp_path: Path) -> None:
    (tmp_path / "navigate.ttl").write_text(NAVIGATE)
    graph = rdflib.Graph().parse(data=NAVIGATE, format="turtle")
    names = {template(source).iri for source in (tmp_path / "navigate.ttl", str(tmp_path / "navigate.ttl"), NAVIGATE)}
    assert names | {template(graph).iri} == {iri("navigate")}


def test_one_template_of_several_is_named() -> None:
    two = NAVIGATE + f":t a sc:Template ; sc:roles ( :r ) . {ROLE}"
    assert template(two, ":t").iri == iri("t")
    assert template(two, f"<{iri('navigate')}>").iri == iri("navigate")
    with pytest.raises(AuthorError, match="--template"):
        template(two)
    with pytest.raises(BindingError, match="a CURIE or an <IRI>"):
        template(two, "plain words")
    with pytest.raises(AuthorError, match="nowhere"):
        template(two, ":nowhere")


# Values.


@pytest.mark.parametrize(
    ("value", "term"),
    [
        (":kitchen", iri("kitchen")),
        ("<urn:x>", IRI("urn:x")),
        ("5", xsd("5", "integer")),
        ("plain words", Literal("plain words")),
        ('"5"^^xsd:byte', xsd("5", "byte")),
        (5, xsd("5", "integer")),
        (True, xsd("true", "boolean")),
        (1.5, xsd("1.5", "double")),
        (Decimal("1.50"), xsd("1.50", "decimal")),
        (IRI("urn:x"), IRI("urn:x")),
        (Literal("x"), Literal("x")),
        (rdflib.URIRef("urn:x"), IRI("urn:x")),
        (rdflib.Literal(5), xsd("5", "integer")),
    ],
)
def test_a_parameter_is_bound_to_a_term_a_number_or_words(value: Any, term: object) -> None:
    assert template(FREE).bind(p=value).bindings == {"p": term}


def test_to_bind_changes_nothing_but_gives_another_task() -> None:
    free = template(NAVIGATE)
    bound = free.bind(robot=":Astrid").bind(goal="(AT BEDROOM)")
    assert (free.bindings, len(bound.bindings)) == ({}, 2)
    assert bound.complete().bindings == bound.bindings
    assert ":Astrid" in repr(bound)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"colour": "red"}, "no parameter 'colour'"),
        ({"robot": "Astrid"}, "cannot stand for the parameter 'robot'"),
        ({"robot": "x:Astrid"}, "prefix x:"),
        ({"robot": "<Astrid"}, "no Turtle term"),
        ({"goal": 3}, "cannot stand for the parameter 'goal'"),
        ({"robot": "_:b"}, "blank node"),
        ({"robot": BlankNode("_:b")}, "blank node"),
    ],
)
def test_what_cannot_be_bound_is_said(values: dict[str, Any], words: str) -> None:
    with pytest.raises(BindingError, match=words):
        template(NAVIGATE).bind(**{"robot": ":Astrid", "goal": "x", **values}).complete()


def test_a_parameter_is_bound_once() -> None:
    with pytest.raises(BindingError, match="bound twice"):
        template(NAVIGATE).bind(robot=":Astrid").bind(robot=":Pippi")


def test_a_task_is_complete_once_its_parameters_have_values_or_may_be_free() -> None:
    with pytest.raises(BindingError, match="the parameter 'goal' needs a value"):
        template(NAVIGATE).bind(robot=":Astrid").complete()
    assert set(template(NAVIGATE).bind(goal="x").complete().bindings) == {"goal"}
    default = FREE.replace("sc:name 'p'", "sc:name 'p' ; sh:defaultValue 7")
    assert template(default).complete().bindings == {"p": xsd("7", "integer")}


def test_pairs_are_taken_apart_at_the_first_equals_sign() -> None:
    assert pairs(["robot=:Astrid", "goal=a=b", "x="]) == {"robot": ":Astrid", "goal": "a=b", "x": ""}
    for wrong, words in ((["robot"], "NAME=TERM"), (["=x"], "NAME=TERM"), (["a=1", " a =2"], "bound twice")):
        with pytest.raises(BindingError, match=words):
            pairs(wrong)


# Mistakes.


@pytest.mark.parametrize(
    ("text", "line", "fault", "words"),
    [
        (":t a sc:Template ; sc:roles ( ) .", 1, "( )", "empty"),
        (":t a sc:Template ;\n   sc:roles ( :r ) .", 2, ":r )", "not described as a sc:Role"),
        (f":t a sc:Template ; sc:roles ( :r ) .\n{ROLE}\n:r sc:feeds :nobody .", 3, ":nobody", "which is no role"),
        (f':t a sc:Template ; sc:roles ( :r ) .\n{ROLE}\n:r sc:minCount "two" .', 3, '"two"', "whole number"),
        (
            f":t a sc:Template ; sc:roles ( :r ) .\n{ROLE}\n:i a sc:Interaction ; sc:from :r ; sc:to :x .",
            3,
            ":x .",
            "no role",
        ),
    ],
)
def test_a_mistake_has_the_line_and_the_column_of_the_statement_at_fault(
    text: str, line: int, fault: str, words: str, tmp_path: Path
) -> None:
    path = tmp_path / "t.ttl"
    path.write_text(PREFIXES + text)
    with pytest.raises(TemplateError, match=words) as wrong:
        template(path)
    column = text.splitlines()[line - 1].index(fault) + 1
    assert (wrong.value.file, wrong.value.line, wrong.value.column) == (str(path), LINE + line, column)
    assert str(wrong.value).startswith(f"{path}:{LINE + line}:{column}: ")


def test_a_mistake_in_a_text_or_a_graph_has_a_name_too() -> None:
    text = PREFIXES + ":t a sc:Template ; sc:roles ( ) ."
    with pytest.raises(TemplateError, match="<text>:8:") as wrong:
        template(text)
    assert wrong.value.line == LINE + 1
    with pytest.raises(TemplateError, match="<graph>"):
        template(rdflib.Graph().parse(data=text, format="turtle"))


def test_what_is_no_turtle_or_no_template_is_said(tmp_path: Path) -> None:
    with pytest.raises(TurtleError, match="<text>:8:"):
        template(PREFIXES + "this is no turtle")
    with pytest.raises(AuthorError, match=r"no sc:Template"):
        template(PREFIXES)
    with pytest.raises(AuthorError, match="no file or folder"):
        template(tmp_path / "nowhere.ttl")
    with pytest.raises(AuthorError, match="is a folder"):
        template(tmp_path)
