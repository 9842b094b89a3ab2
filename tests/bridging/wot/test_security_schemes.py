"""What each security scheme adds to a request, and which ones cannot be served."""

from __future__ import annotations

from typing import Any

import pytest

from selfconf.bridging.wot.security_schemes import UnusableFormError, proof_of_identity

TOLD = {"username": "me", "password": "secret", "token": "secret", "key": "secret"}


@pytest.mark.parametrize(
    ("definition", "place", "header"),
    [
        ({"scheme": "basic"}, "header", ("Authorization", "Basic bWU6c2VjcmV0")),
        ({"scheme": "bearer"}, "header", ("Authorization", "Bearer secret")),
        ({"scheme": "bearer", "name": "X-T"}, "header", ("X-T", "Bearer secret")),
        ({"scheme": "bearer", "in": "cookie", "name": "t"}, "cookie", ("Cookie", "t=secret")),
        ({"scheme": "apikey", "name": "api"}, "query", None),
        ({"scheme": "apikey", "in": "cookie", "name": "id"}, "cookie", ("Cookie", "id=secret")),
    ],
)
def test_a_scheme_adds_what_it_asks_for(definition: Any, place: str, header: Any) -> None:
    proof = proof_of_identity("s", definition, TOLD, "http://a")
    assert proof is not None
    assert (proof.place, proof.header) == (place, header)
    assert "secret" not in repr(proof)


def test_a_bearer_token_stands_alone_in_a_query() -> None:
    proof = proof_of_identity("s", {"scheme": "bearer", "in": "query", "name": "access_token"}, TOLD, "http://a")
    assert proof is not None
    assert (proof.place, proof.name, proof.text) == ("query", "access_token", "secret")


def test_no_security_adds_nothing() -> None:
    assert proof_of_identity("s", {"scheme": "nosec"}, {}, "http://a") is None


@pytest.mark.parametrize(
    ("definition", "words"),
    [
        (None, "'s'; a bridge knows nosec"),
        ({"scheme": ["basic"]}, "a bridge knows nosec"),
        ({"scheme": "digest"}, "'digest'"),
        ({"scheme": "apikey"}, "the name of its query"),
        ({"scheme": "apikey", "name": 7}, "the name of its query"),
        ({"scheme": "apikey", "name": "a\r\nb", "in": "header"}, "the name of its header"),
        ({"scheme": "apikey", "name": "a", "in": "uri"}, "header, query and cookie"),
    ],
)
def test_a_scheme_that_cannot_be_served_is_a_sentence(definition: Any, words: str) -> None:
    with pytest.raises(UnusableFormError) as raised:
        proof_of_identity("s", definition, TOLD, "http://a")
    assert words in str(raised.value)
    assert "secret" not in str(raised.value)


def test_what_is_missing_is_named() -> None:
    with pytest.raises(UnusableFormError, match="http://a asks for username and password; put them into a file"):
        proof_of_identity("s", {"scheme": "basic"}, {"token": "secret"}, "http://a")
