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


def test_of_a_composite_it_is_told_which_template_is_inside() -> None:
    good, _ = advertisements.read_advertisements(SERVICE.encode(), "service.ttl")
    body = component_body(FoundAdvertisement(good[0], "site", "service.ttl", startable=False), "alive")
    assert body["inside"] == "localise"
    assert component_body(found("tracker"), "alive")["inside"] == ""
