"""Needs, numbered: which inputs are the same to the search, and which of them an output supports.

Two inputs of components that play a role are the same need if they want the same signal on the same condition and the
same links may feed them; their names matter only where an interaction names one. An optional input is no need. The
types of an output are expanded upward, once for each output of a role, to the needs that it supports, so that no pair
of an output and an input is ever compared.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import chain
from typing import NamedTuple

from selfconf.model.profile import Condition, Input, Output, WantedSignal
from selfconf.model.term import IRI
from selfconf.search.problem import Problem, Sources


class Need(NamedTuple):
    """A signal that an input of each component that plays `role` must get, if the component has such an input.

    `input` is the name of the first such input, where some interaction into the role names an input.
    """

    role: int
    wanted: WantedSignal
    sources: Sources
    input: str | None = None


class Wiring:
    """Numbers the needs of a problem, then says which of them outputs support: a role at a time.

    All inputs have to be numbered before the first output is asked about. Where no interaction names an input of a
    role, its needs are distinguished by their signals and conditions alone; so are outputs. With a limit, only that
    many of the first roles count: an input that a later role may feed is no need.
    """

    def __init__(self, problem: Problem, roles: int | None = None) -> None:
        self.problem = problem
        self._roles = len(problem.roles) if roles is None else roles
        self.needs: list[Need] = []
        self._conditions: dict[int, Condition] = {}
        """The needs with a condition, each with that."""
        self._names_inputs = [any(link.input for link in links) for links in problem.links]
        self._fed: list[dict[IRI, list[int]]] = [{} for _ in problem.roles]
        """For each role and signal the needs that any output of the role feeds with it."""
        self._fed_by_name: list[dict[tuple[IRI, str], list[int]]] = [{} for _ in problem.roles]
        """For each role, signal and name of an output the needs that only an output of this name feeds."""
        self._untyped: list[dict[tuple[bool, str], list[int]]] = [{} for _ in problem.roles]
        """For each role the needs that an output of this name feeds without a type, or (True) whatever its type."""

    def needed(self, role: int, inputs: Sequence[tuple[Input, ...]]) -> list[tuple[int, ...]]:
        """Return for the inputs of each class of a role the numbers of the needs that they are."""
        if self._names_inputs[role]:
            numbered = self._numbered(role, dict.fromkeys(chain.from_iterable(inputs)))
            return [tuple(dict.fromkeys([numbered[one] for one in some if one in numbered])) for some in inputs]
        sources, known = self.problem.feeding(role, None), dict[tuple[tuple[IRI, ...], Condition | None], int]()
        spared = self.problem.spared[role]
        if self._fed_later(sources):
            return [()] * len(inputs)
        found: list[tuple[int, ...]] = []
        for some in inputs:
            numbers: list[int] = []
            for _, signals, _, optional, condition in some:
                if optional:
                    continue
                wanted = signals, condition
                if spared and wanted in spared:
                    continue
                number = known.get(wanted)
                if number is None:
                    number = known[wanted] = self._new(Need(role, WantedSignal(*wanted), sources))
                numbers.append(number)
            found.append(tuple(numbers) if len(set(numbers)) == len(numbers) else tuple(dict.fromkeys(numbers)))
        return found

    def _new(self, need: Need) -> int:
        """Number a need, and note which outputs feed it."""
        number = len(self.needs)
        self.needs.append(need)
        signals, condition = need.wanted
        if condition is not None:
            self._conditions[number] = condition
        any_output = {source for source, output, _ in need.sources if output is None}
        for source, output, by_name in need.sources:
            if output is not None and by_name:
                self._untyped[source].setdefault((not signals, output), []).append(number)
            for signal in signals:
                if output is None:
                    self._fed[source].setdefault(signal, []).append(number)
                elif source not in any_output:
                    self._fed_by_name[source].setdefault((signal, output), []).append(number)
        return number

    def _fed_later(self, sources: Sources) -> bool:
        return self._roles < len(self.problem.roles) and any(source.role >= self._roles for source in sources)

    def _numbered(self, role: int, inputs: Iterable[Input]) -> dict[Input, int]:
        """Return the need that each required input of a role is: one for all that only differ in their names."""
        same: dict[tuple[WantedSignal, Sources], int] = {}
        found: dict[Input, int] = {}
        feeding: dict[str, Sources | None] = {}
        for wanted in inputs:
            name, signals, _, optional, condition = wanted
            if optional:
                continue
            if name not in feeding:
                of_name = self.problem.feeding(role, name)
                feeding[name] = None if self._fed_later(of_name) else of_name
            sources = feeding[name]
            if sources is None:
                continue
            signal = WantedSignal(signals, condition)
            if signal in self.problem.spared[role]:
                continue
            number = same.get((signal, sources))
            if number is None:
                number = same[signal, sources] = self._new(Need(role, signal, sources, name))
            found[wanted] = number
        return found

    def supported(self, role: int, outputs: Sequence[tuple[Output, ...]]) -> list[tuple[int, ...]]:
        """Return for the outputs of each class of a role the needs that they support."""
        served = self.problem.hierarchy.served
        fed, by_name, untyped = self._fed[role], self._fed_by_name[role], self._untyped[role]
        found: list[tuple[int, ...]] = []
        for some in outputs:
            numbers: list[int] = []
            for output in some:
                name, offered = output[:2]
                fits: list[int] = []
                for signal in served(offered):
                    fits += fed.get(signal, ())
                    if by_name:
                        fits += by_name.get((signal, name), ())
                if untyped:
                    fits += untyped.get((True, name), ())
                    fits += () if offered else untyped.get((False, name), ())
                numbers += self._met(fits, output) if self._conditions else fits
            found.append(tuple(sorted(set(numbers))) if len(numbers) > 1 else tuple(numbers))
        return found

    def _met(self, needs: Iterable[int], output: Output) -> list[int]:
        """Return those of some needs whose conditions an output meets."""
        conditions = self._conditions
        return [one for one in needs if one not in conditions or conditions[one].met_by(output)]
