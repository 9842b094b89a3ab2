"""Algorithm 1 and Function 2 of the paper, as printed, with three errata corrected: the oracle of the other strategies.

    Algorithm 1 ConSearch(t, F1 ... Fn)            Function 2 Expand(c, t, F1 ... Fn)
      c0 <- {}, C <- {c0}                            X <- {}
      while C != {} do                               U <- roles of t not yet played in c           (1)
        c <- first(C)                                for all b_i in U do                           (2)
        if |P_c| = |B_t| then return c                 for all p in F_i do
        X <- Expand(c, t, F1 ... Fn)                     if local-compatibility(p, c, t) then
        C <- rest(C) u X                                   X <- X u {c + p}
      return FAIL                                    return X

The working set C is a queue. Since every partial configuration that is part of a solution is expanded, and roles and
profiles are taken in order, the first complete one is the lexicographically first solution.

Errata. (1) The paper drops a role from U as soon as *any* of its candidates plays *some* role, so that two roles
sharing a candidate (two speakers) could never both be played; U is the roles not yet played. (2) U is expanded in
full, so that an assignment is reached once per permutation; as C and X are sets, one that is there already is not
added again. (3) The local compatibility rule speaks of the profile associated to b_F, which may not be associated
yet; the rule is applied once it is.

A role that asks for k components is k roles here. The cost is exponential: it is for tests and for comparison.
"""

from __future__ import annotations

from collections.abc import Iterator

from selfconf.model.configuration import Configuration
from selfconf.model.partition import Candidate
from selfconf.model.refusal import Undecided
from selfconf.search.extension import solved
from selfconf.search.problem import Problem

Partial = tuple[int | None, ...]
"""For each slot the index of its candidate, or None while it is empty."""


def algorithm_1(problem: Problem, steps: int | None = None) -> Configuration | Undecided | None:
    """Return what Algorithm 1 returns, or None where that is FAIL; a step is a partial configuration."""
    if problem.valueless:
        return None  # a role that has to be played would set a parameter to nothing
    if any(role.minimum > len(of) for role, of in zip(problem.roles, problem.candidates, strict=True)):
        return None  # no configuration is complete; the slots of a sc:minCount of 18 digits would fill the memory
    slots = [position for position, role in enumerate(problem.roles) for _ in range(role.minimum)]
    queue: dict[Partial, None] = {tuple(None for _ in slots): None}
    taken = 0
    while queue:
        if taken == steps:
            return Undecided(taken)
        taken += 1
        partial = next(iter(queue))
        del queue[partial]
        if None not in partial:
            return solved(problem, _playing(problem, slots, partial))
        for expansion in expand(problem, slots, partial):
            queue.setdefault(expansion)
    return None


def expand(problem: Problem, slots: list[int], partial: Partial) -> Iterator[Partial]:
    """Yield every one-level expansion of a partial configuration: Function 2."""
    for place, role in enumerate(slots):
        if partial[place] is not None:
            continue
        for index in range(len(problem.candidates[role])):
            expansion = (*partial[:place], index, *partial[place + 1 :])
            if locally_compatible(problem, slots, expansion, place):
                yield expansion


def locally_compatible(problem: Problem, slots: list[int], partial: Partial, added: int) -> bool:
    """Return whether the candidate added last meets the local compatibility rule, is distinct, and shares values.

    Clause (i): the sink rule for the added candidate, if all its feeders are there. Clause (ii): the sink rule for
    each candidate that it feeds and whose feeders are then all there.
    """
    playing = _playing(problem, slots, partial)
    chosen = [candidate for role in playing for candidate in role]
    if len({candidate.profile.component for candidate in chosen}) < len(chosen):
        return False
    values = problem.open_values
    for candidate in chosen:
        narrowed = problem.narrowed(values, candidate)
        if narrowed is None:
            return False
        values = narrowed
    role = slots[added]
    for sink in {role, *problem.sinks[role]}:
        if all(len(playing[source]) == problem.roles[source].minimum for source in problem.sources[sink]) and not all(
            problem.compatible(sink, candidate.profile, playing) for candidate in playing[sink]
        ):
            return False
    return True


def _playing(problem: Problem, slots: list[int], partial: Partial) -> list[list[Candidate]]:
    playing: list[list[Candidate]] = [[] for _ in problem.roles]
    for role, index in zip(slots, partial, strict=True):
        if index is not None:
            playing[role].append(problem.candidates[role][index])
    return playing
