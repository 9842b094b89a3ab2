"""Which request a form stands for, and what keeps a bridge from making it."""

from __future__ import annotations

from base64 import b64decode
from typing import Any

import pytest

from selfconf.bridging.wot.forms import FOLLOWED
from tests.bridging.wot.things import forms_of

BASE = "http://192.0.2.7/"


def one(form: dict[str, Any], operation: str = "readproperty", **thing: Any) -> Any:
    """The form that is found for an affordance with one, or the sentence that says why there is none."""
    forms = forms_of(
        {"base": BASE, **thing}, {"http://192.0.2.7": {"username": "u", "password": "p", "token": "t", "key": "k"}}
    )
    return forms.find({"forms": [form]}, operation, ("", *FOLLOWED)) or next(iter(forms.problems), None)


def test_a_form_has_the_method_of_its_operation() -> None:
    for operation, method in (("readproperty", "GET"), ("writeproperty", "PUT"), ("invokeaction", "POST")):
        found = one({"href": "on"}, operation)
        assert (found.method, found.url, found.media) == (method, "http://192.0.2.7/on", "application/json")
    assert one({"href": "on", "htv:methodName": "PATCH"}, "writeproperty").method == "PATCH"


def test_what_is_answered_may_be_of_another_media_type_than_what_is_sent() -> None:
    found = one({"href": "snap", "response": {"contentType": "image/jpeg"}}, "invokeaction")
    assert (found.media, found.answered) == ("application/json", "image/jpeg")
    for nothing in ({}, {"contentType": 7}, "image/jpeg"):
        assert one({"href": "on", "contentType": "text/plain", "response": nothing}).answered == "text/plain"


def test_a_form_that_does_not_say_its_operation_observes_nothing() -> None:
    assert one({"href": "on"}, "observeproperty") is None
    assert one({"href": "on", "op": "observeproperty", "subprotocol": "sse"}, "observeproperty").subprotocol == "sse"
    assert one({"href": "on", "op": ["writeproperty"]}) is None


def test_the_preferred_subprotocol_counts_and_then_the_order() -> None:
    affordance = {"forms": [
        {"href": "a", "op": "observeproperty", "subprotocol": "longpoll"},
        {"href": "b", "op": "observeproperty", "subprotocol": "sse"},
        {"href": "c", "op": "observeproperty", "subprotocol": "sse"},
        {"href": "d", "op": "observeproperty", "subprotocol": "websub"},
    ]}  # fmt: skip
    found = forms_of({"base": BASE}).find(affordance, "observeproperty", FOLLOWED)
    assert found is not None
    assert found.url == "http://192.0.2.7/b"


def test_of_two_forms_of_a_property_the_one_with_json_counts() -> None:
    cbor = {"href": "a", "contentType": "application/cbor"}
    for media in ("application/json; charset=utf-8", "application/senml+json"):
        forms = forms_of({"base": BASE})
        found = forms.find({"forms": [cbor, {"href": "b", "contentType": media}]}, "readproperty")
        assert found is not None
        assert (found.url, found.media) == ("http://192.0.2.7/b", media)
    assert one(cbor).media == "application/cbor"


def test_a_form_counts_from_the_base_else_from_where_the_description_comes_from() -> None:
    forms = forms_of({}, place="http://127.0.0.1:8080/things/lamp")
    found = forms.find({"forms": [{"href": "on"}]}, "readproperty")
    assert found is not None
    assert found.url == "http://127.0.0.1:8080/things/on"


def test_a_form_that_counts_from_a_base_with_uri_variables_is_named_and_one_that_does_not_is_used() -> None:
    forms = forms_of({"base": "http://192.0.2.7/{room}/"})
    assert forms.find({"forms": [{"href": "on"}]}, "readproperty") is None
    assert "URI variables" in "".join(forms.problems)
    found = forms.find({"forms": [{"href": "/on"}]}, "readproperty")
    assert found is not None
    assert found.url == "http://192.0.2.7/on"


@pytest.mark.parametrize(
    ("form", "words"),
    [
        ({}, "no href"),
        ({"href": 7}, "no href"),
        ({"href": "on{?x}"}, "URI variables"),
        ({"href": "coap://192.0.2.7/on"}, "no http or https URL"),
        ({"href": "http://192.0.2.7:x/"}, "no http or https URL"),
        ({"href": "http://elsewhere.example/on"}, "allow it with host='elsewhere.example'"),
        ({"href": "on", "htv:methodName": "BREW"}, "'BREW'"),
        ({"href": "on", "htv:methodName": ["GET"]}, "['GET']"),
        ({"href": "on\r\nX: y"}, "no http or https URL"),
        ({"href": "http://192.0.2.7/o n"}, "no http or https URL"),
    ],
)
def test_a_form_that_cannot_be_used_is_named_with_its_reason(form: dict[str, Any], words: str) -> None:
    assert words in one(form)


SCHEMES: dict[str, Any] = {
    "open": {"scheme": "nosec"},
    "basic": {"scheme": "basic"},
    "bearer": {"scheme": "bearer", "in": "header", "name": "X-Token"},
    "query": {"scheme": "apikey", "name": "api"},
    "header": {"scheme": "apikey", "in": "header", "name": "X-Key"},
    "cookie": {"scheme": "apikey", "in": "cookie", "name": "session"},
    "body": {"scheme": "apikey", "in": "body", "name": "key"},
    "nameless": {"scheme": "apikey", "in": "header", "name": "a b"},
    "oauth": {"scheme": "oauth2"},
}


def secured(name: str, **form: Any) -> Any:
    return one({"href": "on", **form}, securityDefinitions=SCHEMES, security=name)


def test_each_scheme_is_served_as_it_asks() -> None:
    assert not secured("open").headers
    scheme, _, value = secured("basic").headers["Authorization"].partition(" ")
    assert (scheme, b64decode(value)) == ("Basic", b"u:p")
    assert secured("bearer").headers == {"X-Token": "Bearer t"}
    assert secured("query").query == (("api", "k"),)
    assert secured("header").headers == {"X-Key": "k"}
    assert secured("cookie").headers == {"Cookie": "session=k"}
    both = secured("open", security=["basic", "query"])
    assert both.query
    assert both.headers


def test_nothing_that_is_told_stands_in_a_repr() -> None:
    for name in ("basic", "bearer", "query", "header", "cookie"):
        shown = repr(secured(name)) + str(secured(name))
        assert "Bearer" not in shown
        assert "Basic" not in shown
        assert "'k'" not in shown


@pytest.mark.parametrize(
    ("name", "words"),
    [("body", "header, query and cookie"), ("nameless", "the name"), ("oauth", "'oauth2'"), ("x", "'x'")],
)
def test_a_scheme_that_cannot_be_served_is_named(name: str, words: str) -> None:
    assert words in secured(name)


def test_who_is_told_nothing_is_told_what_is_missing() -> None:
    forms = forms_of({"base": BASE, "securityDefinitions": SCHEMES, "security": "basic"})
    assert forms.find({"forms": [{"href": "on"}]}, "readproperty") is None
    (problem,) = forms.problems
    assert problem.startswith("http://192.0.2.7 asks for username and password")


def test_a_description_cannot_have_a_credential_sent_elsewhere() -> None:
    stranger = one({"href": "http://198.51.100.1/on"}, securityDefinitions=SCHEMES, security="basic")
    assert "http://198.51.100.1 asks for" in stranger
    trick = one({"href": "http://192.0.2.7@198.51.100.1/on"}, securityDefinitions=SCHEMES, security="basic")
    assert "http://198.51.100.1 asks for" in trick
