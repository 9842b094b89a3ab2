"""Patterns at a cost that a text cannot choose."""

from __future__ import annotations

import re
import time
import warnings
from random import Random

import pytest

from selfconf.rdf.shacl.patterns import LONGEST_TEXT, PATTERN_SECONDS, MatchTooCostly, Pattern, pattern_fault
from tests.harness.effort import thorough

LETTERS = "a" * 60
SLOW = [
    (r"^(\w+\s?)*$", LETTERS + "!", False),
    (r"^(\w+\s?)*$", LETTERS * 50, True),
    (r"^(a|a)*$", LETTERS + "!", False),
    (r"(a?){40}a{40}$", "a" * 39, False),
    (r"\s+$", " " * (LONGEST_TEXT - 1) + "x", False),
    (r"[a-z]+[a-z]+[a-z]+[a-z]+!", LETTERS * 100, False),
]
BEYOND = r"^(?=(\w+)+$)"


@pytest.mark.parametrize(("expression", "text", "found"), SLOW, ids=range(len(SLOW)))
def test_what_would_take_years_is_decided_at_once(expression: str, text: str, found: bool) -> None:
    began = time.process_time()
    assert Pattern(expression, 0).finds(text) == found
    assert time.process_time() - began < 2


@pytest.mark.parametrize("text", ["", "a", "Eye 1", "a" * 1_000_000])
def test_what_costs_little_is_asked_of_re(text: str) -> None:
    pattern = Pattern("^[a-z]*$", 0)
    assert pattern.finds(text) == (" " not in text)
    assert pattern._automaton is None


def test_where_each_line_is_a_beginning_longer_texts_cost_more() -> None:
    lengths = [Pattern(expression, 0)._short for expression in (r"^\n*a", r"(?m)^\n*a", r"\n*a")]
    assert lengths[0] > lengths[1] == lengths[2]
    assert Pattern(r"^\n*a", re.MULTILINE)._short == lengths[1]


def test_beyond_regular_languages_many_texts_cost_little_more_than_one() -> None:
    pattern = Pattern(BEYOND, 0)
    began = time.process_time()
    for number in range(200):
        with pytest.raises(MatchTooCostly, match="takes too long"):
            pattern.finds(f"{LETTERS}{number}!")
    assert time.process_time() - began < PATTERN_SECONDS + 1


def test_beyond_regular_languages_a_harmless_text_is_decided_whatever_came_before() -> None:
    pattern = Pattern(r"^(?=.*[A-Z])(?=.*\d).{8,}$", 0)
    pattern._left = 0.0
    assert pattern.finds("Password1 and more")
    assert not pattern.finds("password1 and more")


@thorough
def test_a_text_that_leads_to_ever_more_states_costs_little_and_the_others_are_decided() -> None:
    pattern = Pattern("a([ab]){900}c", 0)  # of which `re` needs fifteen times what it may take
    letters = Random(1)
    long = "".join(letters.choice("ab") for _ in range(LONGEST_TEXT))
    began = time.process_time()
    for _ in range(3):
        with pytest.raises(MatchTooCostly, match="takes too long"):
            pattern.finds(long)
    assert time.process_time() - began < 3
    assert pattern.finds(f"{'a' * 901}c")
    assert not pattern.finds("b" * LONGEST_TEXT)


@pytest.mark.parametrize("text", ["", "a"])
def test_what_takes_no_character_costs_as_often_as_it_is_repeated(text: str) -> None:
    with pytest.raises(MatchTooCostly, match="takes too long"):
        Pattern("(?:(?:^){3000}){3000}", 0).finds(text)  # with 60000 in their place `re` takes all memory
    with_automaton = Pattern("(?:(){60000}){60000}b?$", 0)
    assert with_automaton.finds(text)
    assert with_automaton._automaton is not None


@pytest.mark.parametrize("expression", ["a{99999999999}", f"{'(' * 9000}a{')' * 9000}", "(a"])
def test_what_re_cannot_take_is_no_expression(expression: str) -> None:
    assert pattern_fault(expression, "") is not None
    assert pattern_fault(expression, "q") is None


def test_what_re_warns_of_is_an_expression_without_a_word() -> None:
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        assert pattern_fault("[[:alpha:]]", "") is None
    assert told == []


@pytest.mark.parametrize("expression", ["[a-z-[aeiou]]", r"^[\w-[\d]]+$"])
def test_subtracting_a_class_of_characters_is_no_pattern_of_re(expression: str) -> None:
    """XPath has it; `re` would read the second bracket as a character of the class."""
    assert "subtracts a class of characters" in str(pattern_fault(expression, ""))
    assert "subtracts a class of characters" in str(pattern_fault(expression, "m"))


@pytest.mark.parametrize("expression", [r"[a\-[]", "[[a-z]", r"\[a-[b]"])
def test_a_bracket_in_a_class_of_characters_is_one_of_them(expression: str) -> None:
    assert pattern_fault(expression, "") is None
