"""The fewest components that could be added so that a refused task becomes possible.

A component without inputs that issues every signal that the roles fed by it could need is the most helpful that could
be added for a role; an output that an interaction names has one signal, so that there may be a choice of these.
Wherever there is no solution, an irreducible set of constraints cannot hold; only a component for one of its roles, or
for a role that may feed one of its inputs, changes that. So breadth-first search over sets of such additions, each
extended by these roles alone, finds the fewest, beginning with as many for each role as it has too few candidates that
could be fed at all; then outputs are taken away again one by one, as long as there is a solution without them, the last
one of a component after those of which it has several. Where there are players, but none that have recruits, one more
component for any role may help. That one for a role which the set is not about may feed recruits is not looked at:
where roles recruit, a smaller set may do.
"""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from operator import itemgetter

from selfconf.model.immutable import replace
from selfconf.model.partition import Candidate
from selfconf.model.profile import CALL_MARK, Input, Output, Ports, WantedSignal
from selfconf.model.refusal import Undecided
from selfconf.model.relaxation import AddComponents, Addition
from selfconf.search.additions import with_optional_slots
from selfconf.search.problem import Link, Problem
from selfconf.search.reduction import Fed, LazyReduction, Need, Played
from selfconf.search.relaxations.newcomers import ADDITION, impossible, with_mentioned_variables, with_values
from selfconf.search.relaxations.relaxation_effort import TRIALS, RelaxationEffort
from selfconf.search.relaxations.relaxed_problem import relaxed_by
from selfconf.search.relaxations.supposed_outputs import supposed

CHOICES = 8
"""How many choices of outputs are tried for a role, where interactions name outputs."""
MOST_ADDED = 200
"""How many components are asked for at most; a task that lacks more has asked for too many."""

Added = Counter[tuple[int, tuple[Output, ...]]]
"""How many components are added for each role and choice of outputs."""
Works = Callable[[AddComponents], bool]
"""Whether an addition works in the end, which is possible if all recruits are there at once."""


def components_to_add(problem: Problem, effort: RelaxationEffort, works: Works) -> AddComponents | None:
    """Return the fewest components to add, if a few are enough: breadth-first search over sets of additions."""
    problem = with_mentioned_variables(problem)
    lacking = _lacking(problem)
    if lacking is None:
        return None
    recruiting = any(role.recruits for role in problem.roles)
    choices = _choices(problem, effort)
    waiting = _lacked(lacking, choices, effort)
    seen = {frozenset[object](added.items()) for added in waiting}
    for added in effort.first_of(waiting, TRIALS):  # which grows meanwhile
        if effort.used_up():
            return None
        asked = _asked(problem, added)
        changed = LazyReduction(relaxed_by(problem, asked))
        playing = effort.solution(changed) if added or recruiting else None
        if isinstance(playing, Undecided):
            # What comes later in the queue may be possible, and would not be known to be the fewest.
            return None
        if playing is not None and added and works(asked):
            return _trimmed(problem, added, playing, effort, works)
        helpful = _helpful(changed, effort) if playing is None else _feeding_first(changed.problem)
        waiting += _with_one_more(added, _first_choices_first(helpful, choices), seen)
    return None


def _choices(problem: Problem, effort: RelaxationEffort) -> list[list[tuple[Output, ...]]]:
    """Return for each role the choices of outputs for a component to be added; none where none could be eligible."""
    closed = impossible(problem)
    return [
        [] if role in closed else list(effort.first_of(wanted_of(problem, role), CHOICES))
        for role in range(len(problem.roles))
    ]


def _first_choices_first(
    roles: Iterable[int], choices: Sequence[Sequence[tuple[Output, ...]]]
) -> list[tuple[int, tuple[Output, ...]]]:
    """Return all choices of some roles: the first of each role, then the second of each that has one, and so on.

    A role with many choices would else take all trials for itself.
    """
    ranked = [(rank, (role, outputs)) for role in roles for rank, outputs in enumerate(choices[role])]
    return [one for _, one in sorted(ranked, key=itemgetter(0))]


