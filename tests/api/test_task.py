"""A template is read and bound; binding changes nothing and gives another task."""

from __future__ import annotations

from dataclasses import FrozenInstanceError
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest
import rdflib

import selfconf as sc
from selfconf.api.task import pairs
from selfconf.errors import AuthorError, BindingError, TemplateError
from selfconf.rdf.vocabulary import XSD

NAVIGATE = "examples/navigate.ttl"
HOME = "https://w3id.org/selfconf/peis-home#"
ASTRID = f"{HOME}Astrid"


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
    with pytest.raises(AuthorError, match="no file or folder"):
        sc.template("examples/fly.ttl")
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
        (sc.Literal("x"), "x", XSD.string),
        (rdflib.Literal(3), "3", XSD.integer),
    ],
)
def test_a_value_of_python_stands_for_the_literal_of_its_kind(value: Any, lexical: str, datatype: sc.IRI) -> None:
    text = Path(NAVIGATE).read_text().replace("sh:datatype xsd:string", "sh:nodeKind sh:Literal")
    assert sc.template(text).bind(goal=value).bindings["goal"] == sc.Literal(lexical, datatype)


@pytest.mark.parametrize("value", [":Astrid", f"<{ASTRID}>", sc.IRI(ASTRID), rdflib.URIRef(ASTRID)])
def test_an_iri_is_bound_by_curie_or_as_itself(value: Any, task: sc.TaskSpecification) -> None:
    assert sc.template(NAVIGATE).bind(robot=value).bindings["robot"] == task.bindings["robot"]


@pytest.mark.parametrize("value", [None, [":Astrid"], {"a": 1}, b":Astrid", "_:b", rdflib.BNode(), "nope:Astrid"])
def test_what_cannot_be_bound_is_refused_in_a_sentence(value: Any) -> None:
    with pytest.raises(BindingError):
        sc.template(NAVIGATE).bind(robot=value)


def test_unknown_double_and_missing_bindings_are_refused(task: sc.TaskSpecification, home: sc.Ecology) -> None:
    with pytest.raises(BindingError, match="no parameter 'pilot'"):
        task.bind(pilot=1)
    with pytest.raises(BindingError, match="bound twice"):
        task.bind(robot=":Pippi")
    with pytest.raises(BindingError, match="needs a value"):
        sc.configure(sc.template(NAVIGATE), home)


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


def test_a_task_prints_its_roles_and_parameters(task: sc.TaskSpecification) -> None:
    assert repr(task).startswith("<task :navigate>\n")
    assert "parameter  robot      :Astrid" in repr(task)
    assert "<td style='text-align:left'>&quot;(AT BEDROOM)&quot;</td>" in task._repr_html_()


def test_pairs_are_taken_apart_as_on_a_command_line() -> None:
    assert pairs(["a=1", "b=x=y"]) == {"a": "1", "b": "x=y"}
    for wrong in (["a"], ["=1"], ["a=1", "a=2"]):
        with pytest.raises(BindingError):
            pairs(wrong)
