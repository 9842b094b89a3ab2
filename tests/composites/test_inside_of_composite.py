"""Composites: outside a component, inside a task of their site; repaired inside, and a FAIL only if that is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.api.task import template
from selfconf.composites import InsideOfComposite
from selfconf.composites.inside_of_composite import REPLACING
from selfconf.deployment.components.audits import AUDIT, Audits
from selfconf.discovery import EcologyView
from selfconf.errors import SelfconfError
from selfconf.model.run_event import ComponentActivated, ComponentLost, ComponentReleased, InputConnected
from selfconf.model.term import IRI
from selfconf.testing import MemoryEcology
from selfconf.testing.memory_ecology import ECOLOGY_NAME, REPORT_LAG
from tests.composites.composite_house import (
    CAMERA,
    NAVIGATOR,
    PORTS,
    PREFIXES,
    SERVED,
    SERVICE,
    TASK,
    TRACKER,
    House,
    Source,
    Tracker,
    lost,
)
from tests.lab import Lab


def test_signals_flow_straight_from_inside_to_outside_and_from_outside_to_inside() -> None:
    house = House()
    run = house.run(SERVICE)
    assert (house.navigator.pose, house.navigator.source) == (["t1", "c1", "h1"], "t1")
    assert house.acting() == {"c1", "t1", "h1"}
    connected = [e for e in run.events if isinstance(e, InputConnected) and e.sink.short == "nav"]
    assert [(event.source.short, event.output) for event in connected] == [("t1", "pose")]
    assert run.configuration is not None
    assert run.configuration.components == (IRI("urn:c:h1"), SERVED, IRI("urn:c:nav"))


def test_what_fails_inside_is_repaired_inside_and_the_task_outside_hears_nothing_of_it() -> None:
    house = House()
    run = house.run(SERVICE)
    known = len(run.events)
    house.crash("c1")
    assert house.navigator.pose == ["t1", "c2", "h1"]
    assert run.events[known:] == []
    assert house.acting() == {"c2", "t1", "h1"}


def test_who_follows_a_composite_is_told_when_another_component_stands_behind_its_output(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(Audits, "go_on", lambda audits: None)  # it is told, and does not find out
    house = House()
    run = house.run(SERVICE)
    house.crash("t1")
    assert (house.navigator.pose, house.navigator.source) == (["t2", "c1", "h1"], "t2")
    assert lost(run) == []
    assert house.navigator.active


def test_who_has_not_been_told_finds_out_when_the_composite_is_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    house = House()
    run = house.run(SERVICE)
    monkeypatch.setattr(InsideOfComposite, "_tell_moved", lambda inside: None)  # the notice is lost
    house.crash("t1")
    house.ecology.advance(AUDIT)
    assert (house.navigator.pose, house.navigator.source) == (["t2", "c1", "h1"], "t2")
    assert lost(run) == []


def test_an_output_is_told_to_lack_what_stood_behind_it_half_a_second_after_the_first_loss_inside() -> None:
    house = House()
    house.run(SERVICE)
    inside = house.ecology._composites.living[SERVED]
    assert inside.runner is not None
    for name in ("t1", "c1"):
        inside.runner.request.report(ComponentLost(IRI(f"urn:c:{name}"), "crash", ""))
        assert inside.issued["pose"]
        house.ecology.advance(0.6 * REPLACING)
    assert inside.issued == {"pose": ()}


def test_what_an_inside_reports_late_says_nothing_of_the_one_that_runs_now() -> None:
    house = House()
    run = house.run(SERVICE)
    inside = house.ecology._composites.living[SERVED]
    assert inside.runner is not None
    before = inside.runner.request
    run.stop()
    house.ecology.run(template(TASK)).started()
    before.report(ComponentReleased(IRI("urn:c:t1"), "", ""))
    house.ecology.advance(2 * REPLACING)
    assert inside.issued["pose"]


def test_an_output_that_falls_silent_inside_is_repaired_inside() -> None:
    """It is noticed outside, by who follows it."""
    rate = "sc:signalType :Pose ; sc:rate [ sc:value 10 ; sc:unit <http://qudt.org/vocab/unit/HZ> ]"
    house = House(tracker=TRACKER.replace("sc:signalType :Pose", rate))
    run = house.run(SERVICE)
    tracker = house.by_name["t1"]
    assert isinstance(tracker, Tracker)
    tracker.mute = True
    house.ecology.advance(3.0)
    assert (house.navigator.pose, house.navigator.source) == (["t2", "c1", "h1"], "t2")
    assert lost(run) == []


@pytest.mark.parametrize("roles", [":positions :navigator", ":navigator :positions"])
def test_a_composite_in_a_loop_is_heard_whatever_comes_first(roles: str) -> None:
    output = '; sc:hasOutput [ sc:name "hint" ; sc:signalType :Hint ] .'
    house = House(navigator=NAVIGATOR.rstrip(" .") + output)
    task = TASK.replace(":hints :positions :navigator", roles).replace(
        ":hints a sc:Role ; sh:class :Hinter ; sc:feeds :positions .", ""
    )
    house.run(SERVICE, task=task.replace(":Nav .", ":Nav ; sc:feeds :positions ."))
    assert house.navigator.source == "t1"


def test_what_is_inside_follows_another_component_outside_when_the_first_is_lost() -> None:
    house = House()
    run = house.run(SERVICE)
    house.crash("h1")
    assert house.navigator.pose == ["t1", "c1", "h2"]
    assert lost(run) == [IRI("urn:c:h1")]


def test_when_the_inside_is_refused_the_composite_fails_with_the_reason() -> None:
    house = House(cameras="c1")
    run = house.run(SERVICE)
    house.crash("c1")
    house.ecology.advance(REPORT_LAG)
    (event,) = [event for event in run.events if isinstance(event, ComponentLost)]
    assert (event.component, event.cause) == (SERVED, "fail")
    assert event.detail == "its inside is refused: no component is eligible for the role eye"
    assert run.ended
    assert house.acting() == set()


def test_a_composite_says_what_is_wrong_with_the_search_for_its_inside() -> None:
    house = House()
    run = house.run(SERVICE)
    inside = house.ecology._composites.living[SERVED]
    assert inside.runner is not None
    inside.runner._give_up(SelfconfError("the shape of the role eye cannot be judged"))
    house.ecology.advance(3.0)
    assert [event.detail for event in run.events if isinstance(event, ComponentLost)] == [
        "its inside is refused: the shape of the role eye cannot be judged"
    ]


OPTIONAL_HINT = SERVICE.replace(":Hint ] ; sc:hasOutput", ":Hint ; sc:optional true ] ; sc:hasOutput", 1)
WITHOUT_HINT = TRACKER.replace(', [ sc:name "hint" ; sc:signalType :Hint ]', "")


def test_the_inside_is_configured_again_when_an_optional_input_gets_a_source_or_loses_it() -> None:
    # Of the trackers the first needs hints; the other one does without, and comes later by its IRI.
    house = House(trackers="t1", hinters="h1")
    house.by_name["u1"] = house.ecology.add(Tracker("u1"), WITHOUT_HINT.replace("NAME", "u1"))
    house.ecology.advertise(OPTIONAL_HINT)
    house.ecology.advance(2.0)
    run = house.ecology.run(template(TASK.replace(":hints a", ":hints sc:minCount 0 ; sc:maxCount 1 ; a"))).started()
    house.ecology.advance(1.0)
    assert (house.navigator.pose, house.acting()) == (["t1", "c1", "h1"], {"c1", "t1", "h1"})
    house.crash("h1")
    assert (house.navigator.pose, house.acting()) == (["u1", "c1", ""], {"c1", "u1"})
    assert lost(run) == [IRI("urn:c:h1")]
    assert run.running


def test_a_composite_fails_whose_inside_cannot_do_without_an_optional_input_that_nobody_feeds() -> None:
    house = House(hinters="")
    house.ecology.advertise(OPTIONAL_HINT)
    house.ecology.advance(2.0)
    run = house.ecology.run(template(TASK.replace(":hints a", ":hints sc:minCount 0 ; sc:maxCount 1 ; a")))
    assert house.ecology.until(lambda: run.ended)
    house.ecology.advance(REPORT_LAG)
    (event,) = [event for event in run.events if isinstance(event, ComponentLost)]
    assert event.component == SERVED
    assert event.detail.startswith("its inside is refused: the input 'hint' (Hint) of")
    assert not [event for event in run.events if isinstance(event, ComponentActivated) and event.component == SERVED]


def test_another_component_takes_the_place_of_a_composite_that_has_failed() -> None:
    house = House(cameras="c1")
    house.by_name["plain"] = house.ecology.add(
        Tracker("plain"),
        PREFIXES
        + f":z-plain a sc:Component, :Positions ; {PORTS} rdfs:label 'plain' .".replace("rdfs:label", ":label"),
    )
    run = house.run(SERVICE)
    house.crash("c1")
    assert run.running
    assert house.navigator.source == "z-plain"


def test_a_composite_that_is_released_brings_its_inside_to_rest() -> None:
    house = House()
    run = house.run(SERVICE)
    run.stop()
    house.ecology.advance(1.0)
    assert house.acting() == set()
    again = house.ecology.run(template(TASK)).started()
    assert again.running
    assert house.acting() == {"c1", "t1", "h1"}


OUTER = f"""{PREFIXES}
:whole a sc:Component, :Whole ; {PORTS} sc:grounding [ sc:template :wrap ] .
:wrap a sc:Template ; sc:roles ( :part ) ;
    sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ; sc:of :part ] ;
    sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ; sc:of :part ] .
