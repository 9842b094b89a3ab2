"""Recruits against enumeration: the first players for whom there are any, then the fewest, then the first of these."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations, product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from selfconf.configuration_certificate import broken_conditions
from selfconf.model.configuration import Configuration
from selfconf.model.partition import Candidate, Recruit
from selfconf.model.profile import Profile, WantedSignal
from selfconf.model.refusal import Refusal, Undecided
from selfconf.search.problem import Problem
from selfconf.search.recruiting.recruiting import first_recruited, recruited
from selfconf.search.strategies import first
from tests.harness.effort import NIGHTLY
from tests.search.chance import Chance, by_chance
from tests.search.oracle import World
from tests.search.without_solvers import without_solvers
from tests.search.worlds import a_problem, agreement, component, iri, problem

Players = tuple[tuple[Candidate, ...], ...]


def recruiting() -> st.SearchStrategy[Problem]:
    """Problems as `a_recruiting_problem` makes them."""
    return by_chance(a_recruiting_problem)


def a_recruiting_problem(chance: Chance) -> Problem:
    """A problem some of whose roles recruit, with recruits that may be candidates as well and may feed each other."""
    given_ = a_problem(chance, roles=3, components=4)
    others = a_problem(chance, roles=1, components=4, hierarchy=given_.hierarchy)
    everybody = {c.profile.component: c.profile for some in given_.candidates for c in some}
    pool = [
        *(replace(c.profile, component=iri(f"extra{k}")) for k, c in enumerate(others.candidates[0])),
        *(profile for profile in everybody.values() if chance.flip()),
    ]
    numbers = range(len(given_.roles))
    recruits = tuple(
        Recruit(profile, frozenset(chance.some(numbers, 0, len(numbers)))) for profile in chance.order(pool)
    )
    roles = tuple(replace(role, recruits=chance.flip(), maximum=role.minimum) for role in given_.roles)
    template = replace(given_.task.template, roles=roles)
    partition = replace(given_.partition, recruits=recruits)
    return Problem(replace(given_.task, template=template), partition, given_.hierarchy)


class RecruitingWorld(World):
    """The rules of the contract with recruits, as plain loops."""

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem.task, problem.partition, problem.hierarchy)
        self.recruits = problem.partition.recruits

    def lacking(self, players: Players) -> list[tuple[int, WantedSignal]] | None:
        """The needs that recruits have to feed, each with its role; None where a role that lacks does not recruit."""
        fed = {(c.sink, c.input) for c in self.connections(players)}
        found = []
        for number, some in enumerate(players):
            for candidate in some:
                for port in candidate.profile.required:
                    if (candidate.profile.component, port.name) not in fed:
                        if not self.roles[number].recruits:
                            return None
                        found.append((number, port.wanted))
        return found

    def enough(
        self,
        players: Players,
        needs: Sequence[tuple[int, WantedSignal]],
        chosen: Sequence[Recruit],
        distinct: bool = True,
    ) -> bool:
        """Whether chosen recruits feed all needs and are fed themselves, without a cycle among them.

        Unless they need not be `distinct`, none of them may be a player.
        """
        names = {c.profile.component for some in players for c in some} if distinct else set()
        if any(recruit.component in names for recruit in chosen):
            return False
        sources = [c.profile for some in players for c in some]
        waiting = list(chosen)
        while waiting:
            ready = [
                one for one in waiting if all(self.feeds_one(sources, port.wanted) for port in one.profile.required)
            ]
            if not ready:
                return False
            sources += [one.profile for one in ready]
            waiting = [one for one in waiting if one not in ready]
        return all(
            self.feeds_one([one.profile for one in chosen if number in one.roles], wanted) for number, wanted in needs
        )

    def feeds_one(self, sources: Sequence[Profile], wanted: WantedSignal) -> bool:
        """Whether an output of some components feeds an input that wants this."""
        port = component("x", "i:S").inputs[0]._replace(signals=wanted.signals, condition=wanted.condition)
        return any(self.feeds(output, port, False) for profile in sources for output in profile.outputs)

    def playable(self) -> Iterator[tuple[Players, list[tuple[int, WantedSignal]]]]:
        """Distinct players who share their values, in order, with what recruits have to feed."""
        choices = [combinations(c, role.minimum) for c, role in zip(self.candidates, self.roles, strict=True)]
        for players in product(*map(list, choices)):
            names = [c.profile.component for some in players for c in some]
            needs = self.lacking(players)
            if (
                needs is not None
                and len(set(names)) == len(names)
                and not self.unset(players)
                and all(allowed is None or allowed for allowed in self.values(players))
            ):
                yield players, needs

    def answer(self) -> tuple[Players, tuple[Recruit, ...]] | None:
        """The first players for whom there are recruits, with the fewest of these, the first."""
        for players, needs in self.playable():
            for size in range(len(self.recruits) + 1):
                for chosen in combinations(self.recruits, size):
                    if self.enough(players, needs, chosen):
                        return players, chosen
        return None


def answered(problem: Problem) -> Configuration | None:
    """The configuration that the search finds."""
    outcome = first.search(problem)
    if isinstance(outcome, Refusal):
        return None
    found = recruited(problem, outcome)
    if found is None:
        other = first_recruited(problem)
        assert other is None or isinstance(other, Configuration)
        return other
    configuration, proved = found
    assert proved
    return configuration


def check(problem: Problem) -> None:
    """Hold the search against enumeration, and its answer against the certificate."""
    expected, found = RecruitingWorld(problem).answer(), answered(problem)
    if expected is None or found is None:
        assert expected == found
        return
    players, recruits = expected
    assert [a.components for a in found.assignments] == [tuple(c.profile.component for c in some) for some in players]
    assert found.recruits == tuple(recruit.component for recruit in recruits)
    assert not broken_conditions(problem.task, problem.partition, found, problem.hierarchy)


@given(recruiting())
@agreement(1.0 if NIGHTLY else 0.5)  # more for every push: tests/composition/test_searches.py
def test_recruits_are_those_that_enumeration_finds_first(problem: Problem) -> None:
    pytest.importorskip("pysat")
    check(problem)


@given(recruiting())
@agreement(0.3)
def test_without_a_solver_recruits_are_enough_and_none_of_them_can_be_spared(problem: Problem) -> None:
    with without_solvers():
        outcome = first.search(problem)
        found = None if isinstance(outcome, Refusal) else recruited(problem, outcome)
    if found is not None:
        configuration, _ = found
        assert not broken_conditions(problem.task, problem.partition, configuration, problem.hierarchy)


def with_recruits(problem: Problem, *profiles: Profile) -> Problem:
    """A problem whose roles all recruit any of some components."""
    roles = tuple(replace(role, recruits=True) for role in problem.roles)
    everywhere = frozenset(range(len(roles)))
    partition = replace(problem.partition, recruits=tuple(Recruit(profile, everywhere) for profile in profiles))
    template = replace(problem.task.template, roles=roles)
    return Problem(replace(problem.task, template=template), partition, problem.hierarchy)


def test_recruits_that_only_feed_each_other_feed_nobody() -> None:
    user = problem({"user": [component("user", "s:S")]})
    cycle = with_recruits(user, component("a", "t:T", "s:S"), component("b", "s:S", "t:T"))
    assert isinstance(first.search(cycle), Refusal)


def test_a_recruit_may_be_fed_by_the_player_that_it_feeds() -> None:
    user = problem({"user": [component("user", "s:S", "t:T")]})
    found = recruited(helped := with_recruits(user, component("a", "t:T", "s:S")), first.search(helped))
    assert found is not None
    assert found[0].recruits == (iri("a"),)
    assert {(c.source.short, c.sink.short) for c in found[0].connections} == {("user", "a"), ("a", "user")}


def test_a_further_player_is_no_reason_to_do_without_a_recruit() -> None:
    given_ = problem(
        {"sink": [component("s", "i:S")], "rest": [component("mic", outputs="o:S")]}, counts={"rest": (0, 1)}
    )
    helped = with_recruits(given_, component("mic", outputs="o:S"))
    found = recruited(helped, first.search(helped))
    assert found is not None
    assert found[0].recruits == (iri("mic"),)
    assert found[0].assignments[1].components == ()
    assert not broken_conditions(helped.task, helped.partition, found[0])


def test_a_further_player_joins_what_has_its_recruits() -> None:
    given_ = problem({"sink": [component("a", "i:S"), component("b")]}, counts={"sink": (1, None)})
    helped = with_recruits(given_, component("mic", outputs="o:S"))
    found = recruited(helped, first.search(helped))
    assert found is not None
    assert found[0].assignments[0].components == (iri("a"), iri("b"))
    assert found[0].recruits == (iri("mic"),)
    assert not broken_conditions(helped.task, helped.partition, found[0])


def test_of_equally_few_recruits_those_that_run_are_kept() -> None:
    user = problem({"user": [component("user", "s:S")]})
    helped = with_recruits(user, component("a", "", "s:S"), component("b", "", "s:S"))
    fresh = first.search(helped)
    assert isinstance(fresh, Configuration)
    found = recruited(helped, fresh, running=replace(fresh, recruits=(iri("b"),)))
    assert found is not None
    assert found[0].recruits == (iri("b"),)


def test_a_further_player_that_runs_is_not_recruited_where_another_would_do() -> None:
    lamps = [component("lamp"), component("loud", outputs="o:S")]
    given_ = problem({"sink": [component("a", "i:S")], "lamp": lamps}, counts={"lamp": (1, None)})
    helped = with_recruits(given_, lamps[1], component("mic", outputs="o:S"))
    fresh = first.search(helped)
    assert isinstance(fresh, Configuration)
    ran = replace(fresh.assignments[1], components=(iri("lamp"), iri("loud")))
    found = recruited(helped, fresh, replace(fresh, assignments=(fresh.assignments[0], ran), recruits=(iri("gone"),)))
    assert found is not None
    assert found[0].components == tuple(map(iri, ("a", "lamp", "loud", "mic")))


def test_of_further_players_those_that_run_are_kept() -> None:
    given_ = problem({"sink": [component("a", "i:S"), component("b"), component("c")]}, counts={"sink": (1, 2)})
    helped = with_recruits(given_, component("mic", outputs="o:S"), component("phone", outputs="o:S"))
    found = recruited(helped, first.search(helped))
    assert found is not None
    assert found[0].assignments[0].components == (iri("a"), iri("b"))
    ran = replace(found[0], assignments=(replace(found[0].assignments[0], components=(iri("a"), iri("c"))),))
    left = Problem(helped.task, helped.partition.without(frozenset((iri("mic"),))), helped.hierarchy)
    repaired = recruited(left, first.search(left), ran)
    assert repaired is not None
    assert repaired[0].recruits == (iri("phone"),)
    assert repaired[0].assignments[0].components == (iri("a"), iri("c"))


def test_a_further_player_that_would_feed_what_a_recruit_feeds_keeps_no_other_out() -> None:
    eyes = [component("blind"), component("seeing", outputs="o:S"), component("looking", outputs="o:T")]
    given_ = problem(
        {"eye": eyes, "mind": [component("mind", "s:S"), component("more", "t:T")]},
        "eye>mind",
        counts={"eye": (1, None), "mind": (1, None)},
    )
    helped = with_recruits(given_, component("mic", outputs="o:S"))
    found = recruited(helped, first.search(helped))
    assert found is not None
    assert [[one.short for one in a.components] for a in found[0].assignments] == [
        ["blind", "looking"],
        ["mind", "more"],
    ]
    assert not broken_conditions(helped.task, helped.partition, found[0])


def busy(unrelated: int) -> Problem:
    """A problem whose first solution has no recruits: the only supplier of `needy` has to play a role itself.

    Roles that have nothing to do with it follow, with five candidates each.
    """
    needy, other, plain = component("needy", "s:S"), component("other", "s:S"), component("plain")
    supplier = component("supplier", outputs="s:S")
    roles = {"user": [needy, other, plain], "job": [supplier]}
    roles |= {f"idle{k}": [component(f"idle{k}-{n}") for n in range(5)] for k in range(unrelated)}
    helped = with_recruits(problem(roles), supplier)
    few = tuple(replace(role, recruits=role.iri == iri("user")) for role in helped.roles)
    template = replace(helped.task.template, roles=few)
    return Problem(replace(helped.task, template=template), helped.partition)


@pytest.mark.parametrize("unrelated", [0, 1, 12])
def test_players_on_whom_no_recruit_depends_are_not_tried_in_all_ways(unrelated: int) -> None:
    found = first_recruited(busy(unrelated), steps=2_000)
    assert isinstance(found, Configuration)
    assert found.assignments[0].components == (iri("plain"),)


def test_of_players_with_recruits_those_that_run_come_first() -> None:
    helped = busy(2)
    fresh = first_recruited(helped)
    assert isinstance(fresh, Configuration)
    ran = replace(fresh.assignments[2], components=(iri("idle0-3"),))
    running = replace(fresh, assignments=(*fresh.assignments[:2], ran, *fresh.assignments[3:]))
    kept = first_recruited(helped, running=running)
    assert isinstance(kept, Configuration)
    assert [a.components[0].short for a in kept.assignments] == ["plain", "supplier", "idle0-3", "idle1-0"]


def test_steps_that_end_before_players_have_recruits_are_no_refusal() -> None:
    own = component("own", "s:S", "s:S")
    user = problem({"user": [component("a", "s:S"), own, component("b", "p:S")]}, "user>user")
    helped = with_recruits(user, own)
    assert isinstance(first_recruited(helped, steps=1), Undecided)
    found = first_recruited(helped)
    assert isinstance(found, Configuration)
    assert found.players == (iri("own"),)


def test_what_runs_is_kept_where_the_steps_end_before_the_first_players_are_known() -> None:
    pytest.importorskip("pysat")
    helped = busy(8)
    fresh = first_recruited(helped)
    assert isinstance(fresh, Configuration)
    last = [replace(a, components=(iri(f"idle{k}-4"),)) for k, a in enumerate(fresh.assignments[2:])]
    running = replace(fresh, assignments=(*fresh.assignments[:2], *last))
    kept = first_recruited(helped, steps=10, running=running)
    assert isinstance(kept, Configuration)
    assert not broken_conditions(helped.task, helped.partition, kept)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda c: replace(c, recruits=()), "no interaction makes this connection"),
        (lambda c: replace(c, recruits=(*c.recruits, iri("idle"))), "feeds nothing"),
        (lambda c: replace(c, recruits=(*c.recruits, iri("nobody"))), "cannot be recruited"),
        (lambda c: replace(c, connections=c.connections[1:]), "is not fed"),
    ],
)
def test_the_certificate_names_what_is_wrong_with_recruits(change: object, words: str) -> None:
    user = problem({"user": [component("user", "s:S")]})
    helped = with_recruits(user, component("a", "t:T", "s:S"), component("b", "", "t:T"), component("idle"))
    found = recruited(helped, first.search(helped))
    assert found is not None
    wrong = change(found[0])  # type: ignore[operator]  # a table of functions
    assert any(words in said for said in broken_conditions(helped.task, helped.partition, wrong))
