"""The profile of a component: what its advertisement says about it (section 2.2 of the paper).

The functional part is the inputs and the outputs, each a named and typed signal; the non-functional part is the
component types and the properties. Operational parameters set or tune the running mode (footnote 1 of the paper).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from decimal import Decimal
from functools import lru_cache
from typing import NamedTuple

from selfconf.model.obstacle import in_words
from selfconf.model.term import IRI, Term


@dataclass(frozen=True, slots=True)
class Place:
    """Where something was said: a file or other source, and the line in it, counted from one, where known."""

    source: str
    line: int | None = None

    def __str__(self) -> str:
        return self.source if self.line is None else f"{self.source}:{self.line}"


class Condition(NamedTuple):
    """What an input asks of an output besides its signal types; what is None is not asked for.

    A unit or a frame that the output does not state is taken to agree.
    """

    unit: IRI | None = None
    frame: Term | None = None
    accepts: str | None = None
    """The shape that the output has to conform to (`sc:accepts`), as Turtle."""

    def met_by(self, output: Output) -> bool:
        """Whether an output agrees in unit and frame, and conforms to the shape."""
        return (
            (self.unit is None or output.unit in (None, self.unit))
            and (self.frame is None or output.frame in (None, self.frame))
            and (self.accepts is None or self.accepts in output.conforms)
        )


class WantedSignal(NamedTuple):
    """What an input wants: a signal of any one of its types, from an output that meets its condition."""

    signals: tuple[IRI, ...] = ()
    condition: Condition | None = None

    def output(self, name: str) -> Output:
        """An output of that name which issues what is wanted, of the first of the types."""
        unit, frame, accepts = self.condition or Condition()
        return Output(name, self.signals[:1], None, unit, frame, frozenset(() if accepts is None else (accepts,)))

    def __str__(self) -> str:
        condition = self.condition or Condition()
        shape = " that conforms to its sc:accepts" if condition.accepts else ""
        return signal_in_words(self.signals, condition.unit, condition.frame) + shape


def signal_in_words(signals: Sequence[IRI], unit: IRI | None, frame: Term | None) -> str:
    """What a port carries: its types by their short names, its unit and its frame."""
    types = " or ".join(dict.fromkeys(signal.short for signal in signals)) or "signal without a type"
    in_unit = "" if unit is None else f" in {unit.short}"
    return f"{types}{in_unit}" + ("" if frame is None else f" in the frame {in_words((frame,))}")


# Ports are named tuples, which Python hashes and compares in C: a search groups a hundred thousand candidates by them.
class Input(NamedTuple):
    """A port that accepts signals of any one of its types; without a type it is paired by its name alone."""

    name: str
    signals: tuple[IRI, ...]
    """The signal types, sorted."""
    depth: int | None = None
    """How many signals may wait while the component is busy, if it says so."""
    optional: bool = False
    """Whether it may stay unfed."""
    condition: Condition | None = None

    @property
    def wanted(self) -> WantedSignal:
        """The signal that it wants."""
        return WantedSignal(self.signals, self.condition)


class Output(NamedTuple):
    """A port that issues signals which are of all its types; without a type it is paired by its name alone."""

    name: str
    signals: tuple[IRI, ...]
    """The signal types, sorted."""
    rate: float | None = None
    """The least rate that it promises, in hertz, if it promises one."""
    unit: IRI | None = None
    frame: Term | None = None
    conforms: frozenset[str] = frozenset()
    """Of the shapes that inputs ask outputs to conform to, those that it is known to conform to."""


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
class Operation:
    """Something that a component does when it is asked, with a request and a response; or that it needs to be done."""

    name: str
    request: IRI | None = None
    """The type of what is sent along, if that is said."""
    response: IRI | None = None
    """The type of what is answered, if that is said."""
    optional: bool = False
    """Of an operation that is needed: whether the component does without."""


@dataclass(frozen=True, slots=True)
class Profile:
    """What a component is. Parameters are sorted by name, properties by predicate and value."""

    component: IRI
    types: frozenset[IRI] = frozenset()
    properties: tuple[tuple[IRI, Term], ...] = ()
    ports: Ports = NO_PORTS
    parameters: tuple[OperationalParameter, ...] = ()
    operations: tuple[Operation, ...] = ()
    """What it does when it is asked, sorted by name."""
    needed_operations: tuple[Operation, ...] = ()
    """What it asks of others, sorted by name."""
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
    def required(self) -> tuple[Input, ...]:
        """The inputs that must be fed."""
        return tuple(port for port in self.ports.inputs if not port.optional)

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
