"""Actions as operations: a goal is sent, its result is the answer, and it is cancelled when nobody waits for it."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import pytest

from selfconf import ros2
from selfconf.bridging.ros2.actions import ACTION_SECONDS, actions_of, call_action
from selfconf.bridging.ros2.domain import RosDomain
from selfconf.bridging.ros2.services import SERVICE_SECONDS
from selfconf.bridging.ros2.tokens import RosEndpoint
from selfconf.bus.memory import Network
from selfconf.bus.port import Request
from selfconf.model.term import IRI
from selfconf.protocol.messages import Apply, Reserve, Wire
from selfconf.ros2 import MessageType
from selfconf.sdk import CallStatus, Component, Response, Signal
from tests.bridging.ros2.action_parts import ACTION, known_parts_of, parts_of
from tests.bridging.ros2.nodes import DOMAIN, bridging_domain, lines_of, node
from tests.sdk.living import LivingStage, until

pytest.importorskip("rosbags", reason="the extra `ros2` is not installed")
ROOT = Path(__file__).parents[3]
STARTS = 40.0
"""Seconds that a process with a node may take to be there, and a call on a busy machine."""
COUNTER = IRI("urn:c:counter")


def test_an_action_is_known_by_all_of_its_parts() -> None:
    (found,) = actions_of(parts_of("/lab/count")).items()
    assert (found[0], found[1].name, found[1].type) == ("lab/count", "/lab/count", ACTION)
    for missing in range(4):
        assert not actions_of([each for each in parts_of("/count") if each.entity != missing])


def test_services_of_other_types_are_no_action() -> None:
    other = MessageType("std_srvs/srv/Trigger", "RIHS01_" + "0" * 64)
    assert not actions_of([RosEndpoint(each.entity, each.kind, each.topic, other) for each in parts_of("/count")])


class SimulatedServer:
    """The server of an action in a simulated network, which keeps what it is asked for, and a bridge that asks it."""

    def __init__(self, endpoints: list[RosEndpoint]) -> None:
        self._network = Network()
        self._domain = RosDomain(self._network.node(), DOMAIN, list[str]().append)
        ((_, self._action),) = actions_of(endpoints).items()
        self.sent, self.results, self.cancelled = list[Request](), list[Request](), list[Request]()
        server = self._network.node()
        for endpoint, asked in zip(self._action, (self.sent, self.results, self.cancelled), strict=False):
            server.serve(endpoint.key(DOMAIN), asked.append)

    def called(self, request: Any) -> Future[Any]:
        """The answer to a call."""
        return call_action(self._domain, self._action, Signal(request, COUNTER, 0.0, 1, ""))

    def accept(self) -> None:
        """Accept the goal that was sent."""
        parts = ros2.service_parts(self._action.send_goal.type)
        assert parts is not None
        (request,) = self.sent
        request.reply(request.key, ros2.message({"accepted": True}, parts.response))
        request.finish()

    def end(self, fields: Mapping[str, Any]) -> None:
        """Answer what was asked for as the result."""
        parts = ros2.service_parts(self._action.get_result.type)
        assert parts is not None
        (request,) = self.results
        request.reply(request.key, ros2.message(fields, parts.response))
        request.finish()

    def until(self, happened: Callable[[], object], seconds: float = 5.0) -> bool:
        """Whether something happens within some simulated seconds."""
        return self._network.run(lambda: bool(happened()), seconds)


def test_a_goal_whose_fields_are_not_known_is_refused() -> None:
    server = SimulatedServer(parts_of("/count"))
    answer = server.called({"order": 5})
    assert server.until(answer.done)
    assert str(answer.exception()) == f"the fields of {ACTION} are not known; give its definition, by definitions"
    assert not server.sent


def test_an_action_is_called_whose_definition_was_given(tmp_path: Path) -> None:
    """One like those of Nav2, with messages of a distribution in it and one of its own package."""
    package = tmp_path / "lab_msgs"
    for name, text in {
        "msg/Behavior.msg": "string name\n",
        "action/Drive.action": "geometry_msgs/PoseStamped pose\nBehavior tree\n---\nuint16 NONE=0\nuint16 error\n---\n",
    }.items():
        (package / name).parent.mkdir(parents=True, exist_ok=True)
        (package / name).write_text(text)
    try:
        assert ros2.learn([tmp_path]) == []
        server = SimulatedServer(known_parts_of("/drive", "lab_msgs/action/Drive"))
        answer = server.called({"pose": {"header": {"frame_id": "map"}}, "tree": {"name": "spin"}})
        assert server.until(lambda: server.sent)
        assert b"map\0" in server.sent[0].payload
        assert server.sent[0].payload.endswith(b"spin\0")
        server.accept()
        assert server.until(lambda: server.results)
        server.end({"status": 4, "result": {"error": 7}})
        assert server.until(answer.done)
        assert answer.result() == {"error": 7}
    finally:
        ros2.learn([])


def test_a_goal_that_nobody_waits_for_when_it_is_accepted_is_cancelled() -> None:
    server = SimulatedServer(known_parts_of("/count"))
    answer = server.called({"order": 5})
    assert server.until(lambda: server.sent)
    answer.cancel()
    assert not server.until(lambda: server.cancelled)
    server.accept()
    assert server.until(lambda: server.cancelled)
    assert server.cancelled[0].payload[4:20] == server.sent[0].payload[4:20]  # the UUID of the goal
    assert not server.results


def test_a_server_that_never_says_whether_it_accepts_has_the_goal_cancelled() -> None:
    server = SimulatedServer(known_parts_of("/count"))
    answer = server.called({"order": 5})
    assert server.until(answer.done, SERVICE_SECONDS + 5.0)
    assert str(answer.exception()) == "the service /count/_action/send_goal has not answered within 60 s"
    assert server.until(lambda: server.cancelled)


def test_a_result_that_never_comes_has_an_end() -> None:
    server = SimulatedServer(known_parts_of("/count"))
    answer = server.called({"order": 5})
    assert server.until(lambda: server.sent)
    server.accept()
    assert server.until(answer.done, ACTION_SECONDS + 5.0)
    assert str(answer.exception()) == "the service /count/_action/get_result has not answered within 3600 s"
    assert server.until(lambda: server.cancelled)


class Counter(Component):
    """Has numbers counted, and hears how far they are; it knows nothing of ROS 2."""

    def __init__(self) -> None:
        self.answers: list[Response] = []
        self.heard: list[Any] = []

    def received(self, port: str, signal: Signal) -> None:
        self.heard.append(signal.value)

    def ask(self, request: Any, seconds: float = STARTS) -> Response:
        """What comes of a call."""
        known = len(self.answers)
        self.call("count", request, answered=self.answers.append, seconds=seconds)
        assert until(lambda: len(self.answers) > known, STARTS)
        return self.answers[-1]


def counter(living: LivingStage) -> Counter:
    """A counter that is active."""
    base = f"https://w3id.org/selfconf/ros2/{ACTION}"
    ends = f"""sc:needsOperation [ sc:name "count" ; sc:request <{base}_Goal> ; sc:response <{base}_Result> ] ;
        sc:hasInput [ sc:name "far" ; sc:signalType <{base}_FeedbackMessage> ]"""
    component = living.component(living.advertised(Counter, f"<{COUNTER}> a sc:Component, :Counter ; {ends} .")())
    held = living.call(COUNTER, "reserve", Reserve(1, living.supervisor, "task~1"))
    assert until(lambda: held)
    wires = {"count()": (Wire(node("counting"), "count()"),), "far": (Wire(node("counting"), "count/feedback"),)}
    answers = living.apply(COUNTER, inputs=wires)
    assert until(lambda: answers and answers[0].active), answers
    return component


@pytest.fixture
def counting(living: LivingStage) -> Iterator[subprocess.Popen[str]]:
    """A process with a server of the action `/count`."""
    pytest.importorskip("zenoh_ros2_sdk", reason="zenoh-ros2-sdk, of which the node is made, is not installed")
    command = ("-m", "tests.bridging.ros2.counting_node", "/count", living.endpoint.rpartition(":")[2], str(DOMAIN))
    process = subprocess.Popen(
        [sys.executable, "-u", *command], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, cwd=ROOT
    )
    yield process
    process.kill()
    process.wait()
    if process.stdout is not None:
        process.stdout.close()


@pytest.mark.process
def test_a_component_calls_the_action_of_a_foreign_node(
    living: LivingStage, tmp_path: Path, counting: subprocess.Popen[str]
) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        said = lines_of(counting)
        assert until(lambda: found.is_complete("counting", "count", "count/feedback"), STARTS), found.complaints
        assert "_action" not in found.advertised()
        found.activate("counting", {"count()": (COUNTER,)})
        component = counter(living)

        def counted() -> bool:  # what is published before a subscription is known is lost, as in ROS 2
            assert component.ask({"order": 5}).value == {"sequence": [0, 1, 1, 2, 3]}
            return bool(component.heard)

        assert until(counted, STARTS)
        assert component.heard[0]["feedback"]["sequence"].tolist()[:3] == [0, 1, 1]
        assert component.ask({"order": -1}).detail == "the action /count does not accept the goal"
        assert component.ask({"order": 0}).detail == "the goal of the action /count was aborted"
        assert component.ask({"many": 5}).detail.startswith("what counter asks has many, which ")
        assert component.ask(b"\x00").detail.startswith("what counter asks is no object")
        late = component.ask({"order": 100}, 1.0)  # caller and bridge count the same second, and one of them is first
        assert late.status is CallStatus.LATE or late.detail == "counting ended the call before it answered"
        assert until(lambda: "canceled 100\n" in said), said

        def calls(epoch: int, *callers: IRI) -> None:  # which components may call the action from now on
            apply = Apply(epoch, living.supervisor, "task~1", callers={"count()": callers})
            answers = living.call(node("counting"), "apply", apply)
            assert until(lambda: answers and answers[0].active), answers

        def counts(order: int) -> None:
            component.call("count", {"order": order}, answered=component.answers.append, seconds=STARTS)
            assert until(lambda: f"counting {order}\n" in said), said

        known = len(component.answers)
        counts(101)
        calls(2)
        assert until(lambda: "canceled 101\n" in said), said
        calls(3, COUNTER)
        counts(102)
        counting.kill()
        assert until(lambda: len(component.answers) == known + 2)
        assert until(lambda: found.causes() == [f"the node /counting has left the domain {DOMAIN} of ROS 2"])
        assert component.answers[-1].detail in (
            "the service /count/_action/get_result does not answer",
            "counting ended the call before it answered",
        )
