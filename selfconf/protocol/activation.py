"""For which tasks a component is held, and whether it acts, as a table with no network in it.

    phase     apply              release (of the last)  fail              orphaned (the last)
    IDLE      ACTIVE, start      IDLE                   IDLE              IDLE
    ACTIVE    ACTIVE             IDLE, stop             FAILED, FAIL      IDLE, stop
    FAILED    ACTIVE, restart    IDLE, stop             FAILED            IDLE, stop

A task *holds* a component from its first reserve or apply until its release. A component is held by one task, or, if
it can be shared, by several that want the same inputs and the same values of parameters; it acts while one of them has
applied. `reserve` changes no phase: none of the components of a configuration acts for a task before all are held.

Before the table come three guards. A call of an older epoch than the newest that was obeyed for its task is STALE:
epochs order the calls of one task, not of two, as their clocks may differ. A call of another configurator than the one
that supervises the task is BUSY while that one lives; one for which the component acts and that was not seen yet may
have left while its last call was on its way. A call of a task that cannot hold the component beside those that do is
BUSY, and the task *waits* (`selfconf.protocol.task_queue`).

A component that has failed stays failed for the epoch it failed in: an apply of that epoch, repeated or late, is
REFUSED, or it would hide the failure. A component that has no outputs and offers no operations is never applied to by a
task that does not hold it (NOT HELD): a call that comes late, or after the component was believed to be orphaned, would
let it act on a part of a configuration. Any other component is reserved by the apply itself, if it is free.

*Orphaned* means that the configurator which supervises a task has been gone for the grace period. Until then its hold
lasts, but blocks no other task, and another configurator of the same task goes on with it without a stop.
"""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum

from selfconf.model.immutable import immutable, replace
from selfconf.protocol.messages import Apply, Claim, Release, Reserve, Verdict, Wires
from selfconf.protocol.task_queue import TaskQueue, rank

MOST_HOLDING = 64
"""How many tasks share a component at most; others wait."""
MOST_ENDED = 64
"""Of how many tasks that hold it no more a component remembers the newest epoch."""


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


@immutable
class Hold:
    """A task that holds a component: its newest call that was obeyed, and whether the component acts for it."""

    claim: Reserve | Apply
    active: bool = False
    wish: Reserve | Apply | None = None
    """What the task wants instead, and another that shares the component does not, or not yet."""

    @property
    def wants(self) -> tuple[object, object]:
        """The inputs and the values of parameters, by which tasks that share a component must agree."""
        return self.claim.inputs, self.claim.values

    @property
    def newest(self) -> Reserve | Apply:
        """What its task has asked for last."""
        return self.wish or self.claim

    def agrees_with(self, call: Reserve | Apply) -> bool:
        """Whether its task wishes what another one asks for; one that has an actuator rest leaves that to others."""
        mine = self.newest
        if mine.values != call.values:
            return False
        rests = isinstance(mine, Apply) and mine.rests
        left = {port: wires for port, wires in mine.inputs.items() if wires} if rests else {}
        return mine.inputs == call.inputs or (rests and left.items() <= call.inputs.items())

    def fulfilled_by(self, call: Apply) -> Hold:
        """The hold of a task once the component does as another task says, which may be what this one wished."""
        mine, wanted = self.newest, (call.inputs, call.values)
        if not self.agrees_with(call) or (self.wish is None and self.wants == wanted):
            return self
        if not isinstance(mine, Apply):
            return Hold(replace(self.claim, inputs=call.inputs, values=call.values), self.active)
        claim = replace(mine, epoch=self.claim.epoch, inputs=call.inputs)
        return Hold(claim, self.active, None if mine.inputs == call.inputs else mine)


