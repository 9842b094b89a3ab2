"""Answers as JSON: every member is there, and a value is what its datatype says."""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from fractions import Fraction
from typing import Any, get_args

import pytest

from selfconf.model.consequence import Consequence
from selfconf.model.literal_values import DATATYPES, WHOLE_NUMBERS
from selfconf.model.refusal import Reason, Refusal, TooFewEligible, Undecided
from selfconf.model.relaxation import Relaxation
from selfconf.model.term import IRI, XSD_NAMESPACE, BlankNode, Literal
from selfconf.render import (
    configuration_body,
    consequences_body,
    cost_body,
    refusal_body,
    undecided_body,
    value_body,
)
from tests.render.answers import (
    CLOCK,
    CONFIGURATION,
    CONSEQUENCES,
    LAMP,
    OPTIMUM,
    REASONS,
    REFUSAL,
    REPAIRS,
    SCREEN,
    SINK,
    SOURCE,
    SPARE,
    TEMPLATE,
    term,
)


def xsd(lexical: str, datatype: str) -> Literal:
    """A literal of one of XML Schema's datatypes."""
    return Literal(lexical, IRI(XSD_NAMESPACE + datatype))


# Configurations.


def test_a_configuration_has_its_roles_connections_bindings_and_parameters() -> None:
    assert configuration_body(CONFIGURATION) == {
        "template": TEMPLATE,
        "bindings": {"room": term("kitchen"), "greeting": 'say "hello"'},
        "roles": [
            {"role": SOURCE, "components": [CLOCK]},
            {"role": SINK, "components": [SCREEN]},
            {"role": SPARE, "components": []},
        ],
        "connections": [
            {"from": {"component": CLOCK, "output": "time"}, "to": {"component": SCREEN, "input": "text"}},
        ],
        "parameters": [{"component": SCREEN, "name": "size", "value": 12}],
    }


def test_the_consequences_of_failures_say_who_comes_goes_and_moves() -> None:
    fatal, replaced = consequences_body(CONSEQUENCES)
    assert fatal == {
        "component": CLOCK,
        "role": SOURCE,
        "single_point_of_failure": True,
        "started": [],
        "stopped": [],
        "moved": [],
    }
    assert (replaced["started"], replaced["stopped"]) == ([LAMP], [CLOCK])
    assert replaced["moved"] == [{"component": CLOCK, "role": SPARE}]
    assert not replaced["single_point_of_failure"]
    (open_,) = consequences_body([Consequence(CLOCK, SOURCE, Undecided(5))])
    assert (open_["single_point_of_failure"], open_["undecided"]) == (False, True)


def test_a_cost_has_its_levels_its_bound_and_what_is_not_known() -> None:
    assert cost_body(OPTIMUM, {term("power"), term("error")}) == {
        "levels": [0.5, 24.0],
        "bound": [0.25, 24.0],
        "proved": False,
        "unknown": 2,
        "missing": [
            {"component": CLOCK, "property": term("power")},
            {"component": SCREEN, "property": term("error")},
        ],
        "nobody_has": [term("error"), term("power")],
    }


@pytest.mark.parametrize("sign", [1, -1])
def test_a_cost_that_is_larger_than_any_double_is_written_as_the_largest(sign: int) -> None:
    amount = (Fraction(sign * 10**310),)
    levels = cost_body(replace(OPTIMUM, cost=amount, bound=amount), ())["levels"]
    assert json.loads(json.dumps(levels)) == [sign * sys.float_info.max]


# Refusals.


def test_there_is_an_example_of_every_reason_and_relaxation() -> None:
    assert {type(reason) for reason in REASONS} == set(get_args(Reason))
    assert {type(repair) for repair in REPAIRS} == set(get_args(Relaxation))


def test_a_refusal_has_every_fact_with_its_code_its_role_and_a_sentence() -> None:
    body = refusal_body(REFUSAL)
    assert body["template"] == TEMPLATE
    facts = [{name: one[name] for name in ("code", "role", "message")} for one in body["reasons"]]
    assert facts == [{"code": one.code, "role": one.role, "message": str(one)} for one in REASONS]
    hint = {"code": "reasoning", "message": "with --reasoning subclass there is a configuration"}
    *repairs, last = body["repairs"]
    assert [(one["code"], one["role"], one["message"]) for one in repairs] == [
        (one.code, one.role, str(one)) for one in REPAIRS
    ]
    assert last == hint
    assert body["missing_sites"] == ["cellar"]


