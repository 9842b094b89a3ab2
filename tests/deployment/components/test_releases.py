"""Components are turned off: what does not obey is ended by its site, told again, or out of control."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from selfconf.bus.memory import MemoryBus
from selfconf.bus.port import Replies, Request
from selfconf.configurator import Failed
from selfconf.configurator.state import Phase
from selfconf.deployment.components.calling import CALL, STARTING, CallMessage
from selfconf.deployment.components.releases import SITE_ENDS
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import Cause, End, Page, Release, Wake
from selfconf.site.component_program import TERMINATION
from tests.deployment.simulated import living_room
from tests.deployment.tasks import TASK
from tests.lab import ADVERTISEMENTS, PREFIXES, Lab, iri


@pytest.mark.parametrize(
    ("seconds", "in_time", "is_silent"),
    [
        pytest.param(0.3, True, True, id="soon"),
        pytest.param(TERMINATION + 0.1, True, True, id="killed"),
        pytest.param(2 * SITE_ENDS, False, True, id="late"),
        pytest.param(0.0, True, False, id="its process has ended as it was to answer"),
    ],
)
def test_a_component_that_does_not_obey_its_release_is_ended_by_its_site(
    tmp_path: Path, seconds: float, in_time: bool, is_silent: bool
) -> None:
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
    runtime.calls.close()
    if is_silent:
        runtime.bus.serve(lab.keys.call(tracker), lambda _: None)
    agent.stop()
    assert lab.until(lambda: bool(lab.ended))
    assert ended == [End(tracker, runtime.life, agent.identity.task)]
    (stopped,) = lab.acts("stopped")
    assert stopped.owed == (() if in_time else (tracker,))
    off = [event.detail for event in lab.acts("released") if event.component == tracker]
    assert off == (["its site has ended its process"] if in_time else [])
    assert lab.until(lambda: lab.active() == set())


def test_a_component_that_has_let_go_of_the_task_out_of_its_sight_is_not_ended_and_not_out_of_control(
    tmp_path: Path,
) -> None:
    """As over a link that was cut for a moment: its site finds that it acts for the task no more."""
    lab, tracker = Lab(tmp_path), iri("person-tracker")
    lab.site("astrid", *TASK)
    for name in (*TASK, "tracker"):
        lab.component(name)

    def end(request: Request) -> None:
        request.reply(lab.keys.end("living-room"), b"let go")
        request.finish()

    living_room(lab, "1", lambda node: None).serve(lab.keys.end("living-room"), end)
    agent = lab.agent()
    assert lab.running(agent)
    runtime = lab.runtimes["tracker"]
    runtime.calls.close()
    runtime.bus.serve(lab.keys.call(tracker), lambda _: None)
    agent.stop()
    assert lab.until(lambda: bool(lab.ended))
    assert lab.acts("stopped")[0].owed == ()
    assert [event.detail for event in lab.acts("released") if event.component == tracker] == ["done"]


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


def hangs_in_reach_of_a_site(lab: Lab, lives: list[str]) -> None:
    """The tracker answers no call in its first lives, and its site ends it and starts it again, whenever asked to."""
    tracker = iri("person-tracker")

    def begin(node: object = None) -> None:
        lab.component("tracker")
        runtime = lab.runtimes["tracker"]
        lives.append(runtime.life)
        if len(lives) < 3:
            runtime.calls.close()
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


def test_what_is_waited_for_is_started_again_when_its_site_has_ended_it_for_an_earlier_release(tmp_path: Path) -> None:
    """Its site was asked for it before, while it lived out of sight of the task alone."""
    lab, tracker, woken = Lab(tmp_path), iri("person-tracker"), list[float]()
    lab.site("astrid", *TASK)
    for name in (*TASK, "tracker"):
        lab.component(name)
    hung = lab.runtimes["tracker"]

    def wake(node: object) -> None:
        woken.append(lab.network.time)
        if not lab.node_of("tracker").open:
            lab.component("tracker")

    def end(request: Request) -> None:
        lab.crash("tracker")
        request.reply(lab.keys.end("living-room"), b"ended")
        request.finish()

    living_room(lab, "1", wake).serve(lab.keys.end("living-room"), end)
    agent = lab.agent()
    assert lab.running(agent)
    hung.calls.close()
    hung.bus.serve(lab.keys.call(tracker), lambda _: None)
    hung.hung("it hangs")
    lab.let_pass(0.1)
    assert isinstance(agent.bus, MemoryBus)
    lab.network.cut(agent.bus, lab.node_of("tracker"))
    assert lab.until(lambda: len(woken) == 1, 1.0)
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, CALL + SITE_ENDS)
    assert len(woken) == 2
    assert lab.runtimes["tracker"].active


def test_a_component_that_has_obeyed_since_is_not_ended_for_a_release_that_was_lost(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its life seemed to end for a moment, and is held again."""
    lab, tracker, ended = Lab(tmp_path), iri("person-tracker"), list[Request]()
    lab.site("astrid", *TASK)
    for name in (*TASK, "tracker"):
        lab.component(name)
    living_room(lab, "1", lambda node: None).serve(lab.keys.end("living-room"), ended.append)
    agent = lab.agent()
    assert lab.running(agent)
    calling = agent._components.calls._calling
    ask, lost = calling.ask, list[CallMessage]()

    def lose_first_release(
        component: IRI, message: CallMessage, answered: Callable[[Replies], None] = lambda replies: None
    ) -> None:
        if isinstance(message, Release) and not lost:
            lost.append(message)
            agent.bus.later(CALL, lambda: answered(Replies(complete=False)))
        else:
            ask(component, message, answered)

    monkeypatch.setattr(calling, "ask", lose_first_release)
    life = lab.runtimes["tracker"].life
    agent._components.reachability.heed(Failed(tracker, life, Cause.CRASH, "its life has ended"))
    assert lab.until(lambda: bool(lost))
    assert lab.running(agent)
    lab.let_pass(2 * CALL)
    assert ended == []
    assert (agent.state.phase, agent.state.held[tracker].life) == (Phase.RUNNING, life)