@immutable
class Activation:
    """Whether a component acts, for which tasks, and which wait for it."""

    phase: ActivationPhase = ActivationPhase.IDLE
    holds: tuple[Hold, ...] = ()
    queue: TaskQueue = TaskQueue()
    """The tasks that wait for it."""
    ended: tuple[tuple[str, int], ...] = ()
    """The newest epoch obeyed for each task that holds the component no more."""

    def hold(self, task: str) -> Hold | None:
        """The hold of a task, if it has one."""
        for hold in self.holds:
            if hold.claim.task == task:
                return hold
        return None

    @property
    def first(self) -> Hold | None:
        """The hold of the highest priority, then of the earliest beginning."""
        return min(self.holds, key=lambda hold: rank(hold.claim), default=None)

    @property
    def epoch(self) -> int:
        """The newest epoch for which the component acts, or is held."""
        return max((hold.claim.epoch for hold in self.holds), default=0)

    @property
    def rests(self) -> bool:
        """Whether every task that the component acts for lacks a part of its configuration, so that actuators rest."""
        claims = [hold.claim for hold in self.holds if hold.active]
        return bool(claims) and all(isinstance(claim, Apply) and claim.rests for claim in claims)

    def epoch_of(self, task: str) -> int:
        """The newest epoch that was obeyed for a task."""
        hold = self.hold(task)
        return hold.claim.epoch if hold is not None else dict(self.ended).get(task, 0)


Obedience = tuple[Activation, Verdict, ActivationStep]
"""The activation after a call, the verdict to answer, and what it means to the component's code."""

_START = {
    ActivationPhase.IDLE: ActivationStep.START,
    ActivationPhase.ACTIVE: ActivationStep.NONE,
    ActivationPhase.FAILED: ActivationStep.RESTART,
}


def obey(
    activation: Activation,
    call: Reserve | Apply | Release,
    *,
    shareable: bool = False,
    reserved_first: bool = False,
    gone: frozenset[str] = frozenset(),
    unseen: frozenset[str] = frozenset(),
) -> Obedience:
    """Return what a call makes of an activation; `gone` are the supervisors whose life was seen to end.

    `unseen` are those that were not seen to live yet. `shareable` says whether several tasks may hold the component,
    `reserved_first` whether only a task that holds it may apply to it.
    """
    own = activation.hold(call.task)
    if call.epoch < activation.epoch_of(call.task):
        return activation, Verdict.STALE, ActivationStep.NONE
    if own is not None and _is_anothers(own, call, gone, unseen):
        return activation, Verdict.BUSY, ActivationStep.NONE
    if isinstance(call, Release):
        after, step = _released(activation, call, gone)
        return replace(after, queue=after.queue.left(call.task)), Verdict.DONE, step
    if _blocked(activation, call, shareable, gone) or (isinstance(call, Reserve) and call.waits):
        queue = activation.queue if _others_may_agree(own, call) else activation.queue.joined(call)
        return _wish(replace(activation, queue=queue), own, call), Verdict.BUSY, ActivationStep.NONE
    served = replace(activation, queue=activation.queue.taken(call.task))
    if isinstance(call, Reserve):
        return _reserve(served, own, call), Verdict.DONE, ActivationStep.NONE
    if own is None and reserved_first:
        return activation, Verdict.NOT_HELD, ActivationStep.NONE
    if own is not None and _failed_in(served, own, call.epoch):
        return activation, Verdict.REFUSED, ActivationStep.NONE
    return _activate(served, call, gone, shareable), Verdict.DONE, _START[served.phase]


def _released(activation: Activation, call: Release, gone: frozenset[str]) -> tuple[Activation, ActivationStep]:
    """Let a task go, and with the last one whose supervisor lives those that have shared on: these are orphaned."""
    after, step = drop(activation, (call.task,), call.epoch)
    if activation.hold(call.task) is None or any(hold.claim.supervisor not in gone for hold in after.holds):
        return after, step
    after, last = drop(after, [hold.claim.task for hold in after.holds])
    return after, step if last is ActivationStep.NONE else last


def _failed_in(activation: Activation, own: Hold, epoch: int) -> bool:
    """Whether the component has failed while it acted for a task in an epoch."""
    return activation.phase is ActivationPhase.FAILED and own.active and epoch == own.claim.epoch


def _is_anothers(hold: Hold, call: Claim, gone: frozenset[str], unseen: frozenset[str]) -> bool:
    """Whether another configurator of the same task is to be obeyed than the one that calls."""
    left = gone | unseen if hold.active else gone
    return hold.claim.supervisor not in (call.supervisor, *left)


