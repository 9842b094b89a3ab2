"""A bench for one component: probes feed its inputs and hear its outputs, under a real configurator in memory."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import isfinite
from pathlib import Path
from typing import Any

from selfconf.api.arguments import Paths, checked_delay
from selfconf.api.task import template
from selfconf.errors import ProgrammerError
from selfconf.model.profile import CALL_MARK, Input, Output, Profile
from selfconf.model.run_event import CallDeclined, ComponentLost, ComponentUnreachable
from selfconf.model.term import IRI, Literal
from selfconf.rdf.advertisements import Advertisement, read_advertisements
from selfconf.rdf.turtle import ntriples
from selfconf.rdf.vocabulary import SC, XSD
from selfconf.sdk import Component, Refused, Response, Signal
from selfconf.testing.memory_ecology import MemoryEcology, MemoryRun

BASE = "urn:selfconf:bench:"
PREFIXES = f"""@prefix sc: <https://w3id.org/selfconf#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix :   <{BASE}> .
"""
DELIVERY = 0.1
"""Simulated seconds in which a signal goes from one component through another to a third."""


class _Feeder(Component):
    """Issues signals for one input of the component on the bench, on an output for each signal type that it accepts.

    An output issues what is of all its types, and an input accepts what is of any.
    """

    def __init__(self, outputs: Sequence[str]) -> None:
        self.outputs = outputs

    def feed(self, value: Any) -> str | None:
        """Issue a value on the first output that it fits; if it fits none, returns what is wrong with it."""
        problems = {output: self._attached().outputs.problem(output, value) for output in self.outputs}
        for output, problem in problems.items():
            if problem is None:
                self.emit(output, value)
                return None
        return " and ".join(dict.fromkeys(filter(None, problems.values())))


class _Listener(Component):
    """Hears one output of the component on the bench."""

    def __init__(self) -> None:
        self.heard: list[Any] = []

    def received(self, port: str, signal: Signal) -> None:
        self.heard.append(signal.value)


class _Server(Component):
    """Offers one operation that the component on the bench needs."""

    def __init__(self) -> None:
        self.answer: Callable[[Any], Any] | None = None

    def called(self, operation: str, request: Signal) -> Any:
        if self.answer is None:
            raise Refused("the bench does not answer")
        return self.answer(request.value)


class _Caller(Component):
    """Calls one operation of the component on the bench."""


class _BenchEcology(MemoryEcology):
    """An ecology in which inputs accept what the bench feeds them, whatever they accept elsewhere (`sc:accepts`)."""

    def _advertised(self, component: Component, advertisement: str | Path | None) -> Advertisement:
        found = super()._advertised(component, advertisement)
        said = [triple for triple in found.triples if triple[1] != SC.accepts]
        if len(said) == len(found.triples):
            return found
        place = "the bench" if found.place is None else found.place.source
        (without_shapes,), _ = read_advertisements(ntriples(said), place)
        return without_shapes


class ComponentBench:
    """Tries one component by itself: start it, send it signals, call it, let time pass, see what it emits.

    What feeds it is the bench, which its inputs accept whatever shape they ask of others (`sc:accepts`).

    >>> class Thermostat(Component):
    ...     def received(self, port, signal):
    ...         self.emit("heating", {"on": signal["celsius"] < 20})
    >>> bench = ComponentBench(Thermostat(), '''
    ...     @prefix sc: <https://w3id.org/selfconf#> . @prefix : <urn:home:> .
    ...     :thermostat a sc:Component, :Thermostat ;
    ...         sc:hasInput [ sc:name "temperature" ; sc:signalType :Temperature ] ;
    ...         sc:hasOutput [ sc:name "heating" ; sc:signalType :Switch ] .''')
    >>> bench.start()
    >>> bench.send("temperature", {"celsius": 15.0})
    >>> bench.emitted, bench.active
    ({'heating': [{'on': True}]}, True)
    """

    def __init__(
        self, component: Component, advertisement: str | Path | None = None, *, ontologies: Paths = ()
    ) -> None:
        """The advertisement is the one of the component's class, or the one given: Turtle text or a file.

        What the component emits is checked against its signal type, as in a living ecology: by the ontologies of
        selfconf and those given. A signal that is not of its type is a failure.
        """
        self.component = component
        self.ecology: MemoryEcology = _BenchEcology(ontologies=ontologies)
        self.ecology.add(component, advertisement)
        (only,) = self.ecology.advertisements.values()
        self.profile: Profile = only.profile
        self._feeders = {
            port.name: self.ecology.add(_Feeder(_feeding(port)), _feeder(f"in{number}", port))
            for number, port in enumerate(self.profile.signal_inputs)
        }
        self._listeners = {
            port.name: self.ecology.add(_Listener(), _probe(f"out{number}", "hasInput", port))
            for number, port in enumerate(self.profile.signal_outputs)
        }
        self._servers = {
            port.name: self.ecology.add(_Server(), _probe(f"op{number}", "hasOperation", port))
            for number, port in enumerate(self.profile.needed_operations)
        }
        self._callers = {
            port.name: self.ecology.add(_Caller(), _probe(f"call{number}", "needsOperation", port))
            for number, port in enumerate(self.profile.operations)
        }
        self._run: MemoryRun | None = None

    def start(self, /, **parameters: str | int | float | bool) -> None:
        """Activate the component, with values for its operational parameters by name.

        All parameters of one type have one value, as tasks set them by their type. Raises ProgrammerError if the
        component declines, breaks, acts already, or declares no parameter of that name, and where a value is none that
        a parameter is set to, or two of one type differ.
        """
        if self.active:
            raise ProgrammerError(f"{self.profile.component.short} acts already; stop it first")  # it would be awaited
        task = template(PREFIXES + self._template(parameters))
        self._run = self.ecology.run(task)
        self.ecology.until(lambda: self._run is not None and (self._run.running or self._run.ended))
        self.ecology.advance(DELIVERY)
        if not self._run.running:
            refused = [event for event in self._run.events if isinstance(event, CallDeclined | ComponentLost)]
            said = "; ".join(dict.fromkeys(event.detail for event in refused))  # who declines is lost for that reason
            raise ProgrammerError(f"{self.profile.component.short} does not start: {said or self._run.phase}")

    def send(self, port: str, value: Any) -> None:
        """Let a signal arrive on an input, and let the time pass that its answers take.

        Raises ProgrammerError for a value that is of none of the signal types of the input, and where the component
        does not act: before `start`, and after it has failed or was stopped.
        """
        name = self.profile.component.short
        if port not in self._feeders:
            raise ProgrammerError(f"{name} advertises no input {port!r}")
        if not self.active:
            failure = self.failure
            raise ProgrammerError(f"{name} does not act{'; start it first' if failure is None else f': {failure}'}")
        problem = self._feeders[port].feed(value)
        if problem is not None:
            raise ProgrammerError(f"what is sent to the input {port!r} of {name} {problem}")
        self.advance(DELIVERY)

    def answer(self, operation: str, answer: Callable[[Any], Any]) -> None:
        """Say what an operation that the component needs is answered with, given what is sent along.

        Until then, and if `answer` raises Refused, there is no answer.
        """
        if f"{operation}{CALL_MARK}" not in self._servers:
            raise ProgrammerError(f"{self.profile.component.short} advertises no need of an operation {operation!r}")
        self._servers[operation + CALL_MARK].answer = answer

    def call(self, operation: str, request: Any = None, seconds: float = 2.0) -> Response:
        """Call an operation of the component, and let the time pass until there is an answer, or none in time.

        Raises ProgrammerError for an operation that it does not offer, for what is no number of seconds, and where the
        component does not act.
        """
        within = checked_delay(seconds)
        caller = self._callers.get(f"{operation}{CALL_MARK}")
        if caller is None:
            raise ProgrammerError(f"{self.profile.component.short} advertises no operation {operation!r}")
        answers: list[Response] = []
        caller.call("call", request, answered=answers.append, seconds=within)
        if not self.ecology.until(lambda: bool(answers), within + DELIVERY):
            raise ProgrammerError(f"{self.profile.component.short} cannot be called now; start it first")
        return answers[0]

    def advance(self, seconds: float) -> None:
        """Let simulated time pass: timers of the component go off."""
        self.ecology.advance(seconds)

    @property
    def emitted(self) -> dict[str, list[Any]]:
        """What the component has emitted so far on each output: JSON values, or bytes."""
        return {name: list(listener.heard) for name, listener in self._listeners.items()}

    @property
    def active(self) -> bool:
        """Whether the component acts."""
        return self.component.active

    @property
    def failure(self) -> str | None:
        """Why the component has failed, if it has: what it said by `fail`, or what broke in it.

        So has an actuator that does not come to rest when it is stopped, as its `stopped` breaks.
        """
        for event in self._run.events if self._run is not None else ():
            if isinstance(event, ComponentUnreachable) and event.call != "release":
                continue
            if isinstance(event, ComponentLost | ComponentUnreachable) and event.component == self.profile.component:
                return event.detail
        return None

    def stop(self) -> None:
        """Turn the component off."""
        if self._run is not None:
            self._run.stop()

    def __repr__(self) -> str:
        return f"<bench of {self.profile.component.short}, which {'acts' if self.active else 'does not act'}>"

    def _template(self, parameters: dict[str, str | int | float | bool]) -> str:
        """A template in which the component plays, fed by a probe for each input and heard by one for each output."""
        profile = self.profile
        feeding = [
            (f":in{number}", output, port.name)
            for number, port in enumerate(profile.signal_inputs)
            for output in _feeding(port)
        ]
        feeding += [(f":op{number}", "call()", port.name) for number, port in enumerate(profile.needed_operations)]
        hearing = [(f":out{number}", port.name, "signal") for number, port in enumerate(profile.signal_outputs)]
        hearing += [(f":call{number}", port.name, "call()") for number, port in enumerate(profile.operations)]
        feeders, listeners = list(dict.fromkeys(one for one, _, _ in feeding)), [one for one, _, _ in hearing]
        roles = [f":{name}-role" for name in (one[1:] for one in (*feeders, *listeners))]
        lines = [f":bench a sc:Template ; sc:roles ( {' '.join([*roles, ':tested'])} ) ."]
        lines.append(f":tested a sc:Role ; sh:in ( <{self.profile.component}> ) {self._settings(parameters)} .")
        lines += [f"{one}-role a sc:Role ; sh:in ( {one} ) ." for one in (*feeders, *listeners)]
        lines += [_interaction(f"{one}-role", output, ":tested", port) for one, output, port in feeding]
        lines += [_interaction(":tested", output, f"{one}-role", port) for one, output, port in hearing]
        return "\n".join(lines)

    def _settings(self, parameters: dict[str, str | int | float | bool]) -> str:
        types = {parameter.name: parameter.type for parameter in self.profile.parameters}
        unknown = sorted(parameters.keys() - types.keys())
        if unknown:
            raise ProgrammerError(f"{self.profile.component.short} declares no parameter {unknown[0]!r}")
        set_by: dict[IRI, str] = {}
        """For each type of parameter the name of the first that is set."""
        for name in parameters:
            first = set_by.setdefault(types[name], name)
            if _turtle(name, parameters[name]) != _turtle(first, parameters[first]):
                raise ProgrammerError(
                    f"a task sets parameters by their type, and {first!r} and {name!r} are of one, {types[name].short}:"
                    " they have one value"
                )
        return " ".join(
            f"; sc:sets [ sc:parameterType <{kind}> ; sc:value {_turtle(name, parameters[name])} ]"
            for kind, name in set_by.items()
        )


def _turtle(name: str, value: object) -> str:
    """The value of a parameter as Turtle writes it. Raises ProgrammerError where the parameter cannot be set to it."""
    if isinstance(value, str):
        return Literal(value).turtle(str)
    if isinstance(value, bool | int):
        return str(value).lower()
    if isinstance(value, float) and isfinite(value):
        return Literal(str(value), XSD.double).turtle(repr)
    raise ProgrammerError(f"a parameter is set to text, a finite number or a truth value; {name} is not, by {value!r}")


def _interaction(source: str, output: str, sink: str, port: str) -> str:
    names = f"sc:output {Literal(output).turtle(str)} ; sc:input {Literal(port).turtle(str)}"
    return f"[] a sc:Interaction ; sc:from {source} ; sc:to {sink} ; {names} ."


def _feeding(port: Input) -> list[str]:
    """The outputs by which an input is fed: one for each signal type, or one without a type."""
    return [f"signal{number}" for number in range(max(1, len(port.signals)))]


def _feeder(name: str, port: Input) -> str:
    """The advertisement of a probe that feeds an input."""
    types: Sequence[IRI | None] = port.signals or (None,)
    outputs = [
        f'[ sc:name "{output}"{"" if kind is None else f" ; sc:signalType <{kind}>"} ]'
        for output, kind in zip(_feeding(port), types, strict=True)
    ]
    return PREFIXES + f":{name} a sc:Component, :Probe ; sc:hasOutput {' , '.join(outputs)} .\n"


def _probe(name: str, link: str, port: Input | Output) -> str:
    """The advertisement of a probe with one port, `signal`, or one operation, `call`, that goes with another one."""
    if port.is_operation:
        types = [(SC.request, port.request), (SC.response, port.response)]
    else:
        types = [(SC.signalType, one) for one in port.signals]
    said = "".join(f" ; <{predicate}> <{kind}>" for predicate, kind in types if kind is not None)
    called = "call" if port.is_operation else "signal"
    return PREFIXES + f':{name} a sc:Component, :Probe ; sc:{link} [ sc:name "{called}"{said} ] .\n'
