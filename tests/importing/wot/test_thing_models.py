"""What a Thing Model takes from others."""

from __future__ import annotations

from typing import Any

from selfconf.errors import AuthorError
from selfconf.importing.ledger import ImportLedger
from selfconf.importing.sources import SourceDocument
from selfconf.importing.wot.thing_models import ModelReferences

BASE = {"title": "Base", "properties": {"on": {"@type": "x:A", "readOnly": True}, "dim": {"unit": "%"}}}


def resolved(thing: dict[str, Any], others: dict[str, Any] | None = None) -> tuple[dict[str, Any], int]:
    ledger = ImportLedger("urn:x:", list[AuthorError]().append)
    references = ModelReferences({"base/lamp.tm.json": BASE, **(others or {})}, ledger)
    found = references.resolved(thing, SourceDocument("s", "rooms/lamp.json", b""))
    return found, sum(each.number for each in ledger.omissions())


def test_a_reference_into_another_source_is_followed_and_changed_by_what_stands_beside_it() -> None:
    reference = "../base/lamp.tm.json#/properties/on"
    found, missing = resolved({"properties": {"light": {"tm:ref": reference, "readOnly": None, "unit": "lux"}}})
    assert found["properties"] == {"light": {"@type": "x:A", "unit": "lux"}}
    assert missing == 0


def test_a_reference_may_lead_to_the_same_document_and_on() -> None:
    thing = {"properties": {"a": {"tm:ref": "#/properties/b"}, "b": {"tm:ref": "#/properties/c"}, "c": {"unit": "m"}}}
    found, missing = resolved(thing)
    assert found["properties"] == {name: {"unit": "m"} for name in "abc"}
    assert missing == 0


def test_a_model_extends_another_one() -> None:
    links = [{"rel": "tm:extends", "href": "../base/lamp.tm.json"}]
    found, missing = resolved({"title": "Mine", "links": links, "properties": {"dim": {"unit": "lux"}, "on": None}})
    assert found["title"] == "Mine"
    assert found["properties"] == {"dim": {"unit": "lux"}}
    assert missing == 0


def test_a_reference_to_what_is_not_there_is_noted_and_nothing_is_fetched() -> None:
    thing = {
        "links": [{"rel": "tm:extends", "href": "http://192.0.2.1/model"}],
        "properties": {"a": {"tm:ref": "#/nowhere", "unit": "m"}},
    }
    found, missing = resolved(thing)
    assert found["properties"] == {"a": {"unit": "m"}}
    assert missing == 2


def test_a_circle_of_references_ends() -> None:
    circle = {"properties": {"a": {"tm:ref": "#/properties/b"}, "b": {"tm:ref": "#/properties/a"}}}
    found, missing = resolved(circle)
    assert set(found["properties"]) == {"a", "b"}
    assert missing == 2
    links = [{"rel": "tm:extends", "href": "lamp.json"}]
    assert resolved({"links": links}, {"rooms/lamp.json": {"title": "x", "links": links}})[1] > 0


def test_each_reference_of_circles_is_counted_once() -> None:
    thing = {
        "links": [{"rel": "tm:extends", "href": "lamp.json"}],
        "properties": {"a": {"tm:ref": "#/properties/b"}, "b": {"tm:ref": "#/properties/a"}},
    }
    _, missing = resolved(thing, {"rooms/lamp.json": thing})
    assert missing == 3


def test_a_model_may_extend_several_and_keeps_its_own_identifier() -> None:
    others = {"a.json": {"id": "urn:a", "actions": {"x": {}}}, "b.json": {"actions": {"y": {}}, "@type": "x:B"}}
    links = [{"rel": "tm:extends", "href": f"../{name}.json"} for name in "ab"]
    found, missing = resolved({"links": links, "actions": {"z": {}}}, others)
    assert found == {"links": links, "actions": {"x": {}, "y": {}, "z": {}}, "@type": "x:B"}
    assert missing == 0


def test_references_of_a_model_count_from_where_it_lies() -> None:
    far = {"properties": {"a": {"tm:ref": "near.json#/properties/b"}}}
    others = {"base/far.json": far, "base/near.json": {"properties": {"b": {"unit": "m"}}}}
    found, missing = resolved({"properties": {"a": {"tm:ref": "../base/far.json#/properties/a"}}}, others)
    assert (found["properties"], missing) == ({"a": {"unit": "m"}}, 0)


def test_references_that_lead_to_ever_more_end() -> None:
    links = [{"rel": "tm:extends", "href": "lamp.json"}] * 10
    found, missing = resolved({"links": links}, {"rooms/lamp.json": {"links": links}})
    assert found == {"links": links}
    assert missing > 0
