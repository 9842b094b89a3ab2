"""Where connections really end: behind a port of a composite stand ports inside of it, or outside of this task."""

from __future__ import annotations

import math
from collections.abc import Mapping

from selfconf.configurator import Caller, Callers
from selfconf.deployment.run_request import Outside
from selfconf.discovery import EcologyView
from selfconf.model.configuration import Configuration
from selfconf.model.profile import CALL_MARK
from selfconf.model.term import IRI
from selfconf.protocol.messages import Wire, Wires


class PortEnds:
    """The ends of what one task connects: of components that are no composites, the ports themselves."""

    def __init__(self, ecology: EcologyView, outside: Outside | None) -> None:
        """`outside` is what is outside of the task, if it is the inside of a composite."""
        self._ecology, self._outside = ecology, outside
        self._issuing: dict[IRI, Wires] = {}
        """For each composite that acts for the task, what stands behind its outputs."""
        self._calling: dict[IRI, Mapping[str, tuple[IRI, ...]]] = {}
        """For each composite that acts for the task, which components inside of it call what it needs."""
        self._guessed: set[IRI] = set()
        """The composites that were taken for the ends themselves, as they have not said yet what stands behind them."""

    def moved(self, component: IRI, outputs: Wires, calling: Mapping[str, tuple[IRI, ...]]) -> bool:
        """Note what stands behind a component now; returns whether others were connected otherwise before."""
        issues_otherwise = self._issuing.get(component, {} if component in self._guessed else outputs) != outputs
        calls_otherwise = self._calling.get(component, {}) != calling
        self._issuing[component], self._calling[component] = outputs, calling
        self._guessed.discard(component)
        return issues_otherwise or calls_otherwise

    def unknown(self, connected: Wires, calling: Callers) -> set[IRI]:
        """The composites among those that feed inputs, or call, which have not said yet what stands behind them."""
        calling_composites = {c.component for some in calling.values() for c in some if self.is_composite(c.component)}
        return (self.feeding(connected) | calling_composites) - self._issuing.keys()

    def feeding(self, connected: Wires) -> set[IRI]:
        """The composites among those that feed inputs."""
        return {w.component for some in connected.values() for w in some if self.is_composite(w.component)}

    def is_composite(self, component: IRI) -> bool:
        """Whether a component is a task inside, by its advertisement."""
        found = self._ecology.discovery.found.get(component)
        return found is not None and found.advertisement.profile.inside is not None

    def wires(self, connected: Wires) -> dict[str, tuple[Wire, ...]]:
        """The outputs behind those that feed each input, each with the longest pause that it promises.

        None for an input that follows nothing for now, and will be fed again: a composite is not to do without it, as
        it does without one that is left out.
        """
        fed = {port: some for port, some in connected.items() if not some or not all(map(self._is_unfed, some))}
        return {port: tuple(one for wire in some for one in self._behind(wire)) for port, some in fed.items()}

    def _is_unfed(self, wire: Wire) -> bool:
        """Whether an output is an input of the composite that is left out outside, where this is its inside."""
        outside = self._outside
        return outside is not None and wire.component == outside.composite and wire.output not in outside.received()

    def _behind(self, wire: Wire) -> tuple[Wire, ...]:
        if self._outside is not None and wire.component == self._outside.composite:
            return self._outside.received().get(wire.output, ())
        if wire.component not in self._issuing and self.is_composite(wire.component):
            self._guessed.add(wire.component)
        inside = self._issuing.get(wire.component, {}).get(wire.output)
        return (self._promised(wire),) if inside is None else inside

    def _promised(self, wire: Wire) -> Wire:
        """A wire with the longest pause that the output's advertisement promises."""
        found = self._ecology.discovery.found.get(wire.component)
        output = found.advertisement.profile.output(wire.output) if found else None
        period = 1 / output.rate if output and output.rate else math.inf
        # A rate such as 1e-310 Hz promises nothing that a float can hold: the consumer would be lost by refusing it.
        return Wire(wire.component, wire.output, period) if 0 < period < math.inf else wire

    def callers(self, connected: Callers) -> dict[str, tuple[IRI, ...]]:
        """The components behind those that may call each operation."""
        return {
            name: tuple(dict.fromkeys(c for one in found for c in self._behind_caller(one)))
            for name, found in connected.items()
        }

    def _behind_caller(self, caller: Caller) -> tuple[IRI, ...]:
        if self._outside is not None and caller.component == self._outside.composite:
            return self._outside.calling(caller.operation)
        return self._calling.get(caller.component, {}).get(caller.operation, (caller.component,))

    def issued_outside(self, configuration: Configuration) -> dict[str, tuple[Wire, ...]]:
        """Which outputs stand behind those of the composite of which a configuration is the inside."""
        ends: dict[str, tuple[Wire, ...]] = {}
        for one in configuration.connections:
            if self._outside is not None and one.sink == self._outside.composite:
                ends[one.input] = (*ends.get(one.input, ()), Wire(one.source, one.output))
        return self.wires(ends)

    def calling_outside(self, configuration: Configuration) -> dict[str, tuple[IRI, ...]]:
        """Which components call what the composite needs of which a configuration is the inside."""
        ends: dict[str, tuple[Caller, ...]] = {}
        for one in configuration.connections:
            if self._outside is not None and one.source == self._outside.composite and one.output.endswith(CALL_MARK):
                ends[one.output] = (*ends.get(one.output, ()), Caller(one.sink, one.input))
        return self.callers(ends)

    def stands_outside(self, component: IRI, configuration: Configuration) -> bool:
        """Whether a component issues outputs of the composite of which a configuration is the inside."""
        return any(wire.component == component for some in self.issued_outside(configuration).values() for wire in some)
