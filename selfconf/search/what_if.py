"""What if one component fails (N - 1): for each component of a configuration, what would come instead of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from selfconf.model.configuration import Configuration
from selfconf.model.consequence import Consequence
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.term import IRI
from selfconf.search import reconfigure
from selfconf.search.problem import Problem


def consequences(
    problem: Problem,
    running: Configuration,
    search: Callable[[Problem, Configuration], Configuration | Refusal | Undecided] = reconfigure.nearest_configuration,
) -> Iterator[Consequence]:
    """Yield what the loss of each component of a configuration would bring, one by one, in the order of the roles."""
    players = [
        (component, assignment.role) for assignment in running.assignments for component in assignment.components
    ]
    for component, role in (*players, *((component, None) for component in running.recruits)):
        left = Problem(problem.task, problem.partition.without(frozenset((component,))), problem.hierarchy)
        yield _consequence(component, role, running, search(left, running))


def _consequence(
    component: IRI, role: IRI | None, running: Configuration, after: Configuration | Refusal | Undecided
) -> Consequence:
    if not isinstance(after, Configuration):
        return Consequence(component, role, after)
    before, now = dict.fromkeys(running.components), dict.fromkeys(after.components)
    played = {one: assignment.role for assignment in running.assignments for one in assignment.components}
    playing: list[tuple[IRI, IRI | None]] = [(one, a.role) for a in after.assignments for one in a.components]
    playing += [(one, None) for one in after.recruits]
    return Consequence(
        component,
        role,
        after,
        started=tuple(one for one in now if one not in before),
        stopped=tuple(one for one in before if one not in now and one != component),
        moved=tuple((one, new) for one, new in playing if one in before and played.get(one) != new),
    )
