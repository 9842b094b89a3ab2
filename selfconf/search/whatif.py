"""What if one component fails (N - 1): for each component of a configuration, what would come instead of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from selfconf.model.configuration import Configuration
from selfconf.model.refusal import Refusal
from selfconf.model.term import IRI
from selfconf.search import repair
from selfconf.search.problem import Problem


@dataclass(frozen=True, slots=True)
class Loss:
    """A component that may fail, the role it plays, and the configuration after that, or why there is none."""

    component: IRI
    role: IRI
    after: Configuration | Refusal
    started: tuple[IRI, ...] = ()
    """Components that would begin to play a part, in the order of the roles."""
    stopped: tuple[IRI, ...] = ()
    """Components that would no longer play one, apart from the one that failed."""
    moved: tuple[tuple[IRI, IRI], ...] = ()
    """Components that would play another role, each with that role."""

    @property
    def fatal(self) -> bool:
        """Whether it is a single point of failure."""
        return isinstance(self.after, Refusal)

    def told(self, name: Callable[[IRI], str]) -> str:
        """What would come instead, with names for things."""
        if self.fatal:
            return "NONE, a single point of failure"
        changes = [", ".join(map(name, self.started))] if self.started else []
        changes += [f"{name(one)} as {name(role)}" for one, role in self.moved]
        instead = ", ".join(changes) or "nobody needed"
        return f"{instead}, and {', '.join(map(name, self.stopped))} would stop" if self.stopped else instead

    def __str__(self) -> str:
        return f"{self.component.short} ({self.role.short}): {self.told(lambda iri: iri.short)}"


def losses(
    problem: Problem,
    running: Configuration,
    search: Callable[[Problem, Configuration], Configuration | Refusal] = repair.search,
) -> Iterator[Loss]:
    """The loss of each component of a configuration by itself, in the order of the roles."""
    for assignment in running.assignments:
        for component in assignment.components:
            left = Problem(problem.task, problem.partition.without(frozenset((component,))), problem.hierarchy)
            after = search(left, running)
            if isinstance(after, Refusal):
                yield Loss(component, assignment.role, after)
            else:
                before, now = running.components, after.components
                playing = [(one, new.role) for new in after.assignments for one in new.components]
                yield Loss(
                    component,
                    assignment.role,
                    after,
                    tuple(one for one in now if one not in before),
                    tuple(one for one in before if one not in now and one != component),
                    tuple((one, role) for one, role in playing if one in before and running.role_of(one) != role),
                )
