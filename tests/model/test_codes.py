"""The catalogue of codes: each is one of a kind and is explained. What its examples earn is tested with validation."""

from __future__ import annotations

import re
from collections import Counter

import pytest

from selfconf.model.codes import BY_CODE, CODES, PREAMBLE, Code
from selfconf.model.diagnostic import UNREADABLE, Severity
from selfconf.rdf.turtle import parse


def test_a_code_is_given_once_and_is_found_by_its_name() -> None:
    assert max(Counter(code.code for code in CODES).values()) == 1
    assert [BY_CODE[code.code] for code in CODES] == list(CODES)


@pytest.mark.parametrize("code", CODES, ids=lambda code: code.code)
def test_a_code_has_a_letter_and_a_number_and_says_what_has_to_hold_in_a_sentence(code: Code) -> None:
    assert re.fullmatch(r"SC-[SATKCOLP]\d\d", code.code)
    assert re.fullmatch(r"[A-Z].*\.", code.title)
    assert re.fullmatch(r"[A-Z].*\.", code.why, re.DOTALL)
    assert bool(code.bad) == bool(code.good) or code.code in UNREADABLE


def test_what_cannot_be_read_has_codes_of_errors() -> None:
    assert {BY_CODE[code].severity for code in UNREADABLE} == {Severity.ERROR}


def test_what_stands_at_the_head_of_an_example_is_turtle() -> None:
    assert {"sc", "rob", "sh", "xsd", ""} <= parse(PREAMBLE, "preamble.ttl").prefixes.keys()
