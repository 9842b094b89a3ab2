"""A configuration in the record of a task: what is written is read again, and what is none is an error of a peer."""

from __future__ import annotations

import json
from typing import Any

import pytest

from selfconf.deployment.configuration_record import configuration_record, recorded_configuration
from selfconf.errors import PeerError
from selfconf.model.configuration import Assignment, Configuration, Connection, ParameterSetting
from selfconf.model.term import IRI, Literal
from selfconf.rdf.vocabulary import XSD
from tests.lab import iri

CONFIGURATION = Configuration(
    iri("navigate"),
    (Assignment(iri("eye"), (iri("left"), iri("right"))), Assignment(iri("mind"), (iri("cap"),))),
    (Connection(iri("left"), "image", iri("cap"), "view"),),
    (ParameterSetting(iri("cap"), "speed", Literal("0.5", XSD.decimal)),),
    {"robot": iri("Astrid"), "goal": Literal("kitchen")},
)


def written() -> dict[str, Any]:
    """The record of the configuration, as it comes out of a file."""
    return json.loads(json.dumps(configuration_record(CONFIGURATION)))  # type: ignore[no-any-return]


def test_a_configuration_is_read_from_json_as_it_was_written() -> None:
    again = recorded_configuration(written())
    assert again == CONFIGURATION
    assert isinstance(again.bindings["robot"], IRI)
    assert isinstance(again.assignments[0].components[1], IRI)


@pytest.mark.parametrize("member", configuration_record(CONFIGURATION))
def test_a_record_without_one_of_its_members_is_none(member: str) -> None:
    record = written()
    del record[member]
    with pytest.raises(PeerError, match=f"^not the record of a configuration: KeyError.*{member}"):
        recorded_configuration(record)


@pytest.mark.parametrize(
    ("member", "value"),
    [
        ("roles", None),
        ("roles", [[iri("eye")]]),
        ("roles", [[iri("eye"), "left"]]),
        ("connections", [[iri("left"), "image", iri("cap")]]),
        ("connections", [[iri("left"), ["image"], iri("cap"), "view"]]),
        ("connections", [[iri("left"), "image", {"iri": iri("cap")}, "view"]]),
        ("parameters", [[iri("cap"), ["speed"], {"literal": "0.5"}]]),
        ("parameters", [[iri("cap"), "speed", "fast"]]),
        ("bindings", [["robot", "Astrid"]]),
    ],
)
def test_a_member_of_another_form_is_an_error_of_the_peer(member: str, value: object) -> None:
    with pytest.raises(PeerError):
        recorded_configuration({**written(), member: value})
