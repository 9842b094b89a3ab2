"""Who may supply the players of a role: anybody, or who conforms to the shape that the role states."""

from __future__ import annotations

import pytest

from selfconf import configure, read, template
from selfconf.errors import BindingError, TemplateError
from selfconf.model.configuration import Configuration
from selfconf.model.refusal import Refusal
from tests.lab import PREFIXES

ECOLOGY = (
    PREFIXES
    + """
:user a sc:Component, :User ; sc:hasInput [ sc:name "i" ; sc:signalType :S ] .
:bad a sc:Component, :Maker ; sc:hasOutput [ sc:name "o" ; sc:signalType :S ] ; sc:preference 5 .
:good a sc:Component, :Maker, :Good ; :power 3 ; sc:hasInput [ sc:name "i" ; sc:signalType :T ] ;
    sc:hasOutput [ sc:name "o" ; sc:signalType :S ] .
:base a sc:Component, :Maker, :Good ; :power 9 ; sc:hasOutput [ sc:name "o" ; sc:signalType :T ] .
"""
)


def recruited(recruits: str, **bound: str) -> list[str]:
    """The recruits of the answer, by their short names; nothing where there is no configuration."""
    task = (
        f":t a sc:Template ; sc:roles ( :r ) ; sc:parameter :power-wanted . :r a sc:Role ; sh:class :User ;"
        f' sc:recruits {recruits} . :power-wanted a sc:Parameter ; sc:name "wanted" .'
    )
    answer = configure(template(PREFIXES + task).bind(**bound), read(ECOLOGY))
    assert isinstance(answer, Configuration | Refusal)
    return [one.short for one in answer.recruits] if isinstance(answer, Configuration) else []


@pytest.mark.parametrize(
    ("recruits", "found"),
    [
        ("true", ["bad"]),
        ("false", []),
        ("[ sh:class :Good ]", ["base", "good"]),
        ("[ sh:property [ sh:path :power ; sh:minInclusive 2 ; sh:minCount 1 ] ]", ["base", "good"]),
        ("[ sh:property [ sh:path :power ; sh:maxInclusive 5 ; sh:minCount 1 ] ]", []),
        ('[ sh:class :Good ; sh:property [ sh:path ( sc:hasOutput sc:name ) ; sh:hasValue "o" ] ]', ["base", "good"]),
        ("[ sh:path :power ; sh:minInclusive 2 ; sh:minCount 1 ; sh:nodeKind sh:Literal ]", ["base", "good"]),
        ("[ sh:path :power ; sh:minInclusive 2 ; sh:minCount 1 ; sh:uniqueLang true ]", ["base", "good"]),
        (":named . :named a sh:NodeShape ; sh:class :Good", ["base", "good"]),
    ],
)
def test_only_who_conforms_is_recruited(recruits: str, found: list[str]) -> None:
    assert recruited(recruits) == found


@pytest.mark.parametrize(
    ("recruits", "problem"),
    [
        ('"yes"', "true, false, or one shape"),
        ("true , false", "true, false, or one shape"),
        ("[ sh:pattern 5 ]", "well-formed"),
        (":Certfied", "no shape of this file"),
    ],
)
def test_what_says_neither_is_a_mistake_of_the_template(recruits: str, problem: str) -> None:
    with pytest.raises(TemplateError, match=problem):
        recruited(recruits)


def test_a_parameter_in_the_shape_of_suppliers_has_to_have_a_value() -> None:
    shape = "[ sh:property [ sh:path :power ; sh:in ( :power-wanted ) ; sh:minCount 1 ] ]"
    with pytest.raises(
        BindingError, match=r"'wanted' cannot be left free, for it stands in sc:recruits; .*bind\(wanted="
    ):
        recruited(shape)
    assert recruited(shape, wanted="3") == []
    assert recruited(shape.replace("sh:in ( :power-wanted )", "sh:in ( :power-wanted 9 )"), wanted="3") == [
        "base",
        "good",
    ]


def test_a_shape_without_a_name_by_which_none_can_be_recruited_is_called_by_its_role() -> None:
    """What only pySHACL finds wrong: a constraint component without a validator."""
    odd = "[ :odd 1 ] . :Odd a sh:ConstraintComponent ; sh:parameter [ sh:path :odd ]"
    with pytest.raises(TemplateError, match=r"the shape of what the role <\S+#r> recruits is not well-formed"):
        recruited(odd, wanted="1")
