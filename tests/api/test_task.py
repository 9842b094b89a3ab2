"""A template is read and bound; binding changes nothing and gives another task."""

from __future__ import annotations

import pickle
from dataclasses import FrozenInstanceError
from decimal import Decimal
from http import HTTPStatus
from pathlib import Path
from typing import Any

import pytest
import rdflib

import selfconf as sc
from selfconf import template
from selfconf.api.task import completed, pairs
from selfconf.errors import AuthorError, BindingError, ProgrammerError, TemplateError, TurtleError
from selfconf.model.term import IRI, XSD_NAMESPACE, BlankNode, Literal
from selfconf.rdf.vocabulary import XSD
from tests.lab import NAVIGATE as NAVIGATION
from tests.lab import PREFIXES, iri

NAVIGATE = "examples/navigate.ttl"
HOME = "https://w3id.org/selfconf/peis-home#"
ASTRID = f"{HOME}Astrid"
ANY_GOAL = (
    (Path(__file__).resolve().parents[2] / NAVIGATE)
    .read_text()
    .replace("sh:datatype xsd:string", "sh:nodeKind sh:Literal")
)
"""The template of the paper with a goal that may be any literal."""


def test_a_template_is_read_from_a_path_from_text_and_from_a_graph() -> None:
    for source in (NAVIGATE, Path(NAVIGATE), Path(NAVIGATE).read_text(), rdflib.Graph().parse(NAVIGATE)):
        task = sc.template(source)
        assert task.iri == f"{HOME}navigate"
        assert [role.iri.short for role in task.roles] == ["sonar", "encoder", "position", "control", "drive"]
        assert [parameter.name for parameter in task.parameters] == ["goal", "robot"]
        assert task.bind(robot=":Astrid").bindings == {"robot": sc.IRI(f"{HOME}Astrid")}


@pytest.mark.parametrize("name", [":navigate", f"<{HOME}navigate>", sc.IRI(f"{HOME}navigate")])
def test_a_template_is_chosen_by_curie_or_iri(name: str) -> None:
    assert sc.template(NAVIGATE, name).iri == f"{HOME}navigate"


def test_a_template_that_is_not_there_is_named() -> None:
    with pytest.raises(TemplateError, match="no template or task"):
        sc.template(NAVIGATE, ":fly")
    with pytest.raises(BindingError, match="named by a CURIE"):
        sc.template(NAVIGATE, '"navigate"')
    for name in (42, [], b"a"):
        with pytest.raises(ProgrammerError, match=r"^the name of a template is text, not "):
            sc.template(NAVIGATE, name)  # type: ignore[arg-type]  # that is what is tested
    with pytest.raises(AuthorError, match="no file or folder"):
        sc.template("examples/fly.ttl")
    with pytest.raises(AuthorError, match="a path holds no null character"):
        sc.template("\0")
    with pytest.raises(ProgrammerError, match=r"^a source is a path, Turtle text, "):
        sc.template(42)  # type: ignore[arg-type]  # that is what is tested
    with pytest.raises(AuthorError, match="is a folder"):
        sc.template("examples")
    with pytest.raises(TemplateError, match="is it the right file"):
        sc.template("examples/clock/clock.ttl")


def test_what_is_no_template_is_refused_with_line_and_column() -> None:
    broken = Path(NAVIGATE).read_text().replace("( :sonar", '( "sonar"')
    with pytest.raises(TemplateError, match=r"^<text>:\d+:\d+: "):
        sc.template(broken)


