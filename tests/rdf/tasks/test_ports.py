"""The ports of a template, as they are read, and what is wrong with them."""

from __future__ import annotations

import pytest

from selfconf.errors import TemplateError
from selfconf.model.profile import Condition, Input, Output, needed_operation, offered_operation
from selfconf.model.template import TemplatePort
from selfconf.rdf import tasks
from selfconf.rdf.turtle import parse
from tests.lab import PREFIXES, iri

EYE_ROLE = ":eye a sc:Role ; sh:class :Camera ."
TEMPLATE = ":look a sc:Template ; sc:roles ( :eye )"


def ports(said: str) -> tuple[TemplatePort, ...]:
    """The ports of a template that says something."""
    return tasks.read_task(parse(f"{PREFIXES}{TEMPLATE} ; {said} . {EYE_ROLE}", "t.ttl")).template.ports


def test_ports_are_read_inputs_first() -> None:
    found = ports(
        'sc:hasOutput [ sc:name "image" ; sc:signalType :Image , :Detail ; sc:of :eye ] ;'
        'sc:hasInput [ sc:name "zoom" ; sc:signalType :Zoom ; sc:of :eye ]'
    )
    assert found == (
        TemplatePort(iri("eye"), Input("zoom", (iri("Zoom"),))),
        TemplatePort(iri("eye"), Output("image", (iri("Detail"), iri("Image")))),
    )


def test_operations_and_what_is_said_of_units_are_read_as_a_component_has_them() -> None:
    found = ports(
        'sc:hasOperation [ sc:name "look" ; sc:request :Where ; sc:response :Text ; sc:of :eye ] ;'
        'sc:needsOperation [ sc:name "light" ; sc:of :eye ] ;'
        'sc:hasInput [ sc:name "zoom" ; sc:signalType :Zoom ; sc:unit :Dioptre ; sc:of :eye ]'
    )
    assert [one.port for one in found] == [
        needed_operation("light", None, None),
        Input("zoom", (iri("Zoom"),), condition=Condition(iri("Dioptre"))),
        offered_operation("look", iri("Where"), iri("Text")),
    ]


@pytest.mark.parametrize(
    ("said", "sentence"),
    [
        ("sc:hasOutput [ sc:signalType :Image ; sc:of :eye ]", "has exactly one sc:name"),
        ('sc:hasOutput [ sc:name "" ; sc:signalType :Image ; sc:of :eye ]', "has exactly one sc:name"),
        ('sc:hasOutput [ sc:name "a()" ; sc:signalType :Image ; sc:of :eye ]', "has exactly one sc:name"),
        ('sc:hasOutput [ sc:name "a\\tb" ; sc:signalType :Image ; sc:of :eye ]', "has exactly one sc:name"),
        ('sc:hasOutput [ sc:name "bild"@de ; sc:signalType :Image ; sc:of :eye ]', "has exactly one sc:name, a string"),
        ('sc:hasOutput [ sc:name "a" ; sc:signalType :Image ]', "is that of exactly one role, sc:of"),
        ('sc:hasOutput [ sc:name "a" ; sc:signalType :Image ; sc:of :ear ]', "which is no role of the template"),
        ('sc:hasOutput [ sc:name "a" ; sc:of :eye ]', "has signal types, which are IRIs"),
        ('sc:hasOperation [ sc:name "a" ; sc:request "a" ; sc:of :eye ]', "at most one sc:request, an IRI"),
        ('sc:needsOperation [ sc:name "a" ; sc:response :A , :B ; sc:of :eye ]', "at most one sc:response, an IRI"),
        ('sc:hasInput [ sc:name "a" ; sc:signalType :A ; sc:unit "m" ; sc:of :eye ]', "at most one sc:unit, an IRI"),
        ('sc:hasOutput [ sc:name "a" ; sc:signalType "a" ; sc:of :eye ]', "has signal types, which are IRIs"),
        ('sc:hasInput [ sc:name "a" ; sc:signalType :A ; sc:frame "" ; sc:of :eye ]', "at most one sc:frame, an IRI"),
        (
            'sc:hasOutput [ sc:name "a" ; sc:signalType :A ; sc:frame :map , :odom ; sc:of :eye ]',
            "at most one sc:frame, an IRI or a string",
        ),
        (
            'sc:hasInput [ sc:name "a" ; sc:signalType :A ; sc:of :eye ] , [ sc:name "a" ; sc:of :eye ]',
            "is called 'a', and another one as well",
        ),
    ],
)  # fmt: skip
def test_what_is_no_port_of_the_template_is_one_sentence(said: str, sentence: str) -> None:
    with pytest.raises(TemplateError, match=sentence):
        ports(said)
