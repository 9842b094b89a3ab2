"""Lists and terms in sentences, and what strangers say in one line."""

from __future__ import annotations

from datetime import datetime, timezone

import pytest

from selfconf.model.term import IRI, XSD_NAMESPACE, BlankNode, Literal
from selfconf.model.wording import (
    LONGEST_REMARK,
    MANY,
    as_typed,
    client_text,
    counted,
    in_english,
    in_full,
    in_words,
    is_one_line,
    listed,
    one_line,
    plain,
    utc_text,
    with_article,
)

HALL, CELLAR = (IRI(f"https://example.org/{name}") for name in ("hall", "cellar"))
FIVE = Literal("5", IRI(XSD_NAMESPACE + "integer"))


def test_names_are_listed_as_people_do_and_very_many_are_counted() -> None:
    assert [listed(names) for names in ("", "a", "ab", "abc")] == ["", "a", "a and b", "a, b and c"]
    assert listed(f"r{i}" for i in range(1000)).endswith("r7, r8 and 991 others")
    assert "others" not in listed("a" * MANY)


@pytest.mark.parametrize("steers", ["\x00", "\x1b[2J", "\x9b1m", "\x7f", "\u061c", "\u200f", "\u202e", "\u2066"])
def test_what_steers_a_terminal_is_spelt_out(steers: str) -> None:
    for shown in (plain(f"a{steers}b"), one_line(f"a{steers}b")):
        assert steers[0] not in shown
        assert shown.startswith("a\\")
        assert is_one_line(shown)
    assert not is_one_line(steers)


def test_a_remark_is_a_part_of_one_line_and_not_longer_than_a_screen() -> None:
    assert one_line("a\tb\nLOST c\r\u2028") == r"a\tb\nLOST c\r\u2028"
    assert plain("a\tb\n") == "a\tb\n"
    assert is_one_line("ä 日本 ✓")
    assert one_line("x" * 10_000) == "x" * LONGEST_REMARK + "…"


def test_a_message_is_said_in_english_or_without_a_language_else_in_the_first_one() -> None:
    german, english, plain = ("de", "zu heiß"), ("en-GB", "too hot"), ("", "hot")
    assert in_english([german, english]) == "too hot"
    assert in_english([english, german, plain]) == "hot"
    assert in_english([("fr", "chaud"), german]) == "zu heiß"
    assert in_english([]) == ""


def test_values_are_sorted_and_told_from_others_that_look_alike() -> None:
    assert in_words({HALL, CELLAR, FIVE}) == "5 or cellar or hall"
    assert in_words([Literal("5"), FIVE]) == '"5" or 5'
    assert in_words([BlankNode("_:b"), BlankNode("_:c")]) == "a blank node"  # a label differs from one time to another
    assert in_words([]) == "nothing"
    assert in_full([HALL, FIVE]) == "5 or <https://example.org/hall>"
    assert in_full([]) == "nothing"


def test_a_client_is_named_by_its_certificate_where_it_has_shown_one() -> None:
    assert client_text("read.alice") == "read.alice"
    assert client_text("") == "a client without a trusted certificate"


def test_a_moment_is_said_in_utc_to_the_second() -> None:
    assert utc_text(datetime(2026, 3, 4, 5, 6, 7, 8, timezone.utc)) == "2026-03-04 05:06:07 UTC"


def test_a_path_in_a_command_is_one_argument_and_no_option() -> None:
    assert [as_typed(path) for path in ("a/b.ttl", "my home", "-x")] == ["a/b.ttl", "'my home'", "./-x"]


def test_a_kind_has_the_article_of_its_first_letter() -> None:
    assert [with_article(kind) for kind in ("integer", "IRI", "double", "")] == [
        "an integer",
        "an IRI",
        "a double",
        "a ",
    ]


@pytest.mark.parametrize(("number", "words"), [(0, "0 sites"), (1, "1 site"), (2, "2 sites")])
def test_one_is_one(number: int, words: str) -> None:
    assert counted(number, "site") == words
