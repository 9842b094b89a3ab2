"""What is sent along with calls, under the hierarchy of a partition: its type, and what lies above that."""

from __future__ import annotations

from collections.abc import Iterable
from operator import attrgetter
from typing import TypeVar

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.immutable import replace
from selfconf.model.partition import Candidate, Partition, Recruit
from selfconf.model.profile import Input, Ports, shared_ports

_PORTS = attrgetter("profile.ports")
_C = TypeVar("_C", Candidate, Recruit)


def with_sent_requests(partition: Partition, hierarchy: Hierarchy) -> Partition:
    """A partition in which each operation that is needed knows all that its request is under a hierarchy."""
    if hierarchy.flat:
        return partition
    # One look at each candidate in C, then one at each choice of ports that they share.
    components = (*(one for some in partition.candidates for one in some), *partition.recruits)
    distinct = {id(ports): ports for ports in map(_PORTS, components)}
    changed = {key: _raised(ports, hierarchy) for key, ports in distinct.items() if _sends(ports)}
    if not changed:
        return partition

    def told(some: Iterable[_C]) -> tuple[_C, ...]:
        return tuple(
            replace(one, profile=replace(one.profile, ports=changed[id(one.profile.ports)]))
            if id(one.profile.ports) in changed
            else one
            for one in some
        )

    return replace(partition, candidates=tuple(map(told, partition.candidates)), recruits=told(partition.recruits))


def _sends(ports: Ports) -> bool:
    return any(port.request is not None for port in ports.inputs)


def _raised(ports: Ports, hierarchy: Hierarchy) -> Ports:
    return shared_ports(tuple(_raised_input(port, hierarchy) for port in ports.inputs), ports.outputs)


def _raised_input(port: Input, hierarchy: Hierarchy) -> Input:
    condition = port.condition
    if condition is None or condition.sent is None or condition.sent.type is None:
        return port
    sent = condition.sent._replace(kinds=hierarchy.superclasses(condition.sent.type))
    return port._replace(condition=condition._replace(sent=sent))
