"""A task that is run in a small ecology, in simulated time: the paper's experiment, its end, and its reports."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from selfconf.bus.memory import MemoryBus
from selfconf.bus.port import Replies
from selfconf.configurator.events import Call, Failed
from selfconf.configurator.state import Loss, Phase, Policy
from selfconf.deployment.components.calling import CALL
from selfconf.deployment.runner import LOSSES_TOLD, RETURN
from selfconf.model.refusal import TooFewEligible
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import CallAnswer, Cause, Release, Status, TaskRecord, Verdict
from selfconf.sdk.runtime.supervision import GRACE
from tests.deployment.simulated import living_room
from tests.deployment.tasks import TASK
from tests.lab import ADVERTISEMENTS, Lab, Recorder, iri


def released(recorder: Recorder) -> bool:
    """Whether a component was turned off as often as it was turned on."""
    return recorder.said.count(("started",)) == recorder.said.count(("stopped",))


def test_the_task_is_configured_with_the_tracker_and_never_with_the_drive_of_pippi(lab: Lab) -> None:
    agent = lab.agent()
    assert lab.running(agent)
    assert lab.active() == TASK | {"tracker"}
    assert lab.components["pippi"].said == []
    assert agent.configuration is not None
    assert agent.configuration.components == tuple(
        map(iri, ("sonar-array", "wheels", "person-tracker", "thinking-cap", "astrid-drive"))
    )


def test_signals_flow_along_the_connections_and_the_goal_is_set_first(lab: Lab) -> None:
    lab.running(lab.agent())
    lab.components["tracker"].emit("pose", {"x": 1})
    lab.components["odometry"].emit("pose", {"x": 9})
    lab.components["control"].emit("set.velocity", {"v": 0.3})
    lab.let_pass(0.1)
    assert lab.components["control"].said == [("goal", "(AT BEDROOM)"), ("started",), ("position", {"x": 1})]
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
    told = agent.losses
    with pytest.raises(TypeError):
        told[iri("person-tracker")] = "it is back"  # type: ignore[index]  # that is what is tested
    assert told == {iri("person-tracker"): "fail, Astrid has left the picture"}


def test_repair_neither_stops_nor_starts_nor_sets_anew_what_runs(lab: Lab) -> None:
    lab.running(lab.agent())
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    assert lab.components["control"].said == [("goal", "(AT BEDROOM)"), ("started",)]
    for name in ("sonar", "encoder", "drive"):
        assert lab.components[name].said == [("started",)]


def test_dismantling_first_stops_all_components_as_the_paper_does(lab: Lab) -> None:
    agent = lab.agent(policy=Policy.DISMANTLE)
    lab.running(agent)
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.components["drive"].said == [("started",), ("stopped",), ("started",)]
    assert lab.components["control"].said == [
        ("goal", "(AT BEDROOM)"),
        ("started",),
        ("stopped",),
        ("goal", "(AT BEDROOM)"),
        ("started",),
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


def test_its_status_names_the_task_its_priority_and_since_when(lab: Lab) -> None:
    lab.let_pass(5.0)
    agent = lab.agent(priority=3)
    status = agent.status()
    assert (status.task, status.priority, status.beginning) == (f"navigate~{agent.name}", 3, lab.network.time)


def test_a_stranger_cannot_release_what_a_configurator_holds(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    replies: list[Replies] = []
    them = lab.keys.configurator_life("them", "1")
    payload = encode(Release(1 << 60, them, agent.identity.task))
    lab.network.node().ask(lab.keys.call(iri("astrid-drive"), "release"), payload, 1.0, replies.append)
    assert lab.until(lambda: bool(replies))
    assert decode(replies[0].samples[0].payload, CallAnswer).verdict is Verdict.BUSY
    assert "drive" in lab.active()


def test_a_configurator_that_has_ended_asks_nobody_any_more(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    agent = lab.agent(bound=(("robot", ":Nobody"), ("goal", "(AT BEDROOM)")))
    assert lab.until(lambda: bool(lab.ended))
    lab.let_pass(10.0)
    timers: list[float] = []
    monkeypatch.setattr(agent.bus, "later", lambda seconds, action: timers.append(seconds))
    lab.let_pass(10.0)
    assert timers == []


@pytest.mark.parametrize("patient", [False, True])
def test_a_task_is_refused_though_it_cannot_hear_who_holds_what_it_needs(lab: Lab, patient: bool) -> None:
    first = lab.agent()
    assert lab.running(first)
    second = lab.agent(patient=patient)
    assert isinstance(first.bus, MemoryBus)
    assert isinstance(second.bus, MemoryBus)
    lab.network.cut(first.bus, second.bus)
    assert lab.until(lambda: second.state.phase is Phase.REFUSED, 5.0)
    assert second.state.attempt < 10


def test_of_very_many_losses_the_newest_are_told_so_that_the_status_can_be_sent(lab: Lab) -> None:
    agent = lab.agent()
    assert lab.running(agent)
    lost = {iri(f"{'passing-by' * 10}-{number}"): Loss(Cause.CRASH) for number in range(20_000)}
    agent.state = replace(agent.state, lost=lost)
    told = decode(encode(agent.status()), Status).lost
    assert list(told) == list(agent.losses) == list(lost)[-LOSSES_TOLD:]


def test_of_very_many_losses_that_last_the_newest_are_recorded_so_that_sites_take_the_record(lab: Lab) -> None:
    agent = lab.agent()
    assert lab.running(agent)
    lost = {iri(f"passing-by-{number}"): Loss(Cause.FAIL, "blind", life="1") for number in range(20_000)}
    agent.state = replace(agent.state, lost=lost)
    record = TaskRecord("navigate~1", 1, lost=agent.recorded_losses)
    assert decode(encode(record), TaskRecord).lost == agent.recorded_losses
    assert {one.component for one in record.lost} == set(list(lost)[-LOSSES_TOLD:])


def test_why_a_component_was_lost_is_its_cause_where_nothing_else_is_known(lab: Lab) -> None:
    agent = lab.agent()
    assert lab.running(agent)
    lab.components["tracker"].fail("")
    lab.let_pass(1.0)
    assert agent.losses == {iri("person-tracker"): "fail"}


def test_what_has_gone_without_a_word_is_waited_for_as_long_whatever_comes_meanwhile(lab: Lab) -> None:
    agent = lab.agent()
    assert lab.running(agent)
    lab.crash("drive")
    for number in range(50):
        leave = lab.network.node().announce(lab.keys.life(iri("stranger"), str(number)))
        lab.let_pass(0.9 * RETURN / 50)
        leave()
    assert not agent.state.ended
    lab.component("drive")
    assert lab.running(agent)


def test_a_life_that_hangs_and_ends_as_it_is_to_be_reserved_again_is_one_loss(tmp_path: Path) -> None:
    """Its site thinks it alive at first, so it is reserved; nothing else can take its place."""
    lab = Lab(tmp_path)
    lab.site("astrid", *TASK)
    for name in (*TASK, "tracker"):
        lab.component(name)

    def wake(_: object) -> None:
        if not lab.node_of("tracker").open:
            lab.component("tracker")

    living_room(lab, "1", wake)
    agent = lab.agent()
    assert lab.running(agent)
    hung = lab.runtimes["tracker"]
    hung.calls.close()
    hung.bus.serve(lab.keys.call(iri("person-tracker")), lambda _: None)
    hung.hung("it hangs")
    assert lab.until(lambda: (iri("person-tracker"), Call.RESERVE) in agent.state.pending, CALL)
    lab.crash("tracker")
    lab.let_pass(0.2)
    assert [(one.component, one.cause) for one in lab.acts("lost")] == [(iri("person-tracker"), "hung")]
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, CALL)
