"""Several tasks in one ecology: which share a component, which wait, and which gives way to which."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.configurator.state import Phase
from selfconf.deployment import TaskRunner
from selfconf.deployment.components.audits import AUDIT
from selfconf.deployment.retries import TRY_AGAIN
from selfconf.model.configuration import Configuration
from selfconf.model.refusal import Refusal
from tests.deployment.simulated import slow_code
from tests.deployment.tasks import DRIVEN, SPARE, TASK, contended
from tests.lab import ADVERTISEMENTS, PREFIXES, Lab, iri

WATCH = PREFIXES + ":watch a sc:Template ; sc:roles ( :eye ) . :eye a sc:Role ; sh:class rob:PositionSensor ."


def test_two_tasks_share_a_component_that_takes_no_orders_and_it_acts_until_both_have_let_go(lab: Lab) -> None:
    first = lab.agent()
    lab.running(first)
    second = lab.agent(WATCH, bound=())
    assert lab.running(second)
    assert lab.active() == TASK | {"tracker"}
    first.stop()
    lab.let_pass(1.0)
    assert lab.active() == {"tracker"}
    assert lab.components["tracker"].said == [("started",)]
    second.stop()
    lab.let_pass(1.0)
    assert lab.active() == set()
    tracker = [event.holder for event in lab.acts("released") if event.component == iri("person-tracker")]
    assert tracker == ["watch", ""]


def test_two_tasks_use_different_components_where_one_cannot_be_shared(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("tracker", "odometry"):
        alone = ADVERTISEMENTS[name].replace(" ;", " ; sc:shareable false ;", 1)
        monkeypatch.setitem(ADVERTISEMENTS, name, alone)
    lab = Lab(tmp_path)
    lab.navigation()
    first = lab.agent()
    lab.running(first)
    assert lab.running(lab.agent(WATCH, bound=()))
    assert lab.active() == TASK | {"tracker", "odometry"}
    first.stop()
    lab.let_pass(1.0)
    assert lab.active() == {"odometry"}


def test_who_has_waited_longer_gets_whichever_candidate_is_free_first(tmp_path: Path) -> None:
    lab, holding = contended(tmp_path)
    early = lab.agent(DRIVEN, (), patient=True, name="early")
    lab.let_pass(TRY_AGAIN / 2)
    late = lab.agent(DRIVEN, (), patient=True, name="late")
    lab.let_pass(TRY_AGAIN / 4)
    holding[1].stop()
    lab.let_pass(TRY_AGAIN / 20)
    assert (early.state.phase, late.state.phase) == (Phase.RUNNING, Phase.REFUSED)
    assert set(early.state.held) == {iri("right")}
    early.stop()
    lab.let_pass(TRY_AGAIN / 20)
    assert set(late.state.held) == {iri("right")}


SHARED = {
    "oracle": ":oracle a sc:Component, :Oracle ; sc:shareable true ;"
    ' sc:hasParameter [ sc:name "goal" ; sc:parameterType :Goal ] ;'
    ' sc:hasOutput [ sc:name "says" ; sc:signalType :S ] .',
    "ear": ':ear a sc:Component, :Ear ; sc:shareable false ; sc:hasInput [ sc:name "in" ; sc:signalType :S ] .',
    "other-ear": ':other-ear a sc:Component, :Ear ; sc:hasInput [ sc:name "in" ; sc:signalType :S ] .',
}


ASKED = PREFIXES + (
    ":ask a sc:Template ; sc:parameter :goal ; sc:roles ( :oracle-role :ear-role ) ."
    ' :goal a sc:Parameter ; sc:name "goal" ; sh:datatype xsd:string . :ear-role a sc:Role ; sh:class :Ear .'
    " :oracle-role a sc:Role ; sh:class :Oracle ; sc:feeds :ear-role ;"
    " sc:sets [ sc:parameterType :Goal ; sc:value :goal ] ."
)


def asking(folder: Path) -> tuple[Lab, TaskRunner]:
    """An ecology in which a task has an oracle that it has given a value, and that task."""
    lab = Lab(folder, advertised=SHARED)
    lab.site("shared", *SHARED)
    for name in SHARED:
        lab.component(name)
    first = lab.agent(ASKED, (("goal", "x"),), name="first")
    assert lab.running(first)
    return lab, first


@pytest.mark.parametrize(("goal", "shared"), [("x", True), ("y", False)])
def test_a_component_is_shared_with_a_task_that_gives_it_the_same_values_alone(
    tmp_path: Path, goal: str, shared: bool
) -> None:
    lab, _ = asking(tmp_path)
    lab.events.clear()
    second = lab.agent(ASKED, (("goal", goal),), name="second")
    lab.let_pass(1.0)
    assert (second.state.phase is Phase.RUNNING) == shared
    assert [event.outcome.__class__ for event in lab.acts("composed")] == [Configuration if shared else Refusal]
    assert bool(lab.acts("watching")) == shared
    if not shared:
        (refused,) = lab.acts("refused")
        assert [(component, holder.name) for component, holder in refused.refusal.held][-1] == (iri("oracle"), "first")


def test_a_task_that_waits_shares_what_another_that_wants_the_same_has_got_before_it_at_once(tmp_path: Path) -> None:
    lab, first = asking(tmp_path)
    waiting = [lab.agent(ASKED, (("goal", "y"),), patient=True, name=name) for name in ("second", "third")]
    lab.let_pass(TRY_AGAIN / 2)
    first.stop()
    lab.let_pass(TRY_AGAIN / 5)
    assert [one.state.phase for one in waiting] == [Phase.RUNNING] * 2


def test_a_task_of_higher_priority_has_the_components_and_the_other_waits_and_goes_on_afterwards(lab: Lab) -> None:
    low = lab.agent(patient=True)
    lab.running(low)
    high = lab.agent(priority=5)
    assert lab.running(high)
    assert lab.active() == TASK | {"tracker"}
    assert low.state.phase is Phase.REFUSED
    assert low.status().phase == "waiting"
    high.stop()
    assert lab.running(low)
    assert lab.active() == TASK | {"tracker"}


ONE_FILTER = {
    **{
        f"source{n}": f":source{n} a sc:Component, :Source ; sc:preference -{n} ;"
        ' sc:hasOutput [ sc:name "out" ; sc:signalType :X ] .'
        for n in range(2)
    },
    "filter": ':filter a sc:Component, :Filter ; sc:shareable true ; sc:hasInput [ sc:name "x" ; sc:signalType :X ] ;'
    ' sc:hasOutput [ sc:name "out" ; sc:signalType :Y ] .',
    **{
        name: f':{name} a sc:Component, :{name.title()} ; sc:hasInput [ sc:name "y" ; sc:signalType :Y ] .'
        for name in ("low", "high")
    },
}


FILTERED = (
    PREFIXES
    + """:t a sc:Template ; sc:roles ( :source-role :filter-role :sink-role ) .
