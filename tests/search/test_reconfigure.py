"""After a failure as much as possible stays as it was."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given

from selfconf.configuration_certificate import broken_conditions
from selfconf.model.configuration import Configuration
from selfconf.model.partition import Partition
from selfconf.model.profile import Profile
from selfconf.model.refusal import Refusal
from selfconf.search import explain, reconfigure
from selfconf.search.problem import Problem
from selfconf.search.recruiting import recruited
from selfconf.search.strategies import first
from tests.harness.effort import NIGHTLY, thorough
from tests.search.chance import Chance, with_chance
from tests.search.oracle import World
from tests.search.recruiting.test_recruiting import with_recruits
from tests.search.without_solvers import without_solvers
from tests.search.worlds import a_problem, agreement, component, explained_once, iri, problem


def _score(after: Configuration, before: Configuration) -> tuple[int, int]:
    stays = sum(
        component in was.components
        for now, was in zip(after.assignments, before.assignments, strict=True)
        for component in now.components
    )
    return stays, len(set(after.connections) & set(before.connections))


def _nearest(world: World, running: Configuration) -> Configuration | None:
    best: Configuration | None = None
    for players in world.solutions():
        found = world.configuration(players, running)
        if best is None or _score(found, running) > _score(best, running):
            best = found
    return best


def _after_losses(problem: Problem, running: Configuration, chance: Chance) -> Problem:
    """Return the problem once one or two components are lost, and some others are no longer eligible for a role."""
    lost = frozenset(chance.some(running.components, 1, 2))
    unfit = [chance.some(running.components, 0, 1) for _ in problem.roles]
    left = problem.partition.without(lost)
    candidates = tuple(
        tuple(c for c in role if c.profile.component not in out)
        for role, out in zip(left.candidates, unfit, strict=True)
    )
    return Problem(problem.task, Partition(candidates, left.variables), problem.hierarchy)


def _fixed(problem: Problem) -> Problem:
    """The problem with roles that each ask for a fixed number."""
    roles = tuple(replace(role, maximum=role.minimum) for role in problem.roles)
    template = replace(problem.task.template, roles=roles)
    return Problem(replace(problem.task, template=template), problem.partition, problem.hierarchy)


@given(with_chance(a_problem))
@agreement(0.9)
def test_a_reconfiguration_keeps_the_most_and_is_the_first_that_does(drawn: tuple[Problem, Chance]) -> None:
    problem, chance = drawn
    running = first.search(problem)
    if not isinstance(running, Configuration) or not running.components:
        return
    left = _after_losses(problem, running, chance)
    answer = reconfigure.nearest_configuration(left, running)
    expected = _nearest(World(left.task, left.partition, left.hierarchy), running)
    assert (answer if isinstance(answer, Configuration) else None) == expected


@given(with_chance(a_problem))
@agreement(0.75)
def test_clause_learning_finds_the_configuration_that_depth_first_search_finds(drawn: tuple[Problem, Chance]) -> None:
    pytest.importorskip("pysat")
    problem, chance = drawn
    running = first.search(_fixed(problem))
    if not isinstance(running, Configuration) or not running.components:
        return
    left = _after_losses(_fixed(problem), running, chance)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(reconfigure, "DEPTH_FIRST_STEPS", 0)
        answer = reconfigure.nearest(left, running)
    expected = _nearest(World(left.task, left.partition, left.hierarchy), running)
    assert (answer.configuration if isinstance(answer, reconfigure.Reconfiguration) else None) == expected
    assert isinstance(answer, Refusal) or answer.proved


@thorough
@pytest.mark.slow
@pytest.mark.parametrize("aided", [False, True])
def test_what_is_called_the_nearest_is_proved_and_what_is_not_says_so(
    aided: bool, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> None:
    if aided:
        pytest.importorskip("pysat")
        monkeypatch.setattr(reconfigure, "DEPTH_FIRST_STEPS", 0)
        monkeypatch.setattr(reconfigure, "LEAST_STEPS", 1)  # too few to name the first of the nearest
    else:
        request.getfixturevalue("no_solvers")
    monkeypatch.setattr(explain, "refusal", explained_once(explain.refusal))
    unproved: list[bool] = []
    """For each answer without a proof whether there is a nearer one."""

    @given(with_chance(a_problem))
    @agreement(1.5 if NIGHTLY else 7.0)  # so many that ten answers and more lack a proof
    def search(drawn: tuple[Problem, Chance]) -> None:
        problem, chance = drawn
        whole = _fixed(problem) if aided else problem
        running = next(first.answers(whole))  # where there is none, nobody looks at the reasons
        if not isinstance(running, Configuration) or not running.components:
            return
        left = _after_losses(whole, running, chance)
        nearest = _nearest(World(left.task, left.partition, left.hierarchy), running)
        decided = False
        for steps in range(1, 11):
            if decided and steps < 10:  # with more steps than it takes, the search is the same
                continue
            answer = reconfigure.nearest(left, running, steps)
            decided = isinstance(answer, Refusal) or (isinstance(answer, reconfigure.Reconfiguration) and answer.proved)
            if isinstance(answer, Refusal):
                assert nearest is None
            elif isinstance(answer, reconfigure.Reconfiguration):
                assert (answer.kept, answer.connections) == _score(answer.configuration, running)
                assert broken_conditions(left.task, left.partition, answer.configuration, left.hierarchy) == []
                if answer.proved:
                    assert answer.configuration == nearest
                else:
                    unproved.append(answer.configuration != nearest)

    search()
    assert len(unproved) >= 10
    assert aided or any(unproved)


def test_a_component_that_has_to_change_roles_may_keep_its_connections() -> None:
    x, w, v = (component(name, outputs="o:Scan") for name in "xwv")
    n, cap = component("n"), component("cap", "i:Scan")
    running = first.search(problem({"first": [x], "second": [w], "control": [cap]}, "first>control second>control"))
    assert isinstance(running, Configuration)
    left = problem({"first": [n], "second": [v, x], "control": [cap]}, "first>control second>control")
    answer = reconfigure.nearest(left, running)
    assert isinstance(answer, reconfigure.Reconfiguration)
    assert [one.short for one in answer.configuration.components] == ["n", "x", "cap"]
    assert (answer.kept, answer.connections, answer.proved) == (1, 1, True)


def test_a_lost_tracker_is_replaced_and_the_rest_stays() -> None:
    sonar, tracker, odometry = (
        component("sonar"),
        component("tracker", outputs="p:Pose"),
        component("odometry", outputs="p:Pose"),
    )
    cap = component("cap", "p:Pose")
    given_ = problem(
        {"sonar": [component("newer"), sonar], "position": [odometry], "control": [cap]}, "position>control"
    )
    running = first.search(problem({"sonar": [sonar], "position": [tracker], "control": [cap]}, "position>control"))
    assert isinstance(running, Configuration)
    answer = reconfigure.nearest_configuration(given_, running)
    assert isinstance(answer, Configuration)
    assert [c.short for c in answer.components] == ["sonar", "odometry", "cap"]


def test_further_players_stay_where_a_role_recruits() -> None:
    lamps = [component("first"), component("second")]
    keepers = [component("keeper"), lamps[1], component("substitute")]
    plain = problem({"keeper": keepers, "lamp": lamps, "sink": [component("sink", "i:S")]}, counts={"lamp": (1, None)})
    asked = with_recruits(plain, component("mic", outputs="o:S"))
    whole = recruited(asked, first.search(asked))
    assert whole is not None
    running, _ = whole
    assert running.components == tuple(map(iri, ("keeper", "first", "second", "sink", "mic")))
    left = Problem(asked.task, asked.partition.without(frozenset((iri("keeper"),))), asked.hierarchy)
    after = reconfigure.nearest(left, running)
    assert isinstance(after, reconfigure.Reconfiguration)
    assert after.configuration.assignments[0].components == (iri("substitute"),)
    assert (after.kept, after.proved) == (3, True)


def test_where_no_candidate_is_left_the_answer_is_a_refusal() -> None:
    running = first.search(problem({"eye": [component("camera")]}))
    assert isinstance(running, Configuration)
    assert isinstance(reconfigure.nearest_configuration(problem({"eye": []}), running), Refusal)


def test_when_the_steps_end_the_answer_is_the_nearest_configuration_that_was_met() -> None:
    lamps = [component("red", "s:Scan"), component("green", "t:Time")]
    cameras = [component("blind"), component("half", outputs="s:Scan"), component("full", outputs="s:Scan t:Time")]

    def watching(*eyes: Profile) -> Problem:
        return problem({"camera": eyes, "lamp": lamps}, "camera>lamp", {"lamp": (0, 2)})

    running = first.search(watching(component("lost", outputs="s:Scan t:Time")))
    assert isinstance(running, Configuration)
    # The slot of the camera takes the cameras in order, and the lamps that each of them can feed are added to it: one
    # more step, one more lamp. Two steps meet the camera that keeps one lamp, but do not reach the one that keeps both.
    found = [reconfigure.nearest(watching(*cameras), running, steps) for steps in range(1, 5)]
    assert [
        (one.configuration.components[0].short, one.kept, one.proved)
        for one in found
        if isinstance(one, reconfigure.Reconfiguration)
    ] == [("blind", 0, False), ("half", 1, False), ("full", 2, False), ("full", 2, True)]


def test_all_steps_are_for_some_losses_where_it_is_soon_seen_that_there_are_any() -> None:
    useless = [component(f"useless{number:04}", "u:Unfed") for number in range(2_500)]
    moving, other, stays = component("moving"), component("other"), component("stays")
    counts = {"alone": (1, 2)}  # nothing that clauses could go on with
    before = {"alone": [component("lost")], "crowd": [moving], "kept": [stays]}
    running = first.search(problem(before, counts=counts))
    assert isinstance(running, Configuration)
    # Only the component that plays for the crowd can replace the one that is lost, and the crowd has one more.
    left = problem(
        {"alone": [moving], "crowd": [*useless, other, moving], "kept": [component("a"), stays]}, counts=counts
    )
    found = reconfigure.nearest(left, running)
    assert isinstance(found, reconfigure.Reconfiguration)
    assert [one.short for one in found.configuration.components] == ["moving", "other", "stays"]
    assert found.proved


def test_a_connection_is_kept_though_many_that_keep_none_come_before() -> None:
    pytest.importorskip("pysat")
    many = [component(f"new{number:04}", outputs="o:S") for number in range(2_500)]
    moving, other, user = component("x", outputs="o:S"), component("other", outputs="o:S"), component("user", "i:S")
    interactions = "one>user two>user"
    before = {"one": [moving], "two": [component("lost", outputs="o:S")], "user": [user]}
    running = first.search(problem(before, interactions))
    assert isinstance(running, Configuration)
    # It is no longer eligible for its own role, and the last of another one: there its connection stays.
    found = reconfigure.nearest(
        problem({"one": [other], "two": [*many, moving], "user": [user]}, interactions), running
    )
    assert isinstance(found, reconfigure.Reconfiguration)
    assert [one.short for one in found.configuration.components] == ["other", "x", "user"]
    assert (found.connections, found.proved) == (1, True)


def test_what_runs_stays_where_it_is_enough_by_itself_though_many_could_come_before_it() -> None:
    """Six roles in a ring, each with room for all: c0 is lost, and what is left of those that run needs no other."""
    names = [f"r{number}" for number in range(6)]

    def ring(*components: int) -> Problem:
        parts = [component(f"c{k:02}", f"i:X{k % 7}", f"o:X{3 * k % 7}") for k in components]
        interactions = " ".join(f"{name}>{names[(place + 1) % 6]}" for place, name in enumerate(names))
        return problem(dict.fromkeys(names, parts), interactions, dict.fromkeys(names, (1, 100)))

    running = first.search(ring(*range(0, 50, 7)))
    assert isinstance(running, Configuration)
    found = reconfigure.nearest(ring(*range(1, 50)), running)
    assert isinstance(found, reconfigure.Reconfiguration)
    assert found.kept == len(running.components) - 1
    assert set(found.configuration.components) == {c for c in running.components if c.short != "c00"}


@given(with_chance(a_problem))
@agreement(0.6)
def test_more_steps_never_find_a_configuration_farther_away(drawn: tuple[Problem, Chance]) -> None:
    problem, chance = drawn
    running = first.search(problem)
    if not isinstance(running, Configuration) or not running.components:
        return
    left = _after_losses(problem, running, chance)
    if not isinstance(first.search(left), Configuration):
        return
    with without_solvers():
        found = [reconfigure.nearest(left, running, steps) for steps in range(1, 11)]
    scores = [_score(one.configuration, running) for one in found if isinstance(one, reconfigure.Reconfiguration)]
    assert scores == sorted(scores)
    assert len(scores) == len(found)
