"""Needs, numbered: which inputs are the same to the search, and which of them an output supports.

Two inputs of components that play a role are the same need if they want the same signal on the same condition and the
same links may feed them; their names matter only where an interaction names one. An optional input is no need. The
types of an output are expanded upward, once for each output of a role, to the needs that it supports, so that no pair
of an output and an input is ever compared.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from selfconf.model.profile import Condition, Input, Output, WantedSignal
from selfconf.model.term import IRI
from selfconf.search.problem import Feeder, Problem, Sources

_Numbers = dict[tuple[tuple[IRI, ...], Condition | None], int]
"""The numbers of needs by signals and condition."""


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
        named, spared = self._names_inputs[role], self.problem.spared[role]
        fed_alike: dict[Sources, _Numbers] = {}
        by_name: dict[str | None, tuple[Sources, _Numbers | None]] = {}
        found: list[tuple[int, ...]] = []
        for some in inputs:
            numbers: list[int] = []
            for name, signals, _, optional, condition in some:
                if optional:
                    continue
                called = name if named else None
                if called not in by_name:
                    sources = self.problem.feeding(role, called)
                    later = self._fed_later(sources)
                    by_name[called] = sources, None if later else fed_alike.setdefault(sources, {})
                sources, known = by_name[called]
                wanted = signals, condition
                if known is None or (spared and wanted in spared):
                    continue
                number = known.get(wanted)
                if number is None:
                    number = known[wanted] = self._new(Need(role, WantedSignal(*wanted), sources, called))
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
        for source, output, by_name in need.sources:
            if output is None:
                fed = self._fed[source]
                for signal in signals:
                    fed.setdefault(signal, []).append(number)
                continue
            if by_name:
                self._untyped[source].setdefault((not signals, output), []).append(number)
            if Feeder(source) not in need.sources:  # any output of that role feeds it
                for signal in signals:
                    self._fed_by_name[source].setdefault((signal, output), []).append(number)
        return number

    def _fed_later(self, sources: Sources) -> bool:
        return self._roles < len(self.problem.roles) and any(source.role >= self._roles for source in sources)

    def supported(self, role: int, outputs: Sequence[tuple[Output, ...]]) -> list[tuple[int, ...]]:
        """Return for the outputs of each class of a role the needs that they support."""
        by_signal = not (self._fed_by_name[role] or self._untyped[role] or self._conditions)
        fits = self._of_signals if by_signal else self._of_outputs
        found = (fits(role, some) for some in outputs)
        return [tuple(sorted(set(numbers))) if len(numbers) > 1 else tuple(numbers) for numbers in found]

    def _of_signals(self, role: int, outputs: tuple[Output, ...]) -> list[int]:
        """Return the needs that outputs support, where their signals alone decide that."""
        fed, hierarchy = self._fed[role], self.problem.hierarchy
        # One loop without a call: an ecology may have a million outputs.
        if hierarchy.flat:
            return [need for output in outputs for signal in output[1] for need in fed.get(signal, ())]
        served = hierarchy.served
        return [need for output in outputs for signal in served(output[1]) for need in fed.get(signal, ())]

    def _of_outputs(self, role: int, outputs: tuple[Output, ...]) -> list[int]:
        """Return the needs that outputs support, by their signals, their names and what conditions ask of them."""
        served = self.problem.hierarchy.served
        fed, by_name, untyped = self._fed[role], self._fed_by_name[role], self._untyped[role]
        numbers: list[int] = []
        for output in outputs:
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
        return numbers

    def _met(self, needs: Iterable[int], output: Output) -> list[int]:
        """Return those of some needs whose conditions an output meets."""
        conditions = self._conditions
        return [one for one in needs if one not in conditions or conditions[one].met_by(output)]
