"""What an agent is told to do, and what it tells: the order of a task, and the accounts of what happens to it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from selfconf.configurator.machine import Policy
from selfconf.model.configuration import Configuration
from selfconf.model.refusal import Outcome, Refusal, Undecided
from selfconf.model.template import Task
from selfconf.model.term import IRI
from selfconf.protocol.messages import Wire
from selfconf.rdf.advertisements import Advertisement

Compose = Callable[[Mapping[IRI, Advertisement], frozenset[IRI], "Configuration | None"], Outcome]
"""Act 3: from the advertisements, the lost components and what runs now, a configuration or a refusal."""

Standby = Mapping[IRI, Mapping[str, tuple[Wire, ...]]]
"""For each component and input, the outputs that might be connected to it next."""


@dataclass(frozen=True, slots=True)
class Account:
    """One thing that the configurator did or noticed, for people and logs."""

    act: str
    time: float
    facts: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class RunRequest:
    """What an agent is to do: how to compose, how to mend, and who wants to know."""

    task: Task
    compose: Compose
    policy: Policy = Policy.REPAIR
    patient: bool = False
    standby: Callable[[Configuration, frozenset[IRI]], Standby] = lambda configuration, lost: {}
    """For each component and input of a configuration, the outputs that might be connected next, but for the lost."""
    passed_over: Callable[[Configuration], Mapping[IRI, Sequence[IRI]]] = lambda configuration: {}
    """For each role of a configuration, the candidates that came before the chosen ones."""
    tell: Callable[[Account], None] = lambda account: None
    settle: Callable[[Refusal | Undecided | None], None] = lambda refusal: None
    """Hears once when the task has ended; with the refusal if that is why."""


class Tell(Protocol):
    """Notes an account: which act, and the facts by name."""

    def __call__(self, act: str, **facts: Any) -> None: ...
