"""What becomes of each affordance of a thing, and which component the thing therefore is."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from selfconf.bridging.wot.interactions import ThingInteractions, interactions
from selfconf.importing import ImportedDocument, described_text
from selfconf.rdf.advertisements import read_advertisements
from tests.bridging.thing_server import CONTEXT, ROB
from tests.bridging.wot.things import described, forms_of
from tests.lab import PREFIXES

SWITCH = {"@type": "rob:Switch", "type": "boolean"}


def found(rate: float = 2.0, ontologies: tuple[Path, ...] = (), **members: Any) -> ThingInteractions:
    description = {"@context": CONTEXT, "id": "urn:thing:lamp", "title": "lamp", "base": "http://192.0.2.7/", **members}
    return interactions(described(description), forms_of(description), rate, ontologies)


def test_what_can_be_observed_is_followed_and_the_rest_promises_the_rate() -> None:
    sse = {"href": "on/changes", "op": "observeproperty", "subprotocol": "sse"}
    thing = found(
        properties={
            "on": {**SWITCH, "readOnly": True, "forms": [{"href": "on"}, sse]},
            "level": {"type": "number", "readOnly": True, "forms": [{"href": "level"}]},
        },
        events={"pressed": {"forms": [{"href": "pressed", "subprotocol": "longpoll"}]}},
    )
    on, level, pressed = thing.outputs
    assert on.read is not None
    assert on.follow is not None
    assert (on.polled, level.polled, pressed.polled) == (False, True, False)
    assert pressed.read is None
    assert thing.probe is on.read
    assert thing.readable
    text = described_text(ImportedDocument("", "", (thing.component.described(),), {}))
    ((advertisement,), bad) = read_advertisements(text.encode(), "lamp.ttl", "file:///lamp.ttl")
    assert not bad
    assert {port.name: port.rate for port in advertisement.profile.outputs} == {
        "on": None,
        "level": 2.0,
        "pressed": None,
    }


def test_an_event_with_the_name_of_a_property_is_followed_and_that_property_read() -> None:
    thing = found(
        properties={
            "level": {"type": "number", "readOnly": True, "forms": [{"href": "level"}]},
            "goal": {"type": "number", "writeOnly": True, "forms": [{"href": "goal"}]},
        },
        events={each: {"forms": [{"href": f"{each}/news", "subprotocol": "sse"}]} for each in ("level", "goal")},
    )
    assert [(each.name, each.read and each.read.url, each.follow and each.follow.url) for each in thing.outputs] == [
        ("level", "http://192.0.2.7/level", None),
        ("event level", None, "http://192.0.2.7/level/news"),
        ("event goal", None, "http://192.0.2.7/goal/news"),
    ]
    assert [each.name for each in thing.inputs] == ["goal"]


def test_what_is_said_in_the_terms_of_selfconf_alone_is_nothing_that_a_thing_can_do() -> None:
    sc = "https://w3id.org/selfconf#"
    rate = {f"{sc}value": 9, f"{sc}unit": {"@id": "http://qudt.org/vocab/unit/HZ"}}
    thing = found(
        properties={"level": {"readOnly": True, f"{sc}rate": rate, "forms": [{"href": "level"}]}},
        **{f"{sc}{term}": {f"{sc}name": "x"} for term in ("hasInput", "hasOperation", "needsOperation")},
    )
    component = thing.component
    assert (component.inputs, component.operations, component.needs, component.parameters) == ((), (), (), ())
    assert thing.problems == ()
    text = described_text(ImportedDocument("", "", (component.described(),), {}))
    ((advertisement,), _) = read_advertisements(text.encode(), "lamp.ttl", "file:///lamp.ttl")
    assert [port.rate for port in advertisement.profile.outputs] == [2.0]


def test_a_plain_value_is_the_one_field_of_its_type() -> None:
    thing = found(
        properties={
            "on": {**SWITCH, "forms": [{"href": "a"}]},
            "whole": {"@type": "rob:Switch", "type": "object", "forms": [{"href": "b"}]},
            "pose": {"@type": "rob:PlanarPose2D", "forms": [{"href": "c"}]},
            "other": {"type": "boolean", "forms": [{"href": "d"}]},
        }
    )
    assert {each.name: each.field for each in thing.outputs} == {"on": "on", "whole": None, "pose": None, "other": None}
    assert {each.name: each.field for each in thing.inputs} == {"on": "on", "whole": None, "pose": None, "other": None}


def test_the_fields_of_types_are_known_by_further_ontologies_too(tmp_path: Path) -> None:
    volume = {"@type": "https://example.org/x#Volume", "type": "number", "forms": [{"href": "volume"}]}
    told = tmp_path / "words.ttl"
    told.write_text(
        PREFIXES + '<https://example.org/x#Volume> rdfs:subClassOf rob:Signal ; rob:field ( [ rob:fieldName "litres" ; '
        "rob:datatype xsd:double ] ) ."
    )

    def field_of(*ontologies: Path) -> tuple[str | None, tuple[str, ...]]:
        thing = found(properties={"volume": volume}, ontologies=ontologies)
        return thing.outputs[0].field, thing.problems

    assert field_of() == (None, ())
    assert field_of(tmp_path) == ("litres", ())
    broken = tmp_path / "broken.ttl"
    broken.write_text("no Turtle")
    field, (problem,) = field_of(broken)
    assert field is None
    assert "broken.ttl:1:" in problem


def test_an_action_is_an_operation_and_an_input_that_calls_it() -> None:
    thing = found(
        properties={"fade": {"type": "number", "forms": [{"href": "a"}]}},
        actions={
            "fade": {
                "input": {"@type": "rob:Switch", "type": "boolean"},
                "output": {"@type": "rob:Temperature", "type": "number"},
                "forms": [{"href": "b"}],
            },
            "blink": {"forms": [{"href": "c"}]},
        },
    )
    assert [(each.name, each.action, each.empty, each.field) for each in thing.inputs] == [
        ("fade", False, False, None),
        ("call fade", True, False, "on"),
        ("blink", True, True, None),
    ]
    assert [port.name for port in thing.component.inputs] == ["fade", "call fade", "blink"]
    assert all(port.optional for port in thing.component.inputs)
    assert [(each.name, each.request, each.response) for each in thing.component.operations] == [
        ("fade", f"{ROB}Switch", f"{ROB}Temperature"),
        ("blink", None, None),
    ]
    fade, blink = thing.operations
    assert (fade.request_field, fade.response_field, fade.empty, fade.answers) == ("on", "temperature", False, True)
    assert (blink.request_field, blink.response_field, blink.empty, blink.answers) == (None, None, True, False)


def test_what_has_no_form_that_can_be_used_is_not_advertised_and_named() -> None:
    thing = found(
        properties={
            "on": {**SWITCH, "forms": [{"href": "coap://192.0.2.7/on"}]},
            "off": {**SWITCH},
            "level": {"readOnly": True, "forms": [{"href": "level", "op": "observeproperty"}]},
        },
        events={"pressed": {"forms": [{"href": "pressed", "subprotocol": "websub"}]}},
        actions={"blink": {"forms": [{"href": "mqtt://192.0.2.7/x"}]}},
    )
    assert thing.component.inputs == thing.component.outputs == ()
    assert thing.component.operations == ()
    assert thing.probe is None
    assert thing.problems == (
        "the form 'coap://192.0.2.7/on' leads to no http or https URL",
        "no form of 'off' is by HTTP, plain or by sse or longpoll",
        "no form of 'level' is by HTTP, plain or by sse or longpoll",
        "no form of 'pressed' is by HTTP, plain or by sse or longpoll",
        "the form 'mqtt://192.0.2.7/x' leads to no http or https URL",
        "so the output 'on', the input 'on' and the operation 'blink' are left out",
    )


def test_a_thing_that_cannot_be_read_is_looked_for_where_it_takes_something() -> None:
    thing = found(actions={"blink": {"forms": [{"href": "blink"}]}})
    assert thing.probe is not None
    assert thing.probe.method == "POST"
    assert not thing.readable


def test_what_is_described_with_more_offers_what_it_did_before() -> None:
    on, off = {**SWITCH, "forms": [{"href": "on"}]}, {**SWITCH, "forms": [{"href": "off"}]}
    before = found(properties={"on": on})
    assert found(properties={"off": off, "on": on}, description="by the door").offers(before)
    assert not before.offers(found(properties={"on": on, "off": off}))
    assert not found(properties={"on": {**on, "forms": [{"href": "elsewhere"}]}}).offers(before)
    assert not found(properties={"on": {**on, "@type": "rob:Text"}}).offers(before)
