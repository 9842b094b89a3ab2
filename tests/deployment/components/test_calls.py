"""The calls of a configurator: components that are slow, hang, refuse, are held, or do not run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from selfconf.bus.port import Replies, Request
from selfconf.configurator.state import Phase
from selfconf.deployment.components import calls
from selfconf.deployment.components.calls import CALL, SITE_ENDS, STARTING
from selfconf.deployment.components.liveness import SETTLING
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import component_chunk
from selfconf.protocol.messages import CallAnswer, Cause, End, Page, Release, Reserve, Verdict, Wake
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.vocabulary import SC
from selfconf.sdk.component import Refused
from selfconf.sdk.runtime import LIFE_ENDS
from selfconf.sdk.supervision import GRACE
from tests.deployment.simulated import home, living_room, slow_code
from tests.deployment.tasks import TASK
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES, Lab, Recorder, iri


def busy_in_started(lab: Lab, name: str, seconds: float) -> None:
    """Have the thread of a component be in `started` for so long: all that it is asked is heard afterwards."""
    runtime, free = lab.runtimes[name], lab.network.time + seconds
    runtime._served()

    def hear(request: Request) -> None:
        runtime.bus.later(max(0.0, free - lab.network.time), lambda: runtime._call(request))

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
    runtime._served()
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

    monkeypatch.setattr(calls, "decode", reading)
    agent = lab.agent()
    assert lab.running(agent)
    assert len(read) == 2 * len(lab.active())
    assert len(set(read)) == len(read)


def test_every_call_names_the_life_that_is_meant_so_that_no_other_life_obeys_it(lab: Lab) -> None:
    """A process that is started while the call for the one before is on its way does not act for it."""
    runtime = lab.runtimes["drive"]
    held: list[Request] = []
    runtime._served()
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


def test_nothing_acts_before_everything_is_reserved(lab: Lab) -> None:
    """The sonar array cannot be reserved: what comes before it is held, nothing else is, and nothing acts."""
    runtime = lab.runtimes["sonar"]
    runtime._served()
    agent = lab.agent()
    assert lab.until(lambda: agent.state.phase is Phase.RESERVING)
    lab.let_pass(1.0)
    assert lab.active() == set()
    reserved = {name for name in TASK | {"tracker"} if lab.runtimes[name].activation.holds}
    assert reserved == {"drive", "tracker"}  # in the order of the IRIs: astrid-drive, person-tracker, sonar-array


def test_components_start_after_those_that_feed_them_and_actuators_last_and_rest_the_other_way(lab: Lab) -> None:
    order: list[tuple[str, str]] = []
    for name in (*TASK, "tracker"):
        recorder = lab.components[name]
        recorder.started = lambda name=name: order.append(("on", name))  # type: ignore[method-assign,misc]  # it notes
        recorder.stopped = lambda name=name: order.append(("off", name))  # type: ignore[method-assign,misc]  # the order
    agent = lab.agent()
    lab.running(agent)
    on = [name for _, name in order]
    assert (set(on[:3]), on[3:]) == ({"sonar", "encoder", "tracker"}, ["control", "drive"])
    order.clear()
    agent.stop()
    assert lab.until(lambda: bool(lab.ended))
    off = [name for _, name in order]
    assert (off[:2], set(off[2:])) == (["drive", "control"], {"sonar", "encoder", "tracker"})


@pytest.mark.parametrize("seconds", [0.3, 2 * SITE_ENDS], ids=["soon", "late"])
def test_a_component_that_does_not_obey_its_release_is_ended_by_its_site(tmp_path: Path, seconds: float) -> None:
    """It is out of control if the site takes too long for that."""
    lab = Lab(tmp_path)
    lab.site("astrid", *TASK, "odometry")
    for name in ADVERTISEMENTS:
        lab.component(name)
    node, tracker = lab.network.node(), iri("person-tracker")
    page = encode(Page(0, 1, 1, tracker, "tracker.ttl", startable=True))
    ended: list[End] = []

    def advertise(request: Request) -> None:
        payload = (PREFIXES + ADVERTISEMENTS["tracker"]).encode()
        request.reply(lab.keys.advertisement("living-room", tracker), payload, page)
        request.finish()

    def end(request: Request) -> None:
        ended.append(decode(request.payload, End))
        node.later(seconds, lambda: gone(request))

    def gone(request: Request) -> None:
        lab.crash("tracker")
        request.reply(lab.keys.end("living-room"), b"ended")
        request.finish()

    node.announce(lab.keys.site_life("living-room", "1"))
    node.serve(lab.keys.advertisements("living-room"), advertise)
    node.serve(lab.keys.end("living-room"), end)
    agent = lab.agent()
    assert lab.running(agent)
    assert "tracker" in lab.active()
    runtime = lab.runtimes["tracker"]
    runtime._served()
    runtime.bus.serve(lab.keys.call(tracker), lambda _: None)
    agent.stop()
    assert lab.until(lambda: bool(lab.ended))
    assert ended == [End(tracker, runtime.life)]
    (stopped,) = lab.acts("stopped")
    assert stopped.owed == (() if seconds < SITE_ENDS else (tracker,))
    off = [event.detail for event in lab.acts("released") if event.component == tracker]
    assert off == (["its site has ended its process"] if seconds < SITE_ENDS else [])
    assert lab.until(lambda: lab.active() == set())


def test_a_task_that_is_stopped_while_it_waits_says_of_no_component_that_it_is_off(lab: Lab) -> None:
    first = lab.agent()
    assert lab.running(first)
    second = lab.agent(patient=True)
    assert lab.until(lambda: second.state.phase is Phase.REFUSED)
    lab.let_pass(1.0)
    assert second.state.queued
    second.stop()
    assert lab.until(lambda: second.state.ended)
    assert lab.acts("released") == []
    first.stop()
    assert lab.until(lambda: first.state.ended)
    names = TASK | {"tracker"}
    assert {event.component for event in lab.acts("released")} == {lab.profile(name).component for name in names}


def test_a_task_waits_for_a_component_whose_life_is_ending_and_has_its_site_start_it_again(tmp_path: Path) -> None:
    """Its code is in `started` for another task; its process is told to end meanwhile, and ends as that returns."""
    lab = home(tmp_path)
    lab.component("tracker")
    thread = slow_code(lab, "tracker")
    runtime = lab.runtimes["tracker"]
    living_room(lab, "1", lambda _: lab.runtimes["tracker"] is runtime and lab.component("tracker"))
    runtime.code.stop(runtime.at_rest)
    thread.spend(1.5)
    agent = lab.agent()
    runtime.bus.later(1.5, runtime.close)
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, 5.0)
    assert lab.runtimes["tracker"] is not runtime
    assert lab.active() == TASK | {"tracker"}
    assert {event.cause for event in lab.acts("lost")} == {"crash"}
    assert lab.acts("lost")[0].detail == LIFE_ENDS


def hangs_in_reach_of_a_site(lab: Lab, lives: list[str]) -> None:
    """The tracker answers no call in its first lives, and its site ends it and starts it again, whenever asked to."""
    tracker = iri("person-tracker")

    def begin(node: object = None) -> None:
        lab.component("tracker")
        runtime = lab.runtimes["tracker"]
        lives.append(runtime.life)
        if len(lives) < 3:
            runtime._served()
            runtime.bus.serve(lab.keys.call(tracker), lambda _: None)

    def end(request: Request) -> None:
        if decode(request.payload, End).life == lab.runtimes["tracker"].life:
            lab.crash("tracker")
        request.finish()

    lab.site("astrid", *TASK)
    for name in TASK:
        lab.component(name)
    living_room(lab, "1", begin).serve(lab.keys.end("living-room"), end)
    begin()


def test_a_component_that_hangs_is_started_again_each_time_that_its_site_does_so(tmp_path: Path) -> None:
    lab, lives, woken = Lab(tmp_path), list[str](), list[Wake]()
    hangs_in_reach_of_a_site(lab, lives)

    def listen(request: Request) -> None:
        woken.append(decode(request.payload, Wake))
        request.finish()

    lab.network.node().serve(lab.keys.wake("living-room"), listen)
    agent = lab.agent()
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, 4 * (STARTING + 2 * CALL))
    assert lab.active() == TASK | {"tracker"}
    assert [wake.after for wake in woken] == lives[:2]  # so that the site counts them


def test_a_component_that_speaks_another_protocol_is_replaced(lab: Lab) -> None:
    """A component whose program speaks another protocol is replaced, not trusted."""
    runtime = lab.runtimes["tracker"]
    runtime._served()

    def babble(request: Request) -> None:
        request.reply(lab.keys.call(iri("person-tracker"), "apply"), b"yes sir")
        request.finish()

    runtime.bus.serve(lab.keys.call(iri("person-tracker")), babble)
    agent = lab.agent()
    assert lab.running(agent)
    assert lab.active() == TASK | {"odometry"}


def test_connections_that_are_made_again_are_reported_again(lab: Lab) -> None:
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


def test_a_connection_that_is_kept_is_reported_once(lab: Lab) -> None:
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


class Emitting(Recorder):
    """A source of positions that emits ten a second, or none at all."""

    def __init__(self, *, mute: bool = False) -> None:
        super().__init__()
        self.mute = mute

    def started(self) -> None:
        super().started()
        if not self.mute:
            self.every(0.1, lambda: self.emit("pose", {"x": 0}))


@pytest.mark.parametrize("mute", [True, False])
def test_what_runs_is_changed_only_to_a_source_that_delivers(lab: Lab, mute: bool) -> None:
    for name in ("tracker", "odometry"):
        lab.crash(name)
    lab.component("odometry", Emitting())
    agent = lab.agent(upgrade=0.5)
    assert lab.running(agent)
    lab.component("tracker", Emitting(mute=mute))
    lab.let_pass(10.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"odometry" if mute else "tracker"}
    assert ("silence" in [event.cause for event in lab.acts("lost")]) == mute
    assert lab.components["odometry"].said == [("started",)] + ([] if mute else [("stopped",)])
    assert lab.components["tracker"].said == [("started",)] + ([("stopped",)] if mute else [])
    assert lab.components["drive"].said.count(("stopped",)) == 0


def test_a_task_waits_where_another_configurator_of_it_has_run_it_by_a_clock_that_was_ahead(lab: Lab) -> None:
    """Each component orders the calls of a task by their epochs, and remembers the newest that it has obeyed."""
    other = lab.agent()
    assert lab.running(other)
    agent = lab.agent(patient=True)
    before = lab.keys.configurator_life("before", "1")
    released = encode(Release(agent.state.epoch + 300_000, before, agent.identity.task))
    for name in ("thinking-cap", "astrid-drive"):
        lab.network.node().ask(lab.keys.call(iri(name), "release"), released, CALL, lambda replies: None)
    assert lab.until(lambda: agent.state.phase is Phase.REFUSED)
    lab.let_pass(1.0)
    for name in ("control", "drive"):
        assert [claim.task for claim in lab.runtimes[name].activation.waiting] == [agent.identity.task]
    other.stop()
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, 1.0)
