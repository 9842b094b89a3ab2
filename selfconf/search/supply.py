"""What an ecology can supply beyond the roles of a task: which components could be recruited.

*Usable* is a least fixpoint. A component is usable if each of its required inputs is fed by an output of a player or of
a usable component; so a chain of suppliers ends at components that need nothing, or at players, and a cycle among
recruits never feeds itself. Forward chaining finds it in time linear in the ports (Dowling and Gallier, 1984).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.partition import Recruit
from selfconf.model.profile import Output, WantedSignal
from selfconf.model.term import IRI

NO_ROLES: frozenset[int] = frozenset()
"""Of what players issue: recruits alone supply the players of a role."""


class Issuers:
    """The recruits that issue outputs among which no input tells a difference, and may supply the same roles."""

    __slots__ = ("members", "output", "roles")

    def __init__(self, output: Output, roles: frozenset[int]) -> None:
        self.output, self.roles = output, roles
        self.members: list[int] = []
        """Their numbers."""


class Issued:
    """What some recruits issue: a hundred thousand of them differ in far fewer outputs than they have."""

    def __init__(self, hierarchy: Hierarchy) -> None:
        self.hierarchy = hierarchy
        self.by_recruit: dict[int, tuple[Issuers, ...]] = {}
        """For each recruit, by number, the groups of issuers that its outputs make it one of."""
        self._known: dict[tuple[Output, frozenset[int]], Issuers] = {}
        self._by_signal: dict[IRI, list[Issuers]] = {}

    def add(self, number: int, outputs: Iterable[Output], roles: frozenset[int] = NO_ROLES) -> None:
        """Note what a recruit, given by its number, issues for the players of some roles and for other recruits."""
        among = tuple([self._known.get((output, roles)) or self._first(output, roles) for output in outputs])
        for issuers in among:
            issuers.members.append(number)
        self.by_recruit[number] = among

    def _first(self, output: Output, roles: frozenset[int]) -> Issuers:
        found = self._known[output, roles] = Issuers(output, roles)
        for signal in self.hierarchy.served(output.signals):
            self._by_signal.setdefault(signal, []).append(found)
        return found

    def serving(self, wanted: WantedSignal, role: int | None = None) -> Iterator[Issuers]:
        """Yield those whose outputs serve an input that wants this, of a player of a role if one is given."""
        signals, condition = wanted
        for issuers in dict.fromkeys(chain.from_iterable(self._by_signal.get(signal, ()) for signal in signals)):
            if (role is None or role in issuers.roles) and (condition is None or condition.met_by(issuers.output)):
                yield issuers

    def serves(self, wanted: WantedSignal, role: int | None = None) -> bool:
        """Return whether some output serves an input that wants this, of a player of a role if one is given."""
        return any(True for _ in self.serving(wanted, role))


class Supply:
    """The components that may be recruited, in the order in which they are preferred."""

    def __init__(self, recruits: Sequence[Recruit], hierarchy: Hierarchy) -> None:
        self.recruits, self.hierarchy = recruits, hierarchy
        self._served: dict[tuple[IRI, ...], tuple[Sequence[IRI], Sequence[IRI]]] = {}
        """For the types of an output, once that is known, the signals that it serves and that inputs wait for.

        First those for which inputs wait that take any output.
        """
        self.required = [recruit.profile.required for recruit in recruits]
        """The inputs of each recruit that must be fed."""
        self._usable: dict[frozenset[Output], list[int]] = {}
        """What was answered: a search asks again beside the players that it chose, which are mostly all candidates."""
        self._outputs: dict[int, tuple[Output, ...]] = {}
        self._alike: dict[Output, Output] = {}
        """One of all outputs among which no input tells a difference."""
        self._waiting: dict[IRI, list[tuple[int, int]]] = {}
        """For each signal the inputs that wait for it: the number of the recruit, and that of the required input."""
        self._asking: dict[IRI, list[tuple[int, int]]] = {}
        """For each signal the inputs that wait for it, but do not take it from every output that issues it."""
        for number, required in enumerate(self.required):
            for place, port in enumerate(required):
                waiting = self._waiting if port.condition is None else self._asking
                for signal in port.signals:
                    waiting.setdefault(signal, []).append((number, place))

    def usable(self, outputs: Iterable[Output]) -> list[int]:
        """Return the numbers of the recruits that are usable beside some outputs, each after those that feed it."""
        outputs = tuple(outputs)
        key = frozenset(outputs)
        if key not in self._usable:
            self._usable[key] = self._forward(outputs)
        return list(self._usable[key])

    def _forward(self, outputs: Iterable[Output]) -> list[int]:
        lacking, met, issued = list(map(len, self.required)), set[tuple[int, int]](), set[IRI]()
        found = [number for number, count in enumerate(lacking) if not count]
        waiting = [*outputs, *(output for number in found for output in self.recruits[number].profile.outputs)]
        while waiting:
            for one in self._fed_by(waiting.pop(), issued):
                if one in met:
                    continue
                met.add(one)
                number, _ = one
                lacking[number] -= 1
                if not lacking[number]:
                    found.append(number)
                    waiting += self.recruits[number].profile.outputs
        return found

    def _fed_by(self, output: Output, issued: set[IRI]) -> Iterator[tuple[int, int]]:
        """Yield the inputs that an output feeds, but for those that take any output; these once for each signal.

        `issued` are the signals for which that has been done, with all that lie above each.
        """
        types = output.signals
        if types not in self._served:
            # In the order of their names, so that the answer does not depend on the order of a set.
            served = sorted(self.hierarchy.served(types))
            self._served[types] = (
                [signal for signal in served if signal in self._waiting],
                [signal for signal in served if signal in self._asking],
            )
        any_output, asking = self._served[types]
        if not issued.issuperset(types):
            for signal in any_output:
                if signal not in issued:
                    issued.add(signal)
                    yield from self._waiting[signal]
            issued.update(types)
        for signal in asking:
            for number, place in self._asking[signal]:
                condition = self.required[number][place].condition
                if condition is None or condition.met_by(output):
                    yield number, place

    def issued(self, numbers: Iterable[int]) -> Issued:
        """Return what some recruits issue."""
        found = Issued(self.hierarchy)
        for number in numbers:
            found.add(number, self.outputs(number), self.recruits[number].roles)
        return found

    def outputs(self, number: int) -> tuple[Output, ...]:
        """Return the outputs of a recruit, each as one object with all among which no input tells a difference."""
        known = self._outputs.get(number)
        if known is None:
            plain = [output._replace(name="", rate=None) for output in self.recruits[number].profile.outputs]
            known = tuple(dict.fromkeys([self._alike.setdefault(output, output) for output in plain]))
            self._outputs[number] = known
        return known
