"""A bench for one component: probes feed its inputs and hear its outputs, under a real configurator in memory."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from selfconf.api.arguments import Paths
from selfconf.api.task import template
from selfconf.errors import ProgrammerError
from selfconf.model.profile import Profile
from selfconf.model.run_event import CallDeclined, ComponentLost
from selfconf.model.term import IRI, Literal
from selfconf.sdk import Component, Signal
from selfconf.testing.memory_ecology import MemoryEcology, MemoryRun

BASE = "urn:selfconf:bench:"
PREFIXES = f"""@prefix sc: <https://w3id.org/selfconf#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix :   <{BASE}> .
"""
DELIVERY = 0.1
"""Simulated seconds in which a signal goes from one component through another to a third."""


class _Feeder(Component):
    """Issues signals for one input of the component on the bench."""


class _Listener(Component):
    """Hears one output of the component on the bench."""

    def __init__(self) -> None:
        self.heard: list[Any] = []

    def received(self, port: str, signal: Signal) -> None:
        self.heard.append(signal.value)


class ComponentBench:
    """Tries one component by itself: start it, send it signals, let time pass, see what it emits."""

    def __init__(
        self, component: Component, advertisement: str | Path | None = None, *, ontologies: Paths = ()
    ) -> None:
        """The advertisement is the one of the component's class, or the one given: Turtle text or a file.

        What the component emits is checked against its signal type, as in a living ecology: by the ontologies of
        selfconf and those given. A signal that is not of its type is a failure.
        """
        self.component = component
        self.ecology = MemoryEcology(ontologies=ontologies)
        self.ecology.add(component, advertisement)
        (only,) = self.ecology.advertisements.values()
        self.profile: Profile = only.profile
        self._feeders = {
            port.name: self.ecology.add(_Feeder(), _probe(f"in{number}", "hasOutput", port.signals))
            for number, port in enumerate(self.profile.inputs)
        }
        self._listeners = {
            port.name: self.ecology.add(_Listener(), _probe(f"out{number}", "hasInput", port.signals))
            for number, port in enumerate(self.profile.outputs)
        }
        self._run: MemoryRun | None = None

    def start(self, **parameters: str | int | float | bool) -> None:
        """Activate the component, with values for its operational parameters by name.

        Raises ProgrammerError if it declines, breaks, or declares no parameter of that name.
        """
        task = template(PREFIXES + self._template(parameters))
        self._run = self.ecology.run(task)
        self.ecology.until(lambda: self._run is not None and (self._run.running or self._run.ended))
        self.ecology.advance(DELIVERY)
        if not self._run.running:
            said = [event.detail for event in self._run.events if isinstance(event, CallDeclined | ComponentLost)]
            raise ProgrammerError(
                f"{self.profile.component.short} does not start: {'; '.join(said) or self._run.phase}"
            )

    def send(self, port: str, value: Any) -> None:
        """Let a signal arrive on an input, and let the time pass that its answers take."""
        if port not in self._feeders:
            raise ProgrammerError(f"{self.profile.component.short} advertises no input {port!r}")
        self._feeders[port].emit("signal", value)
        self.advance(DELIVERY)

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
        """Why the component has failed, if it has: what it said by `fail`, or what broke in it."""
        for event in self._run.events if self._run is not None else ():
            if isinstance(event, ComponentLost) and event.component == self.profile.component:
                return event.detail
        return None

    def stop(self) -> None:
        """Turn the component off."""
        if self._run is not None:
            self._run.stop()

    def _template(self, parameters: dict[str, str | int | float | bool]) -> str:
        """A template in which the component plays, fed by a probe for each input and heard by one for each output."""
        feeders = [f":in{number}" for number in range(len(self._feeders))]
        listeners = [f":out{number}" for number in range(len(self._listeners))]
        roles = [f":{name}-role" for name in (one[1:] for one in (*feeders, *listeners))]
        lines = [f":bench a sc:Template ; sc:roles ( {' '.join([*roles, ':tested'])} ) ."]
        lines.append(f":tested a sc:Role ; sh:in ( <{self.profile.component}> ) {self._settings(parameters)} .")
        lines += [f"{one}-role a sc:Role ; sh:in ( {one} ) ." for one in (*feeders, *listeners)]
        for one, port in zip(feeders, self.profile.inputs, strict=True):
            lines.append(
                f'[] a sc:Interaction ; sc:from {one}-role ; sc:output "signal" ; sc:to :tested ; '
                f"sc:input {Literal(port.name).turtle(str)} ."
            )
        for one, output in zip(listeners, self.profile.outputs, strict=True):
            lines.append(
                f"[] a sc:Interaction ; sc:from :tested ; sc:output {Literal(output.name).turtle(str)} ; "
                f'sc:to {one}-role ; sc:input "signal" .'
            )
        return "\n".join(lines)

    def _settings(self, parameters: dict[str, str | int | float | bool]) -> str:
        types = {parameter.name: parameter.type for parameter in self.profile.parameters}
        unknown = sorted(parameters.keys() - types.keys())
        if unknown:
            raise ProgrammerError(f"{self.profile.component.short} declares no parameter {unknown[0]!r}")
        said = [f"; sc:sets [ sc:parameterType <{types[n]}> ; sc:value {_turtle(v)} ]" for n, v in parameters.items()]
        return " ".join(said)


def _turtle(value: str | int | float | bool) -> str:
    """A value as Turtle writes it."""
    if isinstance(value, bool):
        return str(value).lower()
    return Literal(value).turtle(str) if isinstance(value, str) else f"{value!r}{'e0' * isinstance(value, float)}"


def _probe(name: str, link: str, signals: Sequence[IRI]) -> str:
    types = "".join(f" ; sc:signalType <{signal}>" for signal in signals)
    return PREFIXES + f':{name} a sc:Component, :Probe ; sc:{link} [ sc:name "signal"{types} ] .\n'
