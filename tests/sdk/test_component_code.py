"""The code of a component on a thread of its own: what is not run any more, and what a stop ends at once."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from selfconf.bus.memory import Network
from selfconf.bus.port import Replies, Urgency
from selfconf.model.profile import Ports, Profile
from selfconf.model.term import Literal
from selfconf.protocol.activation import Activation, ActivationPhase
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import Apply, CallAnswer, Cause, Release, Reserve, Stamp, Verdict, Wire
from selfconf.sdk.code_thread import CodeThread, RunningCode
from selfconf.sdk.component import Component, Refused
from selfconf.sdk.component_code import ComponentCode
from selfconf.sdk.component_context import ComponentContext
from selfconf.sdk.runtime import ComponentRuntime
from selfconf.sdk.runtime.supervision import GRACE
from selfconf.sdk.runtime.waiting_tasks import YIELDING
from tests.lab import Recorder
from tests.sdk.stage import (
    CAP_PROFILE,
    DRIVE,
    DRIVE_PROFILE,
    KEYS,
    THEM,
    TRACKER,
    TRACKER_PROFILE,
    US,
    Stage,
    apply,
    follow,
    release,
    reserve,
)


class Split:
    """A component in simulated time whose code runs when the test says so, as if it were busy until then."""

    def __init__(self, component: Component, profile: Profile = CAP_PROFILE) -> None:
        self.network, self.code = Network(), CodeThread(inline=False)
        self.caller = self.network.node()
        self.leave = self.caller.announce(US)
        self.caller.announce(THEM)
        node = self.network.node()
        self.runtime = ComponentRuntime(node, KEYS, profile, component, "life-1", self.code)
        self.answers: list[CallAnswer] = []

    def let_pass(self, seconds: float = 0.1) -> None:
        """Simulated time passes; the component's code does not run."""
        self.network.run(lambda: False, seconds)

    def call(self, message: Reserve | Apply | Release) -> None:
        """Make a call; its answer may come later."""

        def answered(replies: Replies) -> None:
            self.answers += [decode(sample.payload, CallAnswer) for sample in replies.samples]

        name = {Reserve: "reserve", Apply: "apply", Release: "release"}[type(message)]
        self.caller.ask(KEYS.call(self.runtime.profile.component, name), encode(message), 100.0, answered)
        self.let_pass()

    def run_code(self) -> None:
        """The component's code has time."""
        self.code.poll()
        self.let_pass()
        self.code.poll()
        self.let_pass()

    @property
    def verdicts(self) -> list[Verdict]:
        """The answers so far."""
        return [answer.verdict for answer in self.answers]


def test_a_call_is_answered_when_the_code_has_done_what_it_asks_for() -> None:
    split = Split(recorder := Recorder())
    split.call(apply(1, US, values={"goal": Literal("x")}))
    assert (split.answers, recorder.said) == ([], [])
    split.run_code()
    assert recorder.said == [("goal", "x"), ("started",)]
    assert split.verdicts == [Verdict.DONE]


def test_a_component_that_is_released_before_its_code_has_begun_to_start_is_not_started() -> None:
    split = Split(recorder := Recorder())
    split.call(apply(1, US))
    split.call(release(2, US))
    split.run_code()
    assert recorder.said == []
    assert set(split.verdicts) == {Verdict.REFUSED, Verdict.DONE}


@pytest.mark.parametrize("again", [apply(3, US), reserve(3, US)])
def test_a_start_that_was_overtaken_by_a_release_takes_back_nothing_that_comes_after_it(again: Apply | Reserve) -> None:
    split = Split(recorder := Recorder())
    split.call(apply(1, US))
    split.call(release(2, US))
    split.call(again)
    split.run_code()
    assert split.runtime.activation.epoch == 3
    if isinstance(again, Apply):
        assert recorder.said == [("started",)]
        assert split.answers[-1].active


def test_a_component_that_refuses_to_start_is_free_though_another_task_shares_it_by_then() -> None:
    class Cold(Recorder):
        def started(self) -> None:
            super().started()
            raise Refused("too cold")

    split = Split(recorder := Cold(), TRACKER_PROFILE)
    split.call(apply(1, US))
    split.call(apply(1, THEM))
    split.run_code()
    assert [answer.detail for answer in split.answers] == ["too cold"] * 2
    assert (split.runtime.activation.phase, split.runtime.activation.holds) == (ActivationPhase.IDLE, ())
    assert recorder.said == [("started",), ("stopped",)]


def test_a_component_that_is_released_while_a_parameter_is_set_is_not_started() -> None:
    class Interrupted(Recorder):
        def parameter_set(self, name: str, value: Any) -> None:
            super().parameter_set(name, value)
            split.call(release(2, US))

    split = Split(recorder := Interrupted())
    split.call(apply(1, US, values={"goal": Literal("x")}))
    split.run_code()
    assert recorder.said == [("goal", "x")]
    assert not split.runtime.active
    assert set(split.verdicts) == {Verdict.REFUSED, Verdict.DONE}


