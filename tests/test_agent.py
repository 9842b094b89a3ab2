"""A configurator in a small ecology, in simulated time: the paper's experiment, and everything that can go wrong."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from selfconf.bus.port import Replies, Request, Urgency
from selfconf.configurator.events import Failed
from selfconf.configurator.state import Phase, Policy
from selfconf.deployment.calls import CALL, STARTING, WAKING
from selfconf.deployment.liveness import ASK_AGAIN, SETTLING
from selfconf.deployment.runner import TRY_AGAIN
from selfconf.discovery import DISCOVERY_ATTEMPTS
from selfconf.errors import TemplateError
from selfconf.model.refusal import Refusal, TooFewEligible
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import CallAnswer, Cause, Fail, Page, Release, Status, Verdict
from selfconf.rdf import conformance as shacl
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.vocabulary import PROV, SC
from selfconf.render.run_events import event_body
from selfconf.sdk.component import Refused
from selfconf.sdk.supervision import GRACE
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES, Lab, Recorder, iri

TASK = {"sonar", "encoder", "control", "drive"}


@pytest.fixture
def lab(tmp_path: Path) -> Lab:
    """The paper's ecology, at two sites, before any task."""
    lab = Lab(tmp_path)
    lab.navigation()
    return lab


def released(recorder: Recorder) -> bool:
    """Whether a component was turned off as often as it was turned on."""
    return recorder.said.count(("started",)) == recorder.said.count(("stopped",))


# The paper's experiment.


def test_the_task_is_configured_with_the_tracker_and_never_with_the_drive_of_pippi(lab: Lab) -> None:
    agent = lab.agent()
    assert lab.running(agent)
    assert lab.active() == TASK | {"tracker"}
    assert lab.components["pippi"].said == []
    assert agent.configuration is not None
    assert agent.configuration.components == tuple(
        map(iri, ("sonar-array", "wheels", "person-tracker", "thinking-cap", "astrid-drive"))
    )


def test_signals_flow_along_the_connections_and_the_goal_is_set_last(lab: Lab) -> None:
    lab.running(lab.agent())
    lab.components["tracker"].emit("pose", {"x": 1})
    lab.components["odometry"].emit("pose", {"x": 9})
    lab.components["control"].emit("set.velocity", {"v": 0.3})
    lab.let_pass(0.1)
    assert lab.components["control"].said == [("started",), ("goal", "(AT BEDROOM)"), ("position", {"x": 1})]
    assert lab.components["drive"].said == [("started",), ("velocity", {"v": 0.3})]


def test_a_lost_tracker_is_replaced_by_odometry(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.components["tracker"].fail("Astrid has left the picture")
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"odometry"}
    assert lab.components["tracker"].said == [("started",), ("stopped",)]
    lab.components["odometry"].emit("pose", {"x": 2})
    lab.let_pass(0.1)
    assert lab.components["control"].said[-1] == ("position", {"x": 2})
    (lost,) = lab.acts("lost")
    assert lost.component == iri("person-tracker")
    assert lost.detail == "Astrid has left the picture"


def test_repair_neither_stops_nor_starts_nor_sets_anew_what_runs(lab: Lab) -> None:
    lab.running(lab.agent())
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    assert lab.components["control"].said == [("started",), ("goal", "(AT BEDROOM)")]
    for name in ("sonar", "encoder", "drive"):
        assert lab.components[name].said == [("started",)]


def test_dismantling_stops_everybody_first_as_the_paper_does(lab: Lab) -> None:
    agent = lab.agent(policy=Policy.DISMANTLE)
    lab.running(agent)
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.components["drive"].said == [("started",), ("stopped",), ("started",)]
    assert lab.components["control"].said == [
        ("started",),
        ("goal", "(AT BEDROOM)"),
        ("stopped",),
        ("started",),
        ("goal", "(AT BEDROOM)"),
    ]


