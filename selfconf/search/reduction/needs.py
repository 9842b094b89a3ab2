"""Needs, numbered: which inputs are the same to the search, and which of them an output supports.

Two inputs of components that play a role are the same need if they want the same signal on the same condition and the
same links may feed them; their names matter only where an interaction names one. An optional input is no need. The
types of an output are expanded upward, once for each output of a role, to the needs that it supports, so that no pair
of an output and an input is ever compared.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple, overload

from selfconf.model.profile import Condition, Input, Output, WantedSignal
from selfconf.model.term import IRI
from selfconf.search.problem import Feeder, Problem, Sources


class NeedScope:
    """What the needs of inputs have in common that the same links may feed, in one role; not changed once made."""

    __slots__ = ("named", "role", "sources")

    def __init__(self, role: int, sources: Sources, named: bool = False) -> None:
        self.role, self.sources = role, sources
        self.named = named
        """Whether some interaction into the role names an input."""


class Need(NamedTuple):
    """A signal that an input of each component in the role of a scope must get, if the component has such an input."""

    scope: NeedScope
    port: Input
    """The first such input."""

    @property
    def role(self) -> int:
        """The role whose components need it."""
        return self.scope.role

    @property
    def sources(self) -> Sources:
        """What may feed it."""
        return self.scope.sources

    @property
    def wanted(self) -> WantedSignal:
        """The signal."""
        return self.port.wanted

    @property
    def input(self) -> str | None:
        """The name of the first such input, where some interaction into the role names an input."""
        return self.port.name if self.scope.named else None


class Needs(Sequence[Need]):
    """Needs by number: the scope and the first input of each, put together when it is asked for."""

    __slots__ = ("ports", "scopes")

    def __init__(self, needs: Iterable[Need] = ()) -> None:
        self.scopes: list[NeedScope] = []
        self.ports: list[Input] = []
        for scope, port in needs:
            self.scopes.append(scope)
            self.ports.append(port)

    def __len__(self) -> int:
        return len(self.ports)

    @overload
    def __getitem__(self, number: int) -> Need: ...

    @overload
    def __getitem__(self, number: slice) -> list[Need]: ...

    def __getitem__(self, number: int | slice) -> Need | list[Need]:
        if isinstance(number, slice):
            return list(map(Need, self.scopes[number], self.ports[number]))
        return Need(self.scopes[number], self.ports[number])


class _Numbering:
    """The numbers of the needs of one scope."""

    __slots__ = ("others", "plain", "scope")

    def __init__(self, scope: NeedScope) -> None:
        self.scope = scope
        self.plain: dict[IRI, int] = {}
        """The numbers of the needs of one signal each, without a condition, by that signal."""
        self.others: dict[tuple[tuple[IRI, ...], Condition | None], int] = {}
        """All others, by signals and condition."""


class Wiring:
    """Numbers the needs of a problem, then says which of them outputs support: a role at a time.

    All inputs have to be numbered before the first output is asked about. Where no interaction names an input of a
    role, its needs are distinguished by their signals and conditions alone; so are outputs. With a limit, only that
    many of the first roles count: an input that a later role may feed is no need.
    """

    def __init__(self, problem: Problem, roles: int | None) -> None:
        self.problem = problem
        self._roles = len(problem.roles) if roles is None else roles
        self.needs = Needs()
        self._conditions: dict[int, Condition] = {}
        """The needs with a condition, each with that."""
        self._feeds: list[list[_Numbering]] = [[] for _ in problem.roles]
        """For each role the needs that any output of the role may feed."""
        self._fed_of: dict[tuple[_Numbering, ...], dict[IRI, tuple[int, ...]]] = {}
        """The needs that signals feed, by that, of roles that may feed the same ones."""
        self._fed_by_name: list[dict[tuple[IRI, str], list[int]]] = [{} for _ in problem.roles]
        """For each role, signal and name of an output the needs that only an output of this name feeds."""
        self._untyped: list[dict[tuple[bool, str], list[int]]] = [{} for _ in problem.roles]
        """For each role the needs that an output of this name feeds without a type, or (True) whatever its type."""

    def needed(self, role: int, inputs: Sequence[tuple[Input, ...]]) -> list[tuple[int, ...]]:
        """Return for the inputs of each class of a role the numbers of the needs that they are."""
        if not any(inputs):
            return [()] * len(inputs)
        by_name = self._numberings(role)
        named, unnamed = len(by_name) > 1, by_name[None]
        spared, scopes, ports = self.problem.spared[role], self.needs.scopes, self.needs.ports
        found: list[tuple[int, ...]] = []
        for some in inputs:
            numbers: list[int] = []
            for port in some:
                name, signals, _, optional, condition = port
                numbering = by_name.get(name, unnamed) if named else unnamed
                if optional or numbering is None or (spared and (signals, condition) in spared):
                    continue
                if condition is None and len(signals) == 1:
                    number = numbering.plain.setdefault(signals[0], len(ports))
                else:
                    number = numbering.others.setdefault((signals, condition), len(ports))
                if number == len(ports):
                    scopes.append(numbering.scope)
                    ports.append(port)
                numbers.append(number)
            found.append(tuple(numbers) if len(set(numbers)) == len(numbers) else tuple(dict.fromkeys(numbers)))
        self._note_particular(role, dict.fromkeys(one for one in by_name.values() if one is not None))
        return found

    def _numberings(self, role: int) -> dict[str | None, _Numbering | None]:
        """Return where inputs are numbered, by their names, and by None: one for all that the same links feed.

        It is None where a role that does not count may feed them: such inputs are no needs.
        """
        by_name = self.problem.feeding_by_name(role)
        alike: dict[Sources, _Numbering | None] = {}
        found: dict[str | None, _Numbering | None] = {}
        for name, sources in by_name.items():
            if sources in alike:
                found[name] = alike[sources]
            else:
                found[name] = alike[sources] = self._numbering(NeedScope(role, sources, len(by_name) > 1))
        return found

    def _numbering(self, scope: NeedScope) -> _Numbering | None:
        if self._roles < len(self.problem.roles) and any(source.role >= self._roles for source in scope.sources):
            return None
        found = _Numbering(scope)
        for source, output, _ in scope.sources:
            if output is None:
                self._feeds[source].append(found)
        return found

    def _note_particular(self, role: int, numberings: Iterable[_Numbering]) -> None:
        """Note the needs of a role that have a condition, and those that are fed by the name of an output."""
        names_outputs = any(link.output for link in self.problem.links[role])
        for numbering in numberings:
            if numbering.others or names_outputs:
                self._note(numbering)

    def _note(self, numbering: _Numbering) -> None:
        """Note which needs have a condition, and which are fed by the name of an output."""
        for (_, condition), number in numbering.others.items():
            if condition is not None:
                self._conditions[number] = condition
        sources = numbering.scope.sources
        for source, output, by_name in sources:
            if output is None:
                continue
            numbers = [*numbering.plain.values(), *numbering.others.values()]
            for number in numbers if by_name else ():
                signals = self.needs.ports[number].signals
                self._untyped[source].setdefault((not signals, output), []).append(number)
            for number in numbers if Feeder(source) not in sources else ():  # else any output of that role feeds it
                for signal in self.needs.ports[number].signals:
                    self._fed_by_name[source].setdefault((signal, output), []).append(number)

    def supported(self, role: int, outputs: Sequence[tuple[Output, ...]]) -> list[tuple[int, ...]]:
        """Return for the outputs of each class of a role the needs that they support."""
        by_signal = not (self._fed_by_name[role] or self._untyped[role] or self._conditions)
        fed = self._fed(role)
        if by_signal and not fed:
            return [()] * len(outputs)
        fits = self._of_signals(outputs, fed) if by_signal else self._of_outputs(role, outputs, fed)
        return [tuple(numbers) if len(numbers) < 2 else _ascending(numbers) for numbers in fits]

    def _fed(self, role: int) -> dict[IRI, tuple[int, ...]]:
        """Return for each signal the needs that any output of a role feeds with it."""
        several = tuple(self._feeds[role])
        known = self._fed_of.get(several)
        if known is not None:
            return known
        gathered: dict[IRI, list[int]] = {}  # a role may feed thousands that all want the same signal
        for numbering in several:
            for signal, number in numbering.plain.items():
                if signal in gathered:
                    gathered[signal].append(number)
                else:
                    gathered[signal] = [number]
            for (signals, _), number in numbering.others.items():
                for signal in signals:
                    gathered.setdefault(signal, []).append(number)
        fed = self._fed_of[several] = {signal: tuple(numbers) for signal, numbers in gathered.items()}
        return fed

    def _of_signals(self, outputs: Sequence[tuple[Output, ...]], fed: Mapping[IRI, tuple[int, ...]]) -> list[list[int]]:
        """Return the needs that the outputs of each class support, where their signals alone decide that."""
        # One loop without a call: an ecology may have a million outputs.
        if self.problem.hierarchy.flat:
            return [
                [need for output in some for signal in output[1] if signal in fed for need in fed[signal]]
                for some in outputs
            ]
        served = self.problem.hierarchy.served
        return [
            [need for output in some for signal in served(output[1]) for need in fed.get(signal, ())]
            for some in outputs
        ]

    def _of_outputs(
        self, role: int, outputs: Sequence[tuple[Output, ...]], fed: Mapping[IRI, tuple[int, ...]]
    ) -> list[list[int]]:
        """Return the needs that the outputs of each class of a role support, by signals, names and conditions."""
        known: dict[tuple[str, tuple[IRI, ...]], list[int]] = {}
        found: list[list[int]] = []
        for some in outputs:
            numbers: list[int] = []
            for output in some:
                port = name, offered = output[:2]
                fits = known.get(port)
                if fits is None:  # many candidates of a role have outputs of the same name and types
                    fits = known[port] = self._fed_by(role, name, offered, fed)
                numbers += self._met(fits, output) if self._conditions else fits
            found.append(numbers)
        return found

    def _fed_by(self, role: int, name: str, offered: tuple[IRI, ...], fed: Mapping[IRI, tuple[int, ...]]) -> list[int]:
        """Return the needs that an output of a role feeds, by its name and its types, whatever their conditions."""
        by_name, untyped = self._fed_by_name[role], self._untyped[role]
        fits: list[int] = []
        for signal in self.problem.hierarchy.served(offered):
            fits += fed.get(signal, ())
            fits += by_name.get((signal, name), ())
        fits += untyped.get((True, name), ())
        fits += () if offered else untyped.get((False, name), ())
        return fits

    def _met(self, needs: Iterable[int], output: Output) -> list[int]:
        """Return those of some needs whose conditions an output meets."""
        conditions = self._conditions
        return [one for one in needs if one not in conditions or conditions[one].met_by(output)]


def _ascending(numbers: list[int]) -> tuple[int, ...]:
    """Return numbers without repetitions, in ascending order."""
    if len(set(numbers)) < len(numbers):
        numbers = list(dict.fromkeys(numbers))
    numbers.sort()  # at once, as they are nearly in order; not if they came out of a set
    return tuple(numbers)
