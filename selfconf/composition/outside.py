"""What is outside of a task that is the inside of a composite, as one more player of it.

Seen from inside, a composite is a component with its ports turned round: what the template receives it issues, and what
the template gives it needs. It plays a role of its own, by its own IRI, which feeds the roles of the input ports and is
fed by those of the output ports. So the search, its certificate and its refusals know of ports what they know of roles;
only the deployment leaves it out, and takes its connections for the ports.
"""

from __future__ import annotations

from dataclasses import replace

from selfconf.model.configuration import Assignment, Configuration
from selfconf.model.partition import ANY_VALUE, Candidate, Partition
from selfconf.model.profile import Input, Output, Ports, Profile
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


def with_outside_candidate(partition: Partition, task: Task, composite: IRI) -> Partition:
    """The partition of a task that is the inside of a composite, with the only candidate for what is outside."""
    ports = task.template.ports
    profile = Profile(
        composite,
        ports=Ports(
            tuple(Input(port.name, port.signals) for port in ports if not port.is_input),
            tuple(Output(port.name, port.signals) for port in ports if port.is_input),
        ),
    )
    outside = Candidate(profile, (ANY_VALUE,) * len(partition.variables))
    return replace(partition, candidates=(*partition.candidates, (outside,)))


def inside_alone(configuration: Configuration, composite: IRI) -> Configuration:
    """A configuration without the composite as a player; the connections with it stay, as those of its ports."""
    assignments = tuple(one for one in configuration.assignments if one.role != composite)
    return replace(configuration, assignments=assignments)


def with_outside_player(configuration: Configuration, composite: IRI) -> Configuration:
    """A configuration of an inside with the composite as a player, as the search has it."""
    whole = Assignment(composite, (composite,))
    return replace(configuration, assignments=(*configuration.assignments, whole))
