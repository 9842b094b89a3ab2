"""Which components are asked for, how few of them, and what they are to issue."""

from __future__ import annotations

from dataclasses import replace

from selfconf.model.profile import Condition
from selfconf.model.refusal import Refusal
from selfconf.model.relaxation import AddComponents
from selfconf.search.relaxations.components_to_add import wanted_of
from selfconf.search.relaxations.relaxations import with_relaxations
from selfconf.search.strategies import first
from tests.search.worlds import component, iri, problem


def test_an_output_that_is_not_needed_is_not_asked_for() -> None:
    minds = [component("deaf", "p:Pose b:Bump"), component("cap", "p:Pose")]
    given_ = problem({"sensor": [], "control": minds}, "sensor>control")
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    words = [str(one) for one in with_relaxations(given_, refused).repairs]
    assert words[0] == "add one more component for the role sensor that issues Pose"


def test_what_is_issued_in_another_unit_is_asked_of_the_role_that_issues_it() -> None:
    sorter = component("sorter", "i:Image k:Kilos")
    image, kilos = sorter.ports.inputs
    inputs = (image, kilos._replace(condition=Condition(accepts="in pounds")))
    given_ = problem(
        {
            "eye": [component("eye", outputs="i:Image")],
            "scale": [component("scale", outputs="k:Kilos")],
            "sort": [replace(sorter, ports=sorter.ports._replace(inputs=inputs))],
        },
        "eye>sort scale>sort",
    )
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    (added,) = (str(one) for one in with_relaxations(given_, refused).repairs if isinstance(one, AddComponents))
    assert added == "add one more component for the role scale that issues Kilos as the sc:accepts of its input asks"


def test_what_one_addition_issues_is_not_asked_of_another() -> None:
    given_ = problem(
        {"a": [], "b": [], "control": [component("cap", "p:Pose")], "drive": [component("car", "v:Velocity")]},
        "a>control b>drive b>control",
    )
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    words = [str(one) for one in with_relaxations(given_, refused).repairs]
    each = "one more component for the role {} that issues {}"
    assert words[0] == f"add {each.format('a', 'Pose')} and {each.format('b', 'Velocity')}"


def test_an_output_that_is_asked_for_by_name_has_one_signal() -> None:
    given_ = problem(
        {"a": [], "b": [component("b1", "x:X y:Y")]},
        "a.out>b",
    )
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    # One output cannot issue both, and a component has one of that name: no component for `a` alone will do.
    words = [str(one) for one in with_relaxations(given_, refused).repairs]
    assert words == ["add one more component for the role a and one more component for the role b"]


def test_two_that_are_lacking_for_one_role_may_issue_different_signals_by_one_output() -> None:
    given_ = problem({"a": [], "b": [component("b1", "x:X y:Y")]}, "a.out>b", {"a": (2, 2)})
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    added = [one for one in with_relaxations(given_, refused).repairs if isinstance(one, AddComponents)]
    each = "one more component for the role a that issues {} by the output 'out'"
    assert str(added[0]) == f"add {each.format('X')} and {each.format('Y')}"


def test_what_has_to_leave_by_an_output_says_so() -> None:
    given_ = problem(
        {"a": [], "b": [component("b1", "x:X y:Y")], "c": []},
        "a.out>b c>b c>a",
    )
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    added = next(one for one in with_relaxations(given_, refused).repairs if isinstance(one, AddComponents))
    each = "one more component for the role {} that issues {}"
    assert str(added) == f"add {each.format('a', 'X')} by the output 'out' and {each.format('c', 'Y')}"
    given_ = problem({"a": [], "b": [component("b1", "x:X")]}, "a.out>b")
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    assert "add one more component for the role a that issues X by the output 'out'" in [
        str(one) for one in with_relaxations(given_, refused).repairs
    ]


def test_no_operation_is_asked_to_feed_an_input_and_no_output_to_answer_a_call() -> None:
    given_ = problem({"a": [], "b": [component("b1", "x:X")]}, "a.ask()>b")
    assert list(wanted_of(given_, 0)) == [()]


def test_signals_of_one_name_leave_by_outputs_of_different_names() -> None:
    given_ = problem({"a": [], "b": [component("b1", "x:one/X y:two/X")]}, "a>b")
    assert [[o.name for o in outputs] for outputs in wanted_of(given_, 0)] == [["X", "X2"]]


def test_candidates_that_could_not_be_fed_count_for_none() -> None:
    deaf, other = component("deaf", "x:X"), component("other", "y:Y z:Z")
    given_ = problem(
        {"a": [deaf, other], "b": [deaf, other], "c": [deaf, other]}, "c.out>b", {"a": (2, 2), "c": (3, 3)}
    )
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    added = next(one for one in with_relaxations(given_, refused).repairs if isinstance(one, AddComponents))
    assert str(added) == (
        "add 2 more components for the role a and 3 more components for the role c that issue X by the output 'out'"
    )


def test_an_addition_names_the_value_that_the_others_leave() -> None:
    sonar, drive = component("sonar"), component("drive")
    given_ = problem(
        {"sonar": [sonar], "drive": [drive]},
        values={"sonar": {"sonar": 0b01}, "drive": {"drive": 0b10}},
        domain=["astrid", "pippi"],
    )
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    words = [str(one) for one in with_relaxations(given_, refused).repairs]
    assert words[0] == "add one more component for the role sonar, with robot pippi"


def test_additions_that_differ_in_what_they_state_are_put_in_order() -> None:
    inches = component("b", "i:S")
    port = inches.inputs[0]._replace(condition=Condition(unit=iri("IN")))
    given_ = problem(
        {
            "a": [component("x")],
            "b": [component("c", "i:S j:T"), replace(inches, ports=inches.ports._replace(inputs=(port,)))],
        },
        "a.o>b",
    )
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    assert with_relaxations(given_, refused).repairs


def test_an_output_that_is_to_conform_to_a_shape_is_not_taken_to_have_the_unit_that_another_input_asks_for() -> None:
    both = component("x", "p:S q:S")
    asking = Condition(unit=iri("CentiM")), Condition(accepts="in metres")
    inputs = tuple(port._replace(condition=one) for port, one in zip(both.inputs, asking, strict=True))
    given_ = problem({"src": [], "sink": [replace(both, ports=both.ports._replace(inputs=inputs))]}, "src>sink")
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    (added,) = (str(one) for one in with_relaxations(given_, refused).repairs if isinstance(one, AddComponents))
    signals = "S in CentiM and S as the sc:accepts of its input asks"
    assert added == f"add one more component for the role src that issues {signals}"


def test_an_addition_names_the_value_that_matters_to_its_role_though_no_candidate_states_one() -> None:
    given_ = problem(
        {"sonar": [component("sonar")], "drive": [component("drive")]},
        counts={"drive": (2, None)},
        values={"sonar": {"sonar": 0b01}},
        domain=["astrid", "pippi"],
    )
    refused = first.search(given_)
    assert isinstance(refused, Refusal)
    words = [str(one) for one in with_relaxations(given_, refused).repairs]
    assert words[0] == "add one more component for the role drive, with robot astrid"