def test_a_component_that_is_released_while_it_starts_is_inactive_at_once_and_stopped_afterwards() -> None:
    class Interrupted(Recorder):
        def started(self) -> None:
            super().started()
            split.call(release(2, US))
            self.said.append(("active", self.active))

    split = Split(recorder := Interrupted())
    split.call(apply(1, US))
    split.run_code()
    assert recorder.said == [("started",), ("active", False), ("stopped",)]
    assert split.runtime.activation.phase is ActivationPhase.IDLE


def test_a_release_is_answered_when_the_code_is_at_rest_and_calls_that_come_meanwhile_wait() -> None:
    split = Split(recorder := Recorder())
    split.call(apply(1, US))
    split.run_code()
    split.call(release(2, US))
    assert not split.runtime.active
    split.call(apply(3, THEM))
    assert split.verdicts == [Verdict.DONE]
    split.run_code()
    assert split.verdicts == [Verdict.DONE] * 3
    assert recorder.said == [("started",), ("stopped",), ("started",)]


def test_a_component_whose_stop_ends_its_program_has_obeyed() -> None:
    class Ending(Recorder):
        def stopped(self) -> None:
            super().stopped()
            raise SystemExit(0)

    split = Split(recorder := Ending())
    split.call(apply(1, US))
    split.run_code()
    split.call(release(2, US))
    with pytest.raises(SystemExit):
        split.code.poll()
    split.let_pass()
    assert (recorder.said, split.verdicts) == ([("started",), ("stopped",)], [Verdict.DONE] * 2)
    assert not split.answers[-1].stopping


def test_an_apply_that_changes_a_parameter_while_the_code_starts_is_obeyed_after_the_start() -> None:
    class Picky(Recorder):
        def parameter_set(self, name: str, value: Any) -> None:
            super().parameter_set(name, value)
            if value == "wrong":
                raise Refused("not there")

    split = Split(recorder := Picky())
    split.call(apply(1, US, values={"goal": Literal("x")}))
    split.call(apply(2, US, values={"goal": Literal("wrong")}))
    split.run_code()
    assert recorder.said == [("goal", "x"), ("started",), ("goal", "wrong")]
    assert [(answer.verdict, answer.detail) for answer in split.answers] == [
        (Verdict.DONE, ""),
        (Verdict.REFUSED, "not there"),
    ]


def test_signals_that_wait_are_not_delivered_after_a_stop() -> None:
    split = Split(recorder := Recorder())
    split.call(follow())
    split.run_code()
    publisher = split.caller.publisher(KEYS.output(TRACKER, "pose"), Urgency.SIGNAL)
    publisher.put(b"1", encode(Stamp(TRACKER, "l", 1, 0.0)))
    split.let_pass()
    split.call(release(2, US))
    split.run_code()
    assert recorder.said == [("started",), ("stopped",)]


def test_the_grace_period_ends_and_a_component_changes_hands_though_its_code_is_busy() -> None:
    split = Split(Recorder())
    split.call(apply(1, US))
    split.run_code()
    split.leave()
    split.let_pass(GRACE + 0.1)
    assert not split.runtime.active
    assert split.runtime.activation.phase is ActivationPhase.IDLE


def test_a_component_is_preempted_though_its_code_is_busy() -> None:
    split = Split(Recorder())
    split.call(apply(1, US))
    split.run_code()
    split.call(reserve(1, THEM, priority=1))
    split.let_pass(YIELDING + 0.1)
    assert not split.runtime.active
    split.run_code()
    split.call(reserve(1, THEM, priority=1))
    assert split.verdicts == [Verdict.DONE, Verdict.BUSY, Verdict.DONE]


def test_an_actuator_that_is_to_act_and_to_rest_again_while_its_code_is_busy_rests() -> None:
    split = Split(recorder := Recorder(), replace(DRIVE_PROFILE, ports=Ports()))
    split.call(reserve(1, US))
    split.call(apply(1, US))
    split.run_code()
    for rests in (True, False, True):
        split.call(apply(1, US, rests=rests))
    split.run_code()
    assert recorder.said[-1] == ("stopped",)
    for rests in (False, True, False):
        split.call(apply(1, US, rests=rests))
    split.run_code()
    assert recorder.said[-1] == ("started",)


def test_a_parameter_that_a_task_adds_while_an_actuator_is_woken_is_set_as_well() -> None:
    class Slow(Recorder):
        def parameter_set(self, name: str, value: Any) -> None:
            super().parameter_set(name, value)
            if self.said.count(("goal", "x")) == 2:  # it is woken
                split.call(apply(2, US, values={"goal": Literal("x"), "speed": Literal("y")}))

    parameters = tuple(replace(CAP_PROFILE.parameters[0], name=name) for name in ("goal", "speed"))
    split = Split(recorder := Slow(), replace(DRIVE_PROFILE, ports=Ports(), parameters=parameters))
    split.call(reserve(1, US))
    for rests in (False, True, False):
        split.call(apply(1, US, values={"goal": Literal("x")}, rests=rests))
        split.run_code()
    assert recorder.said[-3:] == [("goal", "x"), ("started",), ("speed", "y")]
    assert split.verdicts[-1] is Verdict.DONE


