"""The tasks that wait for a component which others hold, as a value: in which order, and for which of them it is kept.

Higher priority comes first, then the earlier beginning. A component that becomes free is *offered* to the first task
that waits, and kept for it; until that task has reserved it or the offer is over, tasks that come later have to wait.
If a task of higher priority begins to wait meanwhile, the component is offered to that one instead.

An offer is over soon. Until the component is held again, each waiting task has one offer: otherwise the component would
be offered forever to two tasks each of which waits for the other. A task that has not taken its offer goes on waiting,
but no task is asked to yield for its sake until it asks again: its configurator may be gone.
"""

from __future__ import annotations

from selfconf.model.immutable import immutable, replace
from selfconf.protocol.messages import Claim

MOST_WAITING = 64
"""How many tasks a component remembers that wait for it; those that come last wait by asking again."""


def rank(claim: Claim) -> tuple[int, float, str]:
    """The order in which tasks are served: the higher priority first, then the earlier beginning."""
    return -claim.priority, claim.beginning, claim.task


@immutable
class TaskQueue:
    """The tasks that wait for a component."""

    claims: tuple[Claim, ...] = ()
    """What each has asked for last, in the order in which the component is offered to them."""
    kept_for: str = ""
    """The task that a component which is free is kept for."""
    passed: frozenset[str] = frozenset()
    """The tasks that have been offered the component since it was held last."""
    lapsed: frozenset[str] = frozenset()
    """The tasks that did not come for the component when it was kept for them last."""

    def __bool__(self) -> bool:
        return bool(self.claims)

    @property
    def first(self) -> Claim | None:
        """The first task for which others may be asked to yield."""
        return next((claim for claim in self.claims if claim.task not in self.lapsed), None)

    @property
    def kept(self) -> Claim | None:
        """The claim of the task that the component is kept for."""
        return next((claim for claim in self.claims if claim.task == self.kept_for), None)

    def is_kept_from(self, call: Claim) -> bool:
        """Whether the component is kept for a task that goes before the one that calls."""
        kept = self.kept
        return kept is not None and kept.task != call.task and rank(kept) < rank(call)

    def joined(self, call: Claim) -> TaskQueue:
        """With a task that waits, in its place; a call that it has made before is forgotten."""
        rest = [claim for claim in self.claims if claim.task != call.task]
        claims = tuple(sorted([*rest, call], key=rank)[:MOST_WAITING])
        return replace(self, claims=claims, lapsed=self.lapsed - {call.task})

    def left(self, task: str) -> TaskQueue:
        """Without a task, which waits no more."""
        claims = tuple(claim for claim in self.claims if claim.task != task)
        kept_for = "" if self.kept_for == task else self.kept_for
        return TaskQueue(claims, kept_for, self.passed - {task}, self.lapsed - {task})

    def taken(self, task: str) -> TaskQueue:
        """When a task has the component: it waits no more, and all others may be offered it once it is free again."""
        return replace(self.left(task), kept_for="", passed=frozenset())

    def offered(self) -> tuple[TaskQueue, Claim | None]:
        """When a component is free that is kept for the first task from now on, and the claim of that one.

        One that is kept already goes to no other, but to a task of higher priority that has come since.
        """
        first = next((claim for claim in self.claims if claim.task not in self.passed), None)
        kept = self.kept
        if first is None or (kept is not None and kept.priority >= first.priority):
            return self, None
        passed = self.passed - {self.kept_for} | {first.task}
        return replace(self, kept_for=first.task, passed=passed), first

    def withdrawn(self, task: str) -> TaskQueue:
        """When the component is kept no longer for a task that has not reserved it."""
        if self.kept_for != task:
            return self
        waiting = {claim.task for claim in self.claims}
        return replace(self, kept_for="", lapsed=(self.lapsed | {task}) & waiting)
