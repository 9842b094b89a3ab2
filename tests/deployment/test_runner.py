"""A task that is run in a small ecology, in simulated time: the paper's experiment, losses, patience, and reports."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from selfconf.bus.memory_bus import MemoryBus
from selfconf.bus.port import Replies
from selfconf.configurator.events import Event, Failed, LossLasts
from selfconf.configurator.state import Phase, Policy
from selfconf.deployment.components.liveness import AUDIT
from selfconf.deployment.retries import TRY_AGAIN
from selfconf.deployment.runner import LASTS_LONG
from selfconf.model.configuration import Configuration
from selfconf.model.refusal import Refusal, TooFewEligible
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import CallAnswer, Cause, Release, Verdict
from selfconf.render.run_events import event_body
from selfconf.sdk.supervision import GRACE
from tests.deployment.simulated import slow_code
from tests.deployment.tasks import DRIVEN, TASK, contended
from tests.lab import ADVERTISEMENTS, PREFIXES, Lab, Recorder, iri


def released(recorder: Recorder) -> bool:
    """Whether a component was turned off as often as it was turned on."""
    return recorder.said.count(("started",)) == recorder.said.count(("stopped",))


def test_the_task_is_configured_with_the_tracker_and_never_with_the_drive_of_pippi(lab: Lab) -> None:
    agent = lab.agent()
    assert lab.running(agent)
    assert lab.active() == TASK | {"tracker"}
    assert lab.components["pippi"].said == []
    assert agent.configuration is not None
    assert agent.configuration.components == tuple(
        map(iri, ("sonar-array", "wheels", "person-tracker", "thinking-cap", "astrid-drive"))
    )


def test_signals_flow_along_the_connections_and_the_goal_is_set_first(lab: Lab) -> None:
    lab.running(lab.agent())
    lab.components["tracker"].emit("pose", {"x": 1})
    lab.components["odometry"].emit("pose", {"x": 9})
    lab.components["control"].emit("set.velocity", {"v": 0.3})
    lab.let_pass(0.1)
    assert lab.components["control"].said == [("goal", "(AT BEDROOM)"), ("started",), ("position", {"x": 1})]
    assert lab.components["drive"].said == [("started",), ("velocity", {"v": 0.3})]


def test_a_lost_tracker_is_replaced_by_odometry(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.components["tracker"].fail("Astrid has left the picture")
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"odometry"}
    assert lab.components["tracker"].said == [("started",), ("stopped",)]
    lab.components["odometry"].emit("pose", {"x": 2})
    lab.let_pass(0.1)
    assert lab.components["control"].said[-1] == ("position", {"x": 2})
    (lost,) = lab.acts("lost")
    assert lost.component == iri("person-tracker")
    assert lost.detail == "Astrid has left the picture"
    told = agent.losses
    with pytest.raises(TypeError):
        told[iri("person-tracker")] = "it is back"  # type: ignore[index]  # that is what is tested
    assert told == {iri("person-tracker"): "fail, Astrid has left the picture"}


def test_repair_neither_stops_nor_starts_nor_sets_anew_what_runs(lab: Lab) -> None:
    lab.running(lab.agent())
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    assert lab.components["control"].said == [("goal", "(AT BEDROOM)"), ("started",)]
    for name in ("sonar", "encoder", "drive"):
        assert lab.components[name].said == [("started",)]


@pytest.mark.parametrize(("seconds", "rests"), [(0.5, False), (4.0, True)])
def test_the_drive_rests_for_as_long_as_a_repair_takes_more_than_a_moment(
    lab: Lab, seconds: float, rests: bool
) -> None:
    """The controller acts on, and could go on driving without a position."""
    slow_code(lab, "odometry")
    lab.components["odometry"].slow = seconds
    lab.running(agent := lab.agent())
    control, drive = lab.components["control"], lab.components["drive"]
    lab.components["tracker"].fail("Astrid has left the picture")
    for _ in range(16):
        control.emit("set.velocity", {"v": 0.3})
        lab.let_pass(0.1)
    assert drive.said[-1] == (("stopped",) if rests else ("velocity", {"v": 0.3}))
    assert ("stopped",) not in control.said
    assert agent.state.held[iri("astrid-drive")].reserved, "it is held on"
    lab.until(lambda: agent.state.phase is Phase.RUNNING)
    control.emit("set.velocity", {"v": 0.1})
    lab.let_pass(0.1)
    assert drive.said[-1] == ("velocity", {"v": 0.1})
    assert drive.said.count(("started",)) == 1 + rests


_TWO_SINKS = {
    "left": ':left a sc:Component, :Left ; sc:hasOutput [ sc:name "out" ; sc:signalType :X ] .',
    **{
        f"right{n}": f":right{n} a sc:Component, :Right ; sc:preference -{n} ;"
        ' sc:hasOutput [ sc:name "out" ; sc:signalType :Y ] .'
        for n in range(3)
    },
    "wheels": ':wheels a sc:Component, :Wheels ; sc:hasInput [ sc:name "x" ; sc:signalType :X ] ,'
    ' [ sc:name "y" ; sc:signalType :Y ] .',
    **{
        f"arm{n}": f":arm{n} a sc:Component, :Arm ; sc:preference -{n} ;"
        ' sc:hasInput [ sc:name "x" ; sc:signalType :X ] .'
        for n in range(2)
    },
}
_TWO_SINKS_TASK = (
    PREFIXES
    + """:t a sc:Template ; sc:roles ( :left-role :right-role :wheels-role :arm-role ) .