def test_when_odometry_fails_too_the_task_is_refused_and_everything_is_off(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    for name in ("tracker", "odometry"):
        lab.components[name].fail("broken")
        lab.let_pass(1.0)
    assert agent.state.phase is Phase.REFUSED
    assert lab.active() == set()
    (refusal,) = lab.ended
    assert refusal is not None
    assert [reason.role for reason in refusal.reasons if isinstance(reason, TooFewEligible)] == [iri("position")]


def test_a_stop_takes_everything_down_once(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    agent.stop()
    agent.stop()
    assert lab.until(lambda: bool(lab.ended))
    assert lab.ended == [None]
    assert lab.active() == set()
    assert all(map(released, lab.components.values()))


@pytest.mark.parametrize("moment", [0.0, 0.0004, 0.0012, 0.0018, 0.0024, 0.003, 0.0035, 0.004, 0.0045, 0.01])
@pytest.mark.parametrize("policy", Policy)
def test_a_stop_at_any_moment_leaves_nothing_active(lab: Lab, moment: float, policy: Policy) -> None:
    agent = lab.agent(policy=policy)
    lab.let_pass(moment)
    agent.stop()
    assert lab.until(lambda: bool(lab.ended))
    lab.let_pass(1.0)
    assert lab.ended == [None]
    assert lab.active() == set()


# Losses of all kinds.


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


def test_a_component_that_refuses_to_start_is_replaced(lab: Lab) -> None:
    lab.components["tracker"].refusal = Refused("the camera is covered")
    agent = lab.agent()
    assert lab.running(agent)
    assert lab.active() == TASK | {"odometry"}
    assert lab.acts("declined")[0].detail == "the camera is covered"
    (lost,) = lab.acts("lost")
    assert (lost.cause, lost.detail) == ("refused", "the camera is covered")
    record = turtle.parse(agent._record.turtle(), "record.ttl")
    (failure,) = record.instances(SC.Failure)
    assert [str(cause) for cause in record.values(failure, SC.cause)] == ["refused"]


def test_what_changes_nothing_is_no_loss(lab: Lab) -> None:
    agent = lab.agent()
    assert lab.until(lambda: agent.state.phase is Phase.DEPLOYING)
    agent._step(Failed(iri("person-tracker"), "", Cause.SILENCE, "no signal"))  # it may not have begun
    assert lab.running(agent)
    assert lab.active() == TASK | {"tracker"}
    agent.stop()
    lab.crash("tracker")
    assert lab.until(lambda: bool(lab.ended))
    assert lab.acts("lost") == []


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


def busy_in_started(lab: Lab, name: str, seconds: float) -> None:
    """Have the thread of a component be in `started` for so long: all that it is asked is heard afterwards."""
    body, free = lab.bodies[name], lab.network.time + seconds
    body._served()

    def hear(request: Request) -> None:
        body.bus.later(max(0.0, free - lab.network.time), lambda: body._call(request))

    body.bus.serve(lab.keys.call(body.profile.component), hear)


def test_a_component_that_takes_long_to_start_is_waited_for_as_long_as_it_lives(lab: Lab) -> None:
    busy_in_started(lab, "tracker", STARTING - CALL)
    agent = lab.agent()
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, STARTING + CALL)
    assert lab.active() == TASK | {"tracker"}
    assert lab.components["tracker"].said == [("started",)]


def test_a_component_that_dies_while_it_takes_long_to_start_is_replaced_at_once(lab: Lab) -> None:
    busy_in_started(lab, "tracker", STARTING)
    agent = lab.agent()
    lab.let_pass(3 * CALL)
    assert agent.state.phase is Phase.DEPLOYING
    lab.crash("tracker")
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, CALL)
    assert agent.state.lost[iri("person-tracker")].cause is Cause.CRASH


