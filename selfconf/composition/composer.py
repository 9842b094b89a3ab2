"""Act 3, composition: from a task and the advertisements, a configuration or a refusal.

Roles are compiled once for a task. The partition is kept as long as the advertisements stay the same, so that after
a failure only the lost components leave it and the search alone runs again.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence, Set
from typing import TYPE_CHECKING

from selfconf.composition.outside import inside_alone, with_outside, with_outside_candidate, with_outside_player
from selfconf.composition.searches import Searches, Strategy
from selfconf.configuration_certificate import broken_conditions
from selfconf.errors import ProgrammerError
from selfconf.model.configuration import Configuration
from selfconf.model.consequence import Consequence
from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.immutable import replace
from selfconf.model.obstacle import NotJudged
from selfconf.model.optimum import Optimum, outcome_of
from selfconf.model.partition import ANY_VALUE, Barred, Candidate, NearMiss, Partition, Variable
from selfconf.model.refusal import Outcome, Refusal, TooFewEligible, ValueUnknown
from selfconf.model.requirement import InputFed, RolePlayed
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.eligibility import AdvertisementIndex, Partitioner, near_misses
from selfconf.rdf.tasks import TaskDocument
from selfconf.search.additions import with_optional_slots
from selfconf.search.budget import Budget
from selfconf.search.problem import Problem
from selfconf.search.reduction import recruits_that_matter
from selfconf.search.relaxations import NEAR, with_relaxations
from selfconf.search.strategies import possible
from selfconf.search.what_if import consequences

if TYPE_CHECKING:
    from selfconf.protocol.messages import Wires

HINT_STEPS = 100_000
"""Steps at most for each search of the question whether other reasoning would do: what is refused need not be easy."""
STANDBY = 2
"""How many candidates per role an input hears of in advance."""


def _matches_more(partition: Partition, hierarchy: Hierarchy) -> bool:
    """Whether under a hierarchy an output of some candidate matches an input of another type."""
    profiles = [candidate.profile for candidates in partition.candidates for candidate in candidates]
    profiles += [recruit.profile for recruit in partition.recruits]
    wanted = {signal for profile in profiles for port in profile.inputs for signal in port.signals}
    offered = {signal for profile in profiles for port in profile.outputs for signal in port.signals}
    return any(not wanted.isdisjoint(hierarchy.superclasses(signal) - {signal}) for signal in offered)


def _admitted(near: NearMiss, variables: Sequence[Variable]) -> tuple[int, ...]:
    """What a near miss would let the variables be; values that no candidate states are bits beyond the domain."""
    masks: list[int] = []
    for variable in variables:
        allowed = near.allows.get(variable.parameter)
        known = sum(1 << bit for bit, value in enumerate(variable.domain) if allowed is None or value in allowed)
        of_its_own = allowed is not None and not allowed <= set(variable.domain)
        masks.append(ANY_VALUE if allowed is None else known | of_its_own << len(variable.domain))
    return tuple(masks)


class Composer:
    """Composes one task, again and again as the ecology changes."""

    def __init__(
        self,
        task: TaskDocument,
        hierarchy: Hierarchy = NOTHING_ABOVE,
        strategy: Strategy = Strategy.FIRST,
        steps: int | None = None,
        outside: IRI | None = None,
    ) -> None:
        """`steps` limits each search; `outside` is the composite of which the task is the inside.

        Where no cost is stated, every answer is `best`: the first is taken.
        """
        if strategy is Strategy.BEST and not task.template.cost:
            strategy = Strategy.FIRST
        self.task, self.hierarchy, self.steps = task, hierarchy, steps
        self.searches = Searches(strategy, steps)
        self.partitioner = Partitioner(task, hierarchy)
        self.outside = outside
        self._unfed: Set[str] = frozenset()
        self._searched = task.task if outside is None else with_outside(task.task, outside)
        """The task as it is searched for: with what is outside, if it is the inside of a composite."""
        self._given: Mapping[IRI, Advertisement] | None = None
        self._ecology = AdvertisementIndex({})
        self._partition = Partition(())

    def leave_unfed(self, inputs: Set[str]) -> None:
        """Compose the inside of a composite, from now on, with some inputs of the composite unfed."""
        if inputs != self._unfed:
            self._unfed, self._given = inputs, None

    def partition(self, ecology: Mapping[IRI, Advertisement]) -> Partition:
        """F1 ... Fn of an ecology."""
        self.gathered(ecology)
        return self._partition

    def gathered(self, ecology: Mapping[IRI, Advertisement]) -> AdvertisementIndex:
        """The ecology by kinds, partitioned; done again only if it has changed, which an `Ecology` never does."""
        if self._given is None or (self._given is not ecology and self._given != ecology):
            self._given = None  # until all is known: it may be ended at any moment, or refuse a shape
            self._ecology = AdvertisementIndex.of(ecology)
            self._partition = self.partitioner.partition(self._ecology)
            if self.outside is not None:
                self._partition = with_outside_candidate(
                    self._partition, self._searched, self.outside, self.hierarchy, self._unfed
                )
            self._given = ecology if self._ecology is ecology else dict(ecology)
        return self._ecology

    def recruitable(self, ecology: Mapping[IRI, Advertisement]) -> set[IRI]:
        """The components that could be recruited for what the candidates of the roles need."""
        problem = self._problem(self.partition(ecology), frozenset(), None)
        return {problem.supply.recruits[number].component for number in recruits_that_matter(problem)}

    def usable(self, components: Set[IRI], refusal: Refusal) -> dict[IRI, tuple[IRI, ...]]:
        """The components, among some that the ecology which was refused last did not have, that may help.

        Each comes with the roles that it may play, in their order: none for one that may only be recruited. A component
        of roles that no reason speaks of leaves each of the reasons as it is.
        """
        roles: dict[IRI, tuple[IRI, ...]] = {}
        components -= {self.outside}  # that plays for its inside, whichever task holds it
        lacking = self._lacking(refusal)
        for role, candidates in zip(self._searched.template.roles, self._partition.candidates, strict=True):
            for candidate in candidates if role.iri in lacking else ():
                if (one := candidate.profile.component) in components:
                    roles[one] = (*roles.get(one, ()), role.iri)
        if any(recruit.component in components for recruit in self._partition.recruits):
            problem = self._problem(self._partition, frozenset(), None)
            for number in recruits_that_matter(problem):
                if (one := problem.supply.recruits[number].component) in components:
                    roles.setdefault(one, ())
        return roles

    def _lacking(self, refusal: Refusal) -> set[IRI]:
        """The roles of which another candidate may help: those of the reasons, and those that feed these."""
        template = self._searched.template
        if not refusal.reasons or any(isinstance(reason, ValueUnknown) for reason in refusal.reasons):
            return {role.iri for role in template.roles}  # any candidate may state a value
        few = {reason.role for reason in refusal.reasons if isinstance(reason, TooFewEligible)}
        fed = {
            requirement.role
            for reason in refusal.reasons
            if not isinstance(reason, TooFewEligible)
            for requirement in reason.requirements
            if isinstance(requirement, RolePlayed | InputFed)
        }
        while more := {one.source for one in template.interactions if one.sink in fed} - fed:
            fed |= more
        return few | fed

    def compose(
        self, ecology: Mapping[IRI, Advertisement], left_out: frozenset[Barred], running: Configuration | None
    ) -> Outcome:
        """The configuration without what is left out, keeping what runs where that can be; or why there is none."""
        *_, answer = self.answers(ecology, left_out, running)
        return outcome_of(answer)

    def answers(
        self,
        ecology: Mapping[IRI, Advertisement],
        left_out: frozenset[Barred],
        running: Configuration | None,
        played: tuple[IRI, IRI] | None = None,
    ) -> Iterator[Optimum | Outcome]:
        """Better and better configurations, with their costs where there are any; or why there is none.

        The last answer so far is the one to keep when the time is up. `played` is a role and the component that alone
        may play it, for a question about an alternative. A configuration is certified before it is handed
        out, by rules that share nothing with the search.
        """
        left_out -= {self.outside}  # the task that holds the composite is the one that its inside is for
        if running is not None and self.outside is not None:
            running = with_outside_player(running, self.outside)
        problem = self._problem(self.partition(ecology), left_out, played)
        misses: dict[frozenset[IRI], tuple[NearMiss, ...]] = {}
        for answer in self.searches.answers(problem, running):
            outcome = outcome_of(answer)
            if isinstance(outcome, Configuration):
                wrong = broken_conditions(self._searched, problem.partition, outcome, self.hierarchy)
                if wrong:
                    raise ProgrammerError(f"the search has made a mistake, please report it: {wrong[0]}")
                yield answer if self.outside is None else inside_alone(outcome, self.outside)
            elif isinstance(outcome, Refusal) and outcome.reasons:
                short = frozenset(reason.role for reason in outcome.reasons if isinstance(reason, TooFewEligible))
                if short not in misses:
                    misses[short] = tuple(
                        near_misses(self.partitioner, self.gathered(ecology), short or None, left_out)
                    )
                yield replace(outcome, near_misses=misses[short])
            else:
                yield outcome

    def _problem(self, partition: Partition, left_out: frozenset[Barred], played: tuple[IRI, IRI] | None) -> Problem:
        """What is to be searched: without what is left out, and with one player for a role where that is asked."""
        partition = partition.without(left_out) if left_out else partition
        if played is not None:
            number = next(n for n, role in enumerate(self._searched.template.roles) if role.iri == played[0])
            partition = partition.with_only(number, played[1])
        return Problem(self._searched, partition, self.hierarchy)

    def possible_under(self, ecology: Mapping[IRI, Advertisement], hierarchy: Hierarchy) -> bool:
        """Whether a configuration is found, where there is none now, if the roles see another hierarchy."""
        here = self.partition(ecology)
        there = self.partitioner.under(hierarchy).partition(self.gathered(ecology))
        if here == there and not _matches_more(here, hierarchy):
            return False
        problem = Problem(self.task.task, there, hierarchy)
        steps = HINT_STEPS if self.steps is None else min(self.steps, HINT_STEPS)
        if not possible(with_optional_slots(problem), Budget(steps)):
            return False
        if not any(role.recruits for role in problem.roles):
            return True
        # That took it that whatever can be recruited is there at once, also what plays a role.
        *_, answer = Searches(Strategy.FIRST, steps).answers(problem)
        return isinstance(answer, Configuration)

    def with_relaxations(self, ecology: Mapping[IRI, Advertisement], refusal: Refusal) -> Refusal:
        """A refusal of the whole ecology with the changes that would make the task possible, each tried."""
        partition = self.partition(ecology)
        eligible = self._by_role(partition)
        outside = (m for m in refusal.near_misses if not m.recruit and (m.role, m.component) not in eligible)
        near = {(m.role, m.component): m for m in itertools.islice(outside, NEAR + 1)}  # the last tells of more
        # Near misses are judged among the candidates: an output has to conform to what an input accepts, theirs or not.
        judged = self.partitioner.judged(self._admitting(near, ecology), self.gathered(ecology))
        candidates = tuple(
            tuple(candidate for candidate in some if (role.iri, candidate.profile.component) in eligible)
            for role, some in zip(self.task.template.roles, judged.candidates, strict=True)
        )
        problem = Problem(self.task.task, replace(judged, candidates=candidates), self.hierarchy)
        found = self._by_role(judged)
        return with_relaxations(problem, refusal, [(near[key], found[key]) for key in near if key in found], self.steps)

    def _by_role(self, partition: Partition) -> dict[tuple[IRI, IRI], Candidate]:
        """The candidates of a partition by role and component."""
        roles = zip(self.task.template.roles, partition.candidates, strict=True)
        return {(role.iri, candidate.profile.component): candidate for role, some in roles for candidate in some}

    def _admitting(self, near: Mapping[tuple[IRI, IRI], NearMiss], ecology: Mapping[IRI, Advertisement]) -> Partition:
        """The partition in which some near misses are the last candidates of their roles."""
        partition = self.partition(ecology)
        more: dict[IRI, list[Candidate]] = {role.iri: [] for role in self.task.template.roles}
        for (role, component), miss in near.items():
            more[role].append(Candidate(ecology[component].profile, _admitted(miss, partition.variables)))
        candidates = ((*some, *new) for some, new in zip(partition.candidates, more.values(), strict=True))
        return replace(partition, candidates=tuple(candidates))

    def not_judged(self) -> Mapping[IRI, NotJudged]:
        """The components of the ecology that play no role, as what they say cannot be judged, or not in time."""
        return self.partitioner.not_judged

    def passed_over(self, configuration: Configuration) -> dict[IRI, list[IRI]]:
        """For each role of a configuration, the eligible components that come before the last one it chose."""
        passed: dict[IRI, list[IRI]] = {}
        # Without the last of the partition, which is what is outside of a composite.
        for assignment, candidates in zip(
            configuration.assignments, self._partition.candidates, strict=self.outside is None
        ):
            order = [candidate.profile.component for candidate in candidates]
            chosen = [order.index(component) for component in assignment.components if component in order]
            passed[assignment.role] = [c for c in order[: max(chosen, default=0)] if c not in assignment.components]
        return passed

    def what_if(
        self, ecology: Mapping[IRI, Advertisement], lost: frozenset[IRI], configuration: Configuration
    ) -> list[Consequence]:
        """For each component of a configuration, what would come instead of it, without the lost, if it failed."""
        problem = self._problem(self.partition(ecology), lost, None)
        return list(consequences(problem, configuration, self.searches.after))

    def standby(self, configuration: Configuration, lost: frozenset[IRI]) -> Mapping[IRI, Wires]:
        """For each component and input of a configuration, the outputs of the next candidates that could feed it.

        At most `STANDBY` candidates for each role that feeds, none of them lost.
        """
        from selfconf.protocol.messages import Wire  # which takes a while to load, and only a task that runs needs it

        problem = Problem(self._searched, self._partition.without(lost), self.hierarchy)
        role_of = {component: each.role for each in configuration.assignments for component in each.components}
        playing = {*role_of, self.outside}
        found: dict[IRI, dict[str, tuple[Wire, ...]]] = {}
        spare = [
            [candidate for candidate in candidates if candidate.profile.component not in playing][:STANDBY]
            for candidates in problem.candidates
        ]
        for position, candidates in enumerate(problem.candidates):
            for candidate in candidates:
                profile = candidate.profile
                if role_of.get(profile.component) != problem.roles[position].iri:
                    continue
                for wanted in profile.inputs:
                    feeders = problem.feeders(position, wanted, spare)
                    wires = tuple(Wire(source.component, output.name) for source, output in feeders)
                    if wires:
                        found.setdefault(profile.component, {})[wanted.name] = wires
        return found
