"""The calls of a configurator: components that are slow, hang, refuse, are held, or do not run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from selfconf.bus.port import Request, Urgency
from selfconf.configurator.state import Phase
from selfconf.deployment.calls import CALL, STARTING, WAKING
from selfconf.deployment.liveness import SETTLING
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Cause, Fail, Page
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.vocabulary import SC
from selfconf.sdk.component import Refused
from selfconf.sdk.supervision import GRACE
from tests.deployment.tasks import TASK
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES, Lab, iri


def busy_in_started(lab: Lab, name: str, seconds: float) -> None:
    """Have the thread of a component be in `started` for so long: all that it is asked is heard afterwards."""
    runtime, free = lab.runtimes[name], lab.network.time + seconds
    runtime._served()

    def hear(request: Request) -> None:
        runtime.bus.later(max(0.0, free - lab.network.time), lambda: runtime._call(request))

    runtime.bus.serve(lab.keys.call(runtime.profile.component), hear)


def test_a_component_that_refuses_to_start_is_replaced(lab: Lab) -> None:
    lab.components["tracker"].refusal = Refused("the camera is covered")
    agent = lab.agent()
    assert lab.running(agent)
    assert lab.active() == TASK | {"odometry"}
    assert lab.acts("declined")[0].detail == "the camera is covered"
    (lost,) = lab.acts("lost")
    assert (lost.cause, lost.detail) == ("refused", "the camera is covered")
    record = turtle.parse(agent._record.turtle(), "record.ttl")
    (failure,) = record.instances(SC.Failure)
    assert [str(cause) for cause in record.values(failure, SC.cause)] == ["refused"]


def test_a_component_that_takes_long_to_start_is_waited_for_as_long_as_it_lives(lab: Lab) -> None:
    busy_in_started(lab, "tracker", STARTING - CALL)
    agent = lab.agent()
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, STARTING + CALL)
    assert lab.active() == TASK | {"tracker"}
    assert lab.components["tracker"].said == [("started",)]


def test_a_component_that_dies_while_it_takes_long_to_start_is_replaced_at_once(lab: Lab) -> None:
    busy_in_started(lab, "tracker", STARTING)
    agent = lab.agent()
    lab.let_pass(3 * CALL)
    assert agent.state.phase is Phase.DEPLOYING
    lab.crash("tracker")
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, CALL)
    assert agent.state.lost[iri("person-tracker")].cause is Cause.CRASH


def test_a_component_that_hangs_is_replaced(lab: Lab) -> None:
    """It lives, but answers no call."""
    runtime = lab.runtimes["tracker"]
    runtime._served()
    runtime.bus.serve(lab.keys.call(iri("person-tracker")), lambda _: None)
    agent = lab.agent()
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, STARTING + 2 * CALL)
    assert lab.active() == TASK | {"odometry"}


def test_a_component_that_is_advertised_but_does_not_run_is_passed_over(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.site("home")
    for name in TASK | {"odometry"}:
        lab.component(name)
    assert lab.running(lab.agent())
    assert lab.active() == TASK | {"odometry"}


def test_a_dormant_component_whose_process_ends_at_once_is_not_given_up_a_second_time(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.site("astrid", *TASK, "odometry")
    for name in (*TASK, "odometry"):
        lab.component(name)
    tracker, node = iri("person-tracker"), lab.network.node()
    page = encode(Page(0, 1, 1, tracker, "tracker.ttl", startable=True))

    def advertise(request: Request) -> None:
        payload = (PREFIXES + ADVERTISEMENTS["tracker"]).encode()
        request.reply(lab.keys.advertisement("living-room", tracker), payload, page)
        request.finish()

    def wake(request: Request) -> None:
        request.reply(lab.keys.wake("living-room"), b"started")
        request.finish()
        node.publisher(lab.keys.fail(tracker), Urgency.EVENT).put(encode(Fail(tracker, "", 0, Cause.CRASH, "code 1")))

    node.announce(lab.keys.site_life("living-room", "1"))
    node.serve(lab.keys.advertisements("living-room"), advertise)
    node.serve(lab.keys.wake("living-room"), wake)
    agent = lab.agent()
    assert lab.running(agent)
    assert agent.state.lost[tracker].detail == "code 1"
    lab.let_pass(2 * WAKING)
    assert lab.acts("unreachable") == []


def test_a_component_held_by_another_living_configurator_is_not_taken(lab: Lab) -> None:
    first = lab.agent()
    lab.running(first)
    second = lab.agent()
    assert lab.until(lambda: second.state.phase is Phase.REFUSED)
    assert first.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"tracker"}
    assert lab.components["drive"].said == [("started",)]
    lab.let_pass(1.0)
    declined = lab.acts("declined")
    assert {account.detail for account in declined} == {f"the configurator {first.name} holds it"}
    assert len(declined) == len({account.component for account in declined})


def test_a_component_that_speaks_another_protocol_is_replaced(lab: Lab) -> None:
    """A component whose program speaks another protocol is replaced, not trusted."""
    runtime = lab.runtimes["tracker"]
    runtime._served()

    def babble(request: Request) -> None:
        request.reply(lab.keys.call(iri("person-tracker"), "apply"), b"yes sir")
        request.finish()

    runtime.bus.serve(lab.keys.call(iri("person-tracker")), babble)
    agent = lab.agent()
    assert lab.running(agent)
    assert lab.active() == TASK | {"odometry"}


def test_connections_that_are_made_again_are_reported_again(lab: Lab) -> None:
    agent = lab.agent(patient=True)
    lab.running(agent)
    made = len(lab.acts("connecting"))
    lab.crash("drive")
    lab.let_pass(1.0)
    assert lab.active() == set()
    lab.component("drive")
    lab.running(agent)
    assert len(lab.acts("connecting")) == 2 * made
    lab.isolate(agent)
    lab.let_pass(GRACE + 0.5)
    lab.rejoin(agent)
    lab.let_pass(SETTLING + 1.0)
    assert lab.active() == TASK | {"tracker"}
    assert len(lab.acts("connecting")) == 3 * made


def test_a_connection_that_is_kept_is_reported_once(lab: Lab) -> None:
    lab.running(lab.agent())
    made = len(lab.acts("connecting"))
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    (new,) = lab.acts("connecting")[made:]
    assert (new.source, new.sink) == (iri("absolute-odometry"), iri("thinking-cap"))


def test_an_input_follows_every_output_that_feeds_it(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.navigation()
    both = NAVIGATE.replace(
        "sh:class rob:PositionSensor ;", "sh:class rob:PositionSensor ; sc:minCount 2 ; sc:maxCount 2 ;"
    )
    assert lab.running(lab.agent(both))
    lab.components["tracker"].emit("pose", 1)
    lab.components["odometry"].emit("pose", 2)
    lab.let_pass(0.1)
    values: list[Any] = [said[1] for said in lab.components["control"].said if said[0] == "position"]
    assert sorted(values) == [1, 2]
