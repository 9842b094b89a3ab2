"""An answer is a value: true or false, read by role, immutable, and prints well."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Mapping
from dataclasses import FrozenInstanceError, replace
from pathlib import Path
from xml.etree import ElementTree

import pytest
import rdflib

import selfconf as sc
from selfconf.api.answer import Answer
from selfconf.model.configuration import Configuration
from selfconf.rdf.turtle import parse
from selfconf.rdf.vocabulary import SC
from tests.api.navigation import answered
from tests.lab import iri

TRACKER = sc.IRI("https://w3id.org/selfconf/peis-home#person-tracker")


@pytest.fixture
def answer(task: sc.TaskSpecification, home: sc.Ecology) -> Answer:
    """The configuration of the paper."""
    found = sc.configure(task, home)
    assert isinstance(found, Answer)
    return found


@pytest.fixture
def refusal(clock: sc.TaskSpecification) -> sc.Refusal:
    """A refusal with a near miss."""
    found = sc.configure(clock.bind(room=":cellar"), sc.read("examples/clock"))
    assert isinstance(found, sc.Refusal)
    return found


def test_a_configuration_is_true_and_neither_a_refusal_nor_what_is_undecided_is(
    answer: Answer, refusal: sc.Refusal
) -> None:
    undecided = sc.configure(sc.template("examples/watch.ttl"), sc.read("examples/watch"), steps=1)
    assert isinstance(undecided, sc.Undecided)
    assert (bool(answer), bool(refusal), bool(undecided)) == (True, False, False)
    assert isinstance(answer, sc.Configuration)


@pytest.mark.parametrize("role", ["position", ":position", "https://w3id.org/selfconf/peis-home#position"])
def test_the_components_of_a_role_are_found_by_local_name_curie_and_iri(role: str, answer: Answer) -> None:
    assert answer[role] == (TRACKER,)
    assert role in answer


def test_the_roles_are_listed_and_an_unknown_one_is_answered_with_them(answer: Answer) -> None:
    assert list(answer) == ["sonar", "encoder", "position", "control", "drive"]
    assert [role.short for role in answer.roles] == list(answer)
    assert "pilot" not in answer
    with pytest.raises(KeyError, match="the roles are sonar, encoder"):
        answer["pilot"]


def test_an_answer_is_a_mapping_of_its_roles_and_true_without_any(answer: Answer) -> None:
    assert isinstance(answer, Mapping)
    assert len(answer) == len(answer.roles) == 5
    assert list(answer.keys()) == list(answer)
    assert dict(answer) == dict(answer.items()) == {role: answer[role] for role in answer}
    assert list(answer.values()) == [assignment.components for assignment in answer.assignments]
    assert (answer.get("position"), answer.get("pilot")) == ((TRACKER,), None)
    empty = replace(answer, assignments=())
    assert (len(empty), bool(empty)) == (0, True)


def test_an_answer_can_be_compared_hashed_copied_and_pickled(
    answer: Answer, refusal: sc.Refusal, task: sc.TaskSpecification, home: sc.Ecology
) -> None:
    assert answer == sc.configure(task, home)
    assert len({answer, sc.configure(task, home)}) == 1
    for value in (answer, refusal):
        for twin in (copy.copy(value), copy.deepcopy(value), pickle.loads(pickle.dumps(value))):
            assert twin == value
            assert repr(twin) == repr(value)


def test_an_answer_does_not_change(answer: Answer, refusal: sc.Refusal) -> None:
    with pytest.raises(FrozenInstanceError):
        answer.assignments = ()  # type: ignore[misc]  # refused when it runs, too
    with pytest.raises(TypeError):
        answer.bindings["robot"] = TRACKER  # type: ignore[index]  # refused when it runs, too
    with pytest.raises(FrozenInstanceError):
        refusal.reasons = ()  # type: ignore[misc]  # refused when it runs, too
    with pytest.raises(FrozenInstanceError):
        refusal.reasons[0].place = None  # type: ignore[misc]  # refused when it runs, too


def test_the_turtle_of_an_answer_is_a_configuration_that_validates(answer: Answer, tmp_path: Path) -> None:
    graph = rdflib.Graph().parse(data=answer.to_turtle(), format="turtle")
    sc_ = rdflib.Namespace("https://w3id.org/selfconf#")
    assert len(set(graph.subjects(rdflib.RDF.type, sc_.Connection))) == len(answer.connections)
    (tmp_path / "answer.ttl").write_text(answer.to_turtle())
    report = sc.validate([tmp_path, "examples/navigate.ttl", "examples/peis-home"])
    assert report.conforms, report


def test_reasons_near_misses_and_repairs_have_sentences_and_places(refusal: sc.Refusal) -> None:
    (reason,), (miss,) = refusal.reasons, refusal.near_misses
    assert (reason.code, str(reason.place)) == ("too-few-eligible", "examples/clock/tell-the-time.ttl:15")
    assert (str(miss), str(miss.place)) == ("its place is kitchen, not cellar", "examples/clock/display.ttl:5")
    assert {repair.code for repair in refusal.repairs} >= {"accept-near-miss", "add-components"}
    assert all(repair.place for repair in refusal.repairs)


def test_answers_print_on_one_screen(answer: Answer, refusal: sc.Refusal) -> None:
    assert repr(answer).startswith("<configured :navigate\n  :sonar     :sonar-array\n")
    assert repr(refusal).startswith("<no configuration for :tell-the-time\n  because no component is eligible")
    assert "[examples/clock/display.ttl:5]" in str(refusal)
    assert max(repr(answer).count("\n"), repr(refusal).count("\n")) < 25


def test_a_notebook_shows_a_configuration_as_a_diagram_and_a_refusal_as_text(
    answer: Answer, refusal: sc.Refusal
) -> None:
    shown = answer._repr_html_()
    assert shown.count("<rect ") == len(answer.components)
    assert shown.count("marker-end") == len(answer.connections)
    assert refusal._repr_html_().startswith("<pre>no configuration")  # type: ignore[attr-defined]  # the library's own


HOSTILE = """@prefix sc: <https://w3id.org/selfconf#> .
@prefix : <x:> .
<x:a&b'c> a sc:Component, :K ; sc:hasOutput [ sc:name "<script>" ; sc:signalType :S ] ; :p "\\u001b[2J\\u202e" .
<x:d> a sc:Component, :L ; sc:hasInput [ sc:name "a" ; sc:signalType :S ] ; :p "<b>\\u001b]0;x\\u0007" .
"""
TASK = """@prefix sc: <https://w3id.org/selfconf#> . @prefix sh: <http://www.w3.org/ns/shacl#> . @prefix : <x:> .
:t a sc:Template ; sc:roles ( :r :s ) .
:r a sc:Role ; sh:class :K ; sc:feeds :s . :s a sc:Role ; sh:class :L .
"""


def test_what_strangers_wrote_steers_neither_a_page_nor_a_terminal() -> None:
    home, task = sc.read(HOSTILE), sc.template(TASK)
    strict = sc.template(TASK.replace(":L .", ':L ; sh:property [ sh:path :p ; sh:hasValue "ok" ] .'))
    answer, refusal = sc.configure(task, home), sc.configure(strict, home)
    assert answer
    assert not refusal
    solutions = home.query("SELECT ?n ?p { ?c <x:p> ?p OPTIONAL { ?c sc:hasOutput/sc:name ?n } }")
    for value in (home, home.components, answer, refusal, solutions, sc.partition(strict, home), task):
        assert "\x1b" not in repr(value), value
        assert "\u202e" not in repr(value), value
        for line in repr(value).splitlines():
            assert len(line) < 300
        shown = value._repr_html_()  # type: ignore[union-attr]  # each of them has it
        assert "<script>" not in shown
        assert "<b>" not in shown


def test_what_if_and_cost_come_with_the_answer_where_they_are_asked_for(answer: Answer) -> None:
    watch, cameras = sc.template("examples/watch.ttl"), sc.read("examples/watch")
    best = sc.configure(watch, cameras, strategy="best", what_if=True)
    assert isinstance(best, Answer)
    assert best.optimum is not None
    assert best.optimum.proved
    assert best.what_if is not None
    assert {one.component for one in best.what_if} == set(best.components)
    assert "proved: nothing costs less" in str(best)
    assert "if it failed" in str(best)
    assert (answer.optimum, answer.what_if) == (None, None)


def test_an_answer_is_a_configuration_and_true() -> None:
    answer = answered()
    assert answer
    assert isinstance(answer, Configuration)
    assert type(answer.plain) is Configuration
    assert answer.plain.components == answer.components
    assert len(answer.connections) == 4
    assert answer.settings[0].component == iri("thinking-cap")


def test_an_answer_is_turtle_that_says_what_it_is_a_configuration_of() -> None:
    document = parse(answered().to_turtle(), "answer.ttl")
    (name,) = document.instances(SC.Configuration)
    assert len(document.values(name, SC.assignment)) == 5
    assert len(document.values(name, SC.connection)) == 4
    assert document.values(name, SC.template) == [iri("navigate")]


def test_an_answer_is_text_a_chart_and_a_page() -> None:
    answer = answered(what_if=True)
    assert "configured :navigate" in str(answer)
    assert ":person-tracker -> :absolute-odometry" in [" ".join(line.split()) for line in str(answer).splitlines()]
    assert repr(answer).startswith("<configured :navigate")
    assert answer.to_mermaid().count("-->") == 4
    page = ElementTree.fromstring(f"<div>{answer._repr_html_()}</div>")
    assert page.findtext("h4") == "configured :navigate"
