"""A configuration is read from what its configurator serves, and what is none is passed over."""

from __future__ import annotations

from pathlib import Path

from selfconf.api.deployed import deployed_body
from selfconf.rdf.turtle import parse
from tests.lab import Lab, iri


def test_roles_connections_parameters_and_what_was_passed_over_are_read(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.navigation()
    agent = lab.agent()
    lab.running(agent)
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
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
