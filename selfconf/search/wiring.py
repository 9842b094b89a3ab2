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
    """Numbers the needs of a problem and says which of them an output serves.

    Where no interaction names an input of a role, its needs are told by their signals alone; so are outputs.
    """

    def __init__(self, problem: Problem) -> None:
        self.needs: list[Need] = []
        self._fed = [_Feeding(problem, role) for role in range(len(problem.roles))]
        told = {link.source for links in problem.links for link in links if link.output}
        self._serving = [_Serving(problem, role, self._fed, role in told) for role in range(len(problem.roles))]

    def needed(self, role: int, inputs: Sequence[Input]) -> tuple[int, ...]:
        """The numbers of the needs that these inputs of whoever plays a role are."""
        if not inputs:
            return ()
        fed = self._fed[role]
        known, found = fed.number, []
        for wanted in inputs:
            number = known.get(wanted if fed.named else wanted[1])
            found.append(fed.need(wanted, self.needs) if number is None else number)
        return tuple(found) if len(set(found)) == len(found) else tuple(dict.fromkeys(found))

    def served(self, role: int, outputs: Sequence[Output]) -> tuple[int, ...]:
        """The needs that somebody with these outputs serves by playing a role; every need must be known by now."""
        serving = self._serving[role]
        known = serving.known
        found: tuple[int, ...] = ()
        for output in outputs:
            key = output if serving.told else output[1]
            numbers = known.get(key)
            if numbers is None:
                numbers = known[key] = serving.needs(output, self.needs)
            found += numbers
        return found if len(outputs) == 1 else tuple(sorted(set(found)))


class _Feeding:
    """What feeds a role, and its needs so far."""

    __slots__ = ("_by_name", "_problem", "_role", "_same", "by_signal", "named", "number")

    def __init__(self, problem: Problem, role: int) -> None:
        self._problem, self._role = problem, role
        self.named = any(link.input for link in problem.links[role])
        self.number: dict[Input | IRI, int] = {}
        """The need that an input is."""
        self.by_signal: dict[IRI, list[int]] = {}
        self._same: dict[tuple[IRI, Sources], int] = {}
        self._by_name: dict[str | None, Sources] = {}

    def need(self, wanted: Input, needs: list[Need]) -> int:
        """The number of the need that an input is, which may be a new one."""
        name, signal = wanted if self.named else (None, wanted.signal)
        sources = self._by_name.get(name)
        if sources is None:
            sources = self._by_name[name] = self._problem.feeding(self._role, name)
        number = self._same.setdefault((signal, sources), len(needs)) if self.named else len(needs)
        if number == len(needs):
            needs.append(Need(self._role, signal, sources, name))
            self.by_signal.setdefault(signal, []).append(number)
        self.number[wanted if self.named else signal] = number
        return number


class _Serving:
    """The needs that the outputs of a role serve."""

    __slots__ = ("_above", "_fed", "_role", "known", "told")

    def __init__(self, problem: Problem, role: int, fed: Sequence[_Feeding], told: bool) -> None:
        self._role, self._above = role, problem.hierarchy.superclasses
        self._fed = [fed[sink] for sink in problem.sinks[role]]
        self.told = told
        """Whether the names of its outputs may matter."""
        self.known: dict[Output | IRI, tuple[int, ...]] = {}
        """The needs that an output serves."""

    def needs(self, output: Output, needs: Sequence[Need]) -> tuple[int, ...]:
        """The needs that an output serves that was not met before."""
        found: list[int] = []
        for signal in self._above(output.signal):
            for fed in self._fed:
                numbers = fed.by_signal.get(signal)
                if numbers is None:
                    continue
                if self.told or fed.named:
                    names = (self._role, None), (self._role, output.name)
                    numbers = [n for n in numbers if any(source in names for source in needs[n].sources)]
                found += numbers
        return tuple(found if len(found) < 2 else sorted(found))
