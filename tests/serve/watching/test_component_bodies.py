"""How the page is told of a component."""

from __future__ import annotations

from selfconf.discovery import FoundAdvertisement
from selfconf.rdf import advertisements
from selfconf.serve.watching.component_bodies import component_body
from tests.composites.composite_house import SERVICE
from tests.serve.shown import found


def test_a_component_is_told_with_its_ports_parameters_and_places() -> None:
    control = component_body(found("control"), "dormant")
    assert control["inputs"][0] == {"name": "localize", "signals": ["rob:Odometry2D"]}
    assert control["parameters"] == [{"name": "goal", "type": "rob:BehaviouralGoal"}]
    tracker = component_body(found("tracker"), "alive")
    assert (tracker["places"], tracker["preference"], tracker["shareable"]) == (["living-room"], 10.0, True)


def test_units_of_ports_and_what_is_optional_is_told_and_so_are_operations_and_the_label() -> None:
    prefixes = "@prefix sc: <https://w3id.org/selfconf#> . @prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> ."
    text = f"""{prefixes} @prefix unit: <http://qudt.org/vocab/unit/> .
    <urn:a> a sc:Component, <urn:Lamp> ; rdfs:label <urn:no-text> , "lamp" ;
        sc:hasInput [ sc:name "level" ; sc:signalType <urn:Level> ; sc:unit unit:LUX ; sc:optional true ] ;
        sc:hasOutput [ sc:name "light" ; sc:signalType <urn:Level> ; sc:unit unit:LUX ] ;
        sc:hasOperation [ sc:name "blink" ; sc:request <urn:Often> ] ;
        sc:needsOperation [ sc:name "power" ; sc:response <urn:Power> ; sc:optional true ] ."""
    (good,), _ = advertisements.read_advertisements(text.encode(), "lamp.ttl")
    body = component_body(FoundAdvertisement(good, "site", "lamp.ttl", startable=False), "alive")
    assert (body["name"], body["label"], body["types"]) == ("a", "lamp", ["<urn:Lamp>"])
    assert (body["site"], body["source"], body["state"]) == ("site", "lamp.ttl", "alive")
    assert body["inputs"] == [
        {"name": "level", "signals": ["<urn:Level>"], "unit": "<http://qudt.org/vocab/unit/LUX>", "optional": True}
    ]
    assert body["outputs"] == [
        {"name": "light", "signals": ["<urn:Level>"], "unit": "<http://qudt.org/vocab/unit/LUX>"}
    ]
    assert body["operations"] == [{"name": "blink", "request": "<urn:Often>"}]
    assert body["needed_operations"] == [{"name": "power", "response": "<urn:Power>", "optional": True}]


def test_of_a_composite_it_is_told_which_template_is_inside() -> None:
    good, _ = advertisements.read_advertisements(SERVICE.encode(), "service.ttl")
    body = component_body(FoundAdvertisement(good[0], "site", "service.ttl", startable=False), "alive")
    assert body["inside"] == "localise"
    assert component_body(found("tracker"), "alive")["inside"] == ""