def _with_one_more(
    added: Added, ones: Iterable[tuple[int, tuple[Output, ...]]], seen: set[frozenset[object]]
) -> Iterator[Added]:
    """Yield additions with one component more, given by its role and outputs, that were not seen, and note them."""
    for one in ones:
        further = added + Counter({one: 1})
        if frozenset(further.items()) not in seen:
            seen.add(frozenset(further.items()))
            yield further


def _lacked(
    lacking: Counter[int], choices: Sequence[Sequence[tuple[Output, ...]]], effort: RelaxationEffort
) -> list[Added]:
    """Return additions for what each role lacks by itself, first those in which all for one role issue the same."""
    of_roles = (
        tuple(effort.first_of(_alike_and_mixed(role, count, choices[role]), TRIALS)) for role, count in lacking.items()
    )
    return [sum(some, Added()) for some in effort.first_of(itertools.product(*of_roles), TRIALS)]


def _alike_and_mixed(role: int, count: int, choices: Sequence[tuple[Output, ...]]) -> Iterator[Added]:
    """Yield the ways to add so many components for one role."""
    yield from (Counter({(role, outputs): count}) for outputs in choices)
    for some in itertools.combinations_with_replacement(choices, count):
        if some[0] != some[-1]:
            yield Counter((role, outputs) for outputs in some)


def _lacking(problem: Problem) -> Counter[int] | None:
    """Return how many candidates each role lacks by itself, if adding as many could be advice at all.

    A candidate with an input that could not be fed, whatever plays the other roles, counts for none.
    """
    if problem.valueless or any(role.maximum is not None and role.maximum < role.minimum for role in problem.roles):
        return None
    lacking: Counter[int] = Counter()
    for number, (role, some) in enumerate(zip(problem.roles, problem.candidates, strict=True)):
        lacking[number] = max(0, role.minimum - sum(_may_be_fed(problem, number, one) for one in some))
    return +lacking if sum(lacking.values()) <= MOST_ADDED else None


def _may_be_fed(problem: Problem, role: int, candidate: Candidate) -> bool:
    """Return whether some interaction, or a recruit, could feed each required input of a candidate of a role."""
    return problem.roles[role].recruits or all(
        any(_asks(link, port) for link in problem.links[role]) for port in candidate.profile.required
    )


def wanted_of(problem: Problem, role: int) -> Iterator[tuple[Output, ...]]:
    """Yield the choices of outputs for a component that could feed all that a role may have to feed.

    It issues each signal that the roles fed by it could need; but where an interaction names the output, that output
    has one signal only, so that there is a choice for each.
    """
    plain: dict[WantedSignal, None] = {}
    by_name: dict[str, dict[WantedSignal, None]] = {}
    for sink in problem.sinks[role]:
        for link in problem.links[sink]:
            if link.source == role:
                wanted = plain if link.output is None else by_name.setdefault(link.output, {})
                wanted.update(dict.fromkeys(_wanted_along(problem, sink, link)))
    names = set(by_name)
    others = []
    for one in plain:
        if not one.signals:
            continue  # nothing feeds it along an interaction that does not name it
        stem = name = one.signals[0].short
        number = 2
        while name in names:
            name, number = f"{stem}{number}", number + 1
        names.add(name)
        others.append(one.output(name))
    ways = itertools.product(*([one.output(name) for one in wanted] for name, wanted in by_name.items() if wanted))
    yield from ((*others, *chosen) for chosen in ways)


def _wanted_along(problem: Problem, sink: int, link: Link) -> Iterator[WantedSignal]:
    """Yield what the candidates of a sink want that a component to add could issue along an interaction."""
    unissuable = problem.partition.unissuable
    for candidate in problem.candidates[sink]:
        for port in candidate.profile.required:
            if _asks(link, port) and not (unissuable and (link.source, link.output, port.wanted) in unissuable):
                yield port.wanted


def _asks(link: Link, port: Input) -> bool:
    """Return whether an input could be fed along an interaction, by the names: no output feeds what calls, or back."""
    called = link.output is not None and link.output.endswith(CALL_MARK)
    return link.input in (None, port.name) and (link.output is None or called is port.is_operation)


