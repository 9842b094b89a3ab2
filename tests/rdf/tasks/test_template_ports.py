"""The ports of a template: each with a name, types and a role, and a sentence for what is none."""

from __future__ import annotations

import pytest

from selfconf.errors import TemplateError
from selfconf.model.template import TemplatePort
from selfconf.rdf import tasks
from selfconf.rdf.turtle import parse
from tests.lab import PREFIXES, iri

ROLES = ":eye a sc:Role ; sh:class :Camera ."
TEMPLATE = ":look a sc:Template ; sc:roles ( :eye )"


def ports(said: str) -> tuple[TemplatePort, ...]:
    """The ports of a template that says something."""
    return tasks.read_task(parse(f"{PREFIXES}{TEMPLATE} ; {said} . {ROLES}", "t.ttl")).task.template.ports


def test_ports_are_read_inputs_first() -> None:
    found = ports(
        'sc:hasOutput [ sc:name "image" ; sc:signalType :Image , :Detail ; sc:of :eye ] ;'
        'sc:hasInput [ sc:name "zoom" ; sc:signalType :Zoom ; sc:of :eye ]'
    )
    assert found == (
        TemplatePort("zoom", (iri("Zoom"),), iri("eye"), True),
        TemplatePort("image", (iri("Detail"), iri("Image")), iri("eye"), False),
    )


@pytest.mark.parametrize(
    ("said", "sentence"),
    [
        ("sc:hasOutput [ sc:signalType :Image ; sc:of :eye ]", "has exactly one sc:name"),
        ('sc:hasOutput [ sc:name "" ; sc:signalType :Image ; sc:of :eye ]', "has exactly one sc:name"),
        ('sc:hasOutput [ sc:name "a()" ; sc:signalType :Image ; sc:of :eye ]', "has exactly one sc:name"),
        ('sc:hasOutput [ sc:name "a" ; sc:signalType :Image ]', "is that of exactly one role, sc:of"),
        ('sc:hasOutput [ sc:name "a" ; sc:signalType :Image ; sc:of :ear ]', "which is no role of the template"),
        ('sc:hasOutput [ sc:name "a" ; sc:of :eye ]', "has signal types, which are IRIs"),
        ('sc:hasOutput [ sc:name "a" ; sc:signalType "a" ; sc:of :eye ]', "has signal types, which are IRIs"),
        (
            'sc:hasInput [ sc:name "a" ; sc:signalType :A ; sc:of :eye ] , [ sc:name "a" ; sc:of :eye ]',
            "is called 'a', and another one as well",
        ),
    ],
)  # fmt: skip
def test_what_is_no_port_of_the_template_is_one_sentence(said: str, sentence: str) -> None:
    with pytest.raises(TemplateError, match=sentence):
        ports(said)
