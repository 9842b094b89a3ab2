"""The consequences of losing each component: what would replace it, or that nothing would."""

from __future__ import annotations

from hypothesis import given

from selfconf.composition import Strategy
from selfconf.composition.searches import Searches
from selfconf.model.configuration import Configuration
from selfconf.model.immutable import replace
from selfconf.model.partition import Recruit
from selfconf.search.problem import Problem
from selfconf.search.strategies import first
from selfconf.search.what_if import consequences
from tests.search.oracle import World
from tests.search.recruiting.test_recruiting import with_recruits
from tests.search.worlds import agreement, component, problem, problems


@given(problems(roles=3))
@agreement(0.3)
def test_a_single_point_of_failure_is_one_without_which_nothing_is_possible(problem: Problem) -> None:
    running = first.search(problem)
    if isinstance(running, Configuration):
        found = list(consequences(problem, running))
        assert [loss.component for loss in found] == list(running.components)
        for loss in found:
            without = problem.partition.without(frozenset((loss.component,)))
            assert loss.fatal == (World(problem.task, without, problem.hierarchy).first() is None)
            assert loss.component not in loss.started


def test_for_each_component_its_replacement_is_named() -> None:
    given_ = problem(
        {
            "position": [component("tracker", outputs="p:Pose"), component("odometry", outputs="p:Pose")],
            "control": [component("cap", "p:Pose")],
        },
        "position>control",
    )
    running = first.search(given_)
    assert isinstance(running, Configuration)
    assert [str(loss) for loss in consequences(given_, running)] == [
        "tracker (position): odometry",
        "cap (control): NONE, a single point of failure",
    ]


def test_a_component_that_would_play_another_role_is_named_with_it() -> None:
    a, b, x = component("a"), component("b"), component("x")
    given_ = problem({"first": [a, x], "second": [b, x]}, counts={"second": (1, None)})
    running = first.search(given_)
    assert isinstance(running, Configuration)
    assert [str(loss) for loss in consequences(given_, running)] == [
        "a (first): x as first",
        "b (second): no component needed",
        "x (second): no component needed",
    ]


def test_what_is_not_decided_is_no_single_point_of_failure() -> None:
    own = component("own", "s:S", "s:S")
    user = problem({"user": [component("lost"), component("a", "s:S"), own, component("b", "p:S")]}, "user>user")
    helped = with_recruits(user, own)
    running = first.search(helped)
    assert isinstance(running, Configuration)
    (loss,) = consequences(helped, running, Searches(Strategy.FIRST, steps=1).after)
    assert not loss.fatal
    assert str(loss) == "lost (user): not decided"
    (loss,) = consequences(helped, running, Searches(Strategy.FIRST).after)
    assert str(loss) == "lost (user): own"


def test_a_player_that_would_be_recruited_is_named() -> None:
    lamp, spare = component("lamp", outputs="o:Light"), component("spare", outputs="o:Light")
    plain = problem({"eye": [component("eye", "i:Light")], "hall": [lamp]}, counts={"hall": (0, 1)})
    roles = tuple(replace(role, recruits=role.iri.short == "eye") for role in plain.roles)
    given_ = Problem(
        replace(plain.task, template=replace(plain.task.template, roles=roles)),
        replace(plain.partition, recruits=(Recruit(spare, frozenset({0})), Recruit(lamp, frozenset({0})))),
    )
    search = Searches(Strategy.FIRST)
    *_, running = search.answers(given_)
    assert isinstance(running, Configuration)
    said = {loss.component.short: str(loss) for loss in consequences(given_, running, search.after)}
    assert said["spare"] == "spare (recruit): lamp as recruit"