:source-role a sc:Role ; sh:class :Source ; sc:feeds :filter-role .
:filter-role a sc:Role ; sh:class :Filter ; sc:feeds :sink-role .
:sink-role a sc:Role ; sh:class :SINK .
"""
)


@pytest.mark.parametrize("patient", [True, False])
def test_of_tasks_that_share_what_has_lost_its_source_the_one_of_higher_priority_goes_on(
    tmp_path: Path, patient: bool
) -> None:
    lab = Lab(tmp_path, advertised=ONE_FILTER)
    lab.site("shared", *ONE_FILTER)
    for name in ONE_FILTER:
        lab.component(name)
    high = lab.agent(FILTERED.replace("SINK", "High"), (), patient=patient, priority=1, name="first")
    assert lab.running(high)
    low = lab.agent(FILTERED.replace("SINK", "Low"), (), patient=patient, name="second")
    assert lab.running(low)
    lab.components["source0"].fail("it is dark")
    lab.let_pass(3.0)
    assert high.state.phase is Phase.RUNNING
    assert high.state.lost.keys() == {iri("source0")}
    assert lab.components["filter"].said == [("started",)]
    assert lab.active() >= {"source1", "filter", "high"}


@pytest.mark.parametrize("patient", [True, False])
def test_of_tasks_that_share_the_one_that_gives_way_follows_what_the_other_insists_on(
    tmp_path: Path, patient: bool
) -> None:
    """It would rather follow the second of three sources, which the other one does not."""
    third = {"source2": ONE_FILTER["source0"].replace("source0", "source2").replace("-0", "-2")}
    near = {
        name: (ONE_FILTER | third)[name].replace(":Source ;", ":Source , :Near ;") for name in ("source0", "source2")
    }
    advertised = ONE_FILTER | near
    lab = Lab(tmp_path, advertised=advertised)
    lab.site("shared", *advertised)
    for name in advertised:
        lab.component(name)
    insists = lab.agent(FILTERED.replace("SINK", "High").replace(":Source ;", ":Near ;"), (), name="first")
    assert lab.running(insists)
    gives_way = lab.agent(FILTERED.replace("SINK", "Low"), (), patient=patient, name="second")
    assert lab.running(gives_way)
    lab.components["source0"].fail("it is dark")
    lab.let_pass(4.0)
    assert lab.active() == {"source2", "filter", "high", "low"}
    assert {insists.state.phase, gives_way.state.phase} == {Phase.RUNNING}


def test_a_shared_actuator_acts_again_for_a_task_that_is_whole_before_another_is(tmp_path: Path) -> None:
    """Both have lost what it follows, and for long; one has lost something else as well, and that for longer."""
    lights = {
        f"light{n}": f":light{n} a sc:Component, :Light ; sc:preference -{n} ;"
        ' sc:hasOutput [ sc:name "out" ; sc:signalType :L ] .'
        for n in range(2)
    }
    sinks = {
        "low": ':low a sc:Component, :Low ; sc:shareable true ; sc:hasInput [ sc:name "y" ; sc:signalType :Y ] .',
        "high": ':high a sc:Component, :High ; sc:hasInput [ sc:name "l" ; sc:signalType :L ] .',
    }
    lab = Lab(tmp_path, advertised=ONE_FILTER | lights | sinks)
    lab.site("shared", *lab.advertised)
    for name in lab.advertised:
        lab.component(name)
    for name, seconds in (("source1", 3.0), ("light1", 7.5)):
        slow_code(lab, name)
        lab.components[name].slow = seconds
    text = FILTERED.replace("SINK", "Low")
    more = ":light a sc:Role ; sh:class :Light ; sc:feeds :high . :high a sc:Role ; sh:class :High ."
    whole = lab.agent(text, (), name="whole")
    assert lab.running(whole)
    lacking = lab.agent(text.replace(":sink-role )", ":sink-role :light :high )") + more, (), name="lacking")
    assert lab.running(lacking)
    for name in ("source0", "light0"):
        lab.components[name].fail("it is dark")
    lab.let_pass(2.0)
    assert lab.components["low"].said[-1] == ("stopped",)
    for seconds, phase in ((3.0, Phase.DEPLOYING), (5.0, Phase.RUNNING)):
        lab.let_pass(seconds)
        lab.components["filter"].emit("out", seconds)
        lab.let_pass(0.1)
        assert lab.components["low"].said[-1] == ("y", seconds)
        assert (whole.state.phase, lacking.state.phase) == (Phase.RUNNING, phase)


def test_what_is_being_started_for_something_better_is_yielded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Not only once its code has started, for which an author may have asked for minutes."""
    alone = ADVERTISEMENTS["tracker"].replace(" ;", " ; sc:shareable false ;", 1)
    monkeypatch.setitem(ADVERTISEMENTS, "tracker", alone)
    lab = Lab(tmp_path)
    lab.navigation()
    lab.crash("tracker")
    low = lab.agent(upgrade=2.0)
    assert lab.running(low)
    slow_code(lab, "tracker")
    lab.components["tracker"].slow = 7.0
    assert lab.until(lambda: lab.runtimes["tracker"].activation.hold(low.identity.task) is not None, 10.0)
    high = lab.agent(WATCH, bound=(), priority=5)
    assert lab.until(lambda: lab.runtimes["tracker"].activation.hold(low.identity.task) is None, 1.0)
    assert lab.active() == TASK | {"odometry"}
    assert lab.until(lambda: high.state.phase is Phase.RUNNING, 20.0)
    assert low.state.phase is Phase.RUNNING