@pytest.mark.parametrize(
    ("value", "lexical", "datatype"),
    [
        ("plain words", "plain words", XSD.string),
        ("1.5", "1.5", XSD.decimal),
        (1, "1", XSD.integer),
        (True, "true", XSD.boolean),
        (1.5, "1.5", XSD.double),
        (float("inf"), "INF", XSD.double),
        (float("-inf"), "-INF", XSD.double),
        (float("nan"), "NaN", XSD.double),
        (Decimal("1.50"), "1.50", XSD.decimal),
        (Decimal("1E+3"), "1000", XSD.decimal),
        (Decimal("-1E-9"), "-0.000000001", XSD.decimal),
        (HTTPStatus.OK, "200", XSD.integer),
        (sc.Literal("x"), "x", XSD.string),
        (rdflib.Literal(3), "3", XSD.integer),
    ],
)
def test_a_value_of_python_stands_for_the_literal_of_its_kind(value: Any, lexical: str, datatype: sc.IRI) -> None:
    assert sc.template(ANY_GOAL).bind(goal=value).bindings["goal"] == sc.Literal(lexical, datatype)


def test_a_number_of_numpy_stands_for_the_literal_of_its_kind() -> None:
    np = pytest.importorskip("numpy", reason="numbers of NumPy are bound")
    for value, lexical, datatype in (
        (np.float64(1.5), "1.5", XSD.double),
        (np.float32(0.5), "0.5", XSD.double),
        (np.float64("nan"), "NaN", XSD.double),
        (np.int64(-3), "-3", XSD.integer),
        (np.uint8(200), "200", XSD.integer),
        (np.bool_(True), "true", XSD.boolean),
        (np.array(2), "2", XSD.integer),
        (np.str_("plain"), "plain", XSD.string),
    ):
        assert sc.template(ANY_GOAL).bind(goal=value).bindings["goal"] == sc.Literal(lexical, datatype)
    with pytest.raises(BindingError, match="goal is not"):
        sc.template(ANY_GOAL).bind(goal=np.array([1, 2]))


@pytest.mark.parametrize("value", [":Astrid", f"<{ASTRID}>", sc.IRI(ASTRID), rdflib.URIRef(ASTRID)])
def test_an_iri_is_bound_by_curie_or_as_itself(value: Any, task: sc.TaskSpecification) -> None:
    assert sc.template(NAVIGATE).bind(robot=value).bindings["robot"] == task.bindings["robot"]


@pytest.mark.parametrize("text", ["NaN", "Infinity", "-Infinity"])
def test_a_decimal_that_is_no_number_is_refused_in_a_sentence(text: str) -> None:
    with pytest.raises(BindingError, match=f"^goal cannot be {text}: xsd:decimal has no such number"):
        sc.template(NAVIGATE).bind(goal=Decimal(text))


@pytest.mark.parametrize("value", [None, [":Astrid"], {"a": 1}, b":Astrid", "_:b", rdflib.BNode("b"), "nope:Astrid"])
def test_what_cannot_be_bound_is_refused_in_a_sentence(value: Any) -> None:
    with pytest.raises(BindingError):
        sc.template(NAVIGATE).bind(robot=value)


@pytest.mark.parametrize("parts", [(3,), (None,), ("5", "integer"), ("a", sc.IRI("urn:x"), 7)])
def test_a_literal_whose_parts_are_none_of_a_literal_is_refused_in_a_sentence(parts: Any) -> None:
    with pytest.raises(
        BindingError, match=r"^a Literal has a text, an IRI as its datatype, and a language or None; goal "
    ):
        sc.template(NAVIGATE).bind(goal=sc.Literal(*parts))


def test_a_parameter_may_have_any_name() -> None:
    text = Path(NAVIGATE).read_text("utf-8").replace('sc:name "robot"', 'sc:name "self"')
    assert sc.template(text).bind(self=":Astrid").bindings == {"self": sc.IRI(ASTRID)}


def test_unknown_double_and_missing_bindings_are_refused(task: sc.TaskSpecification, home: sc.Ecology) -> None:
    with pytest.raises(BindingError, match="no parameter 'pilot'"):
        task.bind(pilot=1)
    with pytest.raises(BindingError, match="bound twice"):
        task.bind(robot=":Pippi")
    with pytest.raises(BindingError, match="needs a value"):
        sc.configure(sc.template(NAVIGATE), home)


def test_what_is_no_task_is_refused_in_a_sentence(task: sc.TaskSpecification) -> None:
    assert completed(task).document == task.complete().document
    with pytest.raises(ProgrammerError, match=r"^a task is what selfconf\.template\(\) gives, not str$"):
        completed("examples/navigate.ttl")


