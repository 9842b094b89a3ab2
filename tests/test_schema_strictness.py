"""The JSON Schemas refuse what no command prints: a member more or less, another type."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from typing import Any

import pytest

from docs import json_schemas
from tests.test_schemas import SCHEMAS, validator


def changed(body: Any, path: str) -> Iterator[tuple[str, Any]]:
    """A JSON value with one thing wrong, in every place: a member more, a member less, another type."""
    if isinstance(body, dict):
        yield f"{path} with a member more", {**body, "no such member": 1}
        for key, part in body.items():
            if path.rpartition(".")[2] not in OPEN:
                yield f"{path} without {key}", {k: v for k, v in body.items() if k != key}
            yield f"{path}.{key} as something else", {**body, key: [[body]]}
            for what, wrong in changed(part, f"{path}.{key}"):
                yield what, {**body, key: wrong}
    elif isinstance(body, list):
        for number, part in enumerate(body[:2]):
            for what, wrong in changed(part, f"{path}[{number}]"):
                one_wrong = copy.copy(body)
                one_wrong[number] = wrong
                yield what, one_wrong


OPEN = frozenset(("bindings", "lost", "dropped", "eligible", "values", "issued", "rates", "value"))
"""Members whose own members have names that an author gives: any may be missing."""
OPTIONAL = frozenset(
    (
        "candidates",
        "total",
        "unknown_terms",
        "total_proved",
        "additions",
        "cost",
        "what_if",
        "insides",
        "place",
        "role",
        "datatype",
    )
)
"""Members that some answers do not have."""


@pytest.mark.parametrize("command", [name for name in json_schemas.COMMANDS if name != "query"])
def test_a_member_more_or_less_or_of_another_type_is_refused(command: str) -> None:
    judge, tried = validator(command), 0
    for example in SCHEMAS[command]["examples"]:
        for what, wrong in changed(example, ""):
            tried += 1
            missing = what.rpartition(" without ")[2]
            if ".value" in what and command == "echo":
                continue  # a signal may be anything
            author_named = what.endswith("a member more") and what.split(" ")[0].rpartition(".")[2] in OPEN
            if missing not in OPTIONAL and not (author_named and "eligible" not in what):
                assert not judge.is_valid(wrong), what
    assert tried >= 3


@pytest.mark.parametrize(
    "body",
    [
        {},
        {"head": {"vars": []}},
        {"head": {"vars": ["c"]}, "results": {"bindings": [{"c": {"type": "triple", "value": "x"}}]}},
        {"head": {"vars": ["c"]}, "results": {"bindings": [{"c": {"type": "uri", "value": "x:y", "xml:lang": "en"}}]}},
        {"head": {}, "boolean": "yes"},
        {"head": {}, "boolean": True, "results": {"bindings": []}},
        [{"@type": ["x:y"]}],
    ],
    ids=str,
)
def test_what_is_no_answer_to_a_query_is_refused(body: Any) -> None:
    assert not validator("query").is_valid(body)
