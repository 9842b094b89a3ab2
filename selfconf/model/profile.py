"""The profile of a component: what its advertisement says about it (section 2.2 of the paper).

The functional part is the inputs and the outputs, each a named and typed signal; the non-functional part is the
component types and the properties. Operational parameters set or tune the running mode (footnote 1 of the paper).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from decimal import Decimal
from functools import lru_cache
from typing import NamedTuple

from selfconf.model.term import IRI, Term


@dataclass(frozen=True, slots=True)
class Place:
    """Where something was said: a file or other source, and the line in it, counted from one, where known."""

    source: str
    line: int | None = None

    def __str__(self) -> str:
        return self.source if self.line is None else f"{self.source}:{self.line}"


# Ports are named tuples, which Python hashes and compares in C: a search groups a hundred thousand candidates by them.
class Input(NamedTuple):
    """A port that accepts signals of one type; `depth` is how many may wait while the component is busy, if it says."""

    name: str
    signal: IRI
    depth: int | None = None


class Output(NamedTuple):
    """A port that issues signals of one type; `rate` is the least rate it promises, in hertz, if it promises one."""

    name: str
    signal: IRI
    rate: float | None = None


class Ports(NamedTuple):
    """The functional part of a profile, each sorted by name."""

    inputs: tuple[Input, ...] = ()
    outputs: tuple[Output, ...] = ()


NO_PORTS = Ports()
NO_PREFERENCE = Decimal(0)


@lru_cache(maxsize=10_000)
def shared_ports(inputs: tuple[Input, ...], outputs: tuple[Output, ...]) -> Ports:
    """Ports as one object for all who have the same, so that a search tells by identity who is alike."""
    return Ports(inputs, outputs)


@dataclass(frozen=True, slots=True)
class OperationalParameter:
    """A parameter that a configurator may set on a component."""

    name: str
    type: IRI


@dataclass(frozen=True, slots=True)
class Profile:
    """What a component is. Parameters are sorted by name, properties by predicate and value."""

    component: IRI
    types: frozenset[IRI] = frozenset()
    properties: tuple[tuple[IRI, Term], ...] = ()
    ports: Ports = NO_PORTS
    parameters: tuple[OperationalParameter, ...] = ()
    preference: Decimal = NO_PREFERENCE
    shareable: bool | None = None
    """Whether several tasks may hold it, if it says so; `is_shareable` is what holds."""
    tolerates: float | None = None
    """For how many seconds it acts on while a required input is unfed, if it says so."""
    deadline: float | None = None
    """How many seconds a callback of it may take, if it says so."""
    restarts: int | None = None
    """How often a minute its site starts it again after a crash, if it says so."""
    command: str | None = None
    place: Place | None = field(default=None, compare=False)

    @property
    def inputs(self) -> tuple[Input, ...]:
        """The ports that accept signals."""
        return self.ports.inputs

    @property
    def outputs(self) -> tuple[Output, ...]:
        """The ports that issue signals."""
        return self.ports.outputs

    @property
    def is_shareable(self) -> bool:
        """Whether several tasks may hold it: by default, what has neither inputs nor operational parameters."""
        return not self.inputs and not self.parameters if self.shareable is None else self.shareable

    def output(self, name: str) -> Output | None:
        """The output of that name, if there is one."""
        return next((port for port in self.outputs if port.name == name), None)

    def values(self, predicate: IRI) -> tuple[Term, ...]:
        """The values of a property, in order."""
        return tuple(value for key, value in self.properties if key == predicate)
