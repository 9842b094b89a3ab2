"""The profile of a component: what its advertisement says about it (section 2.2 of the paper).

The functional part is the inputs and the outputs, each a named and typed signal; the non-functional part is the
component types and the properties. Operational parameters set or tune the running mode (footnote 1 of the paper).

*Operations are ports.* An operation that a component offers is an output, one that it needs is an input. Their type is
what is answered (`Operation`); what is sent along is a condition of the one, and stated by the other. Their names end
in `()`, as those of other ports may not. So whatever pairs, counts or names ports does the same with operations.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field
from decimal import Decimal
from functools import lru_cache
from typing import NamedTuple

from selfconf.model.immutable import immutable
from selfconf.model.term import IRI, Term
from selfconf.model.wording import in_words, is_one_line, with_article


@immutable
class Place:
    """Where something was said: a file or other source, and the line in it, counted from one, where known."""

    source: str
    line: int | None = None

    def __str__(self) -> str:
        return self.source if self.line is None else f"{self.source}:{self.line}"


@immutable
class Placed:
    """A fact about a role or component that some document describes."""

    place: Place | None = field(default=None, kw_only=True, compare=False)
    """Where that is described, if it is known."""


class SentRequest(NamedTuple):
    """What is sent along with a call; without a type, nothing is."""

    type: IRI | None = None
    kinds: frozenset[IRI] = frozenset()
    """The type, and what lies above it in the hierarchy that the partition was made under."""

    def taken_by(self, operation: Output) -> bool:
        """Whether an operation takes it: what lies above it, or nothing; one without any type takes what comes."""
        if not operation.signals:
            return True
        return self.type is None if operation.request is None else operation.request in self.kinds


class Condition(NamedTuple):
    """What an input asks of an output besides its signal types; what is None is not asked for.

    A unit or a frame that the output does not state is taken to agree.
    """

    unit: IRI | None = None
    frame: Term | None = None
    accepts: str | None = None
    """The shape that the output has to conform to (`sc:accepts`), as Turtle."""
    sent: SentRequest | None = None
    """Of an operation that is needed: what is sent along."""

    def met_by(self, output: Output) -> bool:
        """Whether an output agrees in unit and frame, conforms to the shape, and takes what is sent along."""
        return (
            (self.unit is None or output.unit in (None, self.unit))
            and (self.frame is None or output.frame in (None, self.frame))
            and (self.accepts is None or self.accepts in output.conforms)
            and (self.sent is None or self.sent.taken_by(output))
        )


CALL_MARK = "()"
"""What the name of a port ends in that is an operation, and that of no other port."""
LONGEST_PORT_NAME = 1000
"""How many characters the name of a port has at most: Zenoh breaks at a key of more than 65,000 bytes, in all programs
that are to listen to it."""


def is_port_name(text: str) -> bool:
    """Whether an author may give a port, an operation or an operational parameter this name.

    It stands in keys and in lines for people, so it is of bounded length and has no control characters, as messages
    hold no such names.
    """
    return 0 < len(text) <= LONGEST_PORT_NAME and not text.endswith(CALL_MARK) and is_one_line(text)


class Operation(IRI):
    """The type of an operation, in the place of a signal type: what it answers with.

    One that is offered serves where another is needed iff its response matches what is wanted, and what is sent along
    (`Condition.sent`) matches the request that it takes: the response like an output, the request the other way round
    (a function type, covariant in its result and contravariant in its argument).
    """

    __slots__ = ()

    @classmethod
    def of(cls, response: IRI | None) -> Operation:
        """The type of operations with that type of response; None stands for one that answers nothing."""
        return cls.unchecked(f"-> <{response or ''}>")

    @property
    def response(self) -> IRI | None:
        """The type of what is answered; None if nothing is."""
        return IRI.unchecked(self[4:-1]) or None

    @property
    def short(self) -> str:
        """For people: `-> Image`."""
        response = self.response
        return f"-> {response.short if response else 'nothing'}"


def _operation_in_words(signals: Sequence[IRI], request: IRI | None) -> str:
    """An operation by its types: `operation Goal -> Image`."""
    return " ".join(["operation", *([request.short] if request else []), *(signal.short for signal in signals)])


def _response(signals: Sequence[IRI]) -> IRI | None:
    return next((one.response for one in signals if isinstance(one, Operation)), None)


def port_in_words(name: str) -> str:
    """A port by its name, for people: `the input 'pose'`, or `the operation 'photo'` of one that is called."""
    return f"the operation {name.removesuffix(CALL_MARK)!r}" if name.endswith(CALL_MARK) else f"the input {name!r}"


class WantedSignal(NamedTuple):
    """What an input wants: a signal of any one of its types, from an output that meets its condition."""

    signals: tuple[IRI, ...] = ()
    condition: Condition | None = None

    def output(self, name: str) -> Output:
        """An output of that name which issues what is wanted, of the first of the types."""
        unit, frame, accepts, sent = self.condition or Condition()
        shapes = frozenset(() if accepts is None else (accepts,))
        return Output(name, self.signals[:1], None, unit, frame, shapes, None if sent is None else sent.type)

    @property
    def issued(self) -> str:
        """What a component does that meets it, for people: `issues a Pose`, `offers an operation -> Image`."""
        return f"{'offers' if _calls(self.signals) else 'issues'} {with_article(str(self))}"

    def __str__(self) -> str:
        condition = self.condition or Condition()
        if _calls(self.signals):
            return _operation_in_words(self.signals, condition.sent.type if condition.sent else None)
        shape = " that conforms to its sc:accepts" if condition.accepts else ""
        return signal_in_words(self.signals, condition.unit, condition.frame) + shape


def _calls(signals: Sequence[IRI]) -> bool:
    return any(isinstance(one, Operation) for one in signals)


def signal_in_words(signals: Sequence[IRI], unit: IRI | None, frame: Term | None) -> str:
    """What a port carries: its types by their short names, its unit and its frame."""
    types = " or ".join(dict.fromkeys(signal.short for signal in signals)) or "signal without a type"
    in_unit = "" if unit is None else f" in {unit.short}"
    return f"{types}{in_unit}" + ("" if frame is None else f" in the frame {in_words((frame,))}")


# Ports are named tuples, which Python hashes and compares in C: a search groups a hundred thousand candidates by them.
class Input(NamedTuple):
    """A port that accepts signals of any one of its types; without a type it is paired by its name alone.

    Or an operation that the component needs: its only type is an `Operation`, or none if nothing is said of that.
    """

    name: str
    signals: tuple[IRI, ...]
    """The signal types, sorted."""
    depth: int | None = None
    """How many signals may wait while the component is busy, if it says so."""
    optional: bool = False
    """Whether it may stay unfed."""
    condition: Condition | None = None

    @property
    def is_operation(self) -> bool:
        """Whether it is an operation that the component needs."""
        return self.name.endswith(CALL_MARK)

    @property
    def request(self) -> IRI | None:
        """The request type of an operation; None for other ports."""
        return None if self.condition is None or self.condition.sent is None else self.condition.sent.type

    @property
    def response(self) -> IRI | None:
        """The response type of an operation; None for other ports."""
        return _response(self.signals)

    @property
    def wanted(self) -> WantedSignal:
        """The signal that it wants."""
        return WantedSignal(self.signals, self.condition)


class Output(NamedTuple):
    """A port that issues signals which are of all its types; without a type it is paired by its name alone.

    Or an operation that the component offers: its only type is an `Operation`, or none if nothing is said of that.
    """

    name: str
    signals: tuple[IRI, ...]
    """The signal types, sorted."""
    rate: float | None = None
    """The least rate that it promises, in hertz, if it promises one."""
    unit: IRI | None = None
    frame: Term | None = None
    conforms: frozenset[str] = frozenset()
    """Of the shapes that inputs ask outputs to conform to, those that it is known to conform to."""
    request: IRI | None = None
    """The request type of an operation; None for other ports."""

    @property
    def is_operation(self) -> bool:
        """Whether it is an operation that the component offers."""
        return self.name.endswith(CALL_MARK)

    @property
    def response(self) -> IRI | None:
        """The response type of an operation; None for other ports."""
        return _response(self.signals)

    def __str__(self) -> str:
        if _calls(self.signals) or self.is_operation:
            return f"an {_operation_in_words(self.signals, self.request)}"
        return signal_in_words(self.signals, self.unit, self.frame)


def needed_operation(name: str, request: IRI | None, response: IRI | None, optional: bool = False) -> Input:
    """The input that an operation is which a component needs; with neither type it is paired by its name alone."""
    if request is None and response is None:
        return Input(name + CALL_MARK, (), optional=optional)
    sent = SentRequest(request, frozenset(() if request is None else (request,)))
    return Input(name + CALL_MARK, (Operation.of(response),), None, optional, Condition(sent=sent))


def offered_operation(name: str, request: IRI | None, response: IRI | None) -> Output:
    """The output that an operation is which a component offers; with neither type it is paired by its name alone."""
    types = () if request is None and response is None else (Operation.of(response),)
    return Output(name + CALL_MARK, types, request=request)


class Ports(NamedTuple):
    """The functional part of a profile, operations included, each sorted by name."""

    inputs: tuple[Input, ...] = ()
    outputs: tuple[Output, ...] = ()


NO_PORTS = Ports()
NO_PREFERENCE = Decimal(0)
CALLBACK_DEADLINE = 2.0
"""Seconds that a callback of a component may take, unless its advertisement says otherwise."""
START_DEADLINE = 8.0
"""Seconds that `started` may take, unless the advertisement says otherwise."""


@lru_cache(maxsize=10_000)
def shared_ports(inputs: tuple[Input, ...], outputs: tuple[Output, ...]) -> Ports:
    """Ports as one object for all components that have the same, so that a search tells by identity which are alike."""
    return Ports(inputs, outputs)


@immutable
class OperationalParameter:
    """A parameter that a configurator may set on a component."""

    name: str
    type: IRI


@immutable
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
    inside: IRI | None = None
    """The template of the task that it is inside, if it is a composite."""
    place: Place | None = field(default=None, compare=False)

    @property
    def callback_deadline(self) -> float:
        """How many seconds a callback of it may take, but for `started`."""
        return CALLBACK_DEADLINE if self.deadline is None else self.deadline

    @property
    def start_deadline(self) -> float:
        """How many seconds `started` may take."""
        return START_DEADLINE if self.deadline is None else self.deadline

    @property
    def inputs(self) -> tuple[Input, ...]:
        """The ports that accept signals, and the operations that it needs."""
        return self.ports.inputs

    @property
    def outputs(self) -> tuple[Output, ...]:
        """The ports that issue signals, and the operations that it offers."""
        return self.ports.outputs

    @property
    def needed_operations(self) -> tuple[Input, ...]:
        """The inputs that are operations of others."""
        return tuple(port for port in self.ports.inputs if port.is_operation)

    @property
    def operations(self) -> tuple[Output, ...]:
        """The outputs that are operations of its own."""
        return tuple(port for port in self.ports.outputs if port.is_operation)

    @property
    def signal_inputs(self) -> tuple[Input, ...]:
        """The inputs that are no operations."""
        return tuple(port for port in self.ports.inputs if not port.is_operation)

    @property
    def signal_outputs(self) -> tuple[Output, ...]:
        """The outputs that are no operations."""
        return tuple(port for port in self.ports.outputs if not port.is_operation)

    @property
    def is_actuator(self) -> bool:
        """Whether it is an actuator: it issues no signal, whatever operations it offers, so that it may move things."""
        return not self.signal_outputs

    @property
    def required(self) -> tuple[Input, ...]:
        """The inputs that must be fed."""
        return tuple(port for port in self.ports.inputs if not port.optional)

    @property
    def is_shareable(self) -> bool:
        """Whether several tasks may hold it: by default, what has neither inputs nor operational parameters.

        Nor an operation that takes a request: by such, too, tasks might have it do different things.
        """
        if self.shareable is not None:
            return self.shareable
        return not self.inputs and not self.parameters and not any(one.request for one in self.outputs)

    def output(self, name: str) -> Output | None:
        """The output of that name, if there is one."""
        return next((port for port in self.outputs if port.name == name), None)

    def values(self, predicate: IRI) -> tuple[Term, ...]:
        """The values of a property, in order."""
        return tuple(value for key, value in self.properties if key == predicate)
