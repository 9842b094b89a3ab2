"""The problems that a reader should know first, worked through."""

from __future__ import annotations

import sys
from dataclasses import replace

import pytest

from selfconf.configuration_certificate import broken_conditions
from selfconf.model.configuration import Configuration, Connection
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.template import Parameter, Setting
from selfconf.search.problem import Problem
from selfconf.search.strategies import first, paper
from tests.search.worlds import component, iri, problem

SCAN, ODOMETRY, POSE, VELOCITY = "scan:RangeScan", "odometry:Odometry2D", "pose:PlanarPose2D", "velocity:Velocity2D"


def configured(problem: Problem) -> Configuration:
    """The first configuration of a problem that has one, accepted by the certificate."""
    answer = first.search(problem)
    assert isinstance(answer, Configuration), answer
    assert broken_conditions(problem.task, problem.partition, answer, problem.hierarchy) == []
    return answer


def navigation(*positions: str) -> Problem:
    """The template of figure 7 with these position sensors."""
    return problem(
        {
            "sonar": [component("sonars", outputs=SCAN)],
            "encoder": [component("encoders", outputs=ODOMETRY)],
            "position": [component(name, outputs=POSE) for name in positions],
            "control": [component("thinking-cap", f"{SCAN} {POSE} {ODOMETRY}", VELOCITY)],
            "drive": [component("wheels", VELOCITY)],
        },
        "sonar>control encoder>control position>control control>drive",
    )


def test_the_person_tracker_is_chosen_as_it_is_tried_first() -> None:
    answer = configured(navigation("person-tracker", "absolute-odometry"))
    assert [c.short for c in answer.components] == ["sonars", "encoders", "person-tracker", "thinking-cap", "wheels"]
    assert Connection(iri("person-tracker"), "pose", iri("thinking-cap"), "pose") in answer.connections
    assert len(answer.connections) == 4


def test_without_the_tracker_the_rest_stays_and_odometry_plays_its_role() -> None:
    given = navigation("person-tracker", "absolute-odometry")
    left = Problem(given.task, given.partition.without(frozenset({iri("person-tracker")})))
    assert [c.short for c in configured(left).components][2] == "absolute-odometry"


def test_two_roles_may_share_their_candidates() -> None:
    """The first erratum: as printed, Function 2 drops the second speaker as soon as the first is played."""
    speakers = [component("left", "s:Audio"), component("right", "s:Audio")]
    given = problem(
        {"tuner": [component("tuner", outputs="s:Audio")], "one": speakers, "other": speakers}, "tuner>one tuner>other"
    )
    assert [c.short for c in configured(given).components] == ["tuner", "left", "right"]
    assert paper.algorithm_1(given) == first.search(given)


def test_one_more_role_than_shared_candidates_is_too_many() -> None:
    speakers = [component("left"), component("right")]
    answer = first.search(problem({"a": speakers, "b": speakers, "c": speakers}))
    assert isinstance(answer, Refusal)
    assert str(answer.reasons[0]) == (
        "the roles a, b and c together ask for 3 different components, and only 2 are eligible"
    )


def test_a_tuner_plays_to_every_speaker_there_is() -> None:
    speakers = [component(f"speaker{k}", "s:Audio") for k in range(5)]
    given = problem(
        {"tuner": [component("tuner", outputs="s:Audio")], "speaker": speakers},
        "tuner>speaker",
        counts={"speaker": (1, None)},
    )
    answer = configured(given)
    assert len(answer.assignments[1].components) == 5
    assert len(answer.connections) == 5


def test_any_robot_will_do_if_all_components_share_it() -> None:
    given = problem(
        {
            "sonar": [component("sonar-a", outputs=SCAN), component("sonar-b", outputs=SCAN)],
            "drive": [component("drive-b", SCAN)],
        },
        "sonar>drive",
        values={"sonar": {"sonar-a": 0b01, "sonar-b": 0b10}, "drive": {"drive-b": 0b10}},
        domain=("Astrid", "Pippi"),
    )
    answer = configured(given)
    assert [c.short for c in answer.components] == ["sonar-b", "drive-b"]
    assert answer.bindings == {"robot": iri("Pippi")}


