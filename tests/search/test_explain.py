"""The reasons of a refusal: which ones are found, how they are worded, and the ports that were misnamed."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given

import selfconf
from benchmarks.search.families.puzzles import pigeonholes
from selfconf.composition import Strategy
from selfconf.composition.searches import Searches
from selfconf.model.refusal import InputUnfed, MisnamedPort, Refusal
from selfconf.search import explain
from selfconf.search.problem import Problem
from selfconf.search.reduction import LazyReduction
from selfconf.search.strategies import first
from tests.lab import PREFIXES
from tests.search.oracle import World
from tests.search.possibility import possible
from tests.search.recruiting.test_recruiting import with_recruits
from tests.search.without_solvers import without_solvers
from tests.search.worlds import agreement, component, problem, problems


def _check(problem: Problem) -> None:
    refused = first.search(problem)
    if not isinstance(refused, Refusal):
        return
    assert refused.irreducible
    assert refused.reasons
    world = World(problem.task, problem.partition, problem.hierarchy)
    for reason in refused.reasons:
        assert str(reason)
        assert reason.code
        assert reason.role in {role.iri for role in problem.roles}
        assert not possible(world, reason.requirements)
        for dropped in reason.requirements:
            assert possible(world, [r for r in reason.requirements if r != dropped]), (reason, dropped)


@given(problems(roles=3, components=4))
@agreement()
def test_a_reason_is_irreducible(problem: Problem) -> None:
    _check(problem)


def test_roles_that_are_crowded_because_of_what_a_third_could_feed_are_no_reason_alone() -> None:
    everyone = [component("c0"), component("c1", "p:S"), component("c2", "p:S")]
    roles = {"r0": everyone, "r1": everyone, "r2": everyone}
    _check(problem(roles, "r0>r0 r0>r1 r0>r2 r1>r0 r2>r0"))


def test_no_reason_is_called_the_smallest_where_what_recruits_could_feed_may_be_part_of_a_smaller_one() -> None:
    roles = {
        "needy": [component("a", "x:X"), component("b", "y:Y"), component("c", "z:Z")],
        "pair": [component("supplier", "s:S", "s:S"), component("user", "s:S")],
    }
    # Four requirements; three would do: the only supplier has to play for the pair, as one of two components.
    helped = with_recruits(problem(roles, counts={"pair": (2, 2)}), roles["pair"][0])
    refused = first.search(helped)
    assert isinstance(refused, Refusal)
    (reason,) = refused.reasons
    assert len(reason.requirements) == 4
    assert refused.minimality == "irreducible"


@given(problems(roles=3, components=4))
@agreement(0.2)
def test_a_reason_is_irreducible_without_a_solver_library(problem: Problem) -> None:
    with without_solvers():
        _check(problem)


def test_the_cause_comes_first_and_then_what_follows_from_it() -> None:
    given_ = problem(
        {
            "sonar": [component("bumper", outputs="o:Bump")],
            "control": [component("cap", "scan:RangeScan", "v:Velocity")],
            "drive": [component("wheels", "v:Velocity")],
        },
        "sonar>control control>drive",
    )
    (reason,) = first.search(given_).reasons
    assert reason.code == "input-unfed"
    assert str(reason).startswith("the input 'scan' (RangeScan) of cap cannot be fed: no candidate of sonar issues")


@pytest.mark.parametrize(
    ("caps", "words"),
    [
        (["b"], "b cannot play the role control"),
        (["b", "c"], "b and one other cannot play the role control"),
        (["b", "c", "d"], "b and 2 others cannot play the role control"),
    ],
)
def test_components_that_cannot_play_for_the_same_cause_are_counted(caps: list[str], words: str) -> None:
    given_ = problem(
        {
            "sonar": [component("bumper", outputs="o:Bump")],
            "position": [component("gps", "scan:RangeScan", "p:Pose"), component("clock", outputs="t:Time")],
            "control": [component(name, "pose:Pose") for name in caps],
        },
        "sonar>position position>control",
    )
    answer = first.search(given_)
    assert isinstance(answer, Refusal)
    (reason,) = answer.reasons
    cause = "the input 'scan' (RangeScan) of gps cannot be fed: no candidate of sonar issues a RangeScan for it"
    assert str(reason) == f"{cause}; so {words}, as no component left in position issues a Pose"


def test_a_component_that_cannot_play_for_another_cause_is_not_counted() -> None:
    given_ = problem(
        {
            "sonar": [component("bumper", outputs="o:Bump")],
            "position": [component("gps", "scan:RangeScan", "p:Pose"), component("clock", outputs="t:Time")],
            "control": [
                component("b", "pose:Pose"),
                component("c", "pose:Pose", "v:Velocity"),
                component("d", "h:Heat"),
            ],
        },
        "sonar>position position>control",
    )
    answer = first.search(given_)
    assert isinstance(answer, Refusal)
    (reason,) = answer.reasons
    assert "b and one other cannot play the role control, as no component left in position issues a Pose" in str(reason)


def test_a_source_with_a_minimum_of_zero_is_not_said_to_issue_nothing() -> None:
    """Nor that it was not asked for a component: it was, and what issues the signal cannot be fed itself."""
    given_ = problem(
        {
            "sonar": [component("ring", "power:Power", "scan:RangeScan")],
            "bumper": [component("skirt", outputs="o:Bump")],
            "control": [component("cap", "scan:RangeScan", "v:Velocity")],
        },
        "sonar>control bumper>control",
        {"sonar": (0, 1)},
    )
    *_, answer = Searches(Strategy.FIRST).answers(given_)
    assert isinstance(answer, Refusal)
    (reason,) = answer.reasons
    nothing, unplayed = "no candidate of bumper issues a RangeScan for it", "cannot play the optional role sonar"
    cause = f"{nothing}, and what could serve it {unplayed} (sc:minCount 0)"
    assert str(reason) == f"the input 'scan' (RangeScan) of cap cannot be fed: {cause}"


def test_explaining_that_ends_before_all_is_asked_says_so() -> None:
    crowded = LazyReduction(pigeonholes(12, 11, seed=1))
    stopped = explain.refusal(crowded, steps=3_000)
    assert (stopped.irreducible, stopped.minimality) == (False, "unproved")
    assert stopped.reasons


CAMERA = """
:camera a sc:Component, :Camera ; sc:hasOutput [ sc:name "picture" ; sc:signalType :Image ] ;
    sc:hasOperation [ sc:name "describe" ; sc:response :Words ] .