def _helpful(changed: LazyReduction, effort: RelaxationEffort) -> list[int]:
    """Return the roles for which one more component could resolve the conflict that there is, optional ones too."""
    optional = with_optional_slots(changed.problem)
    given = (changed if optional is changed.problem else LazyReduction(optional)).reduced
    if given.wiped_out() is not None:
        return []
    together = effort.core(given)
    sources = [s for r in together if isinstance(r, Fed) for s in _likely_first(changed.problem, given.needs[r.need])]
    # Roles that feed come first: of a role that others feed, a component without inputs is less likely to be had.
    return list(dict.fromkeys((*sources, *(r.role for r in together if isinstance(r, Played)))))


def _likely_first(problem: Problem, need: Need) -> list[int]:
    """Return the roles that may feed an input, those first whose candidates issue its signal, if not as it asks."""
    by_type = need.port._replace(condition=None)
    issuing = {
        source.role
        for source in need.sources
        if any(problem.hierarchy.pairs(o, by_type) for c in problem.candidates[source.role] for o in c.profile.outputs)
    }
    return sorted((source.role for source in need.sources), key=lambda role: role not in issuing)


def _feeding_first(problem: Problem) -> list[int]:
    """Return the roles that ask for components, those first that feed others.

    Where players lack recruits alone, one more component for any role may leave another free to be recruited.
    """
    asked = [number for number, role in enumerate(problem.roles) if role.minimum]
    return sorted(asked, key=lambda number: not problem.sinks[number])


def _in_order(added: tuple[int, tuple[Output, ...]]) -> tuple[int, str]:
    """Return what additions are sorted by: the role, then the outputs, some of which say more than others."""
    return added[0], repr(added[1])


def _asked(problem: Problem, added: Added) -> AddComponents:
    """Return additions as a relaxation, those of a role and of equal outputs as one."""
    return AddComponents(
        tuple(
            Addition(problem.roles[role].iri, count, outputs, _named(problem, role) & {o.name for o in outputs})
            for (role, outputs), count in sorted(added.items(), key=lambda one: _in_order(one[0]))
        )
    )


def _named(problem: Problem, role: int) -> frozenset[str]:
    """Return the names by which interactions ask for outputs of a role."""
    links = (link for sink in problem.sinks[role] for link in problem.links[sink])
    return frozenset(link.output for link in links if link.source == role and link.output is not None)


def _trimmed(
    problem: Problem, added: Added, playing: list[list[Candidate]], effort: RelaxationEffort, works: Works
) -> AddComponents:
    """Return additions with only the outputs that are needed for a solution; `playing` is a solution with all."""
    # At first each keeps an output: a component for a role that feeds others is hardly one that issues nothing.
    for least in (1, 0):
        for role, outputs in sorted(added, key=_in_order):
            left = outputs
            for output in outputs:
                if len(left) == least:
                    break
                fewer = tuple(other for other in left if other != output)
                trial: Added = Counter()
                for (at, issued), count in added.items():
                    trial[at, fewer if (at, issued) == (role, left) else issued] += count
                changed = [*playing[:role], [_without(c, left, fewer) for c in playing[role]], *playing[role + 1 :]]
                found = _still_playing(problem, role, changed, _asked(problem, trial), effort)
                if found is not None and works(_asked(problem, trial)):
                    left, playing, added = fewer, found, trial
    return with_values(problem, _asked(problem, added), playing)


def _still_playing(
    problem: Problem, role: int, changed: list[list[Candidate]], asked: AddComponents, effort: RelaxationEffort
) -> list[list[Candidate]] | None:
    """Return players where components of a role have fewer outputs: those that are given if they will do, or others."""
    if all(problem.compatible(sink, c.profile, changed) for sink in problem.sinks[role] for c in changed[sink]):
        return changed
    found = effort.solution(LazyReduction(relaxed_by(problem, asked)))
    return found if isinstance(found, list) else None


def _without(candidate: Candidate, known: tuple[Output, ...], outputs: tuple[Output, ...]) -> Candidate:
    """Return a component that is added, and has the outputs that are known, with these instead; any other as it is."""
    profile = candidate.profile
    if not profile.component.startswith(ADDITION) or profile.outputs != supposed(known):
        return candidate
    return replace(candidate, profile=replace(profile, ports=Ports(profile.inputs, supposed(outputs))))
