"""Activations of a component, and calls of the tasks that want it."""

from __future__ import annotations

from collections.abc import Mapping

from selfconf.model.term import IRI, Literal, Term
from selfconf.protocol.activation import (
    Activation,
    ActivationPhase,
    fail,
    obey,
)
from selfconf.protocol.messages import Apply, Release, Reserve, Verdict, Wire

Call = Reserve | Apply | Release
IDLE, ACTIVE, FAILED = ActivationPhase
A, B, C = "a~1", "b~1", "c~1"
"""Three tasks."""
INPUTS = {"position": (Wire(IRI("urn:c:tracker"), "pose"),)}
OTHER = {"position": (Wire(IRI("urn:c:odometry"), "pose"),)}
THIRD = {"position": (Wire(IRI("urn:c:compass"), "pose"),)}
GOAL: Mapping[str, Term] = {"goal": Literal("x")}


def supervisor(task: str, run: int = 1) -> str:
    """The liveliness key of a configurator of a task."""
    return f"selfconf/e/conf/{task[0]}/live/{run}"


def call_of(kind: type[Call], task: str = A, epoch: int = 5, run: int = 1, **more: object) -> Call:
    """A call of a task, by the configurator that supervises it."""
    return kind(epoch, supervisor(task, run), task, **more)  # type: ignore[arg-type]  # each test gives what fits


def activation_in(phase: ActivationPhase, held: bool = True, epoch: int = 5) -> Activation:
    """An activation in a phase, as it can come about, held by the task A or by none."""
    activation = Activation()
    if held:
        activation, _, _ = obey(activation, call_of(Reserve, epoch=epoch))
    if phase is not IDLE:
        activation, _, _ = obey(activation, call_of(Apply, epoch=epoch))
    if phase is FAILED:
        activation, _ = fail(activation)
    assert activation.phase is phase
    return activation


def waiting_for(activation: Activation) -> list[str]:
    """The tasks that wait, in order."""
    return [claim.task for claim in activation.queue.claims]


def shared_by(*tasks: str, inputs: object = INPUTS) -> Activation:
    """A component that acts for several tasks, which want the same of it."""
    activation = Activation()
    for task in tasks:
        activation, verdict, _ = obey(activation, call_of(Apply, task, inputs=inputs), shareable=True)
        assert verdict is Verdict.DONE
    return activation


def inputs_of(activation: Activation) -> dict[str, object]:
    """What each task has a component follow."""
    return {hold.claim.task: hold.wants[0] for hold in activation.holds}
