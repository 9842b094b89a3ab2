"""Lives that end, seem to end, and begin again; sites that come late; and configurators that are cut off."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path

import pytest

from selfconf.bus.memory import MemoryBus
from selfconf.bus.memory.network import LEASE
from selfconf.bus.port import Request, Urgency
from selfconf.configurator.events import Appeared, Event
from selfconf.configurator.state import Phase, Policy
from selfconf.deployment.components import liveness
from selfconf.deployment.components.liveness import (
    ASK_SITE_AGAIN,
    AUDIT,
    AWAY,
    MOST_REOPENINGS,
    SETTLING,
    SILENT_AUDITS,
)
from selfconf.discovery import ecology_view
from selfconf.discovery.inquiry import DISCOVERY_ATTEMPTS
from selfconf.model.refusal import Refusal
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import CallAnswer, Cause, Page, Verdict
from selfconf.sdk.runtime.supervision import GRACE
from tests.deployment.simulated import home, living_room
from tests.deployment.tasks import TASK
from tests.lab import ADVERTISEMENTS, PREFIXES, Lab, Recorder, iri


def out_of_sight(lab: Lab, *components: str, seconds: float) -> None:
    """Cut components off from all others for a while."""
    cut = [
        (lab.runtimes[component].bus, other)
        for component in components
        for other in lab.network.nodes
        if other is not lab.runtimes[component].bus
    ]
    for node, other in cut:
        lab.network.cut(node, other)
    lab.let_pass(seconds)
    for node, other in cut:
        lab.network.reconnect(node, other)


@pytest.fixture(autouse=True, params=["all lives", "selected lives"])
def followed(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whether a configurator follows all lives, or, as in a large ecology, those that it has selected."""
    if request.param == "selected lives":
        monkeypatch.setattr(ecology_view, "MANY_LIVES", 0)


def test_a_component_that_crashes_is_replaced(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.crash("tracker")
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"odometry"}
    assert lab.acts("lost")[0].cause == "crash"


def test_a_component_that_dies_during_deployment_is_replaced(lab: Lab) -> None:
    agent = lab.agent()
    assert lab.until(lambda: agent.state.phase is Phase.DEPLOYING)
    lab.crash("tracker")
    assert lab.running(agent)
    assert lab.active() == TASK | {"odometry"}


def test_a_component_that_dies_while_it_is_activated_has_crashed(lab: Lab) -> None:
    class Fragile(Recorder):
        def started(self) -> None:
            lab.crash("tracker")

    lab.crash("tracker")
    lab.component("tracker", Fragile())
    agent = lab.agent()
    assert lab.running(agent)
    assert lab.active() == TASK | {"odometry"}
    assert agent.state.lost[iri("person-tracker")].cause is Cause.CRASH
    assert [account.cause for account in lab.acts("lost")] == ["crash"]


def test_a_new_life_of_a_lost_component_may_be_chosen_again(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.crash("tracker")
    lab.let_pass(1.0)
    lab.component("tracker")
    lab.let_pass(1.0)
    assert lab.active() == TASK | {"odometry"}  # what runs is not changed for it
    lab.components["odometry"].fail("wheels slip")
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"tracker"}


def test_a_lost_component_whose_life_ends_may_be_started_and_chosen_again(tmp_path: Path) -> None:
    """It had failed; its process ends while another takes its place, and its site can start it."""
    lab = home(tmp_path, "odometry")
    living_room(lab, "1", lambda node: lab.component("tracker"))
    lab.component("tracker")
    agent = lab.agent()
    assert lab.running(agent)
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    lab.crash("tracker")
    lab.let_pass(1.0)
    assert lab.active() == TASK | {"odometry"}
    lab.components["odometry"].fail("wheels slip")
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"tracker"}


def test_a_lost_component_that_lives_on_is_not_chosen_again_though_its_site_could_start_it(tmp_path: Path) -> None:
    lab = home(tmp_path, "odometry")
    living_room(lab, "1", lambda node: lab.component("tracker"))
    lab.component("tracker")
    agent = lab.agent()
    assert lab.running(agent)
    for name in ("tracker", "odometry"):
        lab.components[name].fail("lost")
        lab.let_pass(1.0)
    assert agent.state.phase is Phase.REFUSED