def test_an_output_that_promised_a_rate_and_stops_is_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    promising = ADVERTISEMENTS["tracker"].replace(
        "sc:signalType rob:PlanarPose2D", "sc:signalType rob:PlanarPose2D ; sc:rate [ sc:value 10 ; sc:unit unit:HZ ]"
    )
    monkeypatch.setitem(ADVERTISEMENTS, "tracker", promising)

    class Tracker(Recorder):
        seeing = True

        def started(self) -> None:
            self.every(0.1, self.look)

        def look(self) -> None:
            if self.seeing:
                self.emit("pose", {"x": 0})

    lab = Lab(tmp_path)
    lab.navigation()
    lab.crash("tracker")
    tracker = Tracker()
    lab.component("tracker", tracker)
    agent = lab.agent()
    assert lab.running(agent)
    lab.let_pass(5.0)
    assert lab.active() == TASK | {"tracker"}
    tracker.seeing = False
    lab.let_pass(1.0)
    assert lab.active() == TASK | {"odometry"}
    assert lab.acts("lost")[0].cause == "silence"


def test_a_component_that_hangs_is_replaced(lab: Lab) -> None:
    """It lives, but answers no call."""
    body = lab.bodies["tracker"]
    body._served()
    body.bus.serve(lab.keys.call(iri("person-tracker")), lambda _: None)
    agent = lab.agent()
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, STARTING + 2 * CALL)
    assert lab.active() == TASK | {"odometry"}


