"""What is outside of a task that is the inside of a composite, as one more player of it.

Seen from inside, a composite is a component with its ports turned round: what the template receives it issues, and what
the template gives it needs; an operation that the template offers it calls, and one that the template needs it answers.
An optional input of the composite that no component feeds it does not issue.
It plays a role of its own, by its own IRI, which feeds the roles of the input ports and is
fed by those of the output ports. So the search, its certificate and its refusals know of ports what they know of roles;
only the deployment leaves it out, and takes its connections for the ports.
"""

from __future__ import annotations

from collections.abc import Set

from selfconf.model.configuration import Assignment, Configuration
from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.immutable import replace
from selfconf.model.partition import ANY_VALUE, Candidate, Partition
from selfconf.model.profile import (
    CALL_MARK,
    Condition,
    Input,
    Output,
    Ports,
    Profile,
    needed_operation,
    offered_operation,
)
from selfconf.model.template import Interaction, Role, Task
from selfconf.model.term import IRI


def with_outside(task: Task, composite: IRI) -> Task:
    """A task that is the inside of a composite, with a role for what is outside."""
    template = task.template
    joined = [
        Interaction(composite, port.role, port.name)
        if port.is_input
        else Interaction(port.role, composite, None, port.name)
        for port in template.ports
    ]
    roles, interactions = (*template.roles, Role(composite)), (*template.interactions, *joined)
    return replace(task, template=replace(template, roles=roles, interactions=interactions))


def with_outside_candidate(
    partition: Partition,
    task: Task,
    composite: IRI,
    hierarchy: Hierarchy = NOTHING_ABOVE,
    unfed: Set[str] = frozenset(),
) -> Partition:
    """The partition of a task that is the inside of a composite, with the only candidate for what is outside.

    `unfed` are the names of the inputs of the composite that no component feeds.
    """
    ports = [one.port for one in task.template.ports]
    profile = Profile(
        composite,
        ports=Ports(
            tuple(_wanted(port) for port in ports if isinstance(port, Output)),
            tuple(_offered(port) for port in ports if isinstance(port, Input) and port.name not in unfed),
        ),
    )
    outside = Candidate(profile, (ANY_VALUE,) * len(partition.variables))
    return replace(partition, candidates=(*partition.candidates, (outside,))).with_sent_requests(hierarchy)


def _wanted(port: Output) -> Input:
    """The input of what is outside to which an output of the template leads."""
    if port.is_operation:
        return needed_operation(port.name.removesuffix(CALL_MARK), port.request, port.response)
    condition = Condition(port.unit, port.frame) if port.unit or port.frame else None
    return Input(port.name, port.signals, condition=condition)


def _offered(port: Input) -> Output:
    """The output of what is outside that leads to an input of the template."""
    if port.is_operation:
        return offered_operation(port.name.removesuffix(CALL_MARK), port.request, port.response)
    unit, frame, *_ = port.condition or Condition()
    return Output(port.name, port.signals, unit=unit, frame=frame)


def inside_alone(configuration: Configuration, composite: IRI) -> Configuration:
    """A configuration without the composite as a player; the connections with it stay, as those of its ports."""
    assignments = tuple(one for one in configuration.assignments if one.role != composite)
    return replace(configuration, assignments=assignments)


def with_outside_player(configuration: Configuration, composite: IRI) -> Configuration:
    """A configuration of an inside with the composite as a player, as the search has it."""
    whole = Assignment(composite, (composite,))
    return replace(configuration, assignments=(*configuration.assignments, whole))