def test_a_component_that_is_restarted_while_it_acts_is_activated_and_set_anew(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.crash("control")
    assert lab.until(lambda: agent.state.phase is Phase.REFUSED)
    lab.ended.clear()
    lab.component("control")
    again = lab.agent()
    assert lab.running(again)
    assert lab.components["control"].said == [("goal", "(AT BEDROOM)"), ("started",)]


@pytest.mark.parametrize("seconds", [0.3, 1.5, 2.5])
def test_components_that_are_out_of_sight_for_a_moment_do_not_end_a_task_that_does_not_wait(
    lab: Lab, seconds: float
) -> None:
    agent = lab.agent()
    lab.running(agent)
    everybody = sorted(TASK | {"tracker", "odometry"})
    for name in everybody:
        lab.isolate(name)
    lab.let_pass(seconds)
    assert {loss.component for loss in lab.acts("lost")} >= {iri("thinking-cap"), iri("wheels")}
    for name in everybody:
        lab.rejoin(name)
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, 2.0)
    lab.let_pass(1.0)
    assert lab.active() == TASK | {"tracker"}


def test_a_configurator_that_was_suspended_applies_anew_to_components_that_have_turned_themselves_off(lab: Lab) -> None:
    """It sees all lives end and begin at one moment; meanwhile the components have not seen their supervisor."""
    agent = lab.agent(policy=Policy.DISMANTLE)
    lab.running(agent)
    epoch = agent.state.epoch
    lab.isolate(agent)
    for name in TASK | {"tracker"}:
        lab.runtimes[name]._orphaned(agent.supervisor)
    lab.rejoin(agent)
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert agent.state.epoch > epoch
    assert lab.active() == TASK | {"tracker"}
    assert lab.components["control"].said[-2:] == [("goal", "(AT BEDROOM)"), ("started",)]
    assert not lab.acts("lost")
    assert len(lab.acts("connected")) == 1


@pytest.mark.parametrize("repairs", [False, True])
def test_a_configurator_that_was_suspended_starts_nothing_before_what_feeds_it(lab: Lab, repairs: bool) -> None:
    """Meanwhile all components have let go of its task, which it does not know as it goes on."""
    agent = lab.agent()
    lab.running(agent)
    node = agent.bus
    assert isinstance(node, MemoryBus)
    if repairs:
        lab.components["tracker"].fail("lost")
        assert lab.until(lambda: agent.state.phase is Phase.DEPLOYING)
    lab.network.pause(node)
    lab.let_pass(LEASE + GRACE + 0.5)
    assert lab.active() == set()
    lab.network.resume(node)
    sources, sinks = TASK - {"control", "drive"}, {"control", "drive"}
    assert not lab.until(lambda: bool(lab.active() & sinks) and not lab.active() >= sources, SETTLING + 1.0)
    assert lab.active() == TASK | {"odometry" if repairs else "tracker"}


def test_a_configurator_that_was_suspended_yields_to_the_one_that_has_taken_over(lab: Lab) -> None:
    first = lab.agent()
    lab.running(first)
    lab.isolate(first)
    lab.let_pass(GRACE + 0.1)
    second = lab.agent()
    lab.isolate(first)  # from the second one as well
    assert lab.running(second)
    lab.rejoin(first)
    assert lab.until(lambda: first.state.phase is Phase.REFUSED)
    assert lab.active() == TASK | {"tracker"}
    assert {holder_of(lab, name) for name in TASK | {"tracker"}} == {second.supervisor}


def holder_of(lab: Lab, name: str) -> str:
    """The liveliness key of the configurator that holds a component."""
    hold = lab.runtimes[name].activation.first
    return "" if hold is None else hold.claim.supervisor


def test_a_component_that_has_let_go_of_its_task_unnoticed_is_applied_to_anew(lab: Lab) -> None:
    """It has seen the life of the configurator end, which goes on, and the configurator has seen nothing."""
    agent = lab.agent()
    lab.running(agent)
    for name in ("tracker", "drive"):
        lab.runtimes[name]._orphaned(agent.supervisor)
        assert lab.active() == (TASK | {"tracker"}) - {name}
        lab.let_pass(2 * AUDIT)
        assert lab.active() == TASK | {"tracker"}
    assert lab.acts("lost") == []
    assert agent.state.phase is Phase.RUNNING


