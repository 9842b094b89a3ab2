"""What a refusal says of recruits: what comes nearest to feeding an input, and whether it would help to recruit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from selfconf.composition.composer import Composer
from selfconf.composition.near_misses import fault_of
from selfconf.model.configuration import Configuration
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.immutable import replace
from selfconf.model.nearness import ranked
from selfconf.model.obstacle import NotFedItself, Obstacle
from selfconf.model.partition import NearMiss, candidate_order
from selfconf.model.port_likeness import PortLikeness, WantedPorts
from selfconf.model.profile import Condition, Input, Profile
from selfconf.model.refusal import InputUnfed, Refusal, Undecided
from selfconf.model.relaxation import LetRecruit
from selfconf.model.requirement import InputFed
from selfconf.model.signal_likeness import SignalLikeness
from selfconf.model.term import IRI
from selfconf.model.text_likeness import words
from selfconf.rdf.advertisements import Advertisement
from selfconf.search.additions import with_optional_slots
from selfconf.search.budget import Budget
from selfconf.search.problem import Problem
from selfconf.search.strategies import possible

RECRUITS_NAMED = 8
"""How many components are named that could nearly be recruited for an input."""
RECRUITING_ROLES = 4
"""Of how many roles it is tried whether they would better recruit."""
RECRUITING_STEPS = 10_000
"""Steps for the question whether there is a solution where a role recruits, a quarter of a second."""
COMPILED_ROLES = 400
"""How many roles are compiled anew to try that, a second: all of the template for each one that would recruit."""


def with_recruit_near_misses(
    composer: Composer, ecology: Mapping[IRI, Advertisement], refusal: Refusal, known: Hierarchy
) -> Refusal:
    """A refusal that names, for each input that a recruit could have fed, the components nearest to it."""
    problem = Problem(composer.task.task, composer.partition(ecology), composer.hierarchy)
    signals = SignalLikeness(known)
    near: list[NearMiss] = []
    reasons = []
    for reason in refusal.reasons:
        if isinstance(reason, InputUnfed) and reason.recruits:
            few = list(_NearInput(composer, ecology, problem, reason).near_misses(signals))[:RECRUITS_NAMED]
            reason = replace(reason, nearest=few[0] if few else None)
            near += few
        reasons.append(reason)
    return replace(refusal, reasons=tuple(reasons), near_misses=(*refusal.near_misses, *near))


class _NearInput:
    """An input that no recruit feeds, and which components come near to being recruited for it."""

    def __init__(
        self, composer: Composer, ecology: Mapping[IRI, Advertisement], problem: Problem, reason: InputUnfed
    ) -> None:
        self._composer, self._ecology, self._problem, self._reason = composer, ecology, problem, reason
        number = next(number for number, role in enumerate(problem.roles) if role.iri == reason.role)
        self._role = number
        self._recruits = [recruit for recruit in problem.supply.recruits if number in recruit.roles]

    def near_misses(self, signals: SignalLikeness) -> Iterator[NearMiss]:
        """Yield the components that could nearly be recruited for it, the nearest first."""
        yield from self._kept_out()
        reason, wanted = self._reason, self._reason.wanted.signals
        profiles = [recruit.profile for recruit in self._recruits if recruit.component != reason.component]
        question = [word for signal in wanted for word in words(signal.short)] + words(reason.input)
        for near in ranked(profiles, PortLikeness([WantedPorts((wanted,))], signals), question):
            if near.lacking is not None and near.lacking.issued[0].likeness:
                obstacle, likeness = self._obstacle(near.profile) or near.lacking, near.likeness
                yield NearMiss(reason.role, near.profile.component, obstacle, likeness=likeness, recruit=True)

    def _kept_out(self) -> Iterator[NearMiss]:
        """Yield the components that issue what it wants, and that the role does not recruit for one thing alone."""
        reason = self._reason
        wanted = Input(reason.input, reason.wanted.signals, condition=reason.wanted.condition)
        passed_over = {recruit.component for recruit in self._recruits}
        passed_over.add(reason.component)  # which is no recruit for itself
        issuing = [
            advertisement
            for advertisement in self._ecology.values()
            if advertisement.component not in passed_over
            and any(self._problem.hierarchy.pairs(output, wanted) for output in advertisement.profile.outputs)
        ]
        index = self._composer.gathered(self._ecology)
        for advertisement in sorted(issuing, key=lambda one: candidate_order(one.profile)):
            faults = self._composer.partitioner.against_supplying(self._role, advertisement, index)
            if len(faults) == 1:
                yield NearMiss(reason.role, advertisement.component, faults[0], likeness=1.0, recruit=True)

    def _obstacle(self, profile: Profile) -> Obstacle | None:
        """Why a component that issues what it wants is not recruited; None where it lacks that, or nothing else."""
        wanted = self._reason.wanted
        plain, condition = Input(self._reason.input, wanted.signals), wanted.condition or Condition()
        matching = [output for output in profile.outputs if self._problem.hierarchy.pairs(output, plain)]
        fault = fault_of(self._composer, self._ecology, profile.component, matching, condition)
        if fault is not None:
            return fault
        unfed = _unfed(self._problem, profile) if matching else None
        return None if unfed is None else _not_fed(self._problem, profile, unfed)


def _not_fed(problem: Problem, profile: Profile, unfed: Input) -> NotFedItself:
    """Why an input of a component is not fed: no component issues what it wants, or none that does is fed itself."""
    way: list[IRI] = [profile.component]
    lacking: Input | None = unfed
    while lacking is not None and way.index(way[-1]) == len(way) - 1:  # it has come to no component twice
        feeder = _feeder(problem, lacking)
        if feeder is None:
            break
        way.append(feeder.component)
        lacking = _unfed(problem, feeder)
    return NotFedItself(unfed.name, unfed.signals, tuple(way[1:]), way[-1] in way[:-1])


def _feeder(problem: Problem, wanting: Input) -> Profile | None:
    """The first component that can be recruited and issues what an input wants."""
    condition = wanting.condition or Condition()
    return next(
        (
            recruit.profile
            for recruit in problem.supply.recruits
            for output in recruit.profile.outputs
            if problem.hierarchy.pairs(output, wanting) and condition.met_by(output)
        ),
        None,
    )


def _unfed(problem: Problem, profile: Profile) -> Input | None:
    """The first input of a component that neither players nor recruits that are fed themselves could feed."""
    outputs = {output for some in problem.candidates for c in some for output in c.profile.outputs}
    issued = problem.supply.issued(problem.supply.usable(outputs))
    issued.add(-1, outputs)  # of players, which have no number as recruits
    return next((port for port in profile.required if not issued.serves(port.wanted)), None)


def with_recruiting_instead(composer: Composer, ecology: Mapping[IRI, Advertisement], refusal: Refusal) -> Refusal:
    """A refusal that first proposes to let a role with unfed inputs recruit, for each of which that alone helps."""
    template = composer.task.template
    unfed = dict.fromkeys(r.role for one in refusal.reasons for r in one.requirements if isinstance(r, InputFed))
    asked = [iri for iri in unfed if not template.role(iri).recruits]
    found: list[LetRecruit] = []
    tried = asked[: max(1, min(RECRUITING_ROLES, COMPILED_ROLES // len(template.roles)))]
    stopped = len(asked) > len(tried)
    for iri in tried:
        roles = tuple(replace(role, recruits=True) if role.iri == iri else role for role in template.roles)
        task = replace(composer.task.task, template=replace(template, roles=roles))
        changed = Composer(replace(composer.task, task=task), composer.hierarchy, steps=composer.steps)
        problem = Problem(task, changed.partition(ecology), changed.hierarchy)
        budget = Budget(RECRUITING_STEPS)
        outcome = (
            changed.compose(ecology, frozenset(), None) if possible(with_optional_slots(problem), budget) else None
        )
        if isinstance(outcome, Configuration):
            found.append(LetRecruit(iri, outcome.recruits))
        elif isinstance(outcome, Undecided) or not budget.steps:
            stopped = True
    return replace(refusal, repairs=(*found, *refusal.repairs), repairs_stopped=refusal.repairs_stopped or stopped)