"""
SCREEN = ':screen a sc:Component, :Screen ; sc:hasInput [ sc:name "shown" ; sc:signalType :Image ] .'
BELL = ':bell a sc:Component, :Screen ; sc:needsOperation [ sc:name "look" ; sc:response :Words ] .'


def misnamed(folder: Path, sink: str, ports: str) -> MisnamedPort | None:
    """What is said of the ports of the only interaction of a task that is refused."""
    template = (
        ":t a sc:Template ; sc:roles ( :eye :face ) . :eye a sc:Role ; sh:class :Camera ."
        f" :face a sc:Role ; sh:class :Screen . [] a sc:Interaction ; sc:from :eye ; sc:to :face ; {ports} ."
    )
    (folder / "t.ttl").write_text(PREFIXES + template)
    refused = selfconf.configure(selfconf.template(folder / "t.ttl"), selfconf.read(PREFIXES + CAMERA + sink))
    assert isinstance(refused, selfconf.Refusal)
    (reason,) = refused.reasons
    assert isinstance(reason, InputUnfed)
    said = "" if reason.misnamed is None else f"; {reason.misnamed}"
    assert str(reason).endswith(said)
    return reason.misnamed


def test_where_no_name_is_like_the_one_of_an_interaction_all_that_there_are_are_told(tmp_path: Path) -> None:
    found = misnamed(tmp_path, SCREEN, 'sc:output "left"')
    assert str(found) == (
        'no candidate of eye has the output "left" that an interaction names (there are "describe()" and "picture")'
    )


def test_of_an_interaction_with_another_input_only_a_name_that_was_probably_meant_is_told(tmp_path: Path) -> None:
    both = SCREEN.replace("sc:hasInput", 'sc:hasInput [ sc:name "second" ; sc:signalType :Words ; sc:optional true ] ,')
    assert misnamed(tmp_path, both, 'sc:output "left" ; sc:input "second"') is None
    assert misnamed(tmp_path, both, 'sc:output "pictur" ; sc:input "second"') is not None


@pytest.mark.parametrize(
    ("sink", "ports", "kind", "named", "meant"),
    [
        (BELL, 'sc:output "describe"', "output", "describe", "describe()"),
        (BELL, 'sc:output "descibe()"', "output", "descibe()", "describe()"),
        (BELL, 'sc:input "look"', "input", "look", "look()"),
        (SCREEN, 'sc:output "pictrue"', "output", "pictrue", "picture"),
        (SCREEN, 'sc:output "Picture"', "output", "Picture", "picture"),
        (SCREEN, 'sc:output "picture()"', "output", "picture()", "picture"),
        (SCREEN, 'sc:output "picture" ; sc:input "show"', "input", "show", "shown"),
    ],
)
def test_a_name_that_was_probably_meant_is_proposed(
    tmp_path: Path, sink: str, ports: str, kind: str, named: str, meant: str
) -> None:
    found = misnamed(tmp_path, sink, ports)
    assert found is not None
    assert (found.kind, found.named, found.meant) == (kind, named, meant)
    assert str(found) == (
        f'no candidate of {"eye" if kind == "output" else "face"} has the {kind} "{named}" that an interaction names'
        f' (did you mean "{meant}"?)'
    )


def test_no_other_name_is_proposed_where_a_candidate_has_it(tmp_path: Path) -> None:
    assert misnamed(tmp_path, SCREEN, 'sc:output "describe()"') is None


def test_of_a_source_with_a_minimum_of_zero_that_issues_nothing_fitting_that_is_told() -> None:
    given_ = problem(
        {
            "bumper": [component("skirt", outputs="o:Bump")],
            "sonar": [],
            "control": [component("cap", "scan:RangeScan", "v:Velocity")],
        },
        "bumper>control sonar>control",
        {"bumper": (0, 1), "sonar": (0, 1)},
    )
    (reason,) = first.search(given_).reasons
    cause = "no candidate of bumper and sonar issues a RangeScan for it"
    assert str(reason) == f"the input 'scan' (RangeScan) of cap cannot be fed: {cause}"


PRESS = ':bell a sc:Component, :Button ; {} [ sc:name "{}" ] . :eye a sc:Component, :Camera ; {} [ sc:name "said" ] .'


@pytest.mark.parametrize(
    ("needed", "offered", "cannot"),
    [
        ("sc:hasInput", "sc:hasOutput", "the input 'words' (signal without a type) of bell cannot be fed"),
        ("sc:needsOperation", "sc:hasOperation", "the operation 'words' that bell needs cannot be called"),
    ],
)
@pytest.mark.parametrize("recruits", ["", "; sc:recruits true"])
def test_of_a_port_without_a_type_it_is_told_that_an_interaction_has_to_name_both(
    tmp_path: Path, needed: str, offered: str, cannot: str, recruits: str
) -> None:
    template = (
        ":t a sc:Template ; sc:roles ( :from :to ) . :from a sc:Role ; sh:class :Camera ; sc:feeds :to ."
        f" :to a sc:Role ; sh:class :Button {recruits} ."
    )
    (tmp_path / "t.ttl").write_text(PREFIXES + template)
    home = selfconf.read(PREFIXES + PRESS.format(needed, "words", offered))
    refused = selfconf.configure(selfconf.template(tmp_path / "t.ttl"), home)
    assert isinstance(refused, selfconf.Refusal)
    assert [str(one) for one in refused.reasons] == [
        f"{cannot}: it states no type, and no sc:Interaction names both ports"
    ]


def test_of_a_further_component_with_a_port_without_a_type_it_is_told_as_well(tmp_path: Path) -> None:
    template = (
        ":t a sc:Template ; sc:roles ( :from :to ) . :from a sc:Role ; sh:class :Camera ; sc:feeds :to ."
        " :to a sc:Role ; sh:class :Button ."
    )
    (tmp_path / "t.ttl").write_text(PREFIXES + template)
    # Of different frames, so that they are two needs.
    bells = [f':{one} a sc:Component, :Button ; sc:hasInput [ sc:name "{one}" ; sc:frame "{one}" ] .' for one in "ab"]
    eye = ':eye a sc:Component, :Camera ; sc:hasOutput [ sc:name "seen" ] .'
    refused = selfconf.configure(selfconf.template(tmp_path / "t.ttl"), selfconf.read(PREFIXES + eye + "".join(bells)))
    assert isinstance(refused, selfconf.Refusal)
    _, further = str(refused.reasons[0]).split("; so ")
    assert (
        further == "a cannot play the role to, as its input 'a' states no type, and no sc:Interaction names both ports"
    )
