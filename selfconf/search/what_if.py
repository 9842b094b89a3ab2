"""What if one component fails (N - 1): for each component of a configuration, what would come instead of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from selfconf.model.configuration import Configuration
from selfconf.model.consequence import Consequence
from selfconf.model.refusal import Refusal
from selfconf.search import reconfigure
from selfconf.search.problem import Problem


def consequences(
    problem: Problem,
    running: Configuration,
    search: Callable[[Problem, Configuration], Configuration | Refusal] = reconfigure.nearest_configuration,
) -> Iterator[Consequence]:
    """The loss of each component of a configuration by itself, in the order of the roles."""
    for assignment in running.assignments:
        for component in assignment.components:
            left = Problem(problem.task, problem.partition.without(frozenset((component,))), problem.hierarchy)
            after = search(left, running)
            if isinstance(after, Refusal):
                yield Consequence(component, assignment.role, after)
            else:
                before, now = running.components, after.components
                playing = [(one, new.role) for new in after.assignments for one in new.components]
                yield Consequence(
                    component,
                    assignment.role,
                    after,
                    tuple(one for one in now if one not in before),
                    tuple(one for one in before if one not in now and one != component),
                    tuple((one, role) for one, role in playing if one in before and running.role_of(one) != role),
                )
