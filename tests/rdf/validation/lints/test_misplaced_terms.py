"""Lints about terms that are said of the wrong thing."""

from __future__ import annotations

import pytest

from selfconf.model.diagnostic import Severity
from tests.rdf.validation.lints.linted_text import COSTED, TEMPLATE, lints, only

INSIDE = TEMPLATE + ":a a sc:Component, rob:Lamp ; sc:grounding {} ."


@pytest.mark.parametrize(
    ("text", "owners"),
    [
        (":a a sc:Component, rob:Tuner ; sc:unit unit:M .", "a sc:Input or a sc:Output"),
        (":a a sc:Component, rob:Tuner ; sc:command 'python a.py' .", "a sc:Grounding"),
        (
            ":a a sc:Component, rob:Tuner ; sc:hasParameter [ sc:name 'p' ; sc:parameterType :P ; sc:depth 3 ] .",
            "a sc:Input",
        ),
        (
            ":a a sc:Component, rob:Tuner ; sc:hasOutput [ sc:name 'o' ; sc:signalType rob:Text ; sc:request :R ] .",
            "a sc:Operation",
        ),
        (
            ":a a sc:Component, rob:Tuner ; sc:grounding [ sc:command 'python a.py' ; sc:frame 'map' ] .",
            "a sc:Input or a sc:Output",
        ),
        (
            ":a a sc:Component, rob:Tuner ; sc:hasOutput [ sc:name 'o' ; sc:signalType rob:Text ; sc:value 30 ] .",
            "a rate or a duration, of what a role sets, and of a binding",
        ),
    ],
)
def test_what_is_said_of_another_part_of_an_advertisement_is_passed_over_and_told(text: str, owners: str) -> None:
    found = only(text)
    assert (found.code, found.severity, found.hint) == ("SC-L25", Severity.WARNING, f"It is said of {owners}.")


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        (":r sc:optional true .", "A role that may stay unplayed has sc:minCount 0."),
        (":r sc:output 'light' .", "It is said of a sc:Interaction."),
        (":r sc:rate [ sc:value 5 ; sc:unit <http://qudt.org/vocab/unit/HZ> ] .", "It is said of a sc:Output."),
        (":t sc:command 'python t.py' .", "It is said of a sc:Grounding."),
        (":t sc:template :t .", "It is said of a sc:Grounding or a sc:Task."),
        (
            ":t sc:parameter :p . :p a sc:Parameter ; sc:name 'p' ; sc:value 3 . :r sh:node [ sh:in ( :p ) ] .",
            "The default of a parameter is sh:defaultValue.",
        ),
        (
            ":k a sc:Task ; sc:template :t ; sc:parameter :p .",
            "A task has sc:binding [ sc:parameter ... ; sc:value ... ].",
        ),
        (
            ":a a sc:Component, rob:Lamp ; sc:parameter [ sc:name 'p' ; sc:parameterType :P ] .",
            "What is set of a component is its sc:hasParameter.",
        ),
    ],
)
def test_what_is_said_of_another_part_of_a_template_is_passed_over_and_told(text: str, hint: str) -> None:
    found = only(TEMPLATE + text)
    assert (found.code, found.hint) == ("SC-L25", hint)


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        (COSTED.format("sc:role :r"), COSTED.format("sc:ofRole :r")),
        (COSTED.format("sc:of :r"), COSTED.format("sc:ofRole :r")),
        (INSIDE.format(":t"), INSIDE.format("[ sc:template :t ]")),
        (INSIDE.format("[ sc:task :t ]"), INSIDE.format("[ sc:template :t ]")),
        (
            TEMPLATE + ":r sc:signalType rob:Image .",
            TEMPLATE + ":r sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue rob:Image ] .",
        ),
        (
            TEMPLATE + ":r sc:parameterType :Goal .",
            TEMPLATE + ":r sh:property [ sh:path ( sc:hasParameter sc:parameterType ) ; sh:hasValue :Goal ] .",
        ),
        (
            TEMPLATE + ":r sc:feeds :r . [] a sc:Interaction ; sc:from :r ; sc:to :r ; sc:signalType rob:Image .",
            TEMPLATE + ":r sc:feeds :r . [] a sc:Interaction ; sc:from :r ; sc:to :r ; sc:output 'image' .",
        ),
    ],
)
def test_a_term_at_the_wrong_part_of_a_template_is_noticed_with_what_to_write(wrong: str, right: str) -> None:
    found = only(wrong)
    assert (found.code, found.hint is not None) == ("SC-L25", True)
    assert not lints(right)
