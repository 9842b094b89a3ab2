"""The pages of a list that a URL answers: which one follows, and where following ends."""

from __future__ import annotations

import json

import pytest

from selfconf.errors import AuthorError
from selfconf.importing import pages
from selfconf.importing.pages import Pages

HERE = "https://directory.example/wot/things"


def after(*links: str, octets: bytes = b"[]") -> str | None:
    """The page that follows the first one."""
    found = Pages(HERE)
    found.go_on(links, octets)
    return found.url


@pytest.mark.parametrize(
    ("links", "following"),
    [
        ((), None),
        (('</things?offset=10>; rel="next"',), "https://directory.example/things?offset=10"),
        (("<?offset=10>;rel=next",), f"{HERE}?offset=10"),
        (('<https://DIRECTORY.example:443/a#b>; title="a, <b>; rel=x"; REL="start Next"',), "https://DIRECTORY.example:443/a"),
        (("</a>; rel=prev, </b>; rel=next",), "https://directory.example/b"),
        (("</a>; rel=prev", "</b>; rel=next"), "https://directory.example/b"),
        (('</a>; rel="prev"; rel="next"',), None),
        (("</a>; rev=next",), None),
        (('</a>; title="; rel=next"',), None),
        (("</a>; rel=nextest",), None),
        (("no link at all, rel=next",), None),
    ],
)  # fmt: skip
def test_a_link_header_says_which_page_follows(links: tuple[str, ...], following: str | None) -> None:
    assert after(*links) == following


@pytest.mark.parametrize(
    ("said", "following"),
    [
        ({"@type": "ThingCollection", "members": [], "next": "?offset=10"}, f"{HERE}?offset=10"),
        ({"@type": "ThingCollection", "members": []}, None),
        ({"@type": "ThingCollection", "next": 7}, None),
        ({"@type": ["x:List", "ThingCollection"], "next": "/x"}, "https://directory.example/x"),
        ({"@type": "Thing", "title": "ThingCollection", "next": "/x"}, None),
        (["ThingCollection"], None),
    ],
)
def test_a_collection_says_which_page_follows(said: object, following: str | None) -> None:
    assert after(octets=json.dumps(said).encode()) == following


def test_what_is_no_json_is_the_last_page() -> None:
    assert after(octets=b'{"@type": "ThingCollection", "next"') is None


def test_a_url_that_none_can_be_is_told_without_its_control_characters_and_in_part() -> None:
    for following in ("/a\x1b[2J", "/a\u202eb", "/a b", "/" + "a" * 3000):
        found = Pages(HERE)
        with pytest.raises(AuthorError, match="which is no URL") as raised:
            found.go_on([], json.dumps({"@type": "ThingCollection", "next": following}).encode())
        assert str(raised.value).isprintable()
        assert len(str(raised.value)) < 300
        assert found.url is None


@pytest.mark.parametrize(
    ("link", "words"),
    [
        ("<http://directory.example/wot/things?2>; rel=next", "which is another server; name that as well"),
        ("<//elsewhere.example/things>; rel=next", "which is another server"),
        ("<https://[::1/>; rel=next", "which is no URL"),
        ("<mailto:a@b.example>; rel=next", "which is no URL"),
        ("<things>; rel=next", "which was read before"),
    ],
)
def test_a_page_that_is_not_to_be_read_is_named_and_none_is_left(link: str, words: str) -> None:
    found = Pages(HERE)
    with pytest.raises(AuthorError, match=words):
        found.go_on([link], b"[]")
    assert found.url is None


@pytest.mark.parametrize("link", ["<a>; x" + " " * 60_000, "<" * 60_000, '<a>; b="' * 8_000, "<a>" + "; b" * 20_000])
def test_a_header_that_is_made_to_take_long_does_not(link: str) -> None:
    assert after(link) is None


def test_pages_without_end_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pages, "MOST_PAGES", 3)
    found = Pages(HERE)
    for number in (2, 3):
        found.go_on([f"<?{number}>; rel=next"], b"[]")
        assert found.number == number
    with pytest.raises(AuthorError, match="goes on, and 3 pages were read"):
        found.go_on(["<?4>; rel=next"], b"[]")