def test_a_task_goes_on_with_what_another_has_changed_for_what_it_yields(tmp_path: Path) -> None:
    """The other one holds both until what it has taken acts, and this one is not patient."""
    lab = Lab(tmp_path, advertised=SPARE)
    lab.site("shared", *SPARE)
    lab.component("right")
    high = lab.agent(DRIVEN, (), priority=1, upgrade=1.0)
    assert lab.running(high)
    lab.component("left")
    low = lab.agent(DRIVEN, ())
    assert lab.running(low)
    assert lab.until(lambda: iri("left") in high.state.held and high.state.phase is Phase.RUNNING)
    assert lab.running(low)
    assert (high.configuration.components, low.configuration.components) == ((iri("left"),), (iri("right"),))


def test_a_configurator_that_does_not_yield_is_preempted(lab: Lab) -> None:
    """It lives, but hears nothing of what it is asked."""
    low = lab.agent()
    lab.running(low)
    low._components._messages._watched.clear()
    high = lab.agent(priority=5)
    assert lab.until(lambda: high.state.phase is Phase.RUNNING, 20.0)
    for name in ("control", "drive"):
        assert [hold.claim.task for hold in lab.runtimes[name].activation.holds] == [high.identity.task]
    assert lab.until(lambda: low.state.phase is Phase.REFUSED, 2 * AUDIT)
    assert lab.active() == TASK | {"tracker"}
