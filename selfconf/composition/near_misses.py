"""The near misses of a refusal, the nearest first: also the components that only their ports keep out of a role.

Ports keep a component out where the shape of the role asks for signal types that it lacks, and where it is eligible but
feeds none of the inputs that stay unfed. What its properties lack is found by `rdf.eligibility.nearly_eligible`; how
near it comes, by degree of match and by words, is `model.nearness`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import filterfalse

from selfconf.composition.composer import Composer
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.immutable import replace
from selfconf.model.nearness import ranked
from selfconf.model.obstacle import NoAlternative, UnfitOutput, UnlikePorts, WrongType
from selfconf.model.partition import NearMiss
from selfconf.model.port_likeness import PortLikeness, WantedPorts
from selfconf.model.profile import Condition, Input, Output, Profile
from selfconf.model.refusal import Refusal, TooFewEligible
from selfconf.model.requirement import InputFed
from selfconf.model.signal_likeness import SignalLikeness
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.eligibility import (
    Exclusion,
    exclusions,
    kept_out_by_ports,
    near_misses_by_type,
    ports_asked,
    words_of_role,
)
from selfconf.search.problem import Problem
from selfconf.search.wanted_along import ways_along_interactions

MOST_NEAR = 2_000
"""How many near misses a refusal has for one role at most."""
MOST_COMPARED = 1_000_000
"""How many pairs of ports are compared to find what issues something akin to what is wanted, which takes two seconds:
where inputs of hundreds of roles stay unfed, only the first roles that could feed them have such near misses."""


def ranked_near_misses(
    composer: Composer, ecology: Mapping[IRI, Advertisement], refusal: Refusal, known: Hierarchy
) -> tuple[NearMiss, ...]:
    """The near misses of a refusal, role by role: first probable slips of the type, then by likeness.

    Slips are of a type that is written like the one that is asked for, or related to it. `known` is the hierarchy that
    the ontologies have, whatever the roles see.
    """
    problem = Problem(composer.task.task, composer.partition(ecology), composer.hierarchy)
    signals = SignalLikeness(known)
    short = {reason.role for reason in refusal.reasons if isinstance(reason, TooFewEligible)}
    unfed = [r for reason in refusal.reasons for r in reason.requirements if isinstance(r, InputFed)]
    slips: list[NearMiss] = []
    found: list[NearMiss] = []
    left = MOST_COMPARED
    for number, role in enumerate(problem.roles):
        near = _NearRole(composer, ecology, problem, number, signals)
        misses = [miss for miss in refusal.near_misses if miss.role == role.iri]
        if role.iri in short:
            compiled = composer.partitioner.roles[number]
            by_type = [*near_misses_by_type(compiled, composer.partitioner, composer.gathered(ecology), known)]
            slips += filter(_is_slip, by_type)
            misses += filterfalse(_is_slip, by_type)
        if role.iri in short or not short:
            misses += near.kept_out()
        misses += near.feeding_nothing(unfed, left)
        found += near.ranked(misses)[:MOST_NEAR]
        left -= near.compared
    return (*slips, *found)


def _is_slip(miss: NearMiss) -> bool:
    """Whether a component has a type that was probably meant to be the one that a role asks for."""
    wrong = miss.obstacle.obstacles if isinstance(miss.obstacle, NoAlternative) else (miss.obstacle,)
    return any(isinstance(one, WrongType) and one.relation is not None for one in wrong)


def fault_of(
    composer: Composer,
    ecology: Mapping[IRI, Advertisement],
    component: IRI,
    outputs: Iterable[Output],
    wanted: Condition,
) -> UnfitOutput | None:
    """In what the first of some outputs differs from what an input asks for besides the type; None if one does not."""
    faults = [_fault_of(composer, ecology, component, output, wanted) for output in outputs]
    return None if None in faults else next(iter(faults), None)


def _fault_of(
    composer: Composer, ecology: Mapping[IRI, Advertisement], component: IRI, output: Output, wanted: Condition
) -> UnfitOutput | None:
    """In what an output differs from what an input asks for besides the type; None if in nothing."""
    units = None if output.unit is None or wanted.unit in (None, output.unit) else (output.unit, wanted.unit)
    frames = None if output.frame is None or wanted.frame in (None, output.frame) else (output.frame, wanted.frame)
    unaccepted = None
    if wanted.accepts is not None and wanted.accepts not in output.conforms:
        index = composer.gathered(ecology)
        unaccepted = composer.partitioner.unaccepted(index, component, output.name, wanted.accepts)
    requests = untaken_request(output, wanted)
    if units or frames or unaccepted or requests:
        return UnfitOutput(output.name, units, frames, unaccepted, requests)
    return None


def untaken_request(operation: Output, wanted: Condition) -> tuple[IRI | None, IRI | None] | None:
    """The request that an operation takes and the one that it would be sent, where it does not take that."""
    if wanted.sent is None or wanted.sent.taken_by(operation):
        return None
    return operation.request, wanted.sent.type


class _NearRole:
    """What one role asks for, by its shape or along its interactions, and which components come near to it."""

    def __init__(
        self,
        composer: Composer,
        ecology: Mapping[IRI, Advertisement],
        problem: Problem,
        number: int,
        signals: SignalLikeness,
    ) -> None:
        self._composer, self._ecology, self._problem, self._number = composer, ecology, problem, number
        self._role = problem.roles[number].iri
        self._signals = signals
        self._asked = ports_asked(composer.partitioner, self._role)

    @cached_property  # most roles of a large task are not asked
    def _ways(self) -> list[WantedPorts]:
        return [self._asked] if self._asked else ways_along_interactions(self._problem, self._number)

    @cached_property
    def _ports(self) -> PortLikeness | None:
        return PortLikeness(self._ways, self._signals, self._composer.hierarchy) if self._ways else None

    @property
    def compared(self) -> int:
        """How many pairs of ports have been compared."""
        return self._ports.compared if "_ports" in vars(self) and self._ports else 0

    def kept_out(self) -> Iterator[NearMiss]:
        """The components that only their ports keep out of the role."""
        if self._asked is None or self._ports is None:
            return
        inside = {candidate.profile.component for candidate in self._problem.candidates[self._number]}
        ecology = self._composer.gathered(self._ecology)
        for one in kept_out_by_ports(self._composer.partitioner, self._role, ecology, inside):
            yield NearMiss(self._role, one.profile.component, self._ports.of(one.profile.ports)[1], one.allows)

    def feeding_nothing(self, unfed: Sequence[InputFed], most: int) -> Iterator[NearMiss]:
        """The candidates that feed none of some inputs, but issue what is akin to it, or the same in other units.

        No further ones are looked at once so many pairs of ports have been compared.
        """
        sinks = {self._problem.roles[number].iri for number in self._problem.sinks[self._number]}
        needs = [need for need in unfed if need.role in sinks]
        for candidate in self._problem.candidates[self._number] if needs and most > 0 and self._ports else ():
            if self.compared > most:
                return
            obstacle = self._unfit(candidate.profile, needs) or self._unlike(candidate.profile, needs)
            if obstacle is not None:
                yield NearMiss(self._role, candidate.profile.component, obstacle)

    def _unlike(self, profile: Profile, unfed: Sequence[InputFed]) -> UnlikePorts | None:
        """What the ports of a component lack that issues something akin to what is wanted; None if nothing."""
        if self._ports is None:
            return None
        _, lacking = self._ports.of(profile.ports)
        if not any(match.likeness for match in lacking.issued):
            return None
        issued, given = (
            # Without what is of another type than the wanted one, and serves all the same.
            [match for match in side if match.exact or not self._ports.serves(match)]
            for side in (lacking.issued, lacking.given)
        )
        if all(match.exact for match in (*issued, *given)):
            return None
        return replace(
            lacking, issued=tuple(issued), given=tuple(given), unfit=tuple(_untaken(profile, lacking, unfed))
        )

    def _unfit(self, profile: Profile, unfed: Sequence[InputFed]) -> UnfitOutput | None:
        """What is wrong with the first output that an unfed input would take by its type, where it takes no other."""
        for need in unfed:
            wanted = need.wanted.condition
            if wanted is not None:
                taken = self._taken_by_type(profile, need)
                fault = fault_of(self._composer, self._ecology, profile.component, taken, wanted)
                if fault is not None:
                    return fault
        return None

    def _taken_by_type(self, profile: Profile, need: InputFed) -> Iterator[Output]:
        """Yield the outputs that an interaction leads to an input and that the input would take by its type."""
        problem, plain = self._problem, Input("", need.wanted.signals)
        sink = next(number for number, role in enumerate(problem.roles) if role.iri == need.role)
        links = [link for link in problem.links[sink] if link.source == self._number]
        for output in profile.outputs:
            led = any(link.output in (None, output.name) and link.input in (None, need.input) for link in links)
            if led and problem.hierarchy.pairs(output, plain):
                yield output

    def ranked(self, misses: Iterable[NearMiss]) -> list[NearMiss]:
        """Near misses of the role, the nearest first; of several of one component the last."""
        of = {miss.component: miss for miss in misses}
        if not of:
            return []
        profiles = [self._ecology[component].profile for component in of]
        question = words_of_role(self._composer.task.document, self._role, next(iter(self._ways), None))
        found = [
            replace(of[near.profile.component], likeness=near.likeness)
            for near in ranked(profiles, self._ports, question)
        ]
        return sorted(found, key=lambda miss: isinstance(miss.obstacle, UnfitOutput) and miss.obstacle.hopeless)


def _untaken(profile: Profile, lacking: UnlikePorts, unfed: Sequence[InputFed]) -> Iterator[UnfitOutput]:
    """Yield the operations of a component, akin to those that are needed, that do not take what would be sent."""
    for need in unfed:
        akin = {match.offered for match in lacking.issued if match.wanted in need.wanted.signals}
        nearest = [output for output in profile.outputs if not akin.isdisjoint(output.signals)]
        untaken = [untaken_request(output, need.wanted.condition or Condition()) for output in nearest]
        if untaken and untaken[0] is not None and None not in untaken:
            yield UnfitOutput(nearest[0].name, requests=untaken[0])


def ranked_exclusions(
    composer: Composer, ecology: Mapping[IRI, Advertisement], number: int, known: Hierarchy
) -> tuple[Exclusion, ...]:
    """What keeps components out of a role, by number: those of its class first, then those with few obstacles.

    Where the role asks for signal types, all that its ports keep out of it is one obstacle, and those that have equally
    many come in the order of their likeness.
    """
    partitioner, role = composer.partitioner, composer.partitioner.roles[number]
    inside = {candidate.profile.component for candidate in composer.partition(ecology).candidates[number]}
    found = exclusions(partitioner, role, inside, composer.gathered(ecology))
    asked = ports_asked(partitioner, role.iri)
    if asked is None:
        return tuple(found)
    of = {one.component: one for one in found}
    by_ports = {
        one.profile.component for one in kept_out_by_ports(partitioner, role.iri, composer.gathered(ecology), inside)
    }
    question = words_of_role(composer.task.document, role.iri, asked)
    ports = PortLikeness([asked], SignalLikeness(known), composer.hierarchy)
    nearest = []
    for near in ranked((ecology[component].profile for component in of), ports, question):
        one = replace(of[near.profile.component], likeness=near.likeness)
        if near.lacking is not None and one.component in by_ports:
            one = replace(one, obstacles=(near.lacking,))
        nearest.append(one)
    return tuple(sorted(nearest, key=lambda one: (not one.akin, len(one.obstacles))))