def test_a_component_that_is_advertised_but_does_not_run_is_passed_over(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.site("home")
    for name in TASK | {"odometry"}:
        lab.component(name)
    assert lab.running(lab.agent())
    assert lab.active() == TASK | {"odometry"}


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


def test_a_component_that_is_restarted_while_it_plays_is_activated_and_set_anew(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.crash("control")
    lab.let_pass(0.5)
    assert agent.state.phase is Phase.REFUSED
    lab.ended.clear()
    lab.component("control")
    again = lab.agent()
    assert lab.running(again)
    assert lab.components["control"].said == [("started",), ("goal", "(AT BEDROOM)")]


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


def test_the_fail_of_a_component_that_was_activated_anew_counts(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.components["odometry"].fail("idle, so nobody hears")
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    assert lab.active() == TASK | {"odometry"}
    lab.components["odometry"].fail("now it does")
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.REFUSED


def test_nobody_else_can_make_a_component_fail(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    mallory = lab.network.node()
    forged = encode(Fail(iri("person-tracker"), "", 1, Cause.FAIL, "says who"))
    for key in (lab.keys.fail(iri("pippi-drive")), lab.keys.fail(iri("thinking-cap"))):
        mallory.publisher(key, Urgency.EVENT).put(forged)
    mallory.publisher(lab.keys.fail(iri("person-tracker")), Urgency.EVENT).put(b"not a message")
    silent = encode(Fail(iri("person-tracker"), "", 1, Cause.SILENCE, "says a stranger"))
    mallory.publisher(lab.keys.fail(iri("pippi-drive")), Urgency.EVENT).put(silent)
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"tracker"}


# Configurators that die, and several of them.


def test_when_the_configurator_dies_everything_turns_itself_off_and_a_new_one_recovers(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.crash(agent)
    lab.let_pass(GRACE - 0.1)
    assert lab.active() == TASK | {"tracker"}
    lab.let_pass(0.2)
    assert lab.active() == set()
    again = lab.agent()
    assert lab.running(again)
    assert lab.active() == TASK | {"tracker"}


def test_a_new_configurator_takes_over_at_once_from_one_that_died(lab: Lab) -> None:
    first = lab.agent()
    lab.running(first)
    lab.crash(first)
    again = lab.agent()
    assert lab.running(again)
    assert lab.active() == TASK | {"tracker"}
    lab.let_pass(10.0)
    assert lab.active() == TASK | {"tracker"}
    assert lab.components["drive"].said == [("started",)]


def test_a_component_held_by_another_living_configurator_is_not_taken(lab: Lab) -> None:
    first = lab.agent()
    lab.running(first)
    second = lab.agent()
    assert lab.until(lambda: second.state.phase is Phase.REFUSED)
    assert first.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"tracker"}
    assert lab.components["drive"].said == [("started",)]
    lab.let_pass(1.0)
    declined = lab.acts("declined")
    assert {account.detail for account in declined} == {f"the configurator {first.name} holds it"}
    assert len(declined) == len({account.component for account in declined})


def test_two_tasks_share_the_ecology_as_long_as_they_need_different_components(lab: Lab) -> None:
    first = lab.agent()
    lab.running(first)
    template = PREFIXES + ":watch a sc:Template ; sc:roles ( :eye ) . :eye a sc:Role ; sh:class rob:PositionSensor ."
    second = lab.agent(template, bound=())
    assert lab.running(second)
    assert lab.active() == TASK | {"tracker", "odometry"}
    first.stop()
    lab.let_pass(1.0)
    assert lab.active() == {"odometry"}


# Patience.


def test_patience_waits_until_the_ecology_has_what_it_needs(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.site("astrid", "sonar", "encoder", "control", "drive")
    for name in TASK:
        lab.component(name)
    agent = lab.agent(patient=True)
    lab.let_pass(5.0)
    assert agent.state.phase is Phase.REFUSED
    assert lab.ended == []
    lab.component("tracker")
    lab.site("living-room", "tracker")
    assert lab.running(agent)
    assert lab.active() == TASK | {"tracker"}


def test_patience_notices_an_advertisement_that_is_added_to_a_site(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    site = lab.site("astrid", "sonar", "encoder", "control", "drive")
    for name in TASK | {"odometry"}:
        lab.component(name)
    agent = lab.agent(patient=True)
    lab.let_pass(5.0)
    assert agent.state.phase is Phase.REFUSED
    (tmp_path / "astrid" / "odometry.ttl").write_text(PREFIXES + ADVERTISEMENTS["odometry"])
    assert lab.running(agent)
    assert site.name == "astrid"


def test_patience_recovers_when_a_lost_component_lives_again(lab: Lab) -> None:
    agent = lab.agent(patient=True)
    lab.running(agent)
    lab.crash("drive")
    lab.let_pass(1.0)
    assert (agent.state.phase, lab.active()) == (Phase.REFUSED, set())
    lab.component("drive")
    assert lab.running(agent)
    agent.stop()
    assert lab.until(lambda: lab.ended == [None])
    assert lab.active() == set()


def test_patience_goes_on_when_a_component_that_another_configurator_held_is_free(lab: Lab) -> None:
    first = lab.agent()
    lab.running(first)
    second = lab.agent(patient=True)
    lab.let_pass(3 * TRY_AGAIN)
    assert second.state.phase is Phase.REFUSED
    (waiting,) = lab.acts("waiting")
    assert set(waiting.lost.values()) == {f"refused, the configurator {first.name} holds it"}
    first.stop()
    assert lab.running(second)
    assert lab.active() == TASK | {"tracker"}
    assert lab.bodies["drive"].activation.supervisor == second.supervisor


def test_patience_goes_on_when_the_configurator_that_held_a_component_is_killed(lab: Lab) -> None:
    first = lab.agent()
    lab.running(first)
    second = lab.agent(patient=True)
    lab.let_pass(2 * TRY_AGAIN)
    lab.crash(first)
    assert lab.running(second)
    assert lab.active() == TASK | {"tracker"}


def test_patience_asks_nobody_again_who_has_refused_for_itself(lab: Lab) -> None:
    lab.components["drive"].refusal = Refused("the battery is empty")
    agent = lab.agent(patient=True)
    lab.let_pass(4 * TRY_AGAIN)
    assert agent.state.phase is Phase.REFUSED
    assert lab.components["drive"].said.count(("started",)) == 1


# Being cut off.


def test_a_configurator_that_was_suspended_applies_anew_to_whoever_has_turned_itself_off(lab: Lab) -> None:
    """It hears at one moment that everybody died and lives; meanwhile nobody has supervised them."""
    agent = lab.agent(policy=Policy.DISMANTLE)
    lab.running(agent)
    for name in TASK | {"tracker"}:
        lab.bodies[name]._orphaned()
    epoch = agent.state.epoch
    lab.isolate(agent)
    lab.rejoin(agent)
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert agent.state.epoch > epoch
    assert lab.active() == TASK | {"tracker"}
    assert lab.components["control"].said[-2:] == [("started",), ("goal", "(AT BEDROOM)")]
    assert not lab.acts("lost")
    assert len(lab.acts("connected")) == 1


def test_a_configurator_that_was_suspended_yields_to_the_one_that_has_taken_over(lab: Lab) -> None:
    first = lab.agent()
    lab.running(first)
    for name in TASK | {"tracker"}:
        lab.bodies[name]._orphaned()
    second = lab.agent()
    lab.running(second)
    lab.isolate(first)
    lab.rejoin(first)
    assert lab.until(lambda: first.state.phase is Phase.REFUSED)
    assert lab.active() == TASK | {"tracker"}
    assert all(lab.bodies[name].activation.supervisor == second.supervisor for name in TASK | {"tracker"})


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


def test_a_component_that_is_cut_off_for_a_moment_and_goes_on_is_kept(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.isolate("tracker")
    lab.let_pass(0.01)
    lab.rejoin("tracker")
    lab.let_pass(10.0)
    assert lab.active() == TASK | {"tracker"}
    assert lab.acts("lost") == []


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


def test_who_died_while_the_configurator_was_cut_off_is_replaced(lab: Lab) -> None:
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


def test_a_configurator_that_is_cut_off_can_be_stopped(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.isolate(agent)
    lab.let_pass(0.1)
    agent.stop()
    assert lab.until(lambda: bool(lab.ended), 10.0)
    lab.let_pass(GRACE + 0.1)
    assert lab.active() == set()


# Sites that do not answer.


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
    lab.let_pass(2 * ASK_AGAIN)
    assert isinstance(agent.state.refusal, Refusal)
    assert agent.state.refusal.missing_sites == ("living-room",)
    undo()
    empty = encode(Page(0, 0, 1))

    def answer(request: Request) -> None:
        request.reply(lab.keys.advertisements("living-room").replace("**", "none"), b"", empty)
        request.finish()

    node.serve(lab.keys.advertisements("living-room"), answer)
    lab.let_pass(2 * ASK_AGAIN)
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
    lab.let_pass(ASK_AGAIN)
    asked.clear()
    lab.let_pass(10 * ASK_AGAIN)
    assert len(asked) <= 10 * DISCOVERY_ATTEMPTS


def test_a_site_that_is_started_again_is_news_though_its_earlier_life_has_not_ended_yet(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.site("astrid", "sonar", "encoder", "control", "drive")
    for name in (*TASK, "tracker"):
        lab.component(name)
    first = lab.site("living-room", "pippi")
    agent = lab.agent(patient=True)
    lab.let_pass(2 * ASK_AGAIN)
    assert agent.state.phase is Phase.REFUSED
    (tmp_path / "living-room" / "pippi.ttl").unlink()
    lab.site("living-room", "tracker")
    first.bus.close()
    assert lab.running(agent)
    assert lab.active() == TASK | {"tracker"}


def test_a_dormant_component_whose_process_ends_at_once_is_not_given_up_a_second_time(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.site("astrid", *TASK, "odometry")
    for name in (*TASK, "odometry"):
        lab.component(name)
    tracker, node = iri("person-tracker"), lab.network.node()
    page = encode(Page(0, 1, 1, tracker, "tracker.ttl", startable=True))

    def advertise(request: Request) -> None:
        payload = (PREFIXES + ADVERTISEMENTS["tracker"]).encode()
        request.reply(lab.keys.advertisement("living-room", tracker), payload, page)
        request.finish()

    def wake(request: Request) -> None:
        request.reply(lab.keys.wake("living-room"), b"started")
        request.finish()
        node.publisher(lab.keys.fail(tracker), Urgency.EVENT).put(encode(Fail(tracker, "", 0, Cause.CRASH, "code 1")))

    node.announce(lab.keys.site_life("living-room", "1"))
    node.serve(lab.keys.advertisements("living-room"), advertise)
    node.serve(lab.keys.wake("living-room"), wake)
    agent = lab.agent()
    assert lab.running(agent)
    assert agent.state.lost[tracker].detail == "code 1"
    lab.let_pass(2 * WAKING)
    assert lab.acts("unreachable") == []


# What others ask of it.


def ask(lab: Lab, key: str) -> Replies:
    """Ask the ecology."""
    replies: list[Replies] = []
    lab.network.node().ask(key, b"", 1.0, replies.append)
    assert lab.until(lambda: bool(replies))
    return replies[0]


def test_it_says_what_it_has_deployed(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    (sample,) = ask(lab, lab.keys.configurator_call("*", "status")).samples
    status = decode(sample.payload, Status)
    assert (status.configurator, status.phase) == (agent.name, "running")
    assert status.template == iri("navigate")
    assert set(status.components) == set(agent.configuration.components) if agent.configuration else False
    assert status.lost == {iri("person-tracker"): "fail"}


def test_it_is_stopped_by_whoever_asks(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    assert ask(lab, lab.keys.configurator_call(agent.name, "stop")).samples
    assert lab.until(lambda: lab.ended == [None])
    assert lab.active() == set()


def test_a_call_that_it_does_not_know_is_refused(lab: Lab) -> None:
    agent = lab.agent()
    replies = ask(lab, lab.keys.configurator_call(agent.name, "dance"))
    assert replies.errors == ("there is no call 'dance'",)


def test_what_is_deployed_is_rdf_with_what_it_revises_and_why(lab: Lab) -> None:
    agent = lab.agent()
    assert ask(lab, lab.keys.configuration()).samples == ()
    lab.running(agent)
    (sample,) = ask(lab, lab.keys.configuration()).samples
    first = turtle.parse(sample.payload, "first")
    (name,) = first.instances(SC.Configuration)
    assert first.values(name, SC.template) == [iri("navigate")]
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    (sample,) = ask(lab, lab.keys.configuration()).samples
    second = turtle.parse(sample.payload, "second")
    (revision,) = second.instances(SC.Configuration)
    assert second.values(revision, PROV.wasRevisionOf) == [name]
    (failure,) = second.instances(SC.Failure)
    assert second.values(failure, SC.component) == [iri("person-tracker")]
    ((node, replaced),) = [
        (node, second.value(node, SC.replaces))
        for node in second.values(revision, SC.assignment)
        if second.values(node, SC.replaces)
    ]
    assert replaced == iri("person-tracker")
    assert second.value(node, SC.component) == iri("absolute-odometry")
    assert second.values(node, SC.passedOver) == [iri("person-tracker")]
    task = second.value(revision, SC.task)
    assert task is not None
    bound = {second.value(b, SC.parameter): second.value(b, SC.value) for b in second.values(task, SC.binding)}
    assert bound[iri("robot")] == iri("Astrid")


def test_what_is_deployed_names_the_newest_failure_of_each_component_and_keeps_no_other(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    for number in range(10):
        for name in ("tracker", "odometry"):
            lab.components[name].fail(f"broken {number}")
            lab.let_pass(1.0)
            lab.crash(name)
            lab.component(name)
            lab.let_pass(1.0)
    record = turtle.parse(agent._record.turtle(), "record.ttl")
    failures = record.instances(SC.Failure)
    assert {record.value(failure, SC.component) for failure in failures} == {
        iri("person-tracker"),
        iri("absolute-odometry"),
    }
    assert [str(record.value(failure, SC.detail)) for failure in failures] == ["broken 9", "broken 9"]


def test_no_broad_question_changes_anything(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    said = {name: list(recorder.said) for name, recorder in lab.components.items()}
    for key in ("**", "selfconf/**", "selfconf/lab/**"):
        ask(lab, key)
    lab.let_pass(1.0)
    assert {name: recorder.said for name, recorder in lab.components.items()} == said
    assert agent.state.phase is Phase.RUNNING


# Strangers.


def test_an_answer_that_is_none_is_passed_over(lab: Lab) -> None:
    """A component whose program speaks another protocol is replaced, not trusted."""
    body = lab.bodies["tracker"]
    body._served()

    def babble(request: Request) -> None:
        request.reply(lab.keys.call(iri("person-tracker"), "apply"), b"yes sir")
        request.finish()

    body.bus.serve(lab.keys.call(iri("person-tracker")), babble)
    agent = lab.agent()
    assert lab.running(agent)
    assert lab.active() == TASK | {"odometry"}


def test_a_stranger_cannot_release_what_a_configurator_holds(lab: Lab) -> None:
    lab.running(lab.agent())
    replies: list[Replies] = []
    them = lab.keys.configurator_life("them", "1")
    payload = encode(Release(1 << 60, them))
    lab.network.node().ask(lab.keys.call(iri("astrid-drive"), "release"), payload, 1.0, replies.append)
    assert lab.until(lambda: bool(replies))
    assert decode(replies[0].samples[0].payload, CallAnswer).verdict is Verdict.BUSY
    assert "drive" in lab.active()


def test_a_shape_that_cannot_be_judged_ends_the_task_with_its_error(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shacl, "SHAPE_SECONDS", 0.05)
    broken = NAVIGATE + ':drive sh:pattern "^([^!]+)+!$" .\n'
    agent = lab.agent(broken)
    assert lab.until(lambda: bool(lab.ended))
    assert isinstance(agent.trouble, TemplateError)
    assert lab.active() == set()


def test_what_it_does_is_told_in_the_order_of_the_four_acts(lab: Lab) -> None:
    lab.running(lab.agent())
    lab.let_pass(0.1)
    acts = [account.act for account in lab.events]
    firsts = [
        acts.index(act) for act in ("query", "discovered", "composed", "watching", "activating", "set", "running")
    ]
    assert firsts == sorted(firsts)
    assert max(i for i, act in enumerate(acts) if act == "watching") < acts.index("activating")
    connected = {(str(a.source), str(a.output)) for a in lab.acts("connecting")}
    assert (str(iri("person-tracker")), "pose") in connected
    assert all(event_body(event) for event in lab.events)


def test_connections_that_are_made_again_are_told_again(lab: Lab) -> None:
    agent = lab.agent(patient=True)
    lab.running(agent)
    made = len(lab.acts("connecting"))
    lab.crash("drive")
    lab.let_pass(1.0)
    assert lab.active() == set()
    lab.component("drive")
    lab.running(agent)
    assert len(lab.acts("connecting")) == 2 * made
    lab.isolate(agent)
    lab.let_pass(GRACE + 0.5)
    lab.rejoin(agent)
    lab.let_pass(SETTLING + 1.0)
    assert lab.active() == TASK | {"tracker"}
    assert len(lab.acts("connecting")) == 3 * made


def test_a_connection_that_is_kept_is_told_once(lab: Lab) -> None:
    lab.running(lab.agent())
    made = len(lab.acts("connecting"))
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    (new,) = lab.acts("connecting")[made:]
    assert (new.source, new.sink) == (iri("absolute-odometry"), iri("thinking-cap"))


def test_an_input_follows_every_output_that_feeds_it(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.navigation()
    both = NAVIGATE.replace(
        "sh:class rob:PositionSensor ;", "sh:class rob:PositionSensor ; sc:minCount 2 ; sc:maxCount 2 ;"
    )
    assert lab.running(lab.agent(both))
    lab.components["tracker"].emit("pose", 1)
    lab.components["odometry"].emit("pose", 2)
    lab.let_pass(0.1)
    values: list[Any] = [said[1] for said in lab.components["control"].said if said[0] == "position"]
    assert sorted(values) == [1, 2]
