"""Needs, numbered: which inputs are one and the same to the search, and which of them an output serves.

Two inputs of whoever plays a role are the same need if they want the same signal and the same links may feed them;
their names matter only where an interaction names one. Output types are expanded upward once for each output and
role, to the needs they serve, so that no pair of an output and an input is ever compared.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from selfconf.model.profile import Input, Output
from selfconf.model.term import IRI
from selfconf.search.problem import Problem

Sources = tuple[tuple[int, str | None], ...]
"""The roles that may feed something, each with the name of the output, if the interaction names one."""


@dataclass(frozen=True, slots=True)
class Need:
    """A signal that an input of whoever plays `role` must get; `input` only where an interaction names one."""

    role: int
    signal: IRI
    sources: Sources
    input: str | None = None


class Wiring:
    """Numbers the needs of a problem and says which of them an output serves."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.needs: list[Need] = []
        self._named = [any(link.input for link in links) for links in problem.links]
        self._feeding: dict[tuple[int, str | None], int] = {}
        """For each role, and input where inputs are named, the number of what may feed it."""
        self._sources: dict[tuple[int, Sources], int] = {}
        self._names: list[tuple[Sources, dict[int, list[str | None]]]] = []
        self._number: dict[tuple[int, IRI], int] = {}
        self._wanted: dict[tuple[int, IRI], list[tuple[int, dict[int, list[str | None]]]]] = {}
        """For each role and signal the needs, each with the names of outputs that may serve it, by role."""

    def need(self, role: int, wanted: Input) -> int:
        """The number of the need that an input is."""
        name = wanted.name if self._named[role] else None
        feeding = self._feeding.get((role, name))
        if feeding is None:
            feeding = self._feeding[role, name] = self._fed_by(role, name)
        number = self._number.get((feeding, wanted.signal))
        if number is None:
            number = self._number[feeding, wanted.signal] = len(self.needs)
            sources, names = self._names[feeding]
            self.needs.append(Need(role, wanted.signal, sources, name))
            self._wanted.setdefault((role, wanted.signal), []).append((number, names))
        return number

    def _fed_by(self, role: int, name: str | None) -> int:
        links = [link for link in self.problem.links[role] if link.input in (None, name)]
        sources = tuple(dict.fromkeys((link.source, link.output) for link in links))
        feeding = self._sources.setdefault((role, sources), len(self._names))
        if feeding == len(self._names):
            names: dict[int, list[str | None]] = {}
            for source, output in sources:
                names.setdefault(source, []).append(output)
            self._names.append((sources, names))
        return feeding

    def served(self, role: int, outputs: Sequence[Output]) -> tuple[int, ...]:
        """The needs that somebody with these outputs serves by playing a role; every need must be known by now."""
        found: set[int] = set()
        for output in outputs:
            for signal in self.problem.hierarchy.superclasses(output.signal):
                for sink in self.problem.sinks[role]:
                    for number, names in self._wanted.get((sink, signal), ()):
                        some = names.get(role, ())
                        if None in some or output.name in some:
                            found.add(number)
        return tuple(sorted(found))
