"""Other lives of a component: one of them stays, and of several never two act."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from selfconf.bus.memory import MemoryBus
from selfconf.bus.port import Replies
from selfconf.protocol.activation import ActivationPhase
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import CallAnswer, Verdict
from selfconf.sdk.runtime import ComponentRuntime
from tests.lab import Recorder
from tests.sdk.stage import CAP, CAP_PROFILE, KEYS, THEM, US, Stage, apply, release


def begun_elsewhere(stage: Stage, life: str, reasons: list[str]) -> ComponentRuntime:
    """A second process of the component of a stage, which has begun on a node that the first cannot reach."""
    node = stage.network.node()
    stage.network.cut(node, node_of(stage.runtime))
    runtime = ComponentRuntime(node, KEYS, CAP_PROFILE, Recorder(), life, superseded=reasons.append)
    stage.let_pass(2.0)
    assert reasons == []
    return runtime


def node_of(runtime: ComponentRuntime) -> MemoryBus:
    """The node of a component."""
    assert isinstance(runtime.bus, MemoryBus)
    return runtime.bus


def applied(stage: Stage, message: object) -> CallAnswer:
    """The answer of the life that a call means."""
    replies: list[Replies] = []
    stage.caller.ask(KEYS.call(CAP, "apply"), encode(message), 1.0, replies.append)
    stage.let_pass(0.1)
    (answer,) = [
        one for one in (decode(s.payload, CallAnswer) for s in replies[0].samples) if one.verdict is Verdict.DONE
    ]
    return answer


def test_two_lives_that_act_and_meet_later_do_not_both_act_on() -> None:
    stage = Stage()
    reasons: list[str] = []
    stage.others.announce(THEM)
    larger = begun_elsewhere(stage, "life-2", reasons)
    applied(stage, apply(1, US, life="life-1"))
    applied(stage, apply(1, THEM, life="life-2"))
    assert stage.component.active
    assert larger.active
    stage.network.reconnect(node_of(larger), node_of(stage.runtime))
    stage.let_pass(0.01)
    assert reasons == [f"{CAP} is alive already, in the life life-1; this process leaves"]
    assert not larger.active
    assert stage.component.active


def test_a_life_that_goes_on_after_it_was_frozen_does_not_act_beside_its_successor() -> None:
    stage = Stage()
    reasons: list[str] = []
    stage.call(apply(1, US, life="life-1"))
    stage.network.pause(node_of(stage.runtime))
    stage.let_pass(5.0)
    successor = ComponentRuntime(
        stage.network.node(), KEYS, CAP_PROFILE, Recorder(), "life-2", superseded=reasons.append
    )
    stage.let_pass(2.0)
    applied(stage, apply(2, US, life="life-2"))
    assert successor.active
    stage.network.resume(node_of(stage.runtime))
    stage.let_pass(0.2)
    assert len(reasons) == 1
    assert not successor.active


def test_a_component_that_nobody_holds_follows_no_lives() -> None:
    stage = Stage()
    reasons: list[str] = []
    larger = begun_elsewhere(stage, "life-2", reasons)
    applied(stage, apply(1, US, life="life-2"))
    stage.caller.ask(KEYS.call(CAP, "release"), encode(release(1, US, life="life-2")), 1.0, lambda replies: None)
    stage.let_pass(0.1)
    stage.network.reconnect(node_of(larger), node_of(stage.runtime))
    stage.let_pass(1.0)
    assert reasons == []
    applied(stage, apply(2, US, life="life-2"))
    stage.let_pass(0.1)
    assert len(reasons) == 1  # it is held again, and sees that it is not the only one


def test_of_two_processes_that_begin_to_be_one_component_the_smaller_life_stays() -> None:
    stage = Stage()
    reasons: list[str] = []
    larger = ComponentRuntime(stage.network.node(), KEYS, CAP_PROFILE, Recorder(), "life-2", superseded=reasons.append)
    stage.let_pass(0.1)
    assert reasons == [f"{CAP} is alive already, in the life life-1; this process leaves"]
    called: list[tuple[str, ...]] = []
    stage.caller.roll_call(KEYS.lives(CAP), 1.0, called.append)
    stage.let_pass(2.0)
    assert called == [(KEYS.life(CAP, "life-1"),)]
    assert len(reasons) == 1
    assert larger.activation.phase is ActivationPhase.IDLE


def test_two_processes_that_see_each_other_only_a_moment_after_their_beginning_do_not_both_stay() -> None:
    stage = Stage()
    node = stage.network.node()
    stage.network.cut(node, stage.network.nodes[2])
    reasons: list[str] = []
    ComponentRuntime(node, KEYS, CAP_PROFILE, Recorder(), "life-2", superseded=reasons.append)
    stage.let_pass(0.5)
    assert reasons == []
    stage.network.reconnect(node, stage.network.nodes[2])
    stage.let_pass(0.6)
    assert len(reasons) == 1


def test_a_component_that_is_superseded_is_at_rest_before_its_process_leaves() -> None:
    stage = Stage()
    seen: list[list[tuple[Any, ...]]] = []
    recorder = Recorder()
    node = stage.network.node()
    stage.network.cut(node, stage.network.nodes[2])

    def superseded(_: str) -> None:
        seen.append(recorder.said)

    larger = ComponentRuntime(node, KEYS, CAP_PROFILE, recorder, "life-2", superseded=superseded)
    replies: list[Replies] = []
    stage.caller.ask(KEYS.call(CAP, "apply"), encode(apply(1, US, life="life-2")), 1.0, replies.append)
    stage.let_pass(0.1)
    assert larger.active
    stage.network.reconnect(node, stage.network.nodes[2])
    stage.let_pass(1.0)
    assert seen == [[("started",), ("stopped",)]]


def test_a_watch_that_tells_of_a_life_that_has_ended_makes_no_component_leave(monkeypatch: pytest.MonkeyPatch) -> None:
    watched = MemoryBus.watch

    def watch(bus: MemoryBus, key: str, changed: Callable[[str, bool], None], **how: bool) -> Callable[[], None]:
        if key == KEYS.lives(CAP):
            bus.network.deliver(bus, bus, lambda: changed(KEYS.life(CAP, "life-0"), True))
        return watched(bus, key, changed, **how)

    monkeypatch.setattr(MemoryBus, "watch", watch)
    stage = Stage()
    stage.others.announce(THEM)
    applied(stage, apply(1, US, life="life-1"))
    stage.let_pass(0.5)
    assert stage.component.active
    assert not stage.runtime.closed