def in_the_way(
    activation: Activation, call: Claim, gone: frozenset[str] = frozenset(), unseen: frozenset[str] = frozenset()
) -> Hold | None:
    """Return the hold because of which a call is BUSY: of another configurator of its task, or of the first other task.

    A task that shares the component is not in its own way.
    """
    own = activation.hold(call.task)
    if own is not None and _is_anothers(own, call, gone, unseen):
        return own
    others = [hold for hold in activation.holds if hold is not own]
    return min(others, key=lambda hold: (hold.claim.supervisor in gone, rank(hold.claim)), default=None)


def _activate(activation: Activation, call: Apply, gone: frozenset[str], shareable: bool) -> Activation:
    """Act for a task, and no more for tasks whose supervisor is gone: those cannot say any more what they want.

    One that shares the component and wants the same is in no other's way, and its supervisor may only be out of sight.
    """
    others = [hold for hold in activation.holds if hold.claim.task != call.task]
    left = {
        hold.claim.task: hold.claim.epoch
        for hold in others
        if hold.claim.supervisor in gone and not (shareable and hold.agrees_with(call))
    }
    kept = (hold for hold in others if hold.claim.task not in left)
    return replace(
        activation,
        phase=ActivationPhase.ACTIVE,
        holds=(*(hold.fulfilled_by(call) for hold in kept), Hold(call, active=True)),
        ended=(*_ended(activation, call), *left.items())[-MOST_ENDED:],
    )


def _reserve(activation: Activation, own: Hold | None, call: Reserve) -> Activation:
    """Hold the component; one that acts already goes on as it is, until it is applied to.

    But what it follows and is not to follow is lost to it: its task has given it up since, when it could not be heard,
    and what is not reserved with it may act for another task by now. One that has failed waits for the apply of a newer
    epoch than the one that it failed in.
    """
    others = tuple(hold for hold in activation.holds if hold is not own)
    held = Hold(call)
    if own is not None and own.active and (activation.phase is ActivationPhase.ACTIVE or call.epoch == own.claim.epoch):
        wish = call if others and own.wants != (call.inputs, call.values) else None
        left = (
            own.claim.inputs if others or call.epoch == own.claim.epoch else _in_common(own.claim.inputs, call.inputs)
        )
        held = Hold(
            replace(own.claim, epoch=call.epoch, supervisor=call.supervisor, inputs=left), active=True, wish=wish
        )
    return replace(activation, holds=(*others, held), ended=_ended(activation, call))


def _in_common(inputs: Wires, others: Wires) -> Wires:
    """Inputs with those of their wires that others have as well."""
    return {port: tuple(wire for wire in wires if wire in others.get(port, ())) for port, wires in inputs.items()}


def _blocked(activation: Activation, call: Reserve | Apply, shareable: bool, gone: frozenset[str]) -> bool:
    """Whether another task stands in the way: one that holds the component, or one that it is kept for."""
    if activation.queue.is_kept_from(call):
        return True
    others = [h for h in activation.holds if h.claim.task != call.task and h.claim.supervisor not in gone]
    wanted = call.inputs, call.values
    own = activation.hold(call.task)
    if own is not None and own.active and all(hold.wants == wanted for hold in (own, *others)):
        return False  # it goes on as it is, whatever others wish
    return len(others) >= MOST_HOLDING or any(not shareable or not hold.agrees_with(call) for hold in others)


def _others_may_agree(own: Hold | None, call: Reserve | Apply) -> bool:
    """Whether no other task is to yield to a call yet: what the component follows for all may be lost to all.

    So it is where the component acts for the task that calls, which wishes this for the first time, or wishes that an
    input follows nothing for now.
    """
    if own is None or not own.active or not isinstance(call, Apply):
        return False
    newest = own.newest
    return (newest.inputs, newest.values) != (call.inputs, call.values) or not all(call.inputs.values())


