"""Which components are kept out of a role, and by what: those that nearly fit, and all the others.

A *near miss* is kept out by exactly one thing: one test, or one property shape, or one constraint that pySHACL finds to
be violated, or that it leaves no value for a free parameter. Without that it may play the role.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from operator import attrgetter

from selfconf.model.immutable import immutable, replace
from selfconf.model.obstacle import NoCommonValue, NotJudged, Obstacle, ParameterForbids, ShapeViolated
from selfconf.model.partition import Barred, NearMiss
from selfconf.model.term import IRI, Term, sort_key
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.eligibility.advertisement_index import AdvertisementIndex, TypeSet
from selfconf.rdf.eligibility.judgements import Violations, another_value
from selfconf.rdf.eligibility.partitioner import Advertisements, Partitioner, Tested, TestOutcome
from selfconf.rdf.eligibility.role_tests import CompiledRole, ParameterTest, PropertyTest

JUDGED = 24
"""How many pySHACL judges at most to find near misses of a role: of those that no test keeps out, and of the others."""
_NO_VALUE = IRI("urn:selfconf:no-value")
"""What a role that mentions no free parameter is judged with, once."""
_component = attrgetter("component")


@immutable
class Exclusion:
    """A component that is not eligible for a role, and everything that keeps it out."""

    component: IRI
    obstacles: tuple[Obstacle, ...]
    akin: bool
    """Whether it is of the classes that the role asks for."""
    likeness: float = 0.0
    """How near it comes to what the role asks for, from 0 to 1, by its ports and its texts."""


def exclusions(
    partitioner: Partitioner, role: CompiledRole, inside: Container[IRI], advertisements: Advertisements
) -> list[Exclusion]:
    """What keeps each component out that does not play a role: first those of its class, and those with few obstacles.

    What only pySHACL can judge is reported of the components that pass all tests.
    """
    return _RoleExclusions(partitioner, role, AdvertisementIndex.of(advertisements)).exclusions(inside)


def near_misses(
    partitioner: Partitioner,
    advertisements: Advertisements,
    roles: Container[IRI] | None = None,
    left_out: Container[Barred] = (),
) -> Iterator[NearMiss]:
    """For each role the components of its class that exactly one other thing keeps out, with that obstacle.

    Of some roles only, where those are given, and without what is left out of all; for each role by component.
    """
    ecology = AdvertisementIndex.of(advertisements)
    for role in partitioner.roles:
        if roles is None or role.iri in roles:
            near = nearly(partitioner, role, ecology, partitioner.akin(role, ecology))
            yield from (miss for miss in near if miss.component not in left_out)


def nearly(
    partitioner: Partitioner, role: CompiledRole, ecology: AdvertisementIndex, type_sets: Iterable[TypeSet]
) -> list[NearMiss]:
    """The components of some kinds that exactly one thing keeps out of a role, by component.

    Where the shape says more than the tests, pySHACL has to agree that there is nothing else; it is asked about a few.
    """
    return sorted(_RoleExclusions(partitioner, role, ecology).near_misses(type_sets), key=_component)


@immutable
class _RoleExclusions:
    """What keeps the components of an ecology out of one role."""

    partitioner: Partitioner
    role: CompiledRole
    ecology: AdvertisementIndex

    def exclusions(self, inside: Container[IRI]) -> list[Exclusion]:
        akin = set(self.partitioner.akin(self.role, self.ecology))
        outside = {
            advertisement: (kind in akin, self._told(alike[0], verdict))
            for kind, alike, verdict in self.partitioner.tested(self.role, self.ecology, self.ecology.type_sets)
            for advertisement in alike
            if advertisement.component not in inside
        }
        passed = [advertisement for advertisement, (_, obstacles) in outside.items() if not obstacles]
        if passed and not self.role.complete:
            outside |= {a: (outside[a][0], obstacles) for a, obstacles in self._least(passed).items()}
        return sorted(
            (
                Exclusion(
                    a.component, reasons or (self.partitioner.unjudged(a.profile) or NoCommonValue(),), of_its_class
                )
                for a, (of_its_class, reasons) in outside.items()
            ),
            key=lambda exclusion: (not exclusion.akin, len(exclusion.obstacles), exclusion.component),
        )

    def _told(self, advertisement: Advertisement, verdict: TestOutcome) -> tuple[Obstacle, ...]:
        """All that tests tell against a component, and what the values do that it would leave to free parameters."""
        failed = verdict.obstacles
        if not failed:
            return tuple(self._forbidden(verdict.allows).values())
        if not self.partitioner.free or any(isinstance(one, NotJudged) for one in failed):
            return failed
        allows = self._let_in(advertisement)
        disagreeing = () if all(allows.values()) else (NoCommonValue(),)
        return (*failed, *self._forbidden(allows).values(), *disagreeing)

    def _least(self, passed: Sequence[Advertisement]) -> dict[Advertisement, tuple[Obstacle, ...]]:
        """What pySHACL finds to keep components out, with the value of a free parameter that leaves the least of it.

        Where no value leaves less than the parameter itself, the parameter is named.
        """
        judged = self.partitioner.judge.violations(self.role, passed, self.ecology, {})
        unbound: dict[Advertisement, tuple[Obstacle, ...]] = {a: judged.get(a.component, ()) for a in passed}
        parameter = self.partitioner.judge.mentioned(self.role)
        if parameter is None:
            return unbound
        reasons = self._reasons(parameter, dict.fromkeys(passed, ()))
        by_number = {a: sorted(map(tuple, by_value.values()), key=len) for a, by_value in reasons.items()}
        least = {a: some[0] if some else () for a, some in by_number.items()}
        return {a: unbound[a] if 0 < len(unbound[a]) <= len(some) else some for a, some in least.items()}

    def near_misses(self, type_sets: Iterable[TypeSet]) -> Iterator[NearMiss]:
        few = [
            tested
            for tested in self.partitioner.tested(self.role, self.ecology, type_sets)
            if len(tested[2].obstacles) < 2 and not any(isinstance(one, NotJudged) for one in tested[2].obstacles)
        ]
        return self._by_tests(few) if self.role.complete else self._judged(few)

    def _by_tests(self, few: Iterable[Tested]) -> Iterator[NearMiss]:
        near: list[tuple[Sequence[Advertisement], Obstacle, Mapping[IRI, frozenset[Term]]]] = []
        for _, alike, verdict in few:
            near += [(alike, obstacle, self._let_in(alike[0])) for obstacle in verdict.obstacles]
            forbidden = self._forbidden(verdict.allows)
            if not verdict.obstacles and len(forbidden) == 1:
                rest = {parameter: values for parameter, values in verdict.allows.items() if parameter not in forbidden}
                near += [(alike, obstacle, rest) for obstacle in forbidden.values()]
        suitable = {
            parameter: self.partitioner.suitable.of(
                parameter, frozenset().union(*(a.get(parameter, ()) for *_, a in near))
            )
            for parameter in self.partitioner.free
        }
        for alike, obstacle, allows in near:
            allowed = {parameter: values & suitable[parameter] for parameter, values in allows.items()}
            if all(allowed.values()):
                yield from (NearMiss(self.role.iri, a.component, obstacle, allowed) for a in alike)

    def _judged(self, few: Iterable[Tested]) -> Iterator[NearMiss]:
        """The components that pySHACL finds to be kept out by one thing, for some value of the free parameter."""
        obstacles = {a: verdict.obstacles for _, alike, verdict in few for a in alike}
        focus = _focus(obstacles)
        parameter = self.partitioner.judge.mentioned(self.role)
        settled = {a: {p: v for p, v in self._let_in(a).items() if p != parameter} for a in focus}
        forbidden = {a: self._forbidden(allows) for a, allows in settled.items()}
        told = {a: [*obstacles[a], *forbidden[a].values()] for a in focus}
        for a, by_value in self._reasons(parameter, told).items():
            near = _alone(by_value)
            if near:
                allows = {p: self.partitioner.suitable.of(p, v) for p, v in settled[a].items() if p not in forbidden[a]}
                if parameter is not None and another_value(parameter) not in near:
                    allows[parameter] = frozenset(near)
                if all(allows.values()):
                    yield NearMiss(self.role.iri, a.component, next(iter(near.values())), allows)

    def _reasons(
        self, parameter: IRI | None, told: Mapping[Advertisement, Sequence[Obstacle]]
    ) -> dict[Advertisement, dict[Term, list[Obstacle]]]:
        """All that keeps components out for each value of a free parameter, behind what the tests have told of it."""
        focus = list(told)
        tests = {a: self._failed(a) for a in focus}
        reasons: dict[Advertisement, dict[Term, list[Obstacle]]] = {a: {} for a in focus}
        for value, judged in self._judged_by_value(parameter, focus):
            for a in focus:
                reasons[a][value] = [*told[a], *_besides(judged.get(a.component, ()), tests[a])]
        return reasons

    def _judged_by_value(
        self, parameter: IRI | None, focus: Sequence[Advertisement]
    ) -> Iterable[tuple[Term, Mapping[IRI, Violations]]]:
        """What pySHACL finds for each of some values of a free parameter; without a parameter, once."""
        if parameter is None:
            return [(_NO_VALUE, self.partitioner.judge.violations(self.role, focus, self.ecology, {}))]
        stated = self.partitioner.judge.values_of(parameter, self.role, focus)
        suitable = sorted(self.partitioner.suitable.of(parameter, frozenset(stated)), key=sort_key)[:JUDGED]
        return self.partitioner.judge.by_value(self.role, parameter, suitable, focus, self.ecology)

    def _failed(self, advertisement: Advertisement) -> set[IRI | None]:
        """The property over which a test of the shape has failed, if one has; None stands for the component itself."""
        profile, hierarchy = advertisement.profile, self.partitioner.hierarchy
        return {
            test.path if isinstance(test, PropertyTest) else None
            for test in self.role.tests
            if not isinstance(test, ParameterTest) and test.obstacle(profile, hierarchy) is not None
        }

    def _let_in(self, advertisement: Advertisement) -> dict[IRI, frozenset[Term]]:
        """The values of free parameters that a component would allow, were it let in."""
        profile, hierarchy = advertisement.profile, self.partitioner.hierarchy
        passed = tuple(test for test in self.role.tests if test.obstacle(profile, hierarchy) is None)
        return replace(self.role, tests=passed).allows(profile, hierarchy)

    def _forbidden(self, allows: Mapping[IRI, frozenset[Term]]) -> dict[IRI, ParameterForbids]:
        """The free parameters that may have none of the values that a component wants them to have."""
        return {
            parameter: ParameterForbids(parameter, values)
            for parameter, values in allows.items()
            if values and not self.partitioner.suitable.of(parameter, values)
        }


def _alone(by_value: Mapping[Term, Sequence[Obstacle]]) -> dict[Term, Obstacle]:
    """The one obstacle for each value of a parameter that leaves one; none where a value leaves none, or is unclear."""
    if not all(by_value.values()) or any(isinstance(one, NotJudged) for some in by_value.values() for one in some):
        return {}
    return {value: some[0] for value, some in by_value.items() if len(some) == 1}


def _focus(obstacles: Mapping[Advertisement, Sequence[Obstacle]]) -> list[Advertisement]:
    """The first by name of the advertisements that no test keeps out, and then of the others."""
    by_name = sorted(obstacles, key=_component)
    return [a for a in by_name if not obstacles[a]][:JUDGED] + [a for a in by_name if obstacles[a]][:JUDGED]


def _besides(violated: Iterable[ShapeViolated | NotJudged], failed: set[IRI | None]) -> list[Obstacle]:
    """Violations but the first that a failed test tells already, in its words."""
    violations = list(violated)
    told = next((one for one in violations if isinstance(one, ShapeViolated) and one.path in failed), None)
    return [one for one in violations if one is not told]
