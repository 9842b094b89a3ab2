"""Single calls of a configurator: components that are slow, hang, refuse, are held, or live another life."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from selfconf.bus.port import Replies, Request, Sample
from selfconf.configurator.state import Phase
from selfconf.deployment.components import calling
from selfconf.deployment.components.calling import CALL, STARTING
from selfconf.model.run_event import ComponentLost
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import component_chunk
from selfconf.protocol.messages import CallAnswer, Cause, Release, Reserve, Verdict
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.vocabulary import SC
from selfconf.sdk.component import Refused
from tests.deployment.simulated import slow_code
from tests.deployment.tasks import TASK
from tests.lab import ADVERTISEMENTS, Lab, iri


def busy_in_started(lab: Lab, name: str, seconds: float) -> None:
    """Have the thread of a component be in `started` for so long: all that it is asked is heard afterwards."""
    runtime, free = lab.runtimes[name], lab.network.time + seconds
    runtime.calls.close()

    def hear(request: Request) -> None:
        runtime.bus.later(max(0.0, free - lab.network.time), lambda: runtime.calls.receive(request))

    runtime.bus.serve(lab.keys.call(runtime.profile.component), hear)


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


def test_a_component_that_fails_while_it_starts_is_not_said_to_be_active_after_that(lab: Lab) -> None:
    """It answers the call all the same, and that comes after its FAIL."""
    tracker = lab.components["tracker"]
    tracker.started = lambda: tracker.fail("it is dark")  # type: ignore[method-assign]  # its code fails at once
    assert lab.running(lab.agent())
    lab.let_pass(1.0)
    said = [event.act for event in lab.events if getattr(event, "component", None) == iri("person-tracker")]
    assert said == ["watching", "activating", "lost", "released"]


def test_a_component_that_takes_long_to_start_is_waited_for_as_long_as_it_lives(lab: Lab) -> None:
    busy_in_started(lab, "tracker", STARTING - CALL)
    agent = lab.agent()
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, STARTING + CALL)
    assert lab.active() == TASK | {"tracker"}
    assert lab.components["tracker"].said == [("started",)]


@pytest.mark.parametrize(
    ("deadline", "seconds"),
    [
        pytest.param("", STARTING - 0.5, id="by default"),
        pytest.param("; sc:deadline [ sc:value 20 ; sc:unit unit:SEC ]", 19.0, id="with a deadline of its own"),
    ],
)
def test_code_may_take_to_start_as_long_as_its_deadline_says(tmp_path: Path, deadline: str, seconds: float) -> None:
    tracker = ADVERTISEMENTS["tracker"].rstrip(" .") + f"{deadline} ."
    lab = Lab(tmp_path, advertised={**ADVERTISEMENTS, "tracker": tracker})
    lab.navigation()
    slow_code(lab, "tracker")
    lab.components["tracker"].slow = seconds
    agent = lab.agent()
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, seconds + 1.0)
    assert lab.active() == TASK | {"tracker"}
    assert lab.components["tracker"].said == [("started",)]


def test_code_that_takes_longer_to_start_than_it_may_is_said_to_hang(lab: Lab) -> None:
    slow_code(lab, "tracker")
    lab.components["tracker"].slow = STARTING + 30.0
    agent = lab.agent()
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, STARTING + CALL)
    assert lab.active() == TASK | {"odometry"}
    loss = agent.state.lost[iri("person-tracker")]
    assert (loss.cause, loss.detail) == (Cause.HUNG, "`started` has not returned within 8 s")


def test_a_component_whose_code_does_not_come_to_rest_is_out_of_control_until_it_does(lab: Lab) -> None:
    """It lives, and says that it is held by no task; but it may still act."""
    thread = slow_code(lab, "drive")
    agent = lab.agent()
    assert lab.running(agent)
    thread.spend(60.0)
    agent.stop()
    assert lab.until(lambda: bool(lab.ended), 3 * CALL)
    assert lab.acts("stopped")[0].owed == (iri("astrid-drive"),)
    assert iri("astrid-drive") not in [event.component for event in lab.acts("released")]
    assert {event.detail for event in lab.acts("unreachable")} == {"its code has not come to rest"}


def test_a_component_whose_code_comes_to_rest_late_owes_nothing_any_more(lab: Lab) -> None:
    thread = slow_code(lab, "tracker")
    agent = lab.agent()
    assert lab.running(agent)
    thread.spend(2 * CALL)
    lab.components["tracker"].fail("lost")
    assert lab.until(lambda: lab.active() == TASK | {"odometry"}, 1.0)
    assert agent.status().owed == (iri("person-tracker"),)
    assert lab.until(lambda: agent.status().owed == (), 4 * CALL)
    assert lab.components["tracker"].said[-1] == ("stopped",)


def test_a_component_that_dies_while_it_takes_long_to_start_is_replaced_at_once(lab: Lab) -> None:
    busy_in_started(lab, "tracker", STARTING)
    agent = lab.agent()
    lab.let_pass(3 * CALL)
    assert agent.state.phase is Phase.RESERVING
    lab.crash("tracker")
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, CALL)
    assert agent.state.lost[iri("person-tracker")].cause is Cause.CRASH


def test_a_component_that_hangs_is_replaced(lab: Lab) -> None:
    """It lives, but answers no call."""
    runtime = lab.runtimes["tracker"]
    runtime.calls.close()
    runtime.bus.serve(lab.keys.call(iri("person-tracker")), lambda _: None)
    agent = lab.agent()
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, STARTING + 2 * CALL)
    assert lab.active() == TASK | {"odometry"}


def test_a_component_held_by_another_living_configurator_is_not_taken(lab: Lab) -> None:
    first = lab.agent()
    lab.running(first)
    second = lab.agent()
    assert lab.until(lambda: second.state.phase is Phase.REFUSED)
    assert first.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"tracker"}
    assert lab.components["drive"].said == [("started",)]
    lab.let_pass(1.0)
    assert lab.acts("declined") == []  # it has asked the other configurators before
    lost = {event.component: event.detail for event in lab.acts("lost")}
    holder = f"the task navigate (priority 0, configurator {first.name}) holds it"
    assert lost == dict.fromkeys([iri("thinking-cap"), iri("astrid-drive")], holder)


def test_a_component_that_another_task_takes_at_the_same_moment_is_declined_by_the_component_itself(lab: Lab) -> None:
    first, second = lab.agent(), lab.agent()
    assert lab.until(lambda: {first.state.phase, second.state.phase} == {Phase.RUNNING, Phase.REFUSED})
    assert lab.active() == TASK | {"tracker"}
    assert lab.components["drive"].said == [("started",)]
    winner = first if first.state.phase is Phase.RUNNING else second
    holds = [hold for name in TASK for hold in lab.runtimes[name].activation.holds]
    assert {hold.claim.task for hold in holds} == {winner.identity.task}


def test_each_answer_to_a_call_is_read_once(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[bytes] = []

    def reading(payload: bytes, expected: type[CallAnswer]) -> CallAnswer:
        read.append(payload)
        return decode(payload, expected)

    monkeypatch.setattr(calling, "decode", reading)
    agent = lab.agent()
    assert lab.running(agent)
    assert len(read) == 2 * len(lab.active())
    assert len(set(read)) == len(read)


def test_a_component_has_obeyed_a_release_once_this_configurator_holds_it_no_more(lab: Lab) -> None:
    drive, calls = iri("astrid-drive"), lab.agent()._components.calls._calling
    message = Release(**calls.claim(drive, 1))
    call = calling._PendingCall(calls, drive, message, None)
    held = CallAnswer(Verdict.DONE, drive, message.life, 1, True, supervisor=message.supervisor, task=message.task)
    assert not call._has_obeyed(held)
    assert call._has_obeyed(replace(held, supervisor="that of another configurator of the task"))
    assert call._has_obeyed(replace(held, task="another task"))


@pytest.mark.parametrize("lives", [("meant", "other"), ("other", "meant")])
def test_of_several_lives_that_answer_the_one_counts_that_was_meant(lab: Lab, lives: tuple[str, str]) -> None:
    drive = iri("astrid-drive")
    said = (encode(CallAnswer(Verdict.DONE, drive, life, 1)) for life in lives)
    replies = Replies(tuple(Sample(lab.keys.call(drive, "apply"), payload) for payload in said))
    answer = lab.agent()._components.calls._calling.answer_in(replies, "meant")
    assert answer is not None
    assert answer.life == "meant"


def test_every_call_names_the_life_that_is_meant_so_that_no_other_life_obeys_it(lab: Lab) -> None:
    """A process that is started while the call for the one before is on its way does not act for it."""
    runtime = lab.runtimes["drive"]
    held: list[Request] = []
    runtime.calls.close()
    runtime.bus.serve(lab.keys.call(iri("astrid-drive")), held.append)
    agent = lab.agent()
    assert lab.until(lambda: bool(held))
    lab.crash("drive")
    drive = lab.component("drive")
    message = decode(held[0].payload, Reserve)
    assert message.life == runtime.life
    replies: list[Replies] = []
    lab.network.node().ask(lab.keys.call(iri("astrid-drive"), "reserve"), held[0].payload, 1.0, replies.append)
    assert lab.until(lambda: bool(replies))
    assert decode(replies[0].samples[0].payload, CallAnswer).verdict is Verdict.OTHER_LIFE
    assert drive.said == []
    assert agent.state.phase is not Phase.RUNNING


def test_a_life_whose_end_was_never_heard_of_has_ended_when_only_another_answers(lab: Lab) -> None:
    lab.crash("tracker")
    agent = lab.agent(patient=True)
    assert lab.running(agent)
    lab.component("tracker")
    lab.let_pass(0.1)
    agent.ecology.began(component_chunk(iri("person-tracker")), "0")
    lab.crash("odometry")
    assert lab.until(lambda: lab.active() == TASK | {"tracker"}, 1.0)
    assert lab.running(agent)


@pytest.mark.parametrize(
    ("answer", "problem"),
    [
        pytest.param(b"yes sir", "not a message: ", id="no JSON"),
        pytest.param(b'{"kind": "yes"}', "not a message of kind 'answer'", id="another message"),
        pytest.param(b'{"kind": "answer", "verdict": "done", "component": "urn:x"}', "lacks 'life'", id="incomplete"),
        pytest.param(
            b'{"kind": "answer", "verdict": "done", "component": "urn:x", "life": "a", "epoch": 7.0}',
            "the member 'epoch' ",
            id="another type",
        ),
    ],
)
def test_a_component_that_speaks_another_protocol_is_replaced_and_it_is_said_why(
    lab: Lab, answer: bytes, problem: str
) -> None:
    """A component whose program speaks another protocol is not trusted; its author reads what is wrong with it."""
    runtime = lab.runtimes["tracker"]
    runtime.calls.close()

    def babble(request: Request) -> None:
        request.reply(lab.keys.call(iri("person-tracker"), "apply"), answer)
        request.finish()

    runtime.bus.serve(lab.keys.call(iri("person-tracker")), babble)
    agent = lab.agent()
    assert lab.running(agent)
    assert lab.active() == TASK | {"odometry"}
    (lost,) = [event for event in lab.events if isinstance(event, ComponentLost)]
    assert lost.detail.startswith("its answer cannot be read: ")
    assert problem in lost.detail
