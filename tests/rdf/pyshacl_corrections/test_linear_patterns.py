"""Patterns in pySHACL and rdflib: in the block they answer as `re` does, at a cost that no text can choose."""

from __future__ import annotations

import re
import time

import pyshacl
import pytest
from pyshacl.constraints.core import string_based_constraints
from rdflib import Graph
from rdflib.plugins.sparql import operators

from selfconf.rdf.pyshacl_corrections.linear_patterns import linear_patterns
from tests.lab import PREFIXES

SLOW, LONG = r"^(\\w+\\s?)*$", "a" * 60 + "!"


def ask(condition: str) -> bool:
    """Whether rdflib says that a condition holds."""
    answer = Graph().query(f"ASK {{ FILTER ( {condition} ) }}").askAnswer
    assert answer is not None
    return answer


def conforms(text: str, pattern: str, flags: str = "") -> bool:
    """Whether pySHACL says that a text has a pattern."""
    shape = f':s a sh:NodeShape ; sh:targetNode :a ; sh:property [ sh:path :p ; sh:pattern "{pattern}" {flags} ] .'
    data, shapes = (Graph().parse(data=PREFIXES + said, format="turtle") for said in (f':a :p "{text}" .', shape))
    return bool(pyshacl.validate(data, shacl_graph=shapes)[0])


@pytest.mark.parametrize(
    ("condition", "holds"),
    [
        ('REGEX("Lamp", "^l")', False),
        ('REGEX("Lamp", "^l", "i")', True),
        ('REPLACE("lamp", "a.", "ime") = "limep"', True),
        ('REPLACE("lamp", "x+", "y") = "lamp"', True),
        ('REPLACE("lamp", "(l)(a)", "$2$1") = "almp"', True),
    ],
)
@pytest.mark.filterwarnings("ignore:'count' is passed as positional:DeprecationWarning")  # by rdflib, to Python 3.13
def test_sparql_answers_the_same_in_the_block_and_outside_of_it(condition: str, holds: bool) -> None:
    with linear_patterns():
        assert ask(condition) == holds
    assert ask(condition) == holds


def test_a_dollar_of_sparql_stands_at_the_end_of_the_text_alone() -> None:
    with linear_patterns():
        assert not ask(r'REGEX("a\n", "^a$")')
        assert ask(r'REGEX("a\n", "^a$", "m")')
        assert ask(r'REPLACE("a\n", "a$", "b") = "a\n"')


def test_replace_of_sparql_goes_by_its_flags() -> None:
    with linear_patterns():
        assert ask('REPLACE("Lamp, lAMP, lamp", "L", "c", "i") = "camp, cAMP, camp"')
        assert ask(r'REPLACE("a\nb", "a.b", "c", "s") = "c"')


def test_shacl_answers_the_same_in_the_block_and_outside_of_it() -> None:
    cases = (("Lamp", "^L", ""), ("Lamp", "^l", ""), ("Lamp", "^l", '; sh:flags "i"'))
    outside = [conforms(*case) for case in cases]
    with linear_patterns():
        assert [conforms(*case) for case in cases] == outside == [True, False, True]


def test_what_would_take_years_is_decided_at_once() -> None:
    began = time.process_time()
    with linear_patterns():
        assert not ask(f'REGEX("{LONG}", "{SLOW}")')
        assert ask(f'REPLACE("{LONG}", "{SLOW}", "") = "{LONG}"')
        assert not conforms(LONG, SLOW)
    assert time.process_time() - began < 2


def fail_inside() -> None:
    """Fail in the block, where the modules see another `re`."""
    with linear_patterns():
        assert vars(operators)["re"] is not re
        raise ZeroDivisionError


def test_after_the_block_all_is_as_before_even_if_it_has_failed() -> None:
    with pytest.raises(ZeroDivisionError):
        fail_inside()
    assert vars(operators)["re"] is re
    assert vars(string_based_constraints)["re"] is re