def test_a_task_does_not_change(task: sc.TaskSpecification) -> None:
    free = sc.template(NAVIGATE)
    bound = free.bind(robot=":Astrid")
    assert not free.bindings
    assert bound.bind(goal="(AT BEDROOM)").bindings == task.bindings
    assert bound == free.bind(robot=":Astrid")
    bound.bindings.clear()
    assert bound.bindings
    with pytest.raises((FrozenInstanceError, AttributeError)):
        task.document = None  # type: ignore[misc,assignment]  # that is what is tested


def test_tasks_of_one_text_and_with_the_same_values_are_equal(task: sc.TaskSpecification) -> None:
    again = sc.template(NAVIGATE).bind(robot=":Astrid", goal="(AT BEDROOM)")
    assert again == task
    assert {again, task, pickle.loads(pickle.dumps(task))} == {task}
    assert sc.template(NAVIGATE) != task
    text = Path(NAVIGATE).read_text("utf-8")
    assert sc.template(text) == sc.template(text) != sc.template(NAVIGATE)
    assert sc.template(text) != sc.template(text.replace("rob:MotorDrive", "rob:Drive"))
    assert task != "navigate"


def test_a_task_prints_its_roles_and_parameters(task: sc.TaskSpecification) -> None:
    assert repr(task).startswith("<task :navigate>\n")
    assert "parameter  robot      :Astrid" in repr(task)
    assert "<td style='text-align:left'>&quot;(AT BEDROOM)&quot;</td>" in task._repr_html_()


def test_pairs_are_taken_apart_as_on_a_command_line() -> None:
    assert pairs(["a=1", "b=x=y"]) == {"a": "1", "b": "x=y"}
    for wrong in (["a"], ["=1"], ["a=1", "a=2"]):
        with pytest.raises(BindingError):
            pairs(wrong)


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
    task = template(NAVIGATION)
    assert task.iri == iri("navigate")
    assert [role.iri.short for role in task.roles] == ["sonar", "encoder", "position", "control", "drive"]
    assert [parameter.name for parameter in task.parameters] == ["goal", "robot"]
    assert task.bindings == {}
    assert ":sonar" in repr(task)
    assert "(free)" in repr(task)
    assert "<table>" in task._repr_html_()


def test_a_parameter_that_has_a_default_is_not_shown_as_free() -> None:
    task = template(NAVIGATION + ":robot sh:defaultValue :Astrid .")
    assert any(row.split() == ["parameter", "robot", ":Astrid", "(default)"] for row in repr(task).splitlines())
    assert ":Astrid  (default)" in task._repr_html_()
    assert "(default)" not in repr(task.bind(robot=":Pippi"))


def test_one_template_of_several_is_named() -> None:
    two = NAVIGATION + f":t a sc:Template ; sc:roles ( :r ) . {ROLE}"
    assert template(two, ":t").iri == iri("t")
    assert template(two, f"<{iri('navigate')}>").iri == iri("navigate")
    with pytest.raises(AuthorError, match="say which with name: "):
        template(two)
    with pytest.raises(BindingError, match="a CURIE or an <IRI>"):
        template(two, "plain words")
    with pytest.raises(AuthorError, match="nowhere"):
        template(two, ":nowhere")


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
    free = template(NAVIGATION)
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
        template(NAVIGATION).bind(**{"robot": ":Astrid", "goal": "x", **values}).complete()


def test_a_task_is_complete_once_its_parameters_have_values_or_may_be_free() -> None:
    with pytest.raises(BindingError, match="the parameter 'goal' needs a value"):
        template(NAVIGATION).bind(robot=":Astrid").complete()
    assert set(template(NAVIGATION).bind(goal="x").complete().bindings) == {"goal"}
    default = FREE.replace("sc:name 'p'", "sc:name 'p' ; sh:defaultValue 7")
    assert template(default).complete().bindings == {"p": xsd("7", "integer")}


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
