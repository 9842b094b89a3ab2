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


class Phase(str, Enum):
    """Whether a component acts."""

    IDLE = "idle"
    ACTIVE = "active"
    FAILED = "failed"


class Step(str, Enum):
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

    phase: Phase = Phase.IDLE
    epoch: int = 0
    supervisor: str | None = None


def obey(life: Life, call: Apply | SetParameters | Release) -> tuple[Life, Verdict, Step]:
    """What a call does to a component: its next life, the answer, and what its code is to be told."""
    if call.epoch < life.epoch:
        return life, Verdict.STALE, Step.NONE
    if life.supervisor is not None and call.supervisor != life.supervisor:
        return life, Verdict.BUSY, Step.NONE
    if isinstance(call, Apply):
        if life.phase is Phase.FAILED and call.epoch == life.epoch:
            return life, Verdict.REFUSED, Step.NONE
        step = {Phase.IDLE: Step.START, Phase.ACTIVE: Step.NONE, Phase.FAILED: Step.RESTART}[life.phase]
        return Life(Phase.ACTIVE, call.epoch, call.supervisor), Verdict.DONE, step
    if isinstance(call, SetParameters):
        verdict = Verdict.REFUSED if life.phase is Phase.IDLE else Verdict.DONE
        return replace(life, epoch=call.epoch), verdict, Step.NONE
    step = Step.NONE if life.phase is Phase.IDLE else Step.STOP
    return Life(Phase.IDLE, call.epoch, None), Verdict.DONE, step


def fail(life: Life) -> tuple[Life, Step]:
    """The component says that it cannot go on."""
    if life.phase is Phase.ACTIVE:
        return replace(life, phase=Phase.FAILED), Step.TELL
    return life, Step.NONE


def orphaned(life: Life) -> tuple[Life, Step]:
    """The supervisor has been gone for the grace period."""
    step = Step.NONE if life.phase is Phase.IDLE else Step.STOP
    return replace(life, phase=Phase.IDLE, supervisor=None), step
