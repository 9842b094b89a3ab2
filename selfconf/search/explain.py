"""Why there is no configuration: reasons in the terms of the template, with how far each is proved.

Roles that contradict themselves or have too few candidates are reasons by themselves, and reason enough. Otherwise the
reason is an irreducible set of constraints that cannot hold together (`cores`), or, where arc consistency has found
that out, the derivation of it: the input that nothing feeds first, and then what follows from it. A refusal says
whether its reason is proved to be irreducible, and to be the smallest.

Where nothing feeds a role because an interaction names a port that no candidate has, the refusal names the port that
was probably meant: the name of an operation is mostly written without its `()`, or with a slip.
"""

from __future__ import annotations

import difflib
from collections import Counter, defaultdict
from collections.abc import Hashable, Iterable, Iterator, Sequence

from selfconf.model import requirement as model
from selfconf.model.profile import CALL_MARK, Input
from selfconf.model.refusal import (
    Conflict,
    Contradiction,
    DerivationStep,
    InputUnfed,
    MisnamedPort,
    Reason,
    Refusal,
    TooFewDistinct,
    TooFewEligible,
    ValueUnknown,
)
from selfconf.model.term import IRI
from selfconf.search.budget import Budget
from selfconf.search.cores import FeasibilityOracle, core, smallest_of
from selfconf.search.engines import hall_set
from selfconf.search.problem import Issuing, Problem
from selfconf.search.reduction import (
    Constraint,
    Distinct,
    Fed,
    InterchangeabilityClass,
    LazyReduction,
    Need,
    Played,
    ReducedProblem,
    Shared,
    signature,
    subproblem,
)

EXPLANATION_STEPS = 50_000
"""Steps spent at most on making reasons irreducible, a second or two; a question costs one for each option at least."""


def refusal(given: LazyReduction, steps: int = EXPLANATION_STEPS) -> Refusal:
    """Return the refusal of a problem that has no solution."""
    problem = given.problem
    template = problem.task.template.iri
    unary = tuple(_reasons_of_single_roles(problem))
    if unary:
        return Refusal(template, unary)
    oracle = FeasibilityOracle(given.reduced, Budget(steps))
    found, smallest = core(oracle), False
    if oracle.complete:
        found, smallest = smallest_of(oracle, found)
    reason = _Wording(problem, given.reduced, found).reason()
    # What recruits could supply is no constraint here: a smaller set may have some of it, unless it were of one.
    smallest = smallest and (len(found) <= 2 or not any(problem.spared))
    return Refusal(template, (reason,), irreducible=oracle.complete, smallest=smallest)


def _reasons_of_single_roles(problem: Problem) -> Iterator[Reason]:
    for role, candidates in zip(problem.roles, problem.candidates, strict=True):
        if role.maximum is not None and role.maximum < role.minimum:
            yield Contradiction(role.iri, role.minimum, role.maximum)
        elif len(candidates) < role.minimum:
            yield TooFewEligible(role.iri, role.minimum, len(candidates))
    for position, parameter in problem.unvalued:
        if problem.roles[position].minimum:
            yield ValueUnknown(problem.roles[position].iri, parameter)


