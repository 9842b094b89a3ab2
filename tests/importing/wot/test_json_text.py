"""JSON as strangers write it."""

from __future__ import annotations

import pytest

from selfconf.errors import AuthorError
from selfconf.importing.sources import SourceDocument
from selfconf.importing.wot.json_text import DEEPEST_JSON, JsonText, one_or_several, parse_json


def source(text: str) -> SourceDocument:
    return SourceDocument("x.json", "x.json", text.encode())


def test_the_value_and_the_names_that_occur_twice() -> None:
    assert parse_json(source('{ "a": 1, "b": { "c": 1, "c": 2 }, "a": 3 }')) == JsonText(
        {"a": 3, "b": {"c": 2}}, ("c", "a")
    )


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('{\n  "a": 1\n:}', r"x\.json:3:1: this is not JSON"),
        ("", r"x\.json:1:1: this is not JSON"),
        ('{\n "NaN": [1, NaN]}', r"x\.json:2:13: this is not JSON: NaN is no number of JSON"),
        ("[-Infinity]", r"x\.json:1:2: this is not JSON: -Infinity is no number of JSON"),
        ("9" * 5000, "more digits than can be read"),
        (r'["\ud83d"]', "half of a surrogate pair"),
        ("[" * 100_000 + "]" * 100_000, r"x\.json:1:101: its JSON is nested more than 100 levels deep"),
        ('{"a":' * 100_000, "nested more than 100 levels deep"),
        ('["' + '\\"' * 200, "this is not JSON"),
    ],
    ids=range(9),
)
def test_what_cannot_be_read_is_one_sentence(text: str, words: str) -> None:
    with pytest.raises(AuthorError, match=words):
        parse_json(source(text))


def test_brackets_in_strings_are_not_depth_and_a_pair_of_surrogates_is_a_character() -> None:
    text = r'["\ud83d\ude00", "' + "[{" * 200 + '"]'
    assert parse_json(source(text)).value[0] == "\U0001f600"


def test_as_deep_as_it_may_be() -> None:
    assert parse_json(source("[" * DEEPEST_JSON + "]" * DEEPEST_JSON + " " * 10)).value
    assert parse_json(source(f"[{'[],' * DEEPEST_JSON}{'[' * (DEEPEST_JSON - 1)}{']' * (DEEPEST_JSON - 1)}]")).value


@pytest.mark.parametrize(
    ("value", "several"), [(None, []), ("a", ["a"]), (["a", "b"], ["a", "b"]), ([], []), ({"a": 1}, [{"a": 1}])]
)
def test_a_member_holds_one_value_or_several_or_none(value: object, several: list[object]) -> None:
    assert one_or_several(value) == several