:part a sc:Role ; sh:class :KIND ."""


def test_composites_nest_and_what_moves_inside_the_inner_one_is_told_outside_the_outer_one() -> None:
    house = House()
    outer = OUTER.replace(":KIND", ":Positions").replace(":Whole", ":Nested")
    for text in (SERVICE, outer):
        house.ecology.advertise(text)
    house.ecology.advance(2.0)
    run = house.ecology.run(template(TASK.replace(":Positions", ":Nested"))).started()
    house.ecology.advance(1.0)
    assert house.navigator.pose == ["t1", "c1", "h1"]
    house.crash("t1")
    assert house.navigator.pose == ["t2", "c1", "h1"]
    house.crash("h1")
    assert house.navigator.pose == ["t2", "c1", "h2"]
    assert lost(run) == [IRI("urn:c:h1")]
    house.crash("c1")
    house.crash("c2")
    (_, failed) = [event for event in run.events if isinstance(event, ComponentLost)]
    assert failed.detail.startswith("its inside is refused: no component is eligible for the role part")


def test_a_composite_is_not_inside_of_itself_where_something_else_can_be() -> None:
    house = House()
    outer = OUTER.replace(":KIND", ":Positions").replace(":Whole ;", ":Whole, :Positions ; sc:preference 9 ;")
    run = house.run(SERVICE, outer, task=TASK.replace(":Positions", ":Whole"))
    assert (run.running, house.navigator.source) == (True, "t1")


@pytest.mark.parametrize(
    ("texts", "sentence"),
    [
        ([OUTER.replace("KIND", "Whole")], "no component is eligible for the role part; it cannot be inside of itself"),
        (
            [
                OUTER.replace("KIND", "Other"),
                OUTER.replace("whole", "other").replace("Whole", "Other").replace("KIND", "Whole"),
            ],
            "it could be inside of itself (",
        ),
        ([SERVICE.replace(":Astrid", ":Pippi")], "now from what its site advertises: no component is eligible for"),
        ([SERVICE.replace("sc:parameter :robot ; sc:value", "sc:parameter :hat ; sc:value")], "which is no parameter"),
        ([SERVICE.replace(":localise", ":elsewhere", 1)], "is not in this file"),
        ([SERVICE.replace('"hint" ; sc:signalType :Hint ]', '"help" ; sc:signalType :Hint ]')], "differ: help, hint"),
        (
            [SERVICE.replace("sc:grounding", 'sc:hasParameter [ sc:name "a" ; sc:parameterType :A ] ; sc:grounding')],
            "its parameter 'a' is none of the template localise",
        ),
        (
            [SERVICE.replace("sc:grounding", 'sc:hasOperation [ sc:name "a" ] ; sc:grounding', 1)],
            "its outputs and those of the template localise differ: a()",
        ),
    ],
)  # fmt: skip
def test_a_composite_that_cannot_act_does_not_live_and_it_is_said_why(texts: list[str], sentence: str) -> None:
    house = House()
    for text in texts:
        house.ecology.advertise(text)
    house.ecology.advance(2.0)
    assert len(house.ecology.complaints) == len(texts)
    assert all(sentence in said for said in house.ecology.complaints)
    run = house.ecology.run(template(TASK.replace(":Positions", ":Whole") if "whole" in texts[0] else TASK))
    assert house.ecology.until(lambda: run.ended)
    assert house.acting() == set()


def test_a_composite_lives_as_soon_as_its_inside_can_be_configured() -> None:
    house = House(cameras="")
    house.ecology.advertise(SERVICE)
    house.ecology.advance(2.0)
    assert "its inside cannot be configured now from what its site advertises" in house.ecology.complaints[0]
    run = house.ecology.run(template(TASK), wait=True)
    house.ecology.advance(2.0)
    assert not run.running
    house.by_name["late"] = house.ecology.add(Source("late", "image"), CAMERA.replace("NAME", "late"))
    assert house.ecology.until(lambda: run.running)
    house.ecology.advance(1.0)
    assert house.navigator.pose == ["t1", "late", "h1"]


def test_the_inside_of_a_composite_sees_the_hierarchy_of_its_site(tmp_path: Path) -> None:
    ontology = tmp_path / "eyes.ttl"
    ontology.write_text(
        f"{PREFIXES}@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> . :Camera rdfs:subClassOf :Eye ."
    )
    wanted = SERVICE.replace("sh:class :Camera", "sh:class :Eye")
    for reasoning, complaints in (("syntactic", 1), ("subclass", 0)):
        house = House()
        house.ecology = MemoryEcology(ontologies=[ontology], reasoning=reasoning)
        house.ecology.add(Source("c1", "image"), CAMERA.replace("NAME", "c1"))
        house.ecology.add(Tracker("t1"), TRACKER.replace("NAME", "t1"))
        house.ecology.advertise(wanted)
        house.ecology.advance(2.0)
        assert len(house.ecology.complaints) == complaints


def test_an_ecology_is_told_why_a_composite_cannot_act_now() -> None:
    house = House(cameras="")
    house.ecology.advertise(SERVICE)
    house.ecology.advance(2.0)
    view = EcologyView(house.ecology.network.node(), ECOLOGY_NAME)
    told: list[str] = []

    def look() -> None:
        view.discover(lambda found: told.append(found.found[SERVED].unable))
        house.ecology.advance(1.0)

    look()
    assert told == [
        "its inside cannot be configured now from what its site advertises: no component is eligible for the role eye"
    ]
    house.by_name["late"] = house.ecology.add(Source("late", "image"), CAMERA.replace("NAME", "late"))
    house.ecology.advance(2.0)
    look()
    assert told[1:] == [""]


def test_a_composite_of_itself_through_two_sites_lives_at_neither(tmp_path: Path) -> None:
    bare = OUTER.removeprefix(PREFIXES).replace(":c:", ":peis-home:")
    other = bare.replace("whole", "other").replace("Whole", "Other").replace("KIND", "Whole").replace(":part", ":piece")
    lab = Lab(tmp_path, advertised={"whole": bare.replace("KIND", "Other"), "other": other})
    lab.site("first", "whole")
    lab.site("second", "other")
    lab.let_pass(3.0)
    assert [said.partition("configured now ")[2] for said in lab.complaints] == [
        "from what its site advertises: no component is eligible for the role part",
        "from what its site advertises: no component is eligible for the role piece",
    ]
