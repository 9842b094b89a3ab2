"""What has changed in an ecology, as the thread of the bus hands it to the one that serves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, fields
from typing import Any

from selfconf.discovery import FoundAdvertisement
from selfconf.model.immutable import immutable
from selfconf.model.term import IRI
from selfconf.protocol.messages import TaskRecord

Body = dict[str, Any]
"""A JSON object."""


@immutable
class EcologyChange:
    """What is new, by kind; None stands for what is gone."""

    advertised: Mapping[IRI, FoundAdvertisement | None] = field(default_factory=dict)
    components: Mapping[str, Body | None] = field(default_factory=dict)
    sites: Mapping[str, Body | None] = field(default_factory=dict)
    tasks: Mapping[str, Body | None] = field(default_factory=dict)
    events: tuple[Body, ...] = ()
    graphs: Mapping[str, bytes] = field(default_factory=dict)
    """What components advertise, as N-Triples by the name of the graph; empty for one that is gone."""
    deployed: Mapping[str, bytes] = field(default_factory=dict)
    """What configurators tell of what they have deployed, likewise."""
    records: Mapping[str, TaskRecord] = field(default_factory=dict)
    """The templates of tasks, with how each is searched for, by the identity of the task."""

    link: str = ""
    """The link of the bus over which all that is advertised and deployed was found anew, if it was."""

    @property
    def empty(self) -> bool:
        """Whether nothing is new."""
        return not any(getattr(self, one.name) for one in fields(self))
