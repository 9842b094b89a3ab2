"""Whether a component acts, and for which configurator, as a table with no network in it.

    phase     apply              set        release         fail              orphaned
    IDLE      ACTIVE, start      refused    IDLE            IDLE              IDLE
    ACTIVE    ACTIVE             ACTIVE     IDLE, stop      FAILED, FAIL      IDLE, stop
    FAILED    ACTIVE, restart    FAILED     IDLE, stop      FAILED            IDLE, stop

A component that has failed stays failed for the epoch it failed in: an apply of that epoch, repeated or late, is
REFUSED, or it would hide the failure.

*Orphaned* means that the configurator which supervises the component has been gone for the grace period: nothing would
notice a failure of the configuration any more, so the component stops acting on it.

Before the table come two guards, for apply, set and release. A call of an older epoch than the newest obeyed is
STALE. A call of another supervisor than the present one is BUSY; a component whose supervisor is gone has none.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

from selfconf.protocol.messages import Apply, Release, SetParameters, Verdict


class ActivationPhase(str, Enum):
    """Whether a component acts."""

    IDLE = "idle"
    ACTIVE = "active"
    FAILED = "failed"


class ActivationStep(str, Enum):
    """What a change of the activation means to the component's own code."""

    NONE = "none"
    START = "start"
    RESTART = "restart"
    """Stop, then start."""
    STOP = "stop"
    RAISE_FAIL = "raise fail"


@dataclass(frozen=True, slots=True)
class Activation:
    """Phase, newest epoch obeyed, and the liveliness key of the configurator that supervises, if one does."""

    phase: ActivationPhase = ActivationPhase.IDLE
    epoch: int = 0
    supervisor: str | None = None


_START = {
    ActivationPhase.IDLE: ActivationStep.START,
    ActivationPhase.ACTIVE: ActivationStep.NONE,
    ActivationPhase.FAILED: ActivationStep.RESTART,
}


def obey(activation: Activation, call: Apply | SetParameters | Release) -> tuple[Activation, Verdict, ActivationStep]:
    """Return what a call makes of an activation, the verdict to answer, and what it means to the component's code."""
    if call.epoch < activation.epoch:
        return activation, Verdict.STALE, ActivationStep.NONE
    if activation.supervisor is not None and call.supervisor != activation.supervisor:
        return activation, Verdict.BUSY, ActivationStep.NONE
    if isinstance(call, Apply):
        if activation.phase is ActivationPhase.FAILED and call.epoch == activation.epoch:
            return activation, Verdict.REFUSED, ActivationStep.NONE
        active = Activation(ActivationPhase.ACTIVE, call.epoch, call.supervisor)
        return active, Verdict.DONE, _START[activation.phase]
    if isinstance(call, SetParameters):
        verdict = Verdict.REFUSED if activation.phase is ActivationPhase.IDLE else Verdict.DONE
        return replace(activation, epoch=call.epoch), verdict, ActivationStep.NONE
    return Activation(ActivationPhase.IDLE, call.epoch, None), Verdict.DONE, _stop(activation)


def fail(activation: Activation) -> tuple[Activation, ActivationStep]:
    """Return what becomes of an activation when the component says that it cannot go on."""
    if activation.phase is ActivationPhase.ACTIVE:
        return replace(activation, phase=ActivationPhase.FAILED), ActivationStep.RAISE_FAIL
    return activation, ActivationStep.NONE


def orphan(activation: Activation) -> tuple[Activation, ActivationStep]:
    """Return what becomes of an activation when the supervisor has been gone for the grace period."""
    return replace(activation, phase=ActivationPhase.IDLE, supervisor=None), _stop(activation)


def _stop(activation: Activation) -> ActivationStep:
    return ActivationStep.NONE if activation.phase is ActivationPhase.IDLE else ActivationStep.STOP