def test_a_fact_of_a_refusal_has_a_place_where_that_is_known() -> None:
    body = refusal_body(REFUSAL)
    assert [one.get("place") for one in body["reasons"]] == [None, None, "tell.ttl:7", "screen.ttl", None, None]
    assert [one.get("place") for one in body["repairs"]] == [None, None, None, "tell.ttl:7", None, None, None]
    (miss,) = body["near_misses"]
    assert miss == {"role": SOURCE, "component": LAMP, "obstacle": "is no Clock", "place": "lamp.ttl:4"}


def test_a_refusal_without_more_has_no_missing_sites_and_no_repairs() -> None:
    body = refusal_body(Refusal(TEMPLATE, (TooFewEligible(SOURCE, 2, 1),)))
    assert body.keys() == {"template", "reasons", "near_misses", "repairs"}
    assert (body["near_misses"], body["repairs"]) == ([], [])


def test_what_is_not_decided_has_a_code_and_says_what_to_allow() -> None:
    assert undecided_body(Undecided(7)) == {
        "code": "undecided",
        "message": "not decided within 7 steps; allow more by steps",
    }
    assert "allow more by seconds" in undecided_body(Undecided(seconds=0.5))["message"]


@pytest.mark.parametrize(
    "body",
    [
        configuration_body(CONFIGURATION),
        refusal_body(REFUSAL),
        consequences_body(CONSEQUENCES),
        cost_body(OPTIMUM, ()),
        undecided_body(Undecided()),
    ],
    ids=["configuration", "refusal", "consequences", "cost", "undecided"],
)
def test_a_body_is_json_and_comes_back_as_it_was(body: Any) -> None:
    assert json.loads(json.dumps(body, allow_nan=False)) == body


# Values.


def test_sixteen_datatypes_are_of_numbers() -> None:
    assert len(DATATYPES) == 16


@pytest.mark.parametrize("datatype", sorted(DATATYPES))
def test_a_number_of_any_datatype_is_a_number(datatype: str) -> None:
    lexical = "-5" if datatype.endswith(("nonPositiveInteger", "negativeInteger")) else "5"
    found = value_body(Literal(lexical, IRI(datatype)))
    assert type(found) is (int if datatype in WHOLE_NUMBERS else float)
    assert found == int(lexical)


@pytest.mark.parametrize(
    ("lexical", "datatype"),
    [
        ("INF", "double"),
        ("-INF", "float"),
        ("NaN", "double"),
        ("five", "integer"),
        ("1_000", "integer"),
        ("٣", "int"),
        ("1.5", "long"),
        ("infinity", "decimal"),
        ("300", "unsignedByte"),
        ("-1", "nonNegativeInteger"),
        ("9" * 5000, "integer"),
        ("maybe", "boolean"),
        ("2026-01-01", "date"),
    ],
)
def test_a_literal_that_json_has_no_value_for_is_its_text(lexical: str, datatype: str) -> None:
    assert value_body(xsd(lexical, datatype)) == lexical


@pytest.mark.parametrize(("lexical", "found"), [("true", True), ("1", True), ("false", False), ("0", False)])
def test_a_truth_value_is_one(lexical: str, found: bool) -> None:
    assert value_body(xsd(lexical, "boolean")) is found


def test_text_and_names_are_text() -> None:
    assert value_body(Literal("5")) == "5"
    assert value_body(Literal("hello", IRI("http://www.w3.org/1999/02/22-rdf-syntax-ns#langString"), "en")) == "hello"
    assert value_body(term("kitchen")) == "https://example.org/home#kitchen"
    assert value_body(BlankNode("_:b0")) == "_:b0"


def test_a_datatype_of_another_namespace_is_no_number() -> None:
    assert value_body(Literal("5", IRI("urn:home#integer"))) == "5"
    assert value_body(Literal("1", IRI("urn:home#boolean"))) == "1"
