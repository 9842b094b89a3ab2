"""The cost of a template as its author writes it, and a sentence for what is none."""

from __future__ import annotations

from fractions import Fraction

import pytest

from selfconf.errors import TemplateError
from selfconf.model.cost import CostLevel, CostTerm
from selfconf.rdf.tasks.costs import cost_of
from selfconf.rdf.turtle import parse
from tests.lab import PREFIXES, iri

ROLES = frozenset((iri("eye"), iri("mind")))


def cost(text: str) -> tuple[CostLevel, ...]:
    """The levels of the cost of the template `:t` in a text."""
    return cost_of(parse(PREFIXES + text, "t.ttl"), iri("t"), ROLES)


def test_a_template_that_states_no_cost_has_no_levels() -> None:
    assert cost(":t a sc:Template .") == ()


def test_a_term_counts_once_and_for_all_roles_unless_it_says_otherwise() -> None:
    assert cost(":t sc:cost ( [ sc:term [ sc:property :delay ] ] ) .") == ((CostTerm(iri("delay")),),)


def test_a_term_may_state_a_weight_what_counts_otherwise_and_a_role() -> None:
    term = "[ sc:property :delay ; sc:weight -0.5 ; sc:otherwise 10 ; sc:ofRole :eye ]"
    expected = CostTerm(iri("delay"), Fraction(-1, 2), Fraction(10), iri("eye"))
    assert cost(f":t sc:cost ( [ sc:term {term} ] ) .") == ((expected,),)


def test_levels_keep_the_order_of_the_list() -> None:
    levels = cost(":t sc:cost ( [ sc:term [ sc:property :z ] ] [ sc:term [ sc:property :a ] , [ sc:property :b ] ] ) .")
    assert [{term.property.short for term in level} for level in levels] == [{"z"}, {"a", "b"}]


def test_a_weight_is_exact() -> None:
    ((term,),) = cost(":t sc:cost ( [ sc:term [ sc:property :delay ; sc:weight 0.1 ] ] ) .")
    assert term.weight == Fraction(1, 10)


@pytest.mark.parametrize(
    ("stated", "sentence"),
    [
        ("()", "the cost of a template is one list of levels"),
        ("[ sc:term [ sc:property :a ] ]", "the cost of a template is one list of levels"),
        ("( [ sc:term [ sc:property :a ] ] ) , ( [ sc:term [ sc:property :b ] ] )", "is one list of levels"),
        ("( [ ] )", "each level of sc:cost has at least one sc:term"),
        ("( [ sc:term [ ] ] )", "needs exactly one sc:property, an IRI"),
        ('( [ sc:term [ sc:property "delay" ] ] )', "needs exactly one sc:property, an IRI"),
        ("( [ sc:term [ sc:property :a ; sc:weight 1 , 2 ] ] )", "sc:weight of a term of sc:cost is one finite number"),
        ('( [ sc:term [ sc:property :a ; sc:otherwise "INF"^^xsd:double ] ] )', "sc:otherwise .* one finite number"),
        ("( [ sc:term [ sc:property :a ; sc:ofRole :eye , :mind ] ] )", "write a term for each role"),
        ("( [ sc:term [ sc:property :a ; sc:ofRole :ear ] ] )", "which is no role of the template"),
    ],
)
def test_what_is_no_cost_is_one_sentence(stated: str, sentence: str) -> None:
    with pytest.raises(TemplateError, match=sentence):
        cost(f":t sc:cost {stated} .")