class _Wording:
    """Puts constraints that cannot hold together into the terms of the template."""

    def __init__(self, problem: Problem, given: ReducedProblem, found: Sequence[Constraint]) -> None:
        self.problem, self.given, self.found = problem, given, found
        self.played = [one.role for one in found if isinstance(one, Played)]
        self.roles = tuple(problem.roles[role].iri for role in self.played)
        self.requirements = tuple(map(self._requirement, found))
        self._alike: dict[int, Counter[Hashable]] = {}
        """How many candidates of a role have each signature, for the roles that were asked about."""

    def reason(self) -> Reason:
        """Return the reason by its kind: too few components, an input that is not fed, or else a conflict."""
        fed, shared = (any(isinstance(one, kind) for one in self.found) for kind in (Fed, Shared))
        distinct = Distinct() in self.found
        if distinct and not fed and not shared:
            return self._too_few_distinct()
        steps = self._derivation_steps() if fed and not shared and not distinct else ()
        if not steps:
            parameters = tuple(one.parameter for one in self.requirements if isinstance(one, model.OneValue))
            roles = self.roles or tuple(role.iri for role in self.problem.roles)
            return Conflict(roles, parameters, self.requirements)
        cause, *consequences = steps
        return InputUnfed(
            cause.role,
            cause.component,
            cause.input,
            cause.wanted,
            cause.sources,
            self.requirements,
            tuple(consequences),
            cause.optional,
            cause.recruits,
            misnamed=misnamed_port(self.problem, cause.role, cause.input),
        )

    def _too_few_distinct(self) -> TooFewDistinct:
        # Counted among all candidates, of which the reduced problem has only those that can matter.
        lack = hall_set(
            [role for role in self.given.slots if role in self.played],
            [[c.profile.component for c in candidates] for candidates in self.problem.candidates],
        )
        among_options = {o.component for role in self.played for o in self.given.options[role]}
        wanted = sum(self.problem.roles[role].minimum for role in self.played)
        return TooFewDistinct(self.roles, wanted, len(among_options) if lack is None else lack.found)

    def _derivation_steps(self) -> Sequence[DerivationStep]:
        """Return the derivation with these constraints alone, if arc consistency makes one from needs alone."""
        part = subproblem(self.given, set(self.found))
        if part.wiped_out() is None or any(removal.need is None for removal in part.removals):
            return ()
        removed: dict[tuple[int, int], list[InterchangeabilityClass]] = {}
        for removal in part.removals:
            removed.setdefault((removal.kind.role, removal.need or 0), []).append(removal.kind)
        return [self._step(role, need, kinds) for (role, need), kinds in removed.items()]

    def _step(self, role: int, number: int, kinds: Sequence[InterchangeabilityClass]) -> DerivationStep:
        """Return the step by which classes of a role are removed, as a need of theirs has no support."""
        problem, need = self.problem, self.given.needs[number]
        profile = problem.candidates[role][min(kind.number for kind in kinds)].profile
        unfed = next(
            port
            for port in profile.inputs
            if not port.optional and port.wanted == need.wanted and problem.feeding(role, port.name) == need.sources
        )
        feeding = _feeding(need)
        sources = tuple(problem.roles[source].iri for source in feeding)
        optional = tuple(problem.roles[source].iri for source in feeding if self._could_feed(source, role, unfed))
        if role not in self._alike:
            self._alike[role] = Counter(map(signature, problem.candidates[role]))
        alike = self._alike[role]
        others = sum(alike[one] for one in {one for kind in kinds for one in kind.signatures}) - 1
        asked = problem.roles[role]
        return DerivationStep(
            asked.iri, profile.component, others, unfed.name, need.wanted, sources, optional, asked.recruits
        )

    def _could_feed(self, source: int, role: int, unfed: Input) -> bool:
        """Return whether a role that asks for no component has a candidate that would feed an input of another role."""
        candidates = self.problem.candidates[source] if self.problem.roles[source].minimum == 0 else ()
        alone: Issuing = defaultdict(list, {source: list(candidates)})
        return next(self.problem.feeders(role, unfed, alone), None) is not None

    def _requirement(self, constraint: Constraint) -> model.Requirement:
        """Return a constraint in the words of the template."""
        problem = self.problem
        if isinstance(constraint, Played):
            return model.RolePlayed(problem.roles[constraint.role].iri)
        if isinstance(constraint, Fed):
            need = self.given.needs[constraint.need]
            return model.InputFed(problem.roles[need.role].iri, need.wanted, need.input)
        if isinstance(constraint, Shared):
            names = {parameter.iri: parameter.name for parameter in problem.task.template.parameters}
            return model.OneValue(names[problem.variables[constraint.variable].parameter])
        return model.OneRoleEach()


def _feeding(need: Need) -> Iterable[int]:
    """Return the roles that may feed a need: a port without a type only by an interaction that names both ports."""
    return dict.fromkeys(source.role for source in need.sources if source.by_name or need.wanted.signals)


LIKE_A_SLIP = 0.7
"""How alike two names have to be for one to be a slip of the other; 1 is equal."""


def misnamed_port(problem: Problem, sink: IRI, unfed: str) -> MisnamedPort | None:
    """Return a port that no candidate has, of the interactions that feed a role, of which an input stays unfed.

    It is the first one that has a name like that of a port, or else the first one on the way to the input.
    """
    found = list(_misnamed(problem, sink, unfed))
    return next((port for port in found if port.meant is not None), next(iter(found), None))


def _misnamed(problem: Problem, sink: IRI, unfed: str) -> Iterator[MisnamedPort]:
    """Yield the ports that no candidate has: any with a name like that of a port, and others on the way to an input."""
    candidates = {role.iri: some for role, some in zip(problem.roles, problem.candidates, strict=True)}
    inputs = sorted({port.name for one in candidates[sink] for port in one.profile.inputs})
    for interaction in problem.task.template.interactions:
        if interaction.sink != sink:
            continue
        giving = candidates[interaction.source]
        outputs = sorted({port.name for one in giving for port in one.profile.outputs})
        on_the_way = bool(giving) and (interaction.input == unfed or interaction.input not in inputs)
        sides = (interaction.source, "output", interaction.output, outputs), (sink, "input", interaction.input, inputs)
        for role, kind, named, known in sides:
            if named is not None and named not in known:
                meant = _meant(named, known)
                if meant is not None or on_the_way:
                    yield MisnamedPort(role, kind, named, meant, tuple(known))


def _meant(named: str, known: Iterable[str]) -> str | None:
    """Return the known name that is most like another one: but for the mark of an operation, or by its letters."""
    names = sorted(known)
    plain = named.removesuffix(CALL_MARK)
    same = [name for name in names if name.removesuffix(CALL_MARK) == plain]
    by_letters = {name.removesuffix(CALL_MARK).lower(): name for name in names}
    close = difflib.get_close_matches(plain.lower(), list(by_letters), n=1, cutoff=LIKE_A_SLIP)
    return next(iter((*same, *(by_letters[one] for one in close))), None)
