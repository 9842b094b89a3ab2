"""Whether some of the requirements of a problem can hold together, by enumeration: the rules of a refusal's reasons."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from itertools import combinations, product

from selfconf.model.partition import ANY_VALUE, Candidate
from selfconf.model.profile import WantedSignal
from selfconf.model.requirement import InputFed, OneRoleEach, OneValue, Requirement, RolePlayed
from tests.search.oracle import World
from tests.search.recruiting.test_recruiting import RecruitingWorld

Players = tuple[tuple[Candidate, ...], ...]
Need = tuple[str, WantedSignal, str | None]


def possible(world: World, force: Iterable[Requirement]) -> bool:
    """Return whether requirements can hold together, by enumeration; what is not required is allowed to fail."""
    wanted = set(force)
    choices = [
        [
            chosen
            for size in (
                range(role.minimum, role.minimum + 1) if RolePlayed(role.iri) in wanted else range(role.minimum + 1)
            )
            for chosen in combinations(candidates, size)
        ]
        for role, candidates in zip(world.roles, world.candidates, strict=True)
    ]
    return any(_holds(world, players, wanted) for players in product(*choices))


def _holds(world: World, players: Players, wanted: Collection[Requirement]) -> bool:
    components = [c.profile.component for role in players for c in role]
    if OneRoleEach() in wanted and len(components) > len(set(components)):
        return False
    for number, variable in enumerate(world.variables):
        if OneValue(variable.parameter.short) in wanted:
            is_set = any(p.is_set for p in world.template.parameters if p.iri == variable.parameter)
            common = (1 << len(variable.domain)) - 1 if is_set else ANY_VALUE
            for role in players:
                for candidate in role:
                    common &= candidate.admits[number]
            if not common:
                return False
    required = {(one.role, one.wanted, one.input) for one in wanted if isinstance(one, InputFed)}
    left = [need for need in unfed(world, players) if need in required]
    return not left or _recruited(world, players, left, OneRoleEach() in wanted)


def _recruited(world: World, players: Players, needs: Collection[Need], distinct: bool) -> bool:
    """Whether recruits feed what no role does; they are no players where no component may play two roles."""
    if not isinstance(world, RecruitingWorld):
        return False
    numbered = [(world.place[role], wanted) for role, wanted, _ in needs]
    if not all(world.roles[number].recruits for number, _ in numbered):
        return False
    names = {c.profile.component for some in players for c in some} if distinct else set()
    pool = [recruit for recruit in world.recruits if recruit.component not in names]
    return any(
        world.enough(players, numbered, chosen, distinct)
        for size in range(1, len(pool) + 1)
        for chosen in combinations(pool, size)
    )


def unfed(world: World, players: Players) -> set[Need]:
    """The needs that no role feeds: of which role, what is wanted, and the input where interactions name some."""
    found = set()
    for role, chosen in zip(world.roles, players, strict=True):
        named = any(i.input for i in world.template.interactions if i.sink == role.iri)
        for candidate in chosen:
            for wanted in candidate.profile.inputs:
                links = [
                    i for i in world.template.interactions if i.sink == role.iri and i.input in (None, wanted.name)
                ]
                fed = any(
                    link.output in (None, output.name) and world.feeds(output, wanted, bool(link.output and link.input))
                    for link in links
                    for source in players[world.place[link.source]]
                    for output in source.profile.outputs
                )
                if not fed and not wanted.optional:
                    # Inputs that the same links feed are one requirement, named after any of them.
                    same = [
                        i.name
                        for c in world.candidates[world.place[role.iri]]
                        for i in c.profile.inputs
                        if i.wanted == wanted.wanted
                        and not i.optional
                        and [k for k in world.template.interactions if k.sink == role.iri and k.input in (None, i.name)]
                        == links
                    ]
                    found |= {(role.iri, wanted.wanted, name if named else None) for name in same}
    return found
