"""Sites that come late, do not answer in full, begin again, or are gone for a moment with all behind their router."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path

import pytest

from selfconf.bus.memory import MemoryBus
from selfconf.bus.port import Request, Urgency
from selfconf.configurator.state import Phase
from selfconf.deployment.components.living_sites import ASK_SITE_AGAIN, AWAY
from selfconf.deployment.components.reachability import SETTLING
from selfconf.discovery.inquiry import DISCOVERY_ATTEMPTS
from selfconf.model.refusal import Refusal
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Page
from tests.deployment.components.sight import out_of_sight
from tests.deployment.simulated import living_room
from tests.deployment.tasks import TASK
from tests.lab import ADVERTISEMENTS, PREFIXES, Lab, iri

pytestmark = pytest.mark.usefixtures("followed")


def test_a_site_that_came_after_the_start_counts_before_the_task_is_given_up(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.site("astrid", "sonar", "encoder", "odometry", "control", "drive")
    for name in TASK | {"odometry"}:
        lab.component(name)
    agent = lab.agent()
    assert lab.running(agent)
    lab.site("living-room", "tracker")
    lab.component("tracker")
    lab.let_pass(1.0)
    lab.components["odometry"].fail("wheels slip")
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"tracker"}


@pytest.mark.parametrize("pages", [0, 1])
def test_a_site_that_does_not_answer_in_full_is_named_when_asked_and_when_the_task_is_refused(
    tmp_path: Path, pages: int
) -> None:
    lab = Lab(tmp_path)
    lab.site("astrid", "sonar", "encoder", "control")
    node = lab.network.node()
    node.announce(lab.keys.site_life("living-room", "1"))

    def answer(request: Request) -> None:
        for _ in range(pages):
            page = encode(Page(0, 2, 1, iri("pippi-drive"), "pippi.ttl"))
            payload = (PREFIXES + ADVERTISEMENTS["pippi"]).encode()
            request.reply(lab.keys.advertisement("living-room", iri("pippi-drive")), payload, page)
        request.finish()

    node.serve(lab.keys.advertisements("living-room"), answer)
    lab.agent()
    assert lab.until(lambda: bool(lab.ended))
    (discovered,) = lab.acts("discovered")
    assert discovered.sites == ("astrid", "living-room")
    assert discovered.missing == ("living-room",)
    assert discovered.components == 3 + pages
    assert lab.ended[0] is not None
    assert lab.ended[0].missing_sites == ("living-room",)


def test_a_site_that_answers_later_is_not_missing_from_the_refusal_any_more(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.site("astrid", "sonar", "encoder", "control", "drive")
    for name in TASK:
        lab.component(name)
    node = lab.network.node()
    node.announce(lab.keys.site_life("living-room", "1"))
    undo = node.serve(lab.keys.advertisements("living-room"), lambda _: None)
    agent = lab.agent(patient=True)
    lab.let_pass(2 * ASK_SITE_AGAIN)
    assert isinstance(agent.state.refusal, Refusal)
    assert agent.state.refusal.missing_sites == ("living-room",)
    undo()
    empty = encode(Page(0, 0, 1))

    def answer(request: Request) -> None:
        request.reply(lab.keys.advertisements("living-room").replace("**", "none"), b"", empty)
        request.finish()

    node.serve(lab.keys.advertisements("living-room"), answer)
    lab.let_pass(2 * ASK_SITE_AGAIN)
    assert isinstance(agent.state.refusal, Refusal)
    assert agent.state.refusal.missing_sites == ()


def test_a_site_that_does_not_answer_is_asked_again_at_one_interval_whatever_else_changes(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.site("astrid", "sonar")
    node = lab.network.node()
    node.announce(lab.keys.site_life("living-room", "1"))
    asked: list[float] = []

    def answer(request: Request) -> None:
        asked.append(lab.network.time)
        request.finish()

    node.serve(lab.keys.advertisements("living-room"), answer)
    lab.agent(patient=True)
    changed = node.publisher(lab.keys.changed("living-room"), Urgency.EVENT)
    for _ in range(20):
        lab.let_pass(0.2)
        changed.put(b"")
    lab.let_pass(ASK_SITE_AGAIN)
    asked.clear()
    lab.let_pass(10 * ASK_SITE_AGAIN)
    assert len(asked) <= 10 * DISCOVERY_ATTEMPTS


def test_a_site_that_is_started_again_is_news_though_its_earlier_life_has_not_ended_yet(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.site("astrid", "sonar", "encoder", "control", "drive")
    for name in (*TASK, "tracker"):
        lab.component(name)
    first = lab.site("living-room", "pippi")
    agent = lab.agent(patient=True)
    lab.let_pass(2 * ASK_SITE_AGAIN)
    assert agent.state.phase is Phase.REFUSED
    (tmp_path / "living-room" / "pippi.ttl").unlink()
    lab.site("living-room", "tracker")
    first.bus.close()
    assert lab.running(agent)
    assert lab.active() == TASK | {"tracker"}


@pytest.mark.parametrize("away", [SETTLING / 2, 2 * SETTLING])
def test_a_site_that_is_cut_off_before_lives_are_followed_is_news_when_it_is_back(tmp_path: Path, away: float) -> None:
    lab = Lab(tmp_path)
    astrid, late = lab.site("astrid", "sonar", "encoder", "control", "drive"), lab.site("living-room", "tracker")
    assert isinstance(late.bus, MemoryBus)
    lab.network.pause(late.bus)
    agent = lab.agent(patient=True)
    lab.let_pass(0.01)
    lab.isolate(astrid)  # it has answered, and is not watched yet
    lab.network.resume(late.bus)
    lab.let_pass(away)
    lab.component("tracker")  # so that the ecology is asked once more, without the site
    lab.let_pass(0.1)
    assert agent.state.phase is Phase.REFUSED
    asked = len(lab.acts("query"))
    lab.rejoin(astrid)
    lab.let_pass(0.1)
    assert len(lab.acts("query")) == asked + 1


def test_a_site_that_is_cut_off_after_its_answer_is_news_when_it_is_back(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    astrid, late = lab.site("astrid", "sonar", "encoder", "control"), lab.site("living-room", "tracker")
    assert isinstance(late.bus, MemoryBus)
    agent = lab.agent(patient=True)
    lab.let_pass(2 * SETTLING)
    lab.network.pause(late.bus)
    lab.component("tracker")  # so that the ecology is asked once more
    lab.let_pass(0.01)
    lab.isolate(astrid)  # it has answered, while the other has not
    lab.let_pass(0.01)
    lab.network.resume(late.bus)
    lab.let_pass(2 * SETTLING)
    assert agent.state.phase is Phase.REFUSED
    asked = len(lab.acts("query"))
    lab.rejoin(astrid)
    lab.let_pass(0.1)
    assert len(lab.acts("query")) == asked + 1


def test_a_component_that_loses_its_router_for_a_moment_together_with_its_site_is_kept(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    behind = [node for node in lab.network.nodes if node in (lab.network.nodes[0], lab.runtimes["tracker"].bus)]
    others = [node for node in lab.network.nodes if node not in behind]
    for node, other in itertools.product(behind, others):
        lab.network.cut(node, other)
    lab.let_pass(AWAY / 2)
    for node, other in itertools.product(behind, others):
        lab.network.reconnect(node, other)
    lab.let_pass(10.0)
    assert lab.active() == TASK | {"tracker"}
    assert lab.acts("lost") == []


def test_a_component_of_a_site_that_does_not_answer_is_given_time_though_the_end_of_the_site_is_not_shown_yet(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    agent = lab.agent()
    lab.running(agent)
    called = MemoryBus.roll_call

    def roll_call(bus: MemoryBus, key: str, seconds: float, done: Callable[[tuple[str, ...]], None]) -> None:
        other = lab.keys.site_life("attic", "0")
        called(bus, key, seconds, (lambda _: done((other,))) if key == lab.keys.any_site_life() else done)

    monkeypatch.setattr(MemoryBus, "roll_call", roll_call)
    out_of_sight(lab, "tracker", seconds=AWAY / 2)
    lab.let_pass(10.0)
    assert lab.acts("lost") == []


@pytest.mark.parametrize("patient", [False, True])
def test_what_another_site_advertises_as_well_is_looked_for_there_at_once_when_its_site_is_gone(
    tmp_path: Path, patient: bool
) -> None:
    """As over a link between two hosts that is cut: the one that is left can start the component as well."""
    lab = Lab(tmp_path)
    lab.site("astrid", *TASK)
    gone = lab.site("attic", "tracker")
    for name in (*TASK, "tracker"):
        lab.component(name)
    living_room(lab, "1", lambda node: lab.component("tracker"))
    agent = lab.agent(patient=patient)
    assert lab.running(agent)
    for one in (gone, "tracker"):
        lab.crash(one)
    assert lab.until(lambda: iri("person-tracker") in agent.state.lost, 1.0)
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, 1.0)
    assert lab.active() == TASK | {"tracker"}
