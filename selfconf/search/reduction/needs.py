"""Needs, numbered: which inputs are one and the same to the search, and which of them an output serves.

Two inputs of whoever plays a role are the same need if they want the same signal and the same links may feed them;
their names matter only where an interaction names one. Output types are expanded upward, for each output of a role,
to the needs they serve, so that no pair of an output and an input is ever compared.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import chain
from typing import NamedTuple

from selfconf.model.profile import Input, Output
from selfconf.model.term import IRI
from selfconf.search.problem import Problem, Sources


class Need(NamedTuple):
    """A signal that an input of whoever plays `role` must get.

    `input` is the name of the first such input, where some interaction into the role names an input.
    """

    role: int
    signal: IRI
    sources: Sources
    input: str | None = None


class Wiring:
    """Numbers the needs of a problem and says which of them outputs serve: a role at a time, first of all the inputs.

    Where no interaction names an input of a role, its needs are told by their signals alone; so are outputs. Where
    only the first so many roles matter, an input that a later one may feed is no need.
    """

    def __init__(self, problem: Problem, roles: int | None = None) -> None:
        self.problem = problem
        self._roles = len(problem.roles) if roles is None else roles
        self.needs: list[Need] = []
        self._named = [any(link.input for link in links) for links in problem.links]
        self._told = {link.source for links in problem.links for link in links if link.output}
        """The roles of which the names of outputs may matter."""
        self._wanted: list[dict[IRI, list[int]]] = [{} for _ in problem.roles]
        """For each role and signal the needs."""

    def needed(self, role: int, inputs: Sequence[tuple[Input, ...]]) -> list[tuple[int, ...]]:
        """The numbers of the needs that inputs are, for those of each who may play a role."""
        if self._named[role]:
            number = self._numbered(role, dict.fromkeys(chain.from_iterable(inputs)))
            return [tuple(dict.fromkeys([number[one] for one in some if one in number])) for some in inputs]
        sources, wanted, needs = self.problem.feeding(role, None), self._wanted[role], self.needs
        if self._fed_later(sources):
            return [()] * len(inputs)
        found: list[tuple[int, ...]] = []
        for some in inputs:
            numbers: list[int] = []
            for _, signal in some:
                known = wanted.get(signal)
                if known is None:
                    known = wanted[signal] = [len(needs)]
                    needs.append(Need(role, signal, sources))
                numbers += known
            found.append(tuple(numbers) if len(set(numbers)) == len(numbers) else tuple(dict.fromkeys(numbers)))
        return found

    def _fed_later(self, sources: Sources) -> bool:
        return any(source >= self._roles for source, _ in sources)

    def _numbered(self, role: int, inputs: Iterable[Input]) -> dict[Input, int]:
        """The need that each input of a role is: one for all of a signal that the same may feed."""
        same: dict[tuple[IRI, Sources], int] = {}
        found: dict[Input, int] = {}
        for wanted in inputs:
            sources = self.problem.feeding(role, wanted.name)
            if self._fed_later(sources):
                continue
            number = found[wanted] = same.setdefault((wanted.signal, sources), len(self.needs))
            if number == len(self.needs):
                self.needs.append(Need(role, wanted.signal, sources, wanted.name))
                self._wanted[role].setdefault(wanted.signal, []).append(number)
        return found

    def served(self, role: int, outputs: Sequence[tuple[Output, ...]]) -> list[tuple[int, ...]]:
        """The needs that outputs serve, for those of each who may play a role; all inputs must have been told."""
        flat, above = self.problem.hierarchy.flat, self.problem.hierarchy.superclasses
        sinks = [(self._wanted[sink], role in self._told or self._named[sink]) for sink in self.problem.sinks[role]]
        found: list[tuple[int, ...]] = []
        for some in outputs:
            numbers: list[int] = []
            for name, offered, _ in some:
                for signal in (offered,) if flat else above(offered):
                    for wanted, names_matter in sinks:
                        if signal in wanted:
                            needs = wanted[signal]
                            numbers += self._fed(needs, role, name) if names_matter else needs
            found.append(tuple(sorted(set(numbers))) if len(numbers) > 1 else tuple(numbers))
        return found

    def _fed(self, numbers: Sequence[int], role: int, name: str) -> list[int]:
        """Those of some needs that an output of that name may feed."""
        return [n for n in numbers if (role, None) in self.needs[n].sources or (role, name) in self.needs[n].sources]
