"""A configuration in RDF says what it is, and why it is so."""

from __future__ import annotations

from dataclasses import replace

from selfconf.model.configuration import Assignment, Configuration, Connection, ParameterSetting
from selfconf.model.template import Parameter, Task, Template
from selfconf.model.term import IRI, Literal
from selfconf.rdf import provenance as write
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.turtle import to_turtle
from selfconf.rdf.vocabulary import PROV, SC, XSD
from tests.lab import iri

CONFIGURATION = Configuration(
    iri("t"),
    (Assignment(iri("r"), (iri("a"), iri("b"))), Assignment(iri("s"), (iri("c"),))),
    (Connection(iri("a"), "pose", iri("c"), "position"), Connection(iri("b"), "pose", iri("c"), "position")),
    (ParameterSetting(iri("c"), "goal", Literal("(AT BEDROOM)")),),
    {"goal": Literal("(AT BEDROOM)")},
)
NAME, BEFORE = IRI("urn:selfconf:configuration:x"), IRI("urn:selfconf:configuration:before")
TASK = Task(Template(iri("t"), (), parameters=(Parameter(iri("goal"), "goal"), Parameter(iri("robot"), "robot"))))


def test_a_configuration_says_who_plays_what_and_what_is_connected_and_set() -> None:
    text = to_turtle(write.configuration_triples(CONFIGURATION, NAME, TASK))
    document = turtle.parse(text, "configuration")
    assert document.instances(SC.Configuration) == [NAME]
    played = {
        (document.value(node, SC.role), document.value(node, SC.component))
        for node in document.values(NAME, SC.assignment)
    }
    assert played == {(iri("r"), iri("a")), (iri("r"), iri("b")), (iri("s"), iri("c"))}
    connected = {
        tuple(document.value(node, SC[end]) for end in ("from", "output", "to", "input"))
        for node in document.values(NAME, SC.connection)
    }
    assert connected == {(iri(source), Literal("pose"), iri("c"), Literal("position")) for source in ("a", "b")}
    (setting,) = document.values(NAME, SC.setting)
    assert document.value(setting, SC.value) == Literal("(AT BEDROOM)")


def test_a_configuration_says_which_task_it_answers_with_which_values() -> None:
    document = turtle.parse(to_turtle(write.configuration_triples(CONFIGURATION, NAME, TASK)), "configuration")
    task = document.value(NAME, SC.task)
    assert document.value(task, SC.template) == iri("t")
    (binding,) = document.values(task, SC.binding)
    assert document.value(binding, SC.parameter) == iri("goal")
    assert document.value(binding, SC.name) == Literal("goal")
    assert document.value(binding, SC.value) == Literal("(AT BEDROOM)")
    named = turtle.parse(
        to_turtle(write.configuration_triples(CONFIGURATION, NAME, replace(TASK, iri=iri("fetch")))), "configuration"
    )
    assert named.value(NAME, SC.task) == iri("fetch")
    assert task is not None
    assert document.value(task, SC.name) is None


def test_a_configuration_that_runs_says_as_which_task() -> None:
    deployment = write.Deployment(1, 0.0, "c1", ("clocktask", -3))
    text = to_turtle(write.deployment_triples(CONFIGURATION, NAME, TASK, deployment))
    document = turtle.parse(text, "configuration")
    task = document.value(NAME, SC.task)
    assert task is not None
    assert document.value(task, SC.name) == Literal("clocktask")
    assert document.value(task, SC.priority) == Literal("-3", XSD.integer)


def test_a_deployed_configuration_says_when_by_whom_and_after_which_failures() -> None:
    deployment = write.Deployment(
        7,
        0.0,
        "c1",
        ("fetch", 0),
        revises=(BEFORE, replace(CONFIGURATION, assignments=(Assignment(iri("r"), (iri("a"), iri("x"))),))),
        failures=((iri("x"), "fail", "lost her", 1.5), (iri("y"), "crash", "", 2.0)),
        passed_over={iri("s"): [iri("z")]},
        outside=iri("composite"),
    )
    text = to_turtle(write.deployment_triples(CONFIGURATION, NAME, TASK, deployment))
    document = turtle.parse(text, "configuration")
    assert document.value(NAME, SC.epoch) == Literal("7", XSD.integer)
    assert document.value(NAME, PROV.wasRevisionOf) == BEFORE
    assert document.value(NAME, SC.insideOf) == iri("composite")
    nodes = document.values(NAME, SC.assignment)
    replaced = {document.value(node, SC.component): document.value(node, SC.replaces) for node in nodes}
    assert replaced == {iri("a"): None, iri("b"): iri("x"), iri("c"): None}
    passed_over = {document.value(node, SC.role): document.value(node, SC.passedOver) for node in nodes}
    assert passed_over == {iri("r"): None, iri("s"): iri("z")}
    assert document.value(NAME, PROV.generatedAtTime) == Literal("1970-01-01T00:00:00.000+00:00", XSD.dateTime)
    causes = {
        (document.value(node, SC.component), document.value(node, SC.cause))
        for node in document.values(NAME, PROV.wasInfluencedBy)
    }
    assert causes == {(iri("x"), Literal("fail")), (iri("y"), Literal("crash"))}


def test_the_name_of_a_configuration_tells_it_and_its_epoch_from_others() -> None:
    names = {
        write.configuration_iri(CONFIGURATION, 1),
        write.configuration_iri(CONFIGURATION, 2),
        write.configuration_iri(Configuration(iri("t"), ()), 1),
    }
    assert len(names) == 3
    assert write.configuration_iri(CONFIGURATION, 1) in names
