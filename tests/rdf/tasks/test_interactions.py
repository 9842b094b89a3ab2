"""The interactions of a template, as they are read, and what is wrong with them."""

from __future__ import annotations

import pytest

from selfconf.errors import TemplateError
from selfconf.model.template import Interaction, Role
from selfconf.rdf.tasks.interactions import interactions_of
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