def test_roles_without_a_robot_in_common_are_the_reason() -> None:
    given = problem(
        {"sonar": [component("sonar-a")], "drive": [component("drive-b")]},
        values={"sonar": {"sonar-a": 0b01}, "drive": {"drive-b": 0b10}},
        domain=("Astrid", "Pippi"),
    )
    answer = first.search(given)
    assert isinstance(answer, Refusal)
    assert str(answer.reasons[0]) == "the roles sonar and drive cannot all be played with one robot for all"


def formula(*clauses: str) -> Problem:
    """A formula as one sink: a feeder role per letter, an input per clause; small letters are negated."""
    letters = sorted({letter.upper() for clause in clauses for letter in clause})
    roles = {
        letter: [
            component(
                f"{letter}-{truth}",
                outputs=" ".join(
                    f"o{k}:clause{k}" for k, c in enumerate(clauses) if (letter if truth else letter.lower()) in c
                ),
            )
            for truth in (True, False)
        ]
        for letter in letters
    }
    roles["sink"] = [component("sink", " ".join(f"i{k}:clause{k}" for k in range(len(clauses))))]
    return problem(roles, " ".join(f"{letter}>sink" for letter in letters))


def test_a_configuration_of_the_3_sat_template_satisfies_the_formula() -> None:
    answer = configured(formula("ABC", "aBc", "Abc", "abC"))
    assert [c.short for c in answer.components[:3]] == ["A-True", "B-True", "C-True"]
    answer = configured(formula("aBc", "ab", "AC"))
    assert [c.short for c in answer.components[:3]] == ["A-True", "B-False", "C-False"]


def test_a_formula_that_cannot_be_satisfied_is_refused_with_the_clauses_that_clash() -> None:
    answer = first.search(formula("A", "a", "BC", "bC"))
    assert isinstance(answer, Refusal)
    (reason,) = answer.reasons
    assert {str(r) for r in reason.requirements} == {
        "sink is played",
        "sink gets the clause0 that it needs",
        "sink gets the clause1 that it needs",
    }


def test_roles_that_feed_each_other_are_played_if_they_can_be() -> None:
    cycle = {"a": [component("x", "i:S", "o:T")], "b": [component("y", "i:T", "o:S")]}
    assert len(configured(problem(cycle, "a>b b>a")).connections) == 2
    assert isinstance(first.search(problem(cycle, "a>b")), Refusal)


def test_an_empty_ecology_and_an_empty_template_have_clear_answers() -> None:
    empty = first.search(problem({"a": [], "b": []}))
    assert isinstance(empty, Refusal)
    assert [reason.code for reason in empty.reasons] == ["too-few-eligible"] * 2
    assert configured(problem({})).components == ()


def test_a_role_that_asks_for_more_than_it_allows_is_a_contradiction() -> None:
    answer = first.search(problem({"a": [component("x"), component("y")]}, counts={"a": (2, 1)}))
    assert isinstance(answer, Refusal)
    assert answer.reasons[0].code == "contradictory-count"


def test_a_parameter_without_a_value_is_asked_for() -> None:
    given = problem({"a": [component("x")]})
    role = replace(given.roles[0], settings=(Setting(iri("Goal"), iri("goal")),))
    template = replace(
        given.task.template, roles=(role,), parameters=(Parameter(iri("goal"), "goal", in_shape=True, is_set=True),)
    )
    answer = first.search(Problem(replace(given.task, template=template), given.partition))
    assert isinstance(answer, Refusal)
    assert answer.reasons[0].code == "value-unknown"
    assert "bind goal" in str(answer.reasons[0])


def test_ten_thousand_roles_are_no_deeper_than_the_stack() -> None:
    size = 10 * sys.getrecursionlimit()
    roles = {f"r{k}": [component(f"c{k}", "i:S" if k else "", "o:S")] for k in range(size)}
    chain = " ".join(f"r{k}>r{k + 1}" for k in range(size - 1))
    assert len(configured(problem(roles, chain)).components) == size
    roles["r1"] = [component("c1", "i:T", "o:S")]
    answer = first.search(problem(roles, chain))
    assert isinstance(answer, Refusal)
    assert answer.reasons[0].role == iri("r1")


@pytest.mark.usefixtures("no_solvers")
def test_steps_that_are_used_up_are_no_refusal() -> None:
    tangled = formula("ABC", "ABc", "AbC", "Abc", "aBC", "aBc", "abC", "abc")
    assert [*map(type, first.answers(tangled, 3))] == [Undecided]
    assert [*map(type, first.answers(tangled, 100_000))] == [Refusal, Refusal]
