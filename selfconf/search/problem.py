"""The configuration problem, and the rules that every strategy shares.

*Given* roles in their order, for each role its candidates in theirs (`model.partition.candidate_order`), and the
interactions between roles; *wanted* as many distinct components per role as it asks for at least, so that every input
of every component is matched by an output of a component that plays a role feeding it (component mutual compatibility
rule, section 2.3 of the paper), unless it is optional, and so that each free parameter has a value that all of the
components admit.

*Slots.* A role that asks for at least k components has k slots, which are the variables of a constraint satisfaction
problem, the candidates being their values; a solution fills every slot. Solutions are compared slot by slot, in the
order of the roles and, within a slot, of the candidates; the answer is the least of them. It is unique, so that no
strategy can change it: it can only take longer.

A least solution is then extended by further candidates (`extension`).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence, Set
from itertools import chain
from operator import and_
from typing import NamedTuple

from selfconf.model.configuration import Assignment, Configuration, Connection, ParameterSetting, ordered_connections
from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.partition import ANY_VALUE, Candidate, Partition, Variable
from selfconf.model.profile import Input, Output, Profile, WantedSignal
from selfconf.model.template import Role, Task
from selfconf.model.term import IRI, Term
from selfconf.search.supply import Supply

Playing = Sequence[Sequence[Candidate]]
"""For each role, in order, the candidates that play it so far."""
Issuing = defaultdict[int, list[Candidate]]
"""By role, candidates that issue a signal; none where a role is not named."""


class Feeder(NamedTuple):
    """A role that may feed an input; `output` is the name of the output, if the interaction names one."""

    role: int
    output: str | None = None
    by_name: bool = False
    """Whether the interaction names both ports, so that ports without a type are paired as well."""


Sources = tuple[Feeder, ...]


class Link(NamedTuple):
    """An interaction seen from its sink: the index of the role that feeds it, and the ports if they are named."""

    source: int
    output: str | None = None
    input: str | None = None


class Problem:
    """A task, its partition and the hierarchy under which signals match; not changed once made."""

    def __init__(self, task: Task, partition: Partition, hierarchy: Hierarchy = NOTHING_ABOVE) -> None:
        self.task, self.partition, self.hierarchy = task, partition, hierarchy
        self.roles: tuple[Role, ...] = task.template.roles
        self.candidates: tuple[tuple[Candidate, ...], ...] = partition.candidates
        self.variables: tuple[Variable, ...] = partition.variables
        index = {role.iri: position for position, role in enumerate(self.roles)}
        feeding: list[list[Link]] = [[] for _ in self.roles]
        fed: list[list[int]] = [[] for _ in self.roles]
        for interaction in task.template.interactions:
            source, sink = index[interaction.source], index[interaction.sink]
            feeding[sink].append(Link(source, interaction.output, interaction.input))
            if sink not in fed[source]:
                fed[source].append(sink)
        self.links: tuple[tuple[Link, ...], ...] = tuple(map(tuple, feeding))
        """For each role, the links by which it is fed."""
        self.sinks: tuple[tuple[int, ...], ...] = tuple(map(tuple, fed))
        """For each role, the roles that it feeds."""
        self.sources: tuple[tuple[int, ...], ...] = tuple(
            tuple(dict.fromkeys(link.source for link in links)) for links in self.links
        )
        """For each role, the roles that feed it."""
        self._feeding: dict[int, dict[str | None, Sources]] = {}
        """For each role that was asked about what may feed its inputs, by name."""
        self._served: dict[int, frozenset[IRI]] = {}
        """For each role that was asked about, the signals that its candidates could serve."""
        self.supply = Supply(partition.recruits, hierarchy)
        self.spared: tuple[Set[WantedSignal], ...] = self._spared()
        """For each role the signals that recruits may supply to its players, so that no role has to."""
        self.open_values: tuple[int, ...] = tuple(self._open(variable) for variable in self.variables)
        """The values that each variable may have before any slot is filled, as a mask.

        A parameter that is also set needs a value of the domain, as does one that lists its values.
        """

    def __repr__(self) -> str:
        """The task and the partition, as a property that fails prints them."""
        return f"Problem({self.task!r}, {self.partition!r})"

    @property
    def unvalued(self) -> tuple[tuple[int, str], ...]:
        """The roles that set something to a parameter that has no value and can get none, with its name.

        No component can play them.
        """
        known = {*self.task.bindings, *(variable.parameter for variable in self.variables)}
        names = {parameter.iri: parameter.name for parameter in self.task.template.parameters}
        return tuple(
            (position, names[setting.value])
            for position, role in enumerate(self.roles)
            for setting in role.settings
            if isinstance(setting.value, IRI) and setting.value in names and setting.value not in known
        )

    @property
    def valueless(self) -> bool:
        """Whether a role that has to be played sets something to a parameter that can get no value."""
        return any(self.roles[position].minimum for position, _ in self.unvalued)

    def _spared(self) -> tuple[Set[WantedSignal], ...]:
        """What recruits could supply if every candidate played: an upper bound of what they can supply in the end."""
        recruiting = [number for number, role in enumerate(self.roles) if role.recruits]
        found: list[Set[WantedSignal]] = [frozenset()] * len(self.roles)
        if recruiting and self.partition.recruits:
            outputs = {output for some in self.candidates for c in some for output in c.profile.outputs}
            issued = self.supply.issued(self.supply.usable(outputs))
            for role in recruiting:
                wanted = {port.wanted for c in self.candidates[role] for port in c.profile.required}
                found[role] = frozenset(signal for signal in wanted if issued.serves(signal, role))
        return tuple(found)

    def _open(self, variable: Variable) -> int:
        is_set = any(p.is_set for p in self.task.template.parameters if p.iri == variable.parameter)
        return (1 << len(variable.domain)) - 1 if is_set or variable.listed else ANY_VALUE

    def served(self, role: int) -> frozenset[IRI]:
        """Return the signals that the candidates of a role could serve."""
        known = self._served.get(role)
        if known is None:
            outputs = (output for candidate in self.candidates[role] for output in candidate.profile.outputs)
            known = self._served[role] = frozenset(
                signal for output in outputs for signal in self.hierarchy.served(output.signals)
            )
        return known

    def feeding(self, role: int, name: str | None) -> Sources:
        """Return what may feed an input of a role, by its name; None stands for one that no interaction names."""
        known = self.feeding_by_name(role)
        return known[name] if name in known else known[None]

    def feeding_by_name(self, role: int) -> Mapping[str | None, Sources]:
        """Return what may feed the inputs of a role by their names, as far as interactions name them, and by None."""
        known = self._feeding.get(role)
        if known is None:
            known = self._feeding[role] = self._named_sources(role)
        return known

    def _named_sources(self, role: int) -> dict[str | None, Sources]:
        links = self.links[role]
        names = [link.input for link in links]
        if not any(names):
            return {None: tuple(dict.fromkeys([Feeder(source, output) for source, output, _ in links]))}
        found: dict[str | None, dict[Feeder, None]] = {name: {} for name in (None, *names)}
        for source, output, wanted in links:
            feeder = Feeder(source, output, output is not None and wanted is not None)
            for some in found.values() if wanted is None else (found[wanted],):
                some[feeder] = None
        return {name: tuple(some) for name, some in found.items()}

    def matches(self, output: Output, link: Link, wanted: Input) -> bool:
        """Return whether an output feeds an input along a link, by the names, where given, and the signal types.

        Where a link names both ports and one of them has no type, the names are enough.
        """
        if link.output not in (None, output.name) or link.input not in (None, wanted.name):
            return False
        if link.output and link.input and not (output.signals and wanted.signals):
            return wanted.condition is None or wanted.condition.met_by(output)
        return self.hierarchy.pairs(output, wanted)

    def feeders(self, role: int, wanted: Input, playing: Playing | Issuing) -> Iterator[tuple[Profile, Output]]:
        """Yield the profiles, with their outputs, that feed an input of a component that plays a role."""
        for link in self.links[role]:
            for candidate in playing[link.source]:
                for output in candidate.profile.outputs:
                    if self.matches(output, link, wanted):
                        yield candidate.profile, output

    def compatible(self, role: int, profile: Profile, playing: Playing, alone: bool = False) -> bool:
        """Return whether each required input of a sink is matched by an output: the mutual compatibility rule.

        Recruits may feed what no role feeds, unless the players have to be enough `alone`.
        """
        lacking: dict[IRI, list[str]] = {}
        spared = frozenset() if alone else self.spared[role]
        for wanted in profile.inputs:
            name, signals, _, optional, condition = wanted
            if optional or (spared and wanted.wanted in spared):
                continue
            if condition is None and len(signals) == 1:
                lacking.setdefault(signals[0], []).append(name)
            elif next(self.feeders(role, wanted, playing), None) is None:
                return False
        return not lacking or self._fed(role, lacking, playing)

    def _fed(self, role: int, lacking: dict[IRI, list[str]], playing: Playing) -> bool:
        """Return whether inputs of one type each, by signal and name, are all fed; those that are get lost."""
        flat, served = self.hierarchy.flat, self.hierarchy.served
        for source, output, only in self.links[role]:
            for candidate in playing[source]:
                for name, offered, *_ in candidate.profile.outputs:
                    if output is not None and output != name:
                        continue
                    if not offered and only and output:
                        offered = tuple(lacking)  # beside an input that is named it feeds this, whatever that wants
                    for signal in offered if flat else served(offered):
                        if signal in lacking:
                            _strike_out(lacking, signal, only)
                if not lacking:
                    return True
        return False

    def narrowed(self, values: tuple[int, ...], candidate: Candidate) -> tuple[int, ...] | None:
        """Return the values left to the variables once a candidate plays too; None if some variable has none left."""
        narrowed = tuple(map(and_, values, candidate.admits))
        return None if 0 in narrowed else narrowed

    def values_of(self, playing: Playing) -> tuple[int, ...]:
        """Return the values that are left to the variables beside all that plays."""
        values = self.open_values
        for candidate in chain.from_iterable(playing):
            values = tuple(v & allowed for v, allowed in zip(values, candidate.admits, strict=True))
        return values

    def configuration(self, playing: Playing, values: tuple[int, ...]) -> Configuration:
        """Return <B, S> for candidates that play the roles: S is every matching pair of ports of an interaction."""
        bindings = self._bindings(values)
        return Configuration(
            template=self.task.template.iri,
            assignments=tuple(
                Assignment(role.iri, tuple(candidate.profile.component for candidate in chosen))
                for role, chosen in zip(self.roles, playing, strict=True)
            ),
            connections=self._connections(playing),
            settings=tuple(self._settings(playing, bindings)),
            bindings=dict(sorted(bindings.items())),
        )

    def _bindings(self, values: tuple[int, ...]) -> dict[str, Term]:
        """Return the values of the parameters by name: those bound, and for each free one the first that is left."""
        bindings = self.task.by_name()
        names = {parameter.iri: parameter.name for parameter in self.task.template.parameters}
        for variable, mask in zip(self.variables, values, strict=True):
            value = variable.first(mask)
            if value is not None:
                bindings[names[variable.parameter]] = value
        return bindings

    def _connections(self, playing: Playing) -> tuple[Connection, ...]:
        issuing = self._issuing(playing)
        none_of_any: Issuing = defaultdict(list)
        connections = {
            Connection(source.component, output.name, candidate.profile.component, wanted.name)
            for position, role in enumerate(playing)
            for candidate in role
            for wanted in candidate.profile.inputs
            for few in (issuing.get(wanted.signals[0], none_of_any) if len(wanted.signals) == 1 else playing,)
            for source, output in self.feeders(position, wanted, few)
        }
        return ordered_connections(connections, (c.profile.component for role in playing for c in role))

    def _issuing(self, playing: Playing) -> dict[IRI, Issuing]:
        """Return for each signal, by role, the candidates that issue it, or have an output without a type."""
        wanted = {signal for role in playing for c in role for port in c.profile.inputs for signal in port.signals}
        found: dict[IRI, Issuing] = defaultdict(lambda: defaultdict(list))
        for position, role in enumerate(playing):
            for candidate in role:
                types = [output.signals for output in candidate.profile.outputs]
                served = chain.from_iterable(map(self.hierarchy.served, types))
                for signal in wanted if () in types else wanted.intersection(served):
                    found[signal][position].append(candidate)
        return found

    def _settings(self, playing: Playing, bindings: Mapping[str, Term]) -> Iterator[ParameterSetting]:
        names = {parameter.iri: parameter.name for parameter in self.task.template.parameters}
        for role, chosen in zip(self.roles, playing, strict=True):
            for setting in role.settings if chosen else ():
                value = setting.value
                if isinstance(value, IRI) and value in names:
                    value = bindings[names[value]]
                for candidate in chosen:
                    for parameter in candidate.profile.parameters:
                        if role.setting_of(parameter, self.hierarchy) is setting:
                            yield ParameterSetting(candidate.profile.component, parameter.name, value)


def _strike_out(lacking: dict[IRI, list[str]], signal: IRI, only: str | None) -> None:
    """Take away the inputs of a signal that are fed: all of them, or the only one that the interaction names."""
    if only is not None and lacking[signal] != [only]:
        lacking[signal] = [other for other in lacking[signal] if other != only]
    else:
        del lacking[signal]
