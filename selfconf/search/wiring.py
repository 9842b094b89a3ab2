"""Needs, numbered: which inputs are one and the same to the search, and which of them an output serves.

Two inputs of whoever plays a role are the same need if they want the same signal and the same links may feed them;
their names matter only where an interaction names one. Output types are expanded upward once for each output and
role, to the needs they serve, so that no pair of an output and an input is ever compared.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from selfconf.model.profile import Input, Output
from selfconf.model.term import IRI
from selfconf.search.problem import Problem

Sources = tuple[tuple[int, str | None], ...]
"""The roles that may feed something, each with the name of the output, if the interaction names one."""


class Need(NamedTuple):
    """A signal that an input of whoever plays `role` must get; `input` only where an interaction names one."""

    role: int
    signal: IRI
    sources: Sources
    input: str | None = None


class Wiring:
    """Numbers the needs of a problem and says which of them an output serves.

    Where no interaction names an input of a role, its needs are told by their signals alone; so are outputs.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.needs: list[Need] = []
        self._fed = [_Feeding(problem, role) for role in range(len(problem.roles))]
        self._told = [any(link.output for sink in sinks for link in problem.links[sink]) for sinks in problem.sinks]
        """For each role whether the names of its outputs may matter."""
        self._tables = [[self._fed[sink] for sink in sinks] for sinks in problem.sinks]
        self._serving: list[dict[Output | IRI, tuple[int, ...]]] = [{} for _ in problem.roles]

    def needed(self, role: int, inputs: Sequence[Input]) -> tuple[int, ...]:
        """The numbers of the needs that these inputs of whoever plays a role are."""
        if not inputs:
            return ()
        fed = self._fed[role]
        known, found = fed.number, []
        for wanted in inputs:
            key = wanted if fed.named else wanted.signal
            number = known.get(key)
            if number is None:
                number = known[key] = self._need(fed, wanted)
            found.append(number)
        return tuple(found if len(found) == 1 else dict.fromkeys(found))

    def _need(self, fed: _Feeding, wanted: Input) -> int:
        name = wanted.name if fed.named else None
        sources = fed.sources(name)
        number = fed.same.setdefault((wanted.signal, sources), len(self.needs)) if fed.named else len(self.needs)
        if number == len(self.needs):
            self.needs.append(Need(fed.role, wanted.signal, sources, name))
            fed.needs.setdefault(wanted.signal, []).append(number)
        return number

    def served(self, role: int, outputs: Sequence[Output]) -> tuple[int, ...]:
        """The needs that somebody with these outputs serves by playing a role; every need must be known by now."""
        known, told = self._serving[role], self._told[role]
        found: tuple[int, ...] = ()
        for output in outputs:
            key = output if told else output.signal
            numbers = known.get(key)
            if numbers is None:
                numbers = known[key] = self._serves(role, output, told)
            found += numbers
        return found if len(outputs) == 1 else tuple(sorted(set(found)))

    def _serves(self, role: int, output: Output, told: bool) -> tuple[int, ...]:
        found: list[int] = []
        for signal in self.problem.hierarchy.superclasses(output.signal):
            for fed in self._tables[role]:
                numbers = fed.needs.get(signal)
                if numbers is None:
                    continue
                if told or fed.named:
                    names = (role, None), (role, output.name)
                    numbers = [n for n in numbers if any(source in names for source in self.needs[n].sources)]
                found += numbers
        return tuple(found if len(found) < 2 else sorted(found))


class _Feeding:
    """What feeds a role, and its needs so far."""

    __slots__ = ("_by_name", "links", "named", "needs", "number", "role", "same")

    def __init__(self, problem: Problem, role: int) -> None:
        self.role, self.links = role, problem.links[role]
        self.named = any(link.input for link in self.links)
        self.number: dict[Input | IRI, int] = {}
        """The need that an input is."""
        self.needs: dict[IRI, list[int]] = {}
        """The needs of a signal."""
        self.same: dict[tuple[IRI, Sources], int] = {}
        self._by_name: dict[str | None, Sources] = {}

    def sources(self, name: str | None) -> Sources:
        """What may feed an input of that name."""
        found = self._by_name.get(name)
        if found is None:
            pairs = [(link.source, link.output) for link in self.links if link.input in (None, name)]
            found = self._by_name[name] = tuple(dict.fromkeys(pairs))
        return found
