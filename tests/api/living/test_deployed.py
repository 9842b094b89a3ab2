"""A configuration is read from what its configurator serves, and what is none is passed over."""

from __future__ import annotations

from pathlib import Path

from selfconf.api.living.deployed import deployed_body
from selfconf.model.configuration import Configuration
from selfconf.model.template import Parameter, Task, Template
from selfconf.model.term import IRI, Literal, Term
from selfconf.rdf.provenance import configuration_triples
from selfconf.rdf.turtle import parse, to_turtle
from tests.lab import Lab, iri


def test_roles_connections_parameters_and_what_was_passed_over_are_read(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    agent = lab.repaired()
    body = deployed_body(parse(agent._record.turtle(), "cfg"))
    assert body is not None
    (position,) = (role for role in body["roles"] if role["role"] == iri("position"))
    assert position["components"] == [iri("absolute-odometry")]
    assert position["passed_over"] == [iri("person-tracker")]
    assert {
        "from": {"component": iri("absolute-odometry"), "output": "pose"},
        "to": {"component": iri("thinking-cap"), "input": "position"},
    } in body["connections"]
    assert body["parameters"] == [{"component": iri("thinking-cap"), "name": "goal", "value": "(AT BEDROOM)"}]


def test_bindings_are_told_by_the_names_of_their_parameters() -> None:
    room, floor = (Parameter(IRI(f"https://example.org/{of}#p"), of) for of in ("room", "floor"))
    task = Task(Template(iri("t"), (), parameters=(room, floor)))
    bindings: dict[str, Term] = {"room": iri("kitchen"), "floor": Literal("2")}
    text = to_turtle(configuration_triples(Configuration(iri("t"), (), (), (), bindings), iri("c"), task))
    body = deployed_body(parse(text, "cfg"))
    assert body is not None
    assert body["bindings"] == {"room": iri("kitchen"), "floor": "2"}


def test_a_binding_of_an_older_record_is_told_by_the_local_name_of_its_parameter() -> None:
    sc = "https://w3id.org/selfconf#"
    bound = f"[ <{sc}binding> [ <{sc}parameter> <{iri('room')}> ; <{sc}value> 2 ] ]"
    body = deployed_body(parse(f"<urn:a> a <{sc}Configuration> ; <{sc}task> {bound} .", "cfg"))
    assert body is not None
    assert body["bindings"] == {"room": 2}


def test_recruits_are_read_beside_the_roles() -> None:
    recruited = "<urn:a> a <https://w3id.org/selfconf#Configuration> ; <https://w3id.org/selfconf#recruited> <urn:r> ."
    body = deployed_body(parse(recruited, "cfg"))
    assert body is not None
    assert body["recruits"] == ["urn:r"]


def test_a_stranger_that_serves_something_else_does_no_harm() -> None:
    assert deployed_body(parse("<urn:a> <urn:b> 1 .", "cfg")) is None
    odd = "<urn:a> a <https://w3id.org/selfconf#Configuration> ; <https://w3id.org/selfconf#assignment> 1 , [] ."
    body = deployed_body(parse(odd, "cfg"))
    assert body is not None
    assert body["connections"] == []
