"""The interactions and the ports of a template, as they are read, and what is wrong with them."""

from __future__ import annotations

import pytest

from selfconf.errors import TemplateError
from selfconf.model.profile import Condition, Input, Output, needed_operation, offered_operation
from selfconf.model.template import Interaction, Role, TemplatePort
from selfconf.rdf import tasks
from selfconf.rdf.tasks.interactions_and_ports import interactions_of
from selfconf.rdf.turtle import parse
from tests.lab import PREFIXES, iri

EYE, MIND = iri("eye"), iri("mind")
ROLES = Role(EYE), Role(MIND)
LONG = "[] a sc:Interaction ; sc:from :eye ; sc:to :mind"


def interactions(text: str) -> tuple[Interaction, ...]:
    """The interactions of a text between the roles `:eye` and `:mind`."""
    return interactions_of(parse(PREFIXES + text, "t.ttl"), ROLES)


def test_roles_of_which_nothing_is_said_do_not_feed_each_other() -> None:
    assert interactions(":eye sh:class :Camera .") == ()


def test_the_short_form_leaves_the_ports_open() -> None:
    assert interactions(":eye sc:feeds :mind , :eye .") == (Interaction(EYE, EYE), Interaction(EYE, MIND))


def test_the_long_form_may_name_one_port_or_both() -> None:
    assert interactions(f'{LONG} ; sc:output "image" .') == (Interaction(EYE, MIND, "image"),)
    assert interactions(f'{LONG} ; sc:output "image" ; sc:input "view" .') == (Interaction(EYE, MIND, "image", "view"),)


def test_what_is_said_in_both_forms_is_one_interaction() -> None:
    assert interactions(f":eye sc:feeds :mind . {LONG} .") == (Interaction(EYE, MIND),)


def test_two_roles_may_be_connected_by_several_pairs_of_ports() -> None:
    found = interactions(f'{LONG} ; sc:output "left" . {LONG} ; sc:output "right" .')
    assert {interaction.output for interaction in found} == {"left", "right"}


def test_interactions_are_in_the_order_of_the_roles_and_of_the_names_of_ports_wherever_they_stand() -> None:
    said = [f'{LONG} ; sc:{port} "{name}" .' for port in ("output", "input") for name in "ab"]
    said += [":eye sc:feeds :mind .", ":mind sc:feeds :eye , :mind ."]
    found = interactions(" ".join(said))
    assert found == interactions(" ".join(reversed(said)))
    assert [(one.source, one.sink, one.output, one.input) for one in found] == [
        (EYE, MIND, None, None),
        (EYE, MIND, None, "a"),
        (EYE, MIND, None, "b"),
        (EYE, MIND, "a", None),
        (EYE, MIND, "b", None),
        (MIND, EYE, None, None),
        (MIND, MIND, None, None),
    ]


def test_a_connection_of_a_configuration_is_no_interaction() -> None:
    assert interactions("[] a sc:Connection ; sc:from :eye ; sc:to :mind .") == ()


def test_an_interaction_between_the_roles_of_another_template_is_passed_over() -> None:
    other = ":u a sc:Template ; sc:roles ( :a :b ) . [] a sc:Interaction ; sc:from :a ; sc:to :b ."
    assert interactions(f"{LONG} . {other}") == (Interaction(EYE, MIND),)


def test_a_role_of_two_templates_may_feed_another_role_in_each() -> None:
    templates = ":this a sc:Template ; sc:roles ( :eye :mind ) . :other a sc:Template ; sc:roles ( :eye :hand ) . "
    assert interactions(f"{templates} {LONG} . {LONG.replace(':mind', ':hand')} .") == (Interaction(EYE, MIND),)
    with pytest.raises(TemplateError, match="hand"):
        interactions(f"{templates} {LONG.replace(':eye', ':hand')} .")


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (":eye sc:feeds :ear .", r"feeds .*ear.*, which is no role of the template"),
        (':eye sc:feeds "mind" .', r"feeds .*mind.*, which is no role of the template"),
        ("[] a sc:Interaction ; sc:to :mind .", "exactly one sc:from"),
        ("[] a sc:Interaction ; sc:from :eye ; sc:to :mind , :eye .", "exactly one sc:to"),
        ("[] a sc:Interaction ; sc:from :eye ; sc:to :ear .", r"speaks of .*ear.*, which is no role of the template"),
        ("[] a sc:Interaction ; sc:from :a ; sc:to :b .", r"speaks of .*a.*, which is no role of the template"),
        ("[] sc:from :eye ; sc:to :mind .", "is a sc:Interaction; say so with its type"),
        (f"{LONG} ; sc:output :image .", "sc:output of an interaction is the name of one port"),
        (f"{LONG} ; sc:input 3 .", "sc:input of an interaction is the name of one port"),
        (f'{LONG} ; sc:output "bild"@de .', "sc:output of an interaction is the name of one port"),
        (f'{LONG} ; sc:input "" .', "sc:input of an interaction is the name of one port"),
        (f'{LONG} ; sc:output "look()" ; sc:input "view" .', r"or an operation with an operation; .* end in \(\)"),
        (f'{LONG} ; sc:input "left" , "right" .', "sc:input of an interaction is the name of one port"),
    ],
)
def test_what_is_no_interaction_of_the_template_is_one_sentence(text: str, sentence: str) -> None:
    with pytest.raises(TemplateError, match=sentence):
        interactions(text)


EYE_ROLE = ":eye a sc:Role ; sh:class :Camera ."
TEMPLATE = ":look a sc:Template ; sc:roles ( :eye )"


def ports(said: str) -> tuple[TemplatePort, ...]:
    """The ports of a template that says something."""
    return tasks.read_task(parse(f"{PREFIXES}{TEMPLATE} ; {said} . {EYE_ROLE}", "t.ttl")).task.template.ports


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
