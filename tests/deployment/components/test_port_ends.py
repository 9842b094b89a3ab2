"""Where connections end: at the ports themselves, inside of a composite, or outside of the one that a task is in."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.configurator import Caller
from selfconf.deployment import Outside
from selfconf.deployment.components import PortEnds
from selfconf.discovery import EcologyView
from selfconf.model.configuration import Configuration, Connection
from selfconf.protocol.messages import Wire
from tests.faults.ecologies import COMPOSED
from tests.lab import ADVERTISEMENTS, Lab, iri

CAMERA, FILTER, LOOKOUT, DISPLAY = map(iri, ("camera", "filter", "lookout", "display"))


def ends(lab: Lab, outside: Outside | None = None) -> PortEnds:
    """Those of a task in an ecology in which nothing was discovered."""
    return PortEnds(EcologyView(lab.network.node(), "lab"), outside)


def test_the_output_of_a_component_is_its_own_end(lab: Lab) -> None:
    found = ends(lab)
    assert found.wires({"in": (Wire(CAMERA, "out"),)}) == {"in": (Wire(CAMERA, "out"),)}
    assert found.callers({"show()": (Caller(CAMERA, "show()"),)}) == {"show()": (CAMERA,)}


@pytest.mark.parametrize(("value", "period"), [("4", 0.25), ("1e-310", None)])
def test_a_promised_rate_is_the_longest_pause_of_a_wire(tmp_path: Path, value: str, period: float | None) -> None:
    rate = f"sc:rate [ sc:value {value} ; sc:unit unit:HZ ] ;"
    rated = ADVERTISEMENTS["tracker"].replace('sc:name "pose" ;', f'sc:name "pose" ; {rate}')
    lab = Lab(tmp_path, advertised={**ADVERTISEMENTS, "tracker": rated})
    lab.navigation()
    agent = lab.agent()
    assert lab.running(agent)
    tracker, odometry = iri("person-tracker"), iri("absolute-odometry")
    found = PortEnds(agent.ecology, None).wires({"in": (Wire(tracker, "pose"), Wire(odometry, "pose"))})
    assert found == {"in": (Wire(tracker, "pose", period), Wire(odometry, "pose"))}


def test_what_stands_behind_a_composite_is_in_its_place(lab: Lab) -> None:
    found = ends(lab)
    inside = {"picture": (Wire(CAMERA, "out"), Wire(FILTER, "out"))}
    assert found.moved(LOOKOUT, inside, {"show()": (FILTER,)}), "others may be called by what is inside"
    assert not found.moved(LOOKOUT, inside, {"show()": (FILTER,)}), "the same as before"
    assert found.wires({"in": (Wire(LOOKOUT, "picture"),)}) == {"in": inside["picture"]}
    assert found.callers({"show()": (Caller(LOOKOUT, "show()"), Caller(FILTER, "show()"))}) == {"show()": (FILTER,)}
    assert found.moved(LOOKOUT, {"picture": ()}, {"show()": (FILTER,)})
    assert found.wires({"in": (Wire(LOOKOUT, "picture"),)}) == {"in": ()}, "nothing issues it now"
    assert found.wires({"in": ()}) == {"in": ()}


def test_the_inside_of_a_composite_is_fed_and_called_by_what_is_outside(lab: Lab) -> None:
    outside = Outside(
        LOOKOUT,
        lambda: {"light": (Wire(CAMERA, "lux"),), "dim": ()},
        lambda operation: (DISPLAY,) if operation == "look()" else (),
    )
    found = ends(lab, outside)
    wires = {"in": (Wire(LOOKOUT, "light"),), "later": (Wire(LOOKOUT, "dim"),), "other": (Wire(LOOKOUT, "dark"),)}
    assert found.wires(wires) == {"in": (Wire(CAMERA, "lux"),), "later": ()}
    assert found.callers({"look()": (Caller(LOOKOUT, "look()"),)}) == {"look()": (DISPLAY,)}


def test_what_a_composite_issues_and_calls_outside_is_that_of_its_inside(lab: Lab) -> None:
    configuration = Configuration(
        iri("look"),
        (),
        (
            Connection(FILTER, "out", LOOKOUT, "picture"),
            Connection(LOOKOUT, "show()", FILTER, "show()"),
            Connection(CAMERA, "out", FILTER, "in"),
        ),
    )
    found = ends(lab, Outside(LOOKOUT))
    assert found.issued_outside(configuration) == {"picture": (Wire(FILTER, "out"),)}
    assert found.calling_outside(configuration) == {"show()": (FILTER,)}
    assert ends(lab).issued_outside(configuration) == {}
    assert found.stands_outside(FILTER, configuration)
    assert not found.stands_outside(CAMERA, configuration)


def test_who_was_connected_to_a_composite_before_it_was_known_what_stands_behind_it_is_to_be_connected_anew(
    tmp_path: Path,
) -> None:
    lab = Lab(tmp_path, advertised=COMPOSED.advertisements)
    for site, names in COMPOSED.sites.items():
        lab.site(site, *names)
    ecology = lab.agent(COMPOSED.whole, ()).ecology
    lab.let_pass(1.0)
    service, inside = iri("service"), {"pose": (Wire(iri("tracker-1"), "track"),)}
    early, late = PortEnds(ecology, None), PortEnds(ecology, None)
    wanted, asking = {"position": (Wire(service, "pose"),)}, {"shine()": (Caller(service, "light()"),)}
    assert early.unknown(wanted, {}) == early.unknown({}, asking) == {service}
    assert early.wires(wanted) == wanted
    assert early.moved(service, inside, {})
    assert early.unknown(wanted, asking) == set()
    assert not late.moved(service, inside, {}), "all that it feeds is connected later"
