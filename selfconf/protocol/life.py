"""The life of a component, as a table with no network in it.

    phase     apply              set        release         fail              orphaned
    IDLE      ACTIVE, start      refused    IDLE            IDLE              IDLE
    ACTIVE    ACTIVE             ACTIVE     IDLE, stop      FAILED, tell      IDLE, stop
    FAILED    ACTIVE, restart    FAILED     IDLE, stop      FAILED            IDLE, stop

A component that has failed stays failed for the epoch it failed in: an apply of that epoch, repeated or late, is
REFUSED, or it would hide the failure.

*Orphaned* means that the configurator which answers for the component has been gone for the grace period: nobody
supervises the configuration any more, so the component stops acting on it.

Before the table come two guards, for apply, set and release. A call of an older epoch than the newest obeyed is
STALE. A call of another supervisor than the present one is BUSY; a component whose supervisor is gone has none.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

from selfconf.protocol.messages import Apply, Release, SetParameters, Verdict


class LifePhase(str, Enum):
    """Whether a component acts."""

    IDLE = "idle"
    ACTIVE = "active"
    FAILED = "failed"


class LifeStep(str, Enum):
    """What the component's own code is to be told."""

    NONE = "none"
    START = "start"
    RESTART = "restart"
    STOP = "stop"
    TELL = "tell"
    """Tell the others: raise FAIL."""


@dataclass(frozen=True, slots=True)
class Life:
    """Phase, newest epoch obeyed, and the liveliness key of the configurator that supervises, if one does."""

    phase: LifePhase = LifePhase.IDLE
    epoch: int = 0
    supervisor: str | None = None


def obey(life: Life, call: Apply | SetParameters | Release) -> tuple[Life, Verdict, LifeStep]:
    """What a call does to a component: its next life, the answer, and what its code is to be told."""
    if call.epoch < life.epoch:
        return life, Verdict.STALE, LifeStep.NONE
    if life.supervisor is not None and call.supervisor != life.supervisor:
        return life, Verdict.BUSY, LifeStep.NONE
    if isinstance(call, Apply):
        if life.phase is LifePhase.FAILED and call.epoch == life.epoch:
            return life, Verdict.REFUSED, LifeStep.NONE
        step = {LifePhase.IDLE: LifeStep.START, LifePhase.ACTIVE: LifeStep.NONE, LifePhase.FAILED: LifeStep.RESTART}[
            life.phase
        ]
        return Life(LifePhase.ACTIVE, call.epoch, call.supervisor), Verdict.DONE, step
    if isinstance(call, SetParameters):
        verdict = Verdict.REFUSED if life.phase is LifePhase.IDLE else Verdict.DONE
        return replace(life, epoch=call.epoch), verdict, LifeStep.NONE
    step = LifeStep.NONE if life.phase is LifePhase.IDLE else LifeStep.STOP
    return Life(LifePhase.IDLE, call.epoch, None), Verdict.DONE, step


def fail(life: Life) -> tuple[Life, LifeStep]:
    """The component says that it cannot go on."""
    if life.phase is LifePhase.ACTIVE:
        return replace(life, phase=LifePhase.FAILED), LifeStep.TELL
    return life, LifeStep.NONE


def orphan(life: Life) -> tuple[Life, LifeStep]:
    """The supervisor has been gone for the grace period."""
    step = LifeStep.NONE if life.phase is LifePhase.IDLE else LifeStep.STOP
    return replace(life, phase=LifePhase.IDLE, supervisor=None), step