:left-role a sc:Role ; sh:class :Left ; sc:feeds :wheels-role , :arm-role .
:right-role a sc:Role ; sh:class :Right ; sc:feeds :wheels-role .
:wheels-role a sc:Role ; sh:class :Wheels .
:arm-role a sc:Role ; sh:class :Arm .
"""
)


class _TwoSinks:
    """Two actuators with sources that issue signals all the time, and a task that runs with the first of each."""

    def __init__(self, folder: Path, *slow: str) -> None:
        """`slow` are the components of which `started` takes four seconds from now on."""
        self.lab = Lab(folder, advertised=_TWO_SINKS)
        self.lab.site("shared", *_TWO_SINKS)
        for name in _TWO_SINKS:
            self.lab.component(name)
        for name in slow:
            slow_code(self.lab, name)
        self.agent = self.lab.agent(_TWO_SINKS_TASK, ())
        assert self.lab.running(self.agent)
        self.goes_on(1.0)
        for name in slow:
            self.lab.components[name].slow = 4.0

    def goes_on(self, seconds: float) -> None:
        for _ in range(round(10 * seconds)):
            for name in _TWO_SINKS:
                if name.startswith(("left", "right")):
                    self.lab.components[name].emit("out", 1)
            self.lab.let_pass(0.1)

    def turns(self, name: str) -> list[str]:
        """How a component was started and stopped."""
        return [said[0] for said in self.lab.components[name].said if said[0] in ("started", "stopped")]


def test_an_actuator_is_not_disturbed_while_another_one_is_replaced(tmp_path: Path) -> None:
    home = _TwoSinks(tmp_path, "arm1")
    home.lab.components["arm0"].fail("it is stuck")
    home.goes_on(3.0)
    assert home.agent.state.phase is Phase.DEPLOYING
    home.goes_on(3.0)
    assert home.agent.state.phase is Phase.RUNNING
    assert home.turns("wheels") == ["started"]


def test_a_drive_that_did_not_hear_that_it_is_to_rest_is_told_again_whatever_has_been_decided_since(lab: Lab) -> None:
    slow_code(lab, "odometry")
    lab.components["odometry"].slow = 7.0
    lab.running(agent := lab.agent())
    control, drive = lab.components["control"], lab.components["drive"]
    lab.components["tracker"].fail("Astrid has left the picture")
    lab.let_pass(LASTS_LONG - 0.1)
    faults = lab.network.faults
    lab.network.faults = replace(faults, loss=1.0)
    lab.let_pass(0.2)
    lab.network.faults = faults
    assert agent.state.held[iri("astrid-drive")].rests
    lab.let_pass(0.1)
    assert drive.said[-1] != ("stopped",), "it was not heard"
    for _ in range(25):
        control.emit("set.velocity", {"v": 0.3})
        lab.let_pass(0.1)
    assert agent.state.phase is not Phase.RUNNING
    assert drive.said[-1] == ("stopped",)


def test_an_actuator_that_has_started_again_rests_again_if_more_is_lost_meanwhile(tmp_path: Path) -> None:
    home = _TwoSinks(tmp_path, "right1", "right2", "arm1")
    home.lab.components["right0"].fail("it is dark")
    home.lab.components["arm0"].fail("it is stuck")
    home.goes_on(4.5)
    assert home.turns("wheels") == ["started", "stopped", "started"]
    assert home.agent.state.phase is Phase.DEPLOYING, "the arm takes four seconds to start"
    home.lab.components["right1"].fail("it is dark here, too")
    home.goes_on(1.5)
    assert home.turns("wheels")[-1] == "stopped"
    home.goes_on(10.0)
    assert home.agent.state.phase is Phase.RUNNING
    assert home.turns("wheels")[-1] == "started"


def test_it_is_looked_once_whether_what_was_lost_within_a_moment_is_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It may be thousands of components, and each look is at all that is held."""
    home = _TwoSinks(tmp_path)
    looks, hear = list[float](), home.agent._step

    def heard(event: Event) -> None:
        if isinstance(event, LossLasts):
            looks.append(home.lab.network.time)
        hear(event)

    monkeypatch.setattr(home.agent, "_step", heard)
    began = home.lab.network.time
    home.lab.components["right0"].fail("it is dark")
    home.lab.components["arm0"].fail("it is stuck")
    home.lab.let_pass(0.03)
    home.lab.components["right1"].fail("it is dark here, too")
    home.lab.let_pass(0.5)
    assert [round(time - began, 2) for time in looks] == [0.05, 0.1]


