"""How components are: what they say themselves, and what is passed over of what strangers say."""

from __future__ import annotations

from dataclasses import replace

from selfconf.api.living.component_states import (
    ComponentState,
    component_states,
    doubled,
    issue_rates,
    told_lives,
    unadvertised,
)
from selfconf.bus.port import Replies, Sample
from selfconf.discovery import Discovery, FoundAdvertisement
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import CallAnswer, Verdict, Wire
from selfconf.rdf.advertisements import read_advertisements

KEYS = Keys("lab")
CLOCK, LAMP = IRI("https://example.org/x#clock"), IRI("https://example.org/x#lamp")
TEXT = """\
@prefix : <https://example.org/x#> .
@prefix sc: <https://w3id.org/selfconf#> .
:clock a sc:Component, :Clock . :lamp a sc:Component, :Lamp .
"""
FOUND = {
    one.component: FoundAdvertisement(one, "home", "a.ttl", one.component == LAMP)
    for one in read_advertisements(TEXT.encode(), "a.ttl")[0]
}


def states(*samples: Sample) -> dict[IRI, ComponentState]:
    found = component_states(Discovery(found=FOUND), told_lives(KEYS, Replies(samples)))
    return {one.component: one for one in found}


def answer(component: IRI, life: str = "b", task: str = "t~1", key: str = "", place: str = "process 1 on a") -> Sample:
    said = CallAnswer(Verdict.DONE, component, life, 1, True, task=task, place=place, age=2.5, memory=9)
    return Sample(key or KEYS.call(component, "state"), encode(said))


def test_what_a_component_says_is_its_state_and_the_others_are_dormant_or_absent() -> None:
    found = states(answer(CLOCK))
    assert found[CLOCK] == ComponentState(
        CLOCK, (IRI("https://example.org/x#Clock"),), "home", "alive", True, "t", "process 1 on a", 2.5, 9, {}, {}, "b"
    )
    assert (found[LAMP].state, found[LAMP].life, found[LAMP].age) == ("dormant", "", 0.0)
    assert states()[CLOCK].state == "absent"


def test_of_two_sites_of_one_name_each_component_names_its_own() -> None:
    lives = {CLOCK: "1", LAMP: "2"}
    found = {component: replace(one, site_life=lives[component]) for component, one in FOUND.items()}
    told = told_lives(KEYS, Replies((answer(CLOCK),)))
    both = {one.component: one for one in component_states(Discovery(found, ("home (1)", "home (2)")), told)}
    assert {component: one.site for component, one in both.items()} == {CLOCK: "home (1)", LAMP: "home (2)"}
    assert both[LAMP].body()["site"] == "home (2)"
    assert {one.site for one in component_states(Discovery(found, ("home",)), told)} == {"home"}


def test_a_component_that_has_not_come_to_rest_is_shown_as_stopping() -> None:
    said = CallAnswer(Verdict.DONE, CLOCK, "b", 1, stopping=True)
    found = states(Sample(KEYS.call(CLOCK, "state"), encode(said)))[CLOCK]
    assert (found.state, found.stopping, found.shown) == ("alive", True, "stopping")
    assert found.body()["stopping"] is True
    assert (states()[CLOCK].stopping, states()[CLOCK].shown) == (False, "absent")


def test_of_two_lives_the_smaller_one_counts_and_what_is_no_answer_is_passed_over() -> None:
    assert states(answer(CLOCK, "b"), answer(CLOCK, "a"))[CLOCK].life == "a"
    assert states(answer(CLOCK, "a"), answer(CLOCK, "b"))[CLOCK].life == "a"
    strangers = Sample("x", b"nothing"), answer(CLOCK, key=KEYS.call(LAMP, "state"))
    assert {one.state for one in states(*strangers).values()} == {"absent", "dormant"}


def test_a_component_that_is_several_processes_is_named_with_each_of_them() -> None:
    first, other, unplaced = (
        answer(CLOCK, "a"),
        answer(CLOCK, "b", place="process 2 on a"),
        answer(CLOCK, "c", place=""),
    )
    told = told_lives(KEYS, Replies((unplaced, first, other, first, answer(LAMP))))
    (said,) = doubled(told)
    assert said.startswith(f"{CLOCK} is process 1 on a, and process 2 on a and life c as well; ")


def test_a_component_that_lives_and_is_not_advertised_is_named() -> None:
    told = told_lives(KEYS, Replies((answer(CLOCK), answer(LAMP, task=""))))
    assert list(unadvertised(Discovery(found=FOUND), told)) == []
    assert list(unadvertised(Discovery(), told)) == [
        f"{CLOCK} lives, and the task t holds it, but no site advertises it",
        f"{LAMP} lives, but no site advertises it",
    ]
    assert list(unadvertised(Discovery(missing=("home",)), told)) == [], "home may advertise it"


def test_rates_are_taken_over_one_life() -> None:
    before = ComponentState(CLOCK, (), "home", "alive", issued={"time": 10}, life="a")

    def rates(now: ComponentState, seconds: float) -> dict[str, float]:
        return issue_rates([before], [now], seconds)[CLOCK]

    assert rates(before._replace(issued={"time": 14, "date": 2}), 2.0) == {"time": 2.0, "date": 1.0}
    assert rates(before._replace(life="b"), 2.0) == {}
    assert rates(before._replace(state="dormant"), 2.0) == {}
    assert rates(before, 0.0) == {}
    assert issue_rates([], [before], 2.0) == {CLOCK: {}}


def test_an_output_of_a_composite_issues_what_is_issued_for_it_inside() -> None:
    clock = ComponentState(CLOCK, (), "home", "alive", issued={"time": 10}, life="a")
    said = CallAnswer(
        Verdict.DONE, LAMP, "b", 1, True, issued={"light": 0, "dark": 0}, outputs={"light": (Wire(CLOCK, "time"),)}
    )
    composite = states(Sample(KEYS.call(LAMP, "state"), encode(said)))[LAMP]
    rates = issue_rates([clock, composite], [composite, clock._replace(issued={"time": 14})], 2.0)
    assert rates[LAMP] == {"light": 2.0, "dark": 0.0}
    assert issue_rates([composite], [composite], 2.0)[LAMP] == {"light": 0.0, "dark": 0.0}, "the clock is unknown"
