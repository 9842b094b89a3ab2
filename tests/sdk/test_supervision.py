"""The supervision of a component: it obeys a configurator only as long as that is alive."""

from __future__ import annotations

from selfconf.model.term import Literal
from selfconf.protocol.activation import ActivationPhase
from selfconf.protocol.messages import (
    Apply,
    Release,
    SetParameters,
    Verdict,
)
from selfconf.sdk.supervision import GRACE
from tests.sdk.stage import THEM, US, Stage


def test_a_component_whose_configurator_is_gone_turns_itself_off_after_the_grace_period() -> None:
    stage = Stage()
    stage.call(Apply(1, US))
    stage.let_pass(100)
    assert stage.component.active
    stage.leave()
    stage.let_pass(GRACE - 0.1)
    assert stage.component.active
    stage.let_pass(0.2)
    assert stage.recorder.said == [("started",), ("stopped",)]
    assert stage.runtime.activation.phase is ActivationPhase.IDLE


def test_a_configurator_that_is_back_within_the_grace_period_is_still_obeyed() -> None:
    stage = Stage()
    stage.call(Apply(1, US))
    stage.leave()
    stage.let_pass(GRACE / 2)
    stage.caller.announce(US)
    stage.let_pass(10 * GRACE)
    assert stage.component.active


def test_a_component_that_is_cut_off_turns_itself_off() -> None:
    stage = Stage()
    stage.call(Apply(1, US))
    node = stage.network.nodes[2]
    assert stage.runtime.bus is node
    stage.network.cut(node, stage.caller)
    stage.let_pass(GRACE + 0.1)
    assert not stage.component.active


def test_a_configurator_that_was_never_there_is_not_obeyed_for_long() -> None:
    stage = Stage()
    stage.call(Apply(1, THEM))
    stage.let_pass(GRACE + 0.1)
    assert not stage.component.active


def test_a_component_that_has_failed_is_free_again_when_its_configurator_is_gone() -> None:
    stage = Stage()
    stage.call(Apply(1, US))
    stage.component.fail("lost her")
    stage.leave()
    stage.let_pass(GRACE + 0.1)
    assert stage.runtime.activation.phase is ActivationPhase.IDLE
    assert stage.recorder.said[-1] == ("stopped",)


def test_a_held_component_is_busy_for_another_configurator_as_long_as_its_own_lives() -> None:
    stage = Stage()
    stage.others.announce(THEM)
    stage.call(Apply(1, US))
    stage.let_pass(0.1)
    assert stage.call(Apply(2, THEM)).verdict is Verdict.BUSY
    assert stage.call(Release(2, THEM)).verdict is Verdict.BUSY
    assert stage.component.active


def test_another_configurator_may_take_over_as_soon_as_the_first_is_gone() -> None:
    stage = Stage()
    leave = stage.others.announce(THEM)
    stage.call(Apply(1, US))
    stage.let_pass(0.1)
    stage.leave()
    stage.let_pass(0.1)
    assert stage.call(SetParameters(2, THEM, {"goal": Literal("x")})).verdict is Verdict.BUSY
    assert stage.call(Apply(2, THEM)).verdict is Verdict.DONE
    stage.let_pass(10 * GRACE)
    assert stage.component.active
    assert stage.recorder.said == [("started",)]
    stage.caller.announce(US)
    stage.let_pass(0.1)
    assert stage.call(Apply(3, US)).verdict is Verdict.BUSY
    leave()
    stage.let_pass(GRACE + 0.1)
    assert not stage.component.active


def test_the_supervision_of_an_earlier_configuration_has_ended_with_it() -> None:
    stage = Stage()
    stage.others.announce(THEM)
    stage.call(Apply(1, US))
    stage.call(Release(2, US))
    stage.call(Apply(3, THEM))
    stage.leave()
    stage.let_pass(10 * GRACE)
    assert stage.component.active
