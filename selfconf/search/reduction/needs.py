"""Needs, numbered: which inputs are the same to the search, and which of them an output supports.

Two inputs of components that play a role are the same need if they want the same signal and the same links may feed
them; their names matter only where an interaction names one. The type of an output is expanded upward, once for each
output of a role, to the needs that it supports, so that no pair of an output and an input is ever compared.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import chain
from typing import NamedTuple

from selfconf.model.profile import Input, Output
from selfconf.model.term import IRI
from selfconf.search.problem import Problem, Sources


class Need(NamedTuple):
    """A signal that an input of each component that plays `role` must get, if the component has such an input.

    `input` is the name of the first such input, where some interaction into the role names an input.
    """

    role: int
    signal: IRI
    sources: Sources
    input: str | None = None


class Wiring:
    """Numbers the needs of a problem, then says which of them outputs support: a role at a time.

    All inputs have to be numbered before the first output is asked about. Where no interaction names an input of a
    role, its needs are distinguished by their signals alone; so are outputs. With a limit, only that many of the first
    roles count: an input that a later role may feed is no need.
    """

    def __init__(self, problem: Problem, roles: int | None = None) -> None:
        self.problem = problem
        self._roles = len(problem.roles) if roles is None else roles
        self.needs: list[Need] = []
        self._names_inputs = [any(link.input for link in links) for links in problem.links]
        self._fed: list[dict[IRI, list[int]]] = [{} for _ in problem.roles]
        """For each role and signal the needs that any output of the role feeds with it."""
        self._fed_by_name: list[dict[tuple[IRI, str], list[int]]] = [{} for _ in problem.roles]
        """For each role, signal and name of an output the needs that only an output of this name feeds."""

    def needed(self, role: int, inputs: Sequence[tuple[Input, ...]]) -> list[tuple[int, ...]]:
        """Return for the inputs of each class of a role the numbers of the needs that they are."""
        if self._names_inputs[role]:
            number = self._numbered(role, dict.fromkeys(chain.from_iterable(inputs)))
            return [tuple(dict.fromkeys([number[one] for one in some if one in number])) for some in inputs]
        sources, by_signal = self.problem.feeding(role, None), dict[IRI, int]()
        if self._fed_later(sources):
            return [()] * len(inputs)
        found: list[tuple[int, ...]] = []
        for some in inputs:
            numbers: list[int] = []
            for _, signal, _ in some:
                known = by_signal.get(signal)
                if known is None:
                    known = by_signal[signal] = self._new(Need(role, signal, sources))
                numbers.append(known)
            found.append(tuple(numbers) if len(set(numbers)) == len(numbers) else tuple(dict.fromkeys(numbers)))
        return found

    def _new(self, need: Need) -> int:
        """Number a need, and note which outputs feed it."""
        number = len(self.needs)
        self.needs.append(need)
        signal, sources = need.signal, need.sources
        for source, output in sources:
            if output is None:
                self._fed[source].setdefault(signal, []).append(number)
            elif (source, None) not in sources:
                self._fed_by_name[source].setdefault((signal, output), []).append(number)
        return number

    def _fed_later(self, sources: Sources) -> bool:
        return self._roles < len(self.problem.roles) and any(source >= self._roles for source, _ in sources)

    def _numbered(self, role: int, inputs: Iterable[Input]) -> dict[Input, int]:
        """Return the need that each input of a role is: one for all inputs with the same signal and sources."""
        same: dict[tuple[IRI, Sources], int] = {}
        found: dict[Input, int] = {}
        feeding: dict[str, Sources | None] = {}
        for wanted in inputs:
            name, signal = wanted.name, wanted.signal
            if name not in feeding:
                of_name = self.problem.feeding(role, name)
                feeding[name] = None if self._fed_later(of_name) else of_name
            sources = feeding[name]
            if sources is None:
                continue
            number = same.get((signal, sources))
            if number is None:
                number = same[signal, sources] = self._new(Need(role, signal, sources, name))
            found[wanted] = number
        return found

    def supported(self, role: int, outputs: Sequence[tuple[Output, ...]]) -> list[tuple[int, ...]]:
        """Return for the outputs of each class of a role the needs that they support."""
        flat, above = self.problem.hierarchy.flat, self.problem.hierarchy.superclasses
        fed, by_name = self._fed[role], self._fed_by_name[role]
        found: list[tuple[int, ...]] = []
        for some in outputs:
            numbers: list[int] = []
            for name, offered, _ in some:
                for signal in (offered,) if flat else above(offered):
                    numbers += fed.get(signal, ())
                    if by_name:
                        numbers += by_name.get((signal, name), ())
            found.append(tuple(sorted(set(numbers))) if len(numbers) > 1 else tuple(numbers))
        return found