def test_a_component_that_has_failed_unnoticed_is_replaced(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.runtimes["tracker"].code.end_acting()
    lab.let_pass(2 * AUDIT)
    assert lab.active() == TASK | {"odometry"}
    (lost,) = lab.acts("lost")
    assert (lost.component, lost.detail) == (iri("person-tracker"), "it does not act any more")


def test_a_component_that_lives_and_answers_no_question_is_replaced(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.runtimes["tracker"].calls.close()
    lab.let_pass((SILENT_AUDITS + 1) * AUDIT)
    assert lab.active() >= TASK | {"odometry"}
    (lost,) = lab.acts("lost")
    assert (lost.component, lost.cause) == (iri("person-tracker"), "hung")


def test_what_a_component_has_not_answered_in_its_last_life_does_not_count_in_the_next(lab: Lab) -> None:
    lab.crash("odometry")
    agent = lab.agent(patient=True)
    for _ in range(2):
        assert lab.running(agent)
        lab.runtimes["tracker"].calls.close()
        lab.let_pass(1.5 * AUDIT)
        assert agent.state.phase is Phase.RUNNING
        assert lab.until(lambda: agent.state.phase is Phase.REFUSED)
        lab.crash("tracker")
        lab.let_pass(1.0)
        lab.component("tracker")


def test_the_status_says_how_many_signals_a_slow_component_has_passed_over(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.runtimes["control"].inputs._dropped = 7
    lab.let_pass(4 * AUDIT)
    assert agent.status().dropped == {lab.runtimes["control"].profile.component: 7}


def test_a_component_that_was_cut_off_for_a_moment_does_not_go_on_in_the_old_configuration(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.isolate("tracker")
    lab.let_pass(GRACE / 2)
    assert lab.active() == TASK | {"odometry", "tracker"}
    lab.rejoin("tracker")
    lab.let_pass(0.1)
    assert lab.active() == TASK | {"odometry"}
    lab.let_pass(10.0)
    assert lab.active() == TASK | {"odometry"}
    lab.components["odometry"].fail("wheels slip")
    lab.let_pass(1.0)
    assert lab.active() == TASK | {"tracker"}
    assert agent.state.phase is Phase.RUNNING


def test_a_component_that_fails_while_it_is_cut_off_for_a_moment_is_replaced(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.isolate("tracker")
    lab.components["tracker"].fail("unheard")
    lab.let_pass(0.01)
    lab.rejoin("tracker")
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"odometry"}


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


def test_a_component_that_crashes_is_lost_after_one_question_to_the_network(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.crash("tracker")
    round_trip = 2 * lab.network.faults.most_delay
    assert lab.until(lambda: bool(agent.state.lost), 4 * round_trip)


def test_a_component_that_crashes_in_an_ecology_whose_sites_are_gone_is_lost_all_the_same(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    for site in lab.network.nodes[:2]:
        site.close()
    lab.let_pass(1.0)
    lab.crash("tracker")
    lab.let_pass(1.0)
    assert iri("person-tracker") in agent.state.lost


def test_many_that_end_at_once_are_asked_about_once(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    agent = lab.agent()
    lab.running(agent)
    asked: list[str] = []
    roll_call = MemoryBus.roll_call

    def counted(bus: MemoryBus, key: str, seconds: float, done: Callable[[tuple[str, ...]], None]) -> None:
        asked.append(key)
        roll_call(bus, key, seconds, done)

    monkeypatch.setattr(MemoryBus, "roll_call", counted)
    for name in ("tracker", "sonar", "pippi"):
        lab.crash(name)
    lab.let_pass(0.01)
    assert set(agent.state.lost) >= {iri("person-tracker"), iri("sonar-array")}
    assert asked[:2] == [lab.keys.any_site_life()] * len(asked[:2])
    assert asked.count(lab.keys.any_site_life()) <= 2 + 1  # a discovery calls the sites as well


def test_lives_that_nobody_waits_for_are_fed_together_when_a_lost_link_is_back(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ecology_view, "MANY_LIVES", 0)
    lamps = lab.network.node()
    undos = [lamps.announce(lab.keys.life(iri(f"lamp{number}"), "1")) for number in range(50)]
    agent = lab.agent()
    lab.running(agent)
    fed: list[Event] = []
    monkeypatch.setattr(agent._liveness, "_step", fed.append)
    node = agent.bus
    assert isinstance(node, MemoryBus)
    lab.network.cut(lamps, node)
    lab.let_pass(1.0)
    lab.network.reconnect(lamps, node)
    lab.let_pass(1.0)
    assert fed == [Appeared({})]
    assert len(undos) == 50


def test_a_life_that_begins_or_ends_costs_one_look_up_however_many_components_there_are(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    agent = lab.agent()
    lab.running(agent)
    hashed: list[str] = []
    monkeypatch.setattr(liveness, "component_chunk", hashed.append)
    for number in range(20):
        lab.network.node().announce(f"selfconf/lab/c/00/stranger{number}/live/1")
    lab.let_pass(1.0)
    assert hashed == []


@pytest.mark.parametrize("seconds", [0.3, GRACE + 0.5, 30.0])
def test_a_configurator_that_was_cut_off_brings_its_configuration_up_again(lab: Lab, seconds: float) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.isolate(agent)
    lab.let_pass(seconds)
    assert lab.active() == (TASK | {"tracker"} if seconds < GRACE else set())
    lab.rejoin(agent)
    lab.let_pass(SETTLING + 1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"tracker"}
    assert lab.components["control"].said[-1] in (("goal", "(AT BEDROOM)"), ("started",))
    assert not lab.acts("lost")


def test_a_component_that_died_while_the_configurator_was_cut_off_is_replaced(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.isolate(agent)
    lab.let_pass(0.3)
    lab.crash("tracker")
    lab.let_pass(0.3)
    lab.rejoin(agent)
    lab.let_pass(SETTLING + 1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"odometry"}


def test_components_that_have_come_to_rest_out_of_sight_are_no_news_to_a_task_that_is_taken_down(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    agent.stop()
    assert agent.state.phase is Phase.DISMANTLING
    for component in list(agent.state.held):
        agent._liveness._seen(component, "1", CallAnswer(Verdict.DONE, component, "1"))
    assert lab.until(lambda: bool(lab.ended))
    assert not lab.acts("connected")


def test_a_configurator_that_is_cut_off_can_be_stopped(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.isolate(agent)
    lab.let_pass(0.1)
    agent.stop()
    assert lab.until(lambda: bool(lab.ended), 10.0)
    lab.let_pass(GRACE + 0.1)
    assert lab.active() == set()
    lab.rejoin(agent)
    lab.let_pass(2 * SETTLING)
    assert not lab.acts("connected")


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


def test_where_a_hub_is_opened_anew_no_end_is_believed_but_not_for_ever(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    node = lab.network.node()

    def say(site: str, number: int) -> None:
        warning = node.publisher(lab.keys.reopens(site), Urgency.EVENT)
        for _ in range(number):
            warning.put(b"")
            lab.let_pass(0.5)

    say("astrid", 10 * MOST_REOPENINGS)
    node.publisher(lab.keys.reopens("living-room"), Urgency.EVENT).put(b"")
    lab.let_pass(0.02)
    out_of_sight(lab, "tracker", "sonar", seconds=0.5)
    lab.let_pass(5.0)
    assert lab.acts("lost") == [], "what another site says is no matter"
    assert lab.active() == TASK | {"tracker"}
    say("living-room", 10 * MOST_REOPENINGS)
    lab.crash("tracker")
    assert lab.until(lambda: iri("person-tracker") in agent.state.lost, 5.0), (
        "whoever says it without an end is not heard"
    )


@pytest.mark.parametrize(("site", "believed"), [("living-room", True), ("nowhere", False)])
def test_of_the_hub_of_a_site_that_does_not_live_nothing_is_believed(lab: Lab, site: str, believed: bool) -> None:
    lab.running(lab.agent())
    lab.network.node().publisher(lab.keys.reopens(site), Urgency.EVENT).put(b"")
    lab.let_pass(0.5)
    assert bool(lab.acts("cut off")) == believed


def test_a_hub_that_is_opened_anew_again_and_again_is_believed_as_the_link_is_lost_each_time(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    agent = lab.agent()
    lab.running(agent)
    turns = 0
    monkeypatch.setattr(MemoryBus, "link", property(lambda _: f"the hub {turns}"))
    warning = lab.network.node().publisher(lab.keys.reopens("living-room"), Urgency.EVENT)
    for _ in range(3 * MOST_REOPENINGS):
        warning.put(b"")
        lab.let_pass(0.02)
        out_of_sight(lab, "tracker", "sonar", seconds=0.2)
        turns += 1
        lab.let_pass(2.0)
    assert lab.acts("lost") == []