def test_dismantling_first_stops_all_components_as_the_paper_does(lab: Lab) -> None:
    agent = lab.agent(policy=Policy.DISMANTLE)
    lab.running(agent)
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.components["drive"].said == [("started",), ("stopped",), ("started",)]
    assert lab.components["control"].said == [
        ("goal", "(AT BEDROOM)"),
        ("started",),
        ("stopped",),
        ("goal", "(AT BEDROOM)"),
        ("started",),
    ]


def test_when_odometry_fails_too_the_task_is_refused_and_everything_is_off(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    for name in ("tracker", "odometry"):
        lab.components[name].fail("broken")
        lab.let_pass(1.0)
    assert agent.state.phase is Phase.REFUSED
    assert lab.active() == set()
    (refusal,) = lab.ended
    assert refusal is not None
    assert [reason.role for reason in refusal.reasons if isinstance(reason, TooFewEligible)] == [iri("position")]


def test_a_stop_takes_everything_down_once(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    agent.stop()
    agent.stop()
    assert lab.until(lambda: bool(lab.ended))
    assert lab.ended == [None]
    assert lab.active() == set()
    assert all(map(released, lab.components.values()))


@pytest.mark.parametrize("moment", [0.0, 0.0004, 0.0012, 0.0018, 0.0024, 0.003, 0.0035, 0.004, 0.0045, 0.01])
@pytest.mark.parametrize("policy", Policy)
def test_a_stop_at_any_moment_leaves_nothing_active(lab: Lab, moment: float, policy: Policy) -> None:
    agent = lab.agent(policy=policy)
    lab.let_pass(moment)
    agent.stop()
    assert lab.until(lambda: bool(lab.ended))
    lab.let_pass(1.0)
    assert lab.ended == [None]
    assert lab.active() == set()


def test_what_changes_nothing_is_no_loss(lab: Lab) -> None:
    agent = lab.agent()
    assert lab.until(lambda: agent.state.phase is Phase.DEPLOYING)
    agent._step(Failed(iri("person-tracker"), "", Cause.SILENCE, "no signal"))  # it may not have begun
    assert lab.running(agent)
    assert lab.active() == TASK | {"tracker"}
    agent.stop()
    lab.crash("tracker")
    assert lab.until(lambda: bool(lab.ended))
    assert lab.acts("lost") == []


def test_an_output_that_promised_a_rate_and_stops_is_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    promising = ADVERTISEMENTS["tracker"].replace(
        "sc:signalType rob:PlanarPose2D", "sc:signalType rob:PlanarPose2D ; sc:rate [ sc:value 10 ; sc:unit unit:HZ ]"
    )
    monkeypatch.setitem(ADVERTISEMENTS, "tracker", promising)

    class Tracker(Recorder):
        seeing = True

        def started(self) -> None:
            self.every(0.1, self.look)

        def look(self) -> None:
            if self.seeing:
                self.emit("pose", {"x": 0})

    lab = Lab(tmp_path)
    lab.navigation()
    lab.crash("tracker")
    tracker = Tracker()
    lab.component("tracker", tracker)
    agent = lab.agent()
    assert lab.running(agent)
    lab.let_pass(5.0)
    assert lab.active() == TASK | {"tracker"}
    tracker.seeing = False
    lab.let_pass(1.0)
    assert lab.active() == TASK | {"odometry"}
    assert lab.acts("lost")[0].cause == "silence"


def test_when_the_configurator_dies_everything_turns_itself_off_and_a_new_one_recovers(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.crash(agent)
    lab.let_pass(GRACE - 0.1)
    assert lab.active() == TASK | {"tracker"}
    lab.let_pass(0.2)
    assert lab.active() == set()
    again = lab.agent()
    assert lab.running(again)
    assert lab.active() == TASK | {"tracker"}


def test_a_new_configurator_takes_over_at_once_from_one_that_died(lab: Lab) -> None:
    first = lab.agent()
    lab.running(first)
    lab.crash(first)
    again = lab.agent()
    assert lab.running(again)
    assert lab.active() == TASK | {"tracker"}
    lab.let_pass(10.0)
    assert lab.active() == TASK | {"tracker"}
    assert lab.components["drive"].said == [("started",)]


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


def test_patience_waits_until_the_ecology_has_what_it_needs(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.site("astrid", "sonar", "encoder", "control", "drive")
    for name in TASK:
        lab.component(name)
    agent = lab.agent(patient=True)
    lab.let_pass(5.0)
    assert agent.state.phase is Phase.REFUSED
    assert lab.ended == []
    lab.component("tracker")
    lab.site("living-room", "tracker")
    assert lab.running(agent)
    assert lab.active() == TASK | {"tracker"}


def test_patience_notices_an_advertisement_that_is_added_to_a_site(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    site = lab.site("astrid", "sonar", "encoder", "control", "drive")
    for name in TASK | {"odometry"}:
        lab.component(name)
    agent = lab.agent(patient=True)
    lab.let_pass(5.0)
    assert agent.state.phase is Phase.REFUSED
    (tmp_path / "astrid" / "odometry.ttl").write_text(PREFIXES + ADVERTISEMENTS["odometry"])
    assert lab.running(agent)
    assert site.name == "astrid"


def test_patience_recovers_when_a_lost_component_lives_again(lab: Lab) -> None:
    agent = lab.agent(patient=True)
    lab.running(agent)
    lab.crash("drive")
    lab.let_pass(1.0)
    assert (agent.state.phase, lab.active()) == (Phase.REFUSED, set())
    lab.component("drive")
    assert lab.running(agent)
    agent.stop()
    assert lab.until(lambda: lab.ended == [None])
    assert lab.active() == set()


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


@pytest.mark.parametrize(("goal", "shared"), [("x", True), ("y", False)])
def test_a_component_is_shared_with_a_task_that_gives_it_the_same_values_alone(
    tmp_path: Path, goal: str, shared: bool
) -> None:
    lab = Lab(tmp_path, advertised=SHARED)
    lab.site("shared", *SHARED)
    for name in SHARED:
        lab.component(name)
    first = lab.agent(ASKED, (("goal", "x"),), name="first")
    assert lab.running(first)
    lab.events.clear()
    second = lab.agent(ASKED, (("goal", goal),), name="second")
    lab.let_pass(1.0)
    assert (second.state.phase is Phase.RUNNING) == shared
    assert [event.outcome.__class__ for event in lab.acts("composed")] == [Configuration if shared else Refusal]
    assert bool(lab.acts("watching")) == shared
    if not shared:
        (refused,) = lab.acts("refused")
        assert [(component, holder.name) for component, holder in refused.refusal.held][-1] == (iri("oracle"), "first")


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


_SHARED = {
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
_SHARING = (
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
    lab = Lab(tmp_path, advertised=_SHARED)
    lab.site("shared", *_SHARED)
    for name in _SHARED:
        lab.component(name)
    high = lab.agent(_SHARING.replace("SINK", "High"), (), patient=patient, priority=1, name="first")
    assert lab.running(high)
    low = lab.agent(_SHARING.replace("SINK", "Low"), (), patient=patient, name="second")
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
    third = {"source2": _SHARED["source0"].replace("source0", "source2").replace("-0", "-2")}
    near = {name: (_SHARED | third)[name].replace(":Source ;", ":Source , :Near ;") for name in ("source0", "source2")}
    advertised = _SHARED | near
    lab = Lab(tmp_path, advertised=advertised)
    lab.site("shared", *advertised)
    for name in advertised:
        lab.component(name)
    insists = lab.agent(_SHARING.replace("SINK", "High").replace(":Source ;", ":Near ;"), (), name="first")
    assert lab.running(insists)
    gives_way = lab.agent(_SHARING.replace("SINK", "Low"), (), patient=patient, name="second")
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
    lab = Lab(tmp_path, advertised=_SHARED | lights | sinks)
    lab.site("shared", *lab.advertised)
    for name in lab.advertised:
        lab.component(name)
    for name, seconds in (("source1", 3.0), ("light1", 7.5)):
        slow_code(lab, name)
        lab.components[name].slow = seconds
    text = _SHARING.replace("SINK", "Low")
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


def test_a_configurator_that_does_not_yield_is_preempted(lab: Lab) -> None:
    """It lives, but hears nothing of what it is asked."""
    low = lab.agent()
    lab.running(low)
    low._messages._watched.clear()
    high = lab.agent(priority=5)
    assert lab.until(lambda: high.state.phase is Phase.RUNNING, 20.0)
    for name in ("control", "drive"):
        assert [hold.claim.task for hold in lab.runtimes[name].activation.holds] == [high.identity.task]
    assert lab.until(lambda: low.state.phase is Phase.REFUSED, 2 * AUDIT)
    assert lab.active() == TASK | {"tracker"}


def test_its_status_names_the_task_its_priority_and_since_when(lab: Lab) -> None:
    lab.let_pass(5.0)
    agent = lab.agent(priority=3)
    status = agent.status()
    assert (status.task, status.priority, status.beginning) == (f"navigate~{agent.name}", 3, lab.network.time)


def test_a_stranger_cannot_release_what_a_configurator_holds(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    replies: list[Replies] = []
    them = lab.keys.configurator_life("them", "1")
    payload = encode(Release(1 << 60, them, agent.identity.task))
    lab.network.node().ask(lab.keys.call(iri("astrid-drive"), "release"), payload, 1.0, replies.append)
    assert lab.until(lambda: bool(replies))
    assert decode(replies[0].samples[0].payload, CallAnswer).verdict is Verdict.BUSY
    assert "drive" in lab.active()


def test_what_it_does_is_reported_in_the_order_of_the_four_acts(lab: Lab) -> None:
    lab.running(lab.agent())
    lab.let_pass(0.1)
    acts = [account.act for account in lab.events]
    firsts = [
        acts.index(act) for act in ("query", "discovered", "composed", "watching", "activating", "set", "running")
    ]
    assert firsts == sorted(firsts)
    assert max(i for i, act in enumerate(acts) if act == "watching") < acts.index("activating")
    connected = {(str(a.source), str(a.output)) for a in lab.acts("connecting")}
    assert (str(iri("person-tracker")), "pose") in connected
    assert all(event_body(event) for event in lab.events)


def test_a_configurator_that_has_ended_asks_nobody_any_more(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    agent = lab.agent(bound=(("robot", ":Nobody"), ("goal", "(AT BEDROOM)")))
    assert lab.until(lambda: bool(lab.ended))
    lab.let_pass(10.0)
    timers: list[float] = []
    monkeypatch.setattr(agent.bus, "later", lambda seconds, action: timers.append(seconds))
    lab.let_pass(10.0)
    assert timers == []


@pytest.mark.parametrize("patient", [False, True])
def test_a_task_is_refused_though_it_cannot_hear_who_holds_what_it_needs(lab: Lab, patient: bool) -> None:
    first = lab.agent()
    assert lab.running(first)
    second = lab.agent(patient=patient)
    assert isinstance(first.bus, MemoryBus)
    assert isinstance(second.bus, MemoryBus)
    lab.network.cut(first.bus, second.bus)
    assert lab.until(lambda: second.state.phase is Phase.REFUSED, 5.0)
    assert second.state.attempt < 10