def test_what_an_actuator_that_is_woken_was_to_do_before_it_failed_is_no_failure_of_its_next_activation() -> None:
    class Failing(Recorder):
        def parameter_set(self, name: str, value: Any) -> None:
            super().parameter_set(name, value)
            if len(self.said) == 4:  # it is woken
                self.fail("the bulb is broken")
                split.let_pass()
                split.call(apply(2, US, values={"goal": Literal("y")}))

    split = Split(recorder := Failing(), replace(DRIVE_PROFILE, ports=Ports()))
    split.call(reserve(1, US))
    for rests in (False, True, False):
        split.call(apply(1, US, values={"goal": Literal("x")}, rests=rests))
        split.run_code()
    assert recorder.said == [("goal", "x"), ("started",), ("stopped",), ("goal", "x"), ("goal", "y"), ("started",)]
    assert split.verdicts[-1] is Verdict.DONE
    assert split.runtime.active


def test_a_timer_that_is_late_is_run_once_and_not_made_up_for() -> None:
    class Ticking(Recorder):
        def started(self) -> None:
            self.every(0.1, lambda: self.said.append(("tick",)))

    split = Split(recorder := Ticking())
    split.call(apply(1, US))
    split.run_code()
    recorder.said.clear()
    split.let_pass(10.0)
    split.code.poll()
    assert recorder.said == [("tick",)]


def test_what_is_due_at_an_interval_as_a_component_fails_is_not_done_once_it_acts_again() -> None:
    class Ticking(Recorder):
        def started(self) -> None:
            super().started()
            self.every(0.1, lambda: self.said.append(("tick",)))

    split = Split(recorder := Ticking())
    split.call(apply(1, US))
    split.code.poll()
    split.let_pass(0.2)  # the code is busy
    recorder.fail("lost")
    split.call(apply(2, US))
    split.code.poll()
    assert recorder.said == [("started",), ("stopped",), ("started",)]


def test_an_actuator_that_loses_its_input_while_it_is_starting_rests_as_any_other() -> None:
    network, code = Network(), CodeThread(inline=False)
    caller, source = network.node(), network.node()
    caller.announce(US)
    leave = source.announce(KEYS.life(TRACKER, "1"))
    recorder = Recorder()
    runtime = ComponentRuntime(network.node(), KEYS, DRIVE_PROFILE, recorder, "life-1", code)

    def call(name: str, message: Reserve | Apply) -> None:
        caller.ask(KEYS.call(DRIVE, name), encode(message), 100.0, lambda replies: None)
        network.run(lambda: False, 0.1)
        if name == "reserve":
            code.poll()

    call("reserve", reserve(1, US))
    call("apply", apply(1, US, {"position": (Wire(TRACKER, "pose"),)}))
    leave()  # the code has not begun yet
    network.run(lambda: False, 0.5)
    code.poll()
    assert runtime.active
    network.run(lambda: False, 2.0)
    code.poll()
    assert recorder.said[-1] == ("stopped",)


def test_a_component_that_leaves_does_not_start_for_a_call_that_waited_for_its_rest() -> None:
    split = Split(recorder := Recorder())
    split.call(apply(1, US))
    split.run_code()
    split.call(release(2, US))
    split.call(apply(3, US))  # waits until the code is at rest
    split.runtime.close()
    split.run_code()
    assert recorder.said == [("started",), ("stopped",)]
    assert split.verdicts[-1] is Verdict.OTHER_LIFE


def test_what_is_done_at_intervals_takes_turns_with_signals_however_long_it_takes() -> None:
    stage, thread = Stage(), CodeThread(inline=False)
    stage.call(apply(1, US))
    code, said = stage.runtime.code, list[str]()
    code._thread = thread

    def tick() -> None:
        said.append("tick")
        code.tick(tick)  # due again before it has returned

    code.tick(tick)
    thread.signal(lambda: said.append("signal"))
    thread.run(lambda: len(said) > 2)
    assert said == ["tick", "signal", "tick"]


def test_code_that_hears_of_the_end_of_a_connection_is_named_by_that() -> None:
    def no_fail(reason: str, cause: Cause = Cause.FAIL) -> None:
        pytest.fail(reason)

    thread, said = CodeThread(inline=True), list[RunningCode | None]()

    class Caller(Component):
        def connected(self, operation: str) -> None:
            said.append(thread.running)

        def disconnected(self, operation: str) -> None:
            said.append(thread.running)

    context = ComponentContext(Network().node(), KEYS, CAP_PROFILE, "life-1", thread, {}, Activation, no_fail)
    code = ComponentCode(context, Caller())
    code.start({}, lambda trouble: None)
    code.connection_changed("look()", True)
    code.connection_changed("look()", False)
    assert [running.what for running in said if running is not None] == ["connected", "disconnected"]
