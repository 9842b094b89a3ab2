"""The partition F1 ... Fn of an ecology by the roles of a task (section 3.2 of the paper).

Every role is compiled once. The classes that it asks for are tested once for each set of types in the ecology, its
other tests once for each *signature*: what a component says of the properties that the role looks at. Where the shape
says more than the tests, pySHACL judges the components that pass them, all in one call.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from copy import copy
from functools import partial
from itertools import chain

from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.immutable import immutable, replace
from selfconf.model.obstacle import NotJudged, Obstacle
from selfconf.model.partition import (
    ANY_VALUE,
    Candidate,
    Mention,
    Partition,
    Recruit,
    Variable,
    candidate_order,
    ordered,
)
from selfconf.model.profile import Profile
from selfconf.model.template import Role
from selfconf.model.term import IRI, Term, sort_key
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.eligibility import free_values
from selfconf.rdf.eligibility.acceptance import Acceptance
from selfconf.rdf.eligibility.advertisement_index import (
    AdvertisementIndex,
    AdvertisementSignature,
    ClassClosure,
    TypeSet,
)
from selfconf.rdf.eligibility.compiled_roles import compile_role, suppliers_of, with_named_suppliers
from selfconf.rdf.eligibility.free_values import (
    conjuncts,
    contradictory,
    lists_components,
    looked_at,
    mentions_of,
    stated_on_paths,
)
from selfconf.rdf.eligibility.judgements import ShapeJudge, another_value
from selfconf.rdf.eligibility.logical_constraints import in_doubt, passable
from selfconf.rdf.eligibility.role_tests import CompiledRole, Count
from selfconf.rdf.eligibility.wanted_signals import required_signals
from selfconf.rdf.tasks import TaskDocument, free_parameters, mentions, substituted
from selfconf.rdf.turtle import Document, Triple
from selfconf.rdf.vocabulary import SC, TYPE

Advertisements = Mapping[IRI, Advertisement] | Iterable[Advertisement]
_NOTHING: Mapping[IRI, frozenset[Term]] = {}


@immutable
class EligibleComponent:
    """A component that is eligible for a role, and for each free parameter it constrains, the values it allows."""

    profile: Profile
    allows: Mapping[IRI, frozenset[Term]]
    forbids: Mapping[IRI, frozenset[Term]]
    """For each free parameter that may be anything else, the values that it may not be."""


@immutable
class TestOutcome:
    """What the tests of a role say of a profile: everything that keeps it out, or the values it allows."""

    obstacles: tuple[Obstacle, ...]
    allows: Mapping[IRI, frozenset[Term]]


Passed = tuple[Advertisement, TestOutcome]
"""A component that passes the tests of a role, with what they say of it."""
Tested = tuple[TypeSet, Sequence[Advertisement], TestOutcome]
"""Some components that are alike, with their kind and what the tests of a role say of them."""


class Partitioner:
    """Partitions ecologies for one task; compile once, use for each new set of advertisements."""

    def __init__(self, given: TaskDocument, hierarchy: Hierarchy = NOTHING_ABOVE) -> None:
        self.task, self.hierarchy = given.task, hierarchy
        self.document = substituted(with_named_suppliers(given.document), given.task.bindings)
        """The template, in the shapes of which only free parameters are left."""
        self.free = free_parameters(given.template, given.task.bindings)
        self._parameters = {parameter.iri: parameter for parameter in given.template.parameters}
        self.roles = tuple(map(self._compiled, given.template.roles))
        self.suppliers = self._compiled_suppliers()
        """For each role that recruits, by number, the tests of what may supply its players."""
        self._above = ClassClosure(hierarchy)
        self.judge = self._judge()
        self._acceptance = Acceptance(hierarchy)
        self.suitable = free_values.Suitable(self._parameters, self.document)

    def _judge(self) -> ShapeJudge:
        """What judges components by pySHACL, by the shapes as they stand in the document."""
        return ShapeJudge(self.document, self.hierarchy, {one: self._parameters[one].name for one in self.free})

    @property
    def not_judged(self) -> dict[IRI, NotJudged]:
        """Of the ecology that was partitioned last: the components that cannot be judged, or not in time, and why."""
        return self.judge.not_judged

    def _compiled(self, role: Role) -> CompiledRole:
        """The tests of a role, by its shape as it stands in the document."""
        settings = tuple(setting.type for setting in role.settings)
        return compile_role(self.document, role.iri, settings, self.free, self.hierarchy)

    def _compiled_suppliers(self) -> Mapping[int, CompiledRole]:
        """The tests of what may supply the players of each role that recruits, by number."""
        roles = enumerate(self.task.template.roles)
        return {n: suppliers_of(self.document, role.iri, self.hierarchy) for n, role in roles if role.recruits}

    def under(self, hierarchy: Hierarchy) -> Partitioner:
        """A partitioner of this task for roles that see another hierarchy."""
        other = copy(self)
        other.hierarchy, other._above = hierarchy, ClassClosure(hierarchy)
        other.roles = tuple(map(other._compiled, self.task.template.roles))
        other.suppliers = other._compiled_suppliers()
        other.judge, other._acceptance = other._judge(), Acceptance(hierarchy)
        return other

    def reading(self, document: Document, role: IRI) -> Partitioner:
        """A partitioner of one role of this task, whose shape stands in another document."""
        other = copy(self)
        other.document = document
        other.roles = (other._compiled(self.task.template.role(role)),)
        other.judge = other._judge()
        return other

    def partition(self, advertisements: Advertisements) -> Partition:
        """F1 ... Fn and the variables that the free parameters are. Raises TemplateError for a shape that is none."""
        ecology = AdvertisementIndex.of(advertisements)
        eligible = self.eligible(ecology)
        variables = tuple(self._variables(eligible))
        bits = [{value: 1 << number for number, value in enumerate(variable.domain)} for variable in variables]

        masks: dict[tuple[int, ...], tuple[int, ...]] = {}

        def admits(found: EligibleComponent) -> tuple[int, ...]:
            allowed = tuple([_mask(found, v.parameter, b) for v, b in zip(variables, bits, strict=True)])
            return masks.setdefault(allowed, allowed)  # shared, so that a search tells by identity which are alike

        found = Partition(
            tuple(ordered([Candidate(one.profile, admits(one)) for one in role]) for role in eligible),
            variables,
            self._recruits(ecology),
            *self._mentions(variables),
        )
        judged = self.judged(found, ecology)
        self.not_judged.update(self._acceptance.not_judged)
        return replace(judged, unissuable=self._acceptance.unissuable(self.task.template, judged, self._looked_at))

    def judged(self, partition: Partition, ecology: AdvertisementIndex) -> Partition:
        """A partition in which ports tell more than their types: what outputs conform to, and what requests are."""
        judged = self._acceptance.judged(self.task.template, partition, partial(self._seen_alone, ecology))
        return judged.with_sent_requests(self.hierarchy)

    def _seen_alone(self, ecology: AdvertisementIndex, component: IRI) -> tuple[Triple, ...]:
        """What the shape that an input accepts sees of the component of an output; of others it sees nothing."""
        return tuple(self.judge.visible_of(ecology[component], ecology))

    def _looked_at(self, number: int) -> frozenset[IRI] | None:
        """The properties of which a role decides who may play it, and the type where it may exclude one."""
        role = self.roles[number]
        found = looked_at(self.document, role.iri)
        excludes = not role.complete or any(isinstance(test, Count) for test in conjuncts(role.tests))
        return found if found is None or excludes else found - {TYPE}

    def unjudged(self, profile: Profile) -> NotJudged | None:
        """Why a component plays no role, although it is eligible: what an input of it accepts cannot be judged."""
        return self._acceptance.unjudged(profile)

    def unaccepted(self, ecology: AdvertisementIndex, component: IRI, output: str, shape: str) -> Obstacle | None:
        """What keeps an output of a component from conforming to the shape that an input accepts."""
        return self._acceptance.obstacle(shape, (component, output), partial(self._seen_alone, ecology))

    def _recruits(self, ecology: AdvertisementIndex) -> tuple[Recruit, ...]:
        """The components that may supply the players of each role that recruits, in the order of preference."""
        roles: dict[IRI, set[int]] = {}
        for number, tests in self.suppliers.items():
            passed = [advertisement for advertisement, _ in self._passed(tests, ecology)]
            outside = {} if tests.complete else self.judge.violations(tests, passed, ecology, {})
            for advertisement in passed:
                if advertisement.component not in outside:
                    roles.setdefault(advertisement.component, set()).add(number)
        profiles = sorted((ecology[component].profile for component in roles), key=candidate_order)
        return tuple(Recruit(profile, frozenset(roles[profile.component])) for profile in profiles)

    def against_supplying(self, number: int, one: Advertisement, ecology: AdvertisementIndex) -> Sequence[Obstacle]:
        """What keeps a component of an ecology from supplying the players of a role that recruits, by its number."""
        tests = self.suppliers[number]
        found = tests.obstacles(one.profile, self.hierarchy)
        if found or tests.complete:
            return found
        return self.judge.violations(tests, [one], ecology, {}).get(one.component, ())

    def akin(self, role: CompiledRole, ecology: AdvertisementIndex) -> Iterator[TypeSet]:
        """The kinds that are of the classes that a role asks for, where these are alternatives of those of one."""
        ways = role.ways_of_classes
        return (
            kind for kind in ecology.type_sets if all(any(way <= self._above[kind] for way in some) for some in ways)
        )

    def tested(self, role: CompiledRole, ecology: AdvertisementIndex, type_sets: Iterable[TypeSet]) -> Iterator[Tested]:
        """What the tests of a role say of the components of some kinds; of those that are alike they say one thing."""
        signature = AdvertisementSignature(role.tests, self.hierarchy)
        for kind in type_sets:
            for alike in ecology.alike(kind, signature):
                profile = alike[0].profile
                obstacles = role.obstacles(profile, self.hierarchy)
                yield kind, alike, TestOutcome(obstacles, {} if obstacles else role.allows(profile, self.hierarchy))

    def eligible(self, ecology: AdvertisementIndex) -> list[list[EligibleComponent]]:
        """For each role the components that conform to it, unordered. Raises TemplateError."""
        self.judge.look_at(ecology)
        found: list[list[EligibleComponent]] = []
        by_value: dict[int, tuple[IRI, list[Passed]]] = {}
        for number, role in enumerate(self.roles):
            passed = self._issuing(role, self._passed(role, ecology))
            parameter = None if role.complete else self.judge.mentioned(role)
            if parameter is not None:
                by_value[number] = parameter, passed
                passed = []
            elif not role.complete:
                outside = self.judge.violations(role, [a for a, _ in passed], ecology, {})
                passed = [(a, outcome) for a, outcome in passed if a.component not in outside]
            found.append([EligibleComponent(a.profile, outcome.allows, _NOTHING) for a, outcome in passed])
        if not self.free:
            return found
        return self._suited(found, by_value, ecology)

    def _passed(self, role: CompiledRole, ecology: AdvertisementIndex) -> list[Passed]:
        """The advertisements that pass all tests of a role, with what the tests say."""
        passed: list[Passed] = []
        for _, alike, outcome in self.tested(role, ecology, self.akin(role, ecology)):
            if not outcome.obstacles:
                passed += [(a, outcome) for a in alike]
            elif isinstance(reason := outcome.obstacles[0], NotJudged):
                self.not_judged.update((a.component, reason) for a in alike)
        return passed

    def _issuing(self, role: CompiledRole, passed: list[Passed]) -> list[Passed]:
        """The advertisements, among some, with ports of the types that the shape asks for, where pySHACL is asked.

        A property that lies below those of ports, or of their types, may lead to further ones: then pySHACL decides.
        """
        undecided = role.complete or self.hierarchy.has_subproperties(SC.signalType)
        asked = () if undecided else required_signals(self.document, role.iri)
        required = [(link, signal) for link, signal in asked if signal not in self.free]
        links = {link for link, _ in required}

        def may_conform(profile: Profile) -> bool:
            if any(not links.isdisjoint(self.hierarchy.superproperties(one)) for one, _ in profile.properties):
                return True
            types = {
                SC.hasInput: [port.signals for port in profile.inputs],
                SC.hasOutput: [port.signals for port in profile.outputs],
            }
            return all(any(signal in self.hierarchy.served(one) for one in types[link]) for link, signal in required)

        return [one for one in passed if may_conform(one[0].profile)] if required else passed

    def _suited(
        self,
        found: list[list[EligibleComponent]],
        by_value: Mapping[int, tuple[IRI, list[Passed]]],
        ecology: AdvertisementIndex,
    ) -> list[list[EligibleComponent]]:
        """The eligible components that leave values to the free parameters, with the values that suit these."""
        stated: dict[IRI, set[Term]] = {parameter: set() for parameter in self.free}
        judged = chain.from_iterable(passed for _, passed in by_value.values())
        for allows in chain((one.allows for one in chain.from_iterable(found)), (tests.allows for _, tests in judged)):
            for parameter, values in allows.items():
                stated[parameter] |= values
        for number, (parameter, passed) in by_value.items():
            role = self.roles[number]
            stated[parameter] |= self.judge.values_of(
                parameter, role, [a for a, _ in passed] if role.local else ecology.values()
            )
        suitable = {parameter: self.suitable.of(parameter, frozenset(values)) for parameter, values in stated.items()}
        for number, (parameter, passed) in by_value.items():
            found[number] = list(
                self._eligible_by_value(self.roles[number], parameter, suitable[parameter], passed, ecology)
            )
        return [[one for one in map(partial(_suited, suitable), some) if all(one.allows.values())] for some in found]

    def _mentions(self, variables: Iterable[Variable]) -> tuple[tuple[tuple[Mention, ...], ...], frozenset[int]]:
        """The free parameters that the shape of each role mentions, and the roles for which none can be added."""
        known = {variable.parameter: variable.domain for variable in variables}
        paths = [stated_on_paths(role.tests, self.hierarchy) for role in self.roles]
        found = tuple(
            mentions_of(sorted(mentions(self.document, role.iri, self.free)), some, known, self.suitable.of)
            for role, some in zip(self.roles, paths, strict=True)
        )
        rows = zip(self.roles, paths, found, strict=True)
        unaddable = frozenset(
            n
            for n, (role, some, one) in enumerate(rows)
            if lists_components(role.tests)
            or in_doubt(role.tests)
            or (not role.complete and self.judge.mentioned(role))  # pySHACL alone can tell what to state for it
            or not passable(role.tests, self.hierarchy)
            or contradictory(some, one)
        )
        return found if self.free else (), unaddable

    def _eligible_by_value(
        self,
        role: CompiledRole,
        parameter: IRI,
        values: frozenset[Term],
        passed: Sequence[Passed],
        ecology: AdvertisementIndex,
    ) -> Iterator[EligibleComponent]:
        """The components that are eligible by a shape that mentions a free parameter where only pySHACL can tell."""
        survivors = [advertisement for advertisement, _ in passed]
        allowed: dict[IRI, set[Term]] = {a.component: set() for a in survivors}
        for value, outside in self.judge.by_value(role, parameter, sorted(values, key=sort_key), survivors, ecology):
            for component in allowed.keys() - outside.keys():
                allowed[component].add(value)
        another = another_value(parameter)
        for advertisement, outcome in passed:
            found = frozenset(allowed[advertisement.component])
            others_allowed = {other: some for other, some in outcome.allows.items() if other != parameter}
            if another not in found:
                yield EligibleComponent(advertisement.profile, {**others_allowed, parameter: found}, _NOTHING)
            else:
                yield EligibleComponent(advertisement.profile, others_allowed, {parameter: values - found})

    def _variables(self, eligible: list[list[EligibleComponent]]) -> Iterator[Variable]:
        for parameter in sorted(self.free):
            listed = self.suitable.of(parameter, frozenset(free_values.enumerated(self.document, parameter)))
            domain = listed.union(*(e.allows.get(parameter, ()) for role in eligible for e in role))
            if domain:
                yield Variable(parameter, tuple(sorted(domain, key=sort_key)), bool(listed))


def _suited(suitable: Mapping[IRI, frozenset[Term]], eligible: EligibleComponent) -> EligibleComponent:
    """With only the values that parameters may have."""
    if all(values <= suitable[parameter] for parameter, values in eligible.allows.items()):
        return eligible
    allows = {parameter: values & suitable[parameter] for parameter, values in eligible.allows.items()}
    return EligibleComponent(eligible.profile, allows, eligible.forbids)


def _mask(eligible: EligibleComponent, parameter: IRI, bits: Mapping[Term, int]) -> int:
    allowed = eligible.allows.get(parameter)
    if allowed is None:
        return ANY_VALUE & ~sum(bits.get(value, 0) for value in eligible.forbids.get(parameter, ()))
    return sum(bits[value] for value in allowed)
