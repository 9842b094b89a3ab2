"""What an observer sees of an ecology in memory: components, tasks, failures, and what takes over."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from selfconf.bus.memory import MemoryBus
from selfconf.bus.port import Request, Urgency
from selfconf.discovery.inquiry import DISCOVERY_ATTEMPTS
from selfconf.rdf.provenance import CONFIGURATION
from selfconf.serve.watching.change import EcologyChange
from selfconf.serve.watching.task_watcher import DEPLOYED, LOOK_ANEW
from selfconf.serve.watching.watcher import ASKED_AGAIN, EcologyWatcher
from selfconf.site.site import Site
from tests.lab import Lab, iri


class Seen:
    """All that a watcher has told, merged."""

    def __init__(self, lab: Lab) -> None:
        self.components: dict[str, Any] = {}
        self.tasks: dict[str, Any] = {}
        self.sites: dict[str, Any] = {}
        self.graphs: dict[str, bytes] = {}
        self.events: list[Any] = []
        self.changes = 0
        self.links: list[str] = []
        self.watcher = EcologyWatcher(lab.network.node(), "lab", self.take, lambda: lab.network.time)
        self.watcher.begin()

    def take(self, change: EcologyChange) -> None:
        self.changes += 1
        for known, new in (
            (self.components, change.components),
            (self.tasks, change.tasks),
            (self.sites, change.sites),
            (self.graphs, {**change.graphs, **change.deployed}),
        ):
            for name, body in new.items():
                if body:
                    known[name] = body
                else:
                    known.pop(name, None)
        self.events += change.events
        self.links += [change.link] if change.link else []

    @property
    def task(self) -> Any:
        (task,) = self.tasks.values()
        return task

    def acts(self, act: str) -> list[Any]:
        return [event for event in self.events if event["act"] == act]


@pytest.fixture
def lab(tmp_path: Path) -> Lab:
    lab = Lab(tmp_path)
    lab.navigation()
    return lab


def test_it_sees_what_is_advertised_where_it_is_and_whether_it_lives(lab: Lab) -> None:
    seen = Seen(lab)
    lab.let_pass(1.0)
    assert set(seen.sites) == {"astrid", "living-room"}
    tracker = seen.components[iri("person-tracker")]
    assert (tracker["site"], tracker["state"], tracker["places"]) == ("living-room", "alive", ["living-room"])
    assert tracker["types"] == ["rob:PositionSensor"]
    assert tracker["outputs"] == [{"name": "pose", "signals": ["rob:PlanarPose2D"]}]
    assert b"PositionSensor" in seen.graphs[iri("person-tracker")]
    lab.crash("tracker")
    lab.let_pass(3.0)
    assert seen.components[iri("person-tracker")]["state"] == "absent"
    assert [event["component"] for event in seen.acts("ended")] == [iri("person-tracker")]


@pytest.mark.parametrize("begins", [DEPLOYED, CONFIGURATION])
def test_what_a_component_advertises_stands_in_no_graph_of_a_configurator(tmp_path: Path, begins: str) -> None:
    lab, name = Lab(tmp_path, advertised={"odd": f"<{begins}x> a sc:Component, rob:Camera ."}), f"{begins}x"
    lab.site("attic", "odd")
    seen = Seen(lab)
    lab.let_pass(1.0)
    assert name in seen.components
    assert name not in seen.graphs


def test_what_is_left_out_of_what_sites_advertise_is_told_once_as_an_event(lab: Lab) -> None:
    lab.site("attic", "tracker")
    seen = Seen(lab)
    lab.let_pass(1.0)
    left_out = [f"left out {iri('person-tracker')} of site living-room: site attic advertises it too"]
    assert [event["detail"] for event in seen.acts("complaint")] == left_out
    lab.network.node().publisher(lab.keys.changed("attic"), Urgency.EVENT).put(b"")
    lab.let_pass(2.0)
    assert len(seen.acts("complaint")) == 1


def test_it_sees_a_configuration_change_when_something_fails_and_why(lab: Lab) -> None:
    seen = Seen(lab)
    agent = lab.agent()
    lab.running(agent)
    lab.let_pass(1.0)
    assert seen.task["phase"] == "running"
    assert chosen(seen.task, "position") == [iri("person-tracker")]
    lab.components["tracker"].fail("lost Astrid")
    lab.let_pass(1.0)
    assert chosen(seen.task, "position") == [iri("absolute-odometry")]
    assert seen.task["configuration"]["replaced"] == {iri("absolute-odometry"): iri("person-tracker")}
    assert seen.task["lost"][iri("person-tracker")]["detail"] == "lost Astrid"
    (graph,) = (text for name, text in seen.graphs.items() if name.startswith("urn:selfconf:"))
    assert b"absolute-odometry" in graph
    agent.stop()
    lab.let_pass(3.0)
    assert (seen.task["phase"], seen.task["over"], seen.task["components"]) == ("stopped", True, [])
    assert not any(name.startswith("urn:selfconf:") for name in seen.graphs)


def test_it_tells_soon_that_a_configurator_is_gone(lab: Lab) -> None:
    seen = Seen(lab)
    agent = lab.agent()
    lab.running(agent)
    lab.let_pass(1.0)
    lab.crash(agent)
    lab.let_pass(1.0)
    assert seen.task["phase"] == "gone"


def test_it_sees_what_began_before_it_came(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    seen = Seen(lab)
    lab.let_pass(2.0)
    assert seen.task["phase"] == "running"
    assert chosen(seen.task, "position") == [iri("person-tracker")]
    assert seen.acts("running")


def test_a_refusal_comes_with_its_near_misses(lab: Lab) -> None:
    for name in ("tracker", "odometry"):
        lab.crash(name)
    seen = Seen(lab)
    lab.let_pass(1.5)
    lab.agent(bound=(("robot", ":Nobody"), ("goal", "(AT BEDROOM)")), patient=True)
    lab.let_pass(5.0)
    assert seen.task["phase"] == "waiting"
    assert seen.task["refusal"]["reasons"]
    assert "support is Astrid, not Nobody" in [miss["obstacle"] for miss in seen.task["refusal"]["near_misses"]]


def test_a_lost_notice_is_asked_for(lab: Lab) -> None:
    seen = Seen(lab)
    agent = lab.agent()
    lab.running(agent)
    lab.let_pass(1.0)
    agent._notices._publisher.put = lambda *_: None  # type: ignore[method-assign]  # the network drops one
    lab.components["tracker"].fail("lost Astrid")
    lab.let_pass(1.0)
    assert not seen.acts("lost")
    lab.let_pass(LOOK_ANEW)
    assert [event["component"] for event in seen.acts("lost")] == [iri("person-tracker")]


def test_a_configurator_of_before_that_tells_no_events_is_asked(lab: Lab) -> None:
    agent = lab.agent()
    agent._notices.close()
    lab.running(agent)
    seen = Seen(lab)
    lab.let_pass(2.0)
    assert chosen(seen.task, "position") == [iri("person-tracker")]
    lab.components["tracker"].fail("lost Astrid")
    lab.let_pass(LOOK_ANEW + 1.0)
    assert chosen(seen.task, "position") == [iri("absolute-odometry")]
    assert seen.task["lost"][iri("person-tracker")]["cause"] == "fail"
    assert seen.events == []


def test_nothing_is_told_while_nothing_changes(lab: Lab) -> None:
    seen = Seen(lab)
    lab.running(lab.agent())
    lab.let_pass(2.0)
    before = seen.changes
    lab.let_pass(3 * LOOK_ANEW)
    assert seen.changes == before


def test_a_site_that_does_not_answer_is_asked_again_at_one_interval_whatever_else_changes(lab: Lab) -> None:
    node, asked = lab.network.node(), list[float]()

    def answer(request: Request) -> None:
        asked.append(lab.network.time)
        request.finish()

    node.announce(lab.keys.site_life("kitchen", "1"))
    node.serve(lab.keys.advertisements("kitchen"), answer)
    Seen(lab)
    changed = node.publisher(lab.keys.changed("kitchen"), Urgency.EVENT)
    for _ in range(20):
        lab.let_pass(0.7)
        changed.put(b"")
    lab.let_pass(ASKED_AGAIN)
    asked.clear()
    lab.let_pass(10 * ASKED_AGAIN)
    assert len(asked) <= 10 * DISCOVERY_ATTEMPTS


def test_what_a_site_advertises_is_there_while_it_is_too_busy_to_answer(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    answer, busy = Site._answer, set[str]()
    monkeypatch.setattr(
        Site, "_answer", lambda site, request: request.finish() if site.name in busy else answer(site, request)
    )
    lab = Lab(tmp_path)
    lab.navigation()
    seen = Seen(lab)
    lab.let_pass(1.0)
    before = dict(seen.components)
    busy.add("astrid")
    lab.network.node().publisher(lab.keys.changed("living-room"), Urgency.EVENT).put(b"")
    lab.let_pass(4.0)
    assert seen.sites["astrid"] == {"missing": True}
    assert seen.components == before
    busy.clear()
    lab.let_pass(2 * ASKED_AGAIN)
    assert seen.sites["astrid"] == {"missing": False}


def test_over_another_link_everything_is_looked_at_anew(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    link = ["first"]
    monkeypatch.setattr(MemoryBus, "link", property(lambda _: link[0]))
    seen = Seen(lab)
    lab.let_pass(1.0)
    assert seen.links[-1] == "first"
    for now, last in (("", "first"), ("second", "second")):
        link[0] = now
        lab.let_pass(2.0)
        assert seen.links[-1] == last
    assert seen.links.count("second") == 1


def test_what_is_deployed_is_known_once_it_is_told_that_everything_was_looked_at(lab: Lab) -> None:
    lab.running(lab.agent())
    seen = Seen(lab)
    assert lab.until(lambda: bool(seen.links), 5.0)
    assert [name for name in seen.graphs if name.startswith(DEPLOYED)]


def test_an_observer_that_comes_and_goes_is_noticed_by_nobody(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    before = list(lab.events)
    seen = Seen(lab)
    lab.let_pass(2.0)
    seen.watcher.bus.close()
    lab.let_pass(2.0)
    assert lab.events == before
    assert agent.state.phase.value == "running"


def chosen(task: Any, role: str) -> list[str]:
    """The components of a role of a task."""
    (found,) = (one["components"] for one in task["configuration"]["roles"] if one["role"] == iri(role))
    return list(found)
