"""What one run finds out about its refusals: where their facts stand, what nearly fits, and what would help."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from selfconf.api.configuring import refusal_with_places
from selfconf.api.method import Method
from selfconf.api.places import Places
from selfconf.api.task import TaskSpecification
from selfconf.api.tasks.run_outcomes import searched_ecology
from selfconf.composition import Composer, TimeLimit
from selfconf.model.refusal import Refusal
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement


class RefusalExplanations:
    """Explains the refusals of one run, the last one once: a task that waits comes to the same again and again."""

    def __init__(
        self,
        task: TaskSpecification,
        method: Method,
        composer: Composer,
        described: Callable[[], Mapping[IRI, Advertisement]],
    ) -> None:
        """`composer` is that of the searches of the run; `described` are advertisements in files of this machine."""
        self._task, self._method, self._composer, self._described = task, method, composer, described
        self._last: tuple[Refusal, Mapping[IRI, Advertisement], Refusal] | None = None
        """The refusal that was explained last, of which ecology, and the explanation."""

    def in_full(self, refusal: Refusal) -> Refusal:
        """A refusal with all that the time of a search allows to find out, once nothing runs any more."""
        return self._explained(refusal, self._composer, TimeLimit(self._method.seconds))

    def meanwhile(self, refusal: Refusal) -> Refusal:
        """A refusal with what can be found out while the task waits.

        With a composer of its own: to be ended in the middle must not spoil the partition of the next search.
        """
        return self._explained(refusal, self._method.composer(self._task), self._method.explaining())

    def with_places(self, refusal: Refusal, is_last: bool) -> Refusal:
        """A refusal that says where its facts stand, which takes no time; nothing else is found out of the last one."""
        placed = Places(self._task.document.template, self._described(), self._task.texts).placed(refusal)
        if is_last:
            self._last = refusal, searched_ecology(refusal), placed
        return placed

    def _explained(self, refusal: Refusal, composer: Composer, limit: TimeLimit) -> Refusal:
        ecology = searched_ecology(refusal)
        if self._last is None or self._last[:2] != (refusal, ecology):
            described = self._described()
            explained = refusal_with_places(
                composer, ecology, refusal, self._method, limit, described, self._task.texts
            )
            self._last = refusal, ecology, explained
        return self._last[2]