def _wish(activation: Activation, own: Hold | None, call: Reserve | Apply) -> Activation:
    """Note what a task wants of a component that acts for it, but that it shares with one that disagrees.

    Once all that share it wish the same, the one that asks last is served. A task for which it does not act holds it no
    more: two that are to wait until the other changes would do so forever.
    """
    if own is None or (isinstance(call, Reserve) and call.waits):
        return activation
    others = tuple(hold for hold in activation.holds if hold is not own)
    if own.active:
        claim = replace(own.claim, supervisor=call.supervisor)
        return replace(activation, holds=(*others, replace(own, claim=claim, wish=call)))
    ended = (*_ended(activation, call), (call.task, own.claim.epoch))[-MOST_ENDED:]
    return replace(activation, holds=others, ended=ended)


def served(before: Activation, after: Activation) -> tuple[str, ...]:
    """The tasks that share a component, and that may have by now what they wished: no other disagrees any more."""
    wished = {hold.claim.task for hold in before.holds if hold.wish is not None}
    return tuple(
        hold.claim.task
        for hold in after.holds
        if hold.claim.task in wished
        and hold.claim.epoch == before.epoch_of(hold.claim.task)  # else it has been served just now
        and all(other.agrees_with(hold.newest) for other in after.holds)
    )


def granted(activation: Activation) -> Apply | None:
    """What is wished of a component by all that hold it, since those that disagreed have let go of it."""
    if activation.phase is not ActivationPhase.ACTIVE:
        return None
    wishes = [hold.wish for hold in activation.holds if isinstance(hold.wish, Apply)]
    return next((wish for wish in wishes if all(hold.agrees_with(wish) for hold in activation.holds)), None)


def _ended(activation: Activation, call: Reserve | Apply) -> tuple[tuple[str, int], ...]:
    return tuple(one for one in activation.ended if one[0] != call.task)


def drop(activation: Activation, tasks: Iterable[str], epoch: int = 0) -> tuple[Activation, ActivationStep]:
    """Return what becomes of an activation when tasks hold it no more; `epoch` is that of the release, if it is one."""
    dropped = dict.fromkeys(tasks)
    newest = {task: max(epoch, activation.epoch_of(task)) for task in dropped}
    ended = (*(one for one in activation.ended if one[0] not in dropped), *newest.items())[-MOST_ENDED:]
    holds = tuple(hold for hold in activation.holds if hold.claim.task not in dropped)
    after = replace(activation, holds=holds, ended=ended)
    if any(hold.active for hold in holds) or activation.phase is ActivationPhase.IDLE:
        return after, ActivationStep.NONE
    return replace(after, phase=ActivationPhase.IDLE), ActivationStep.STOP


def fail(activation: Activation) -> tuple[Activation, ActivationStep]:
    """Return what becomes of an activation when the component says that it cannot go on."""
    if activation.phase is ActivationPhase.ACTIVE:
        return replace(activation, phase=ActivationPhase.FAILED), ActivationStep.RAISE_FAIL
    return activation, ActivationStep.NONE


def held_under(activation: Activation, supervisor: str) -> tuple[str, ...]:
    """The tasks that hold a component and are supervised by a configurator: orphaned once that has been gone."""
    return tuple(hold.claim.task for hold in activation.holds if hold.claim.supervisor == supervisor)


def outranked(activation: Activation) -> tuple[str, ...]:
    """The tasks that hold a component although one of higher priority than all of them waits for it.

    That one may share it with them, and wait until it can have it do something else.
    """
    first = activation.queue.first
    if first is None:
        return ()
    others = [hold.claim for hold in activation.holds if hold.claim.task != first.task]
    lower = [claim for claim in others if claim.priority < first.priority]
    return tuple(claim.task for claim in lower) if len(lower) == len(others) else ()


def offer(activation: Activation) -> tuple[Activation, Claim | None]:
    """Keep a component that no task holds for the first that waits, and return the claim of that task."""
    if activation.holds:
        return activation, None
    queue, claim = activation.queue.offered()
    return replace(activation, queue=queue), claim


def withdraw(activation: Activation, task: str) -> Activation:
    """Keep the component no longer for a task that has not reserved it."""
    return replace(activation, queue=activation.queue.withdrawn(task))
