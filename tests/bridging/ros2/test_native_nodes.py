"""Nodes by hiroz, a native implementation of rmw_zenoh that nobody here wrote: they and components play together."""

from __future__ import annotations

import subprocess
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import pytest

from selfconf import ros2
from selfconf.model.term import IRI
from selfconf.protocol.messages import Apply, Release, Reserve, Wire
from selfconf.sdk import CallStatus, Component, Response, Signal
from tests.bridging.ros2.nodes import DOMAIN, BridgedDomain, bridging_domain, lines_of, node, reader
from tests.foreign import built_crate
from tests.harness.effort import at_night
from tests.sdk.living import LivingStage, until

pytest.importorskip("rosbags", reason="the extra `ros2` is not installed")
pytestmark = [at_night, pytest.mark.process]
STARTS = 40.0
"""Seconds that a process with a node may take to be there, and a call on a busy machine."""
ROS2 = "https://w3id.org/selfconf/ros2/"
ADD, RATE, FIBONACCI = (
    "example_interfaces/srv/AddTwoInts",
    "rosbag2_interfaces/srv/SetRate",
    "action_tutorials_interfaces/action/Fibonacci",
)
PARAMETERS = "rcl_interfaces/srv/ListParameters"
CALLER = IRI("urn:c:caller")
Start = Callable[[str], tuple[subprocess.Popen[str], list[str]]]
"""Starts a node by its role; the process, and the lines that it says, a list that grows."""


@pytest.fixture(scope="session")
def judge() -> Path:
    """The program of the nodes."""
    return built_crate(Path(__file__).parent / "judge")


@pytest.fixture
def native(living: LivingStage, judge: Path) -> Iterator[Start]:
    """Nodes that end with the test."""
    found: list[subprocess.Popen[str]] = []

    def start(role: str) -> tuple[subprocess.Popen[str], list[str]]:
        command = (str(judge), living.endpoint, str(DOMAIN), role)
        found.append(subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True))
        return found[-1], lines_of(found[-1])

    yield start
    for process in found:
        process.kill()
        process.wait()
        if process.stdout is not None:
            process.stdout.close()


def test_topics_lead_from_native_nodes_to_components_and_back(
    living: LivingStage, tmp_path: Path, native: Start
) -> None:
    (talker, _), (_, heard), (_, seen) = native("talker"), native("listener"), native("observer")
    native("mapper")
    with bridging_domain(living, tmp_path / "ads") as found:
        assert until(lambda: all(map(found.lives, ("talker", "listener", "mapper"))), STARTS), found.complaints
        found.activate("talker")
        component = reader(living, text=(Wire(node("talker"), "talker/one"), Wire(node("mapper"), "map")))
        assert until(lambda: len(component.heard) > 2)
        assert component.heard[0][0]["data"].startswith("judge ")
        found.activate("mapper")  # long after it has published
        assert until(lambda: {"data": "the map"} in [value for value, _ in component.heard])
        found.activate("listener", two=(Wire(IRI("urn:c:reader"), "text"),))

        def arrives() -> bool:  # what is issued before a subscription is known is lost, as in ROS 2
            component.emit("text", {"data": "hello"})
            return "heard hello\n" in heard

        assert until(arrives)
        assert until(lambda: "selfconf_bridge publishes /two\n" in seen), seen
        talker.kill()
        assert until(lambda: found.causes() == [f"the node /talker has left the domain {DOMAIN} of ROS 2"])
        assert until(lambda: not found.lives("talker"))
        assert found.lives("listener")


class Caller(Component):
    """Calls what it is connected to, and adds for those that call it; it knows nothing of ROS 2."""

    def __init__(self) -> None:
        self.answers: list[Response] = []
        self.heard: list[Any] = []

    def received(self, port: str, signal: Signal) -> None:
        self.heard.append(signal.value)

    def called(self, operation: str, request: Signal) -> Any | Future[Any]:
        return {"sum": request.value["a"] + request.value["b"]}

    def ask(self, operation: str, request: Any, seconds: float = STARTS) -> Response:
        """What comes of a call."""
        known = len(self.answers)
        self.call(operation, request, answered=self.answers.append, seconds=seconds)
        assert until(lambda: len(self.answers) > known, STARTS)
        return self.answers[-1]


def caller(living: LivingStage, **inputs: tuple[Wire, ...]) -> Caller:
    """A caller that is active."""
    needed = {
        "add": (f"{ADD}_Request", f"{ADD}_Response"),
        "rate": (f"{RATE}_Request", f"{RATE}_Response"),
        "parameters": (f"{PARAMETERS}_Request", f"{PARAMETERS}_Response"),
        "count": (f"{FIBONACCI}_Goal", f"{FIBONACCI}_Result"),
    }
    ends = " ; ".join(
        f'sc:needsOperation [ sc:name "{name}" ; sc:optional true ; sc:request <{ROS2}{request}> ;'
        f" sc:response <{ROS2}{response}> ]"
        for name, (request, response) in needed.items()
    )
    ends += f' ; sc:hasOperation [ sc:name "sum" ; sc:request <{ROS2}{ADD}_Request> ;'
    ends += f" sc:response <{ROS2}{ADD}_Response> ]"
    ends += f' ; sc:hasInput [ sc:name "far" ; sc:optional true ; sc:signalType <{ROS2}{FIBONACCI}_FeedbackMessage> ]'
    component = living.component(living.advertised(Caller, f"<{CALLER}> a sc:Component, :Caller ; {ends} .")())
    held = living.call(CALLER, "reserve", Reserve(1, living.supervisor, "task~1"))
    assert until(lambda: held)
    apply = Apply(1, living.supervisor, "task~1", inputs=inputs, callers={"sum()": (node("client"),)})
    answers = living.call(CALLER, "apply", apply)
    assert until(lambda: answers and answers[0].active), answers
    return component


def connected(found: BridgedDomain, name: str, *operations: str) -> None:
    """Activate a node whose operations the caller calls."""
    assert until(lambda: found.is_complete(name, *operations), STARTS), found.complaints
    found.activate(name, {f"{operation}()": (CALLER,) for operation in operations})


def test_services_of_native_nodes_answer_and_their_clients_are_answered(
    living: LivingStage, tmp_path: Path, native: Start, monkeypatch: pytest.MonkeyPatch
) -> None:
    definition = tmp_path / "given" / "rosbag2_interfaces" / "srv" / "SetRate.srv"
    definition.parent.mkdir(parents=True)
    definition.write_text("float64 rate\n---\nbool success\n")
    for role in ("server", "player"):
        native(role)
    (_, answered), (_, seen) = native("client"), native("observer")
    with bridging_domain(living, tmp_path / "ads") as found:
        connected(found, "server", "three", "server/list_parameters")
        connected(found, "player", "set_rate")
        component = caller(
            living,
            **{
                "add()": (Wire(node("server"), "three()"),),
                "parameters()": (Wire(node("server"), "server/list_parameters()"),),
                "rate()": (Wire(node("player"), "set_rate()"),),
            },
        )
        assert component.ask("add", {"a": 40, "b": 2}).value == {"sum": 42}
        assert "result" in component.ask("parameters", {}).value
        assert "the fields of rosbag2_interfaces/srv/SetRate are not" in component.ask("rate", {"rate": 2.0}).detail
        assert ros2.learn([tmp_path / "given"]) == []
        assert component.ask("rate", {"rate": 2.0}).value == {"success": True}
        assert component.ask("rate", {"rate": 0.0}).value == {"success": False}
        assert until(lambda: found.lives("client"), STARTS), found.complaints
        found.activate("client", **{"four()": (Wire(CALLER, "sum()"),)})
        assert until(lambda: "answered 42\n" in answered, STARTS), found.complaints
        assert until(lambda: "selfconf_bridge serves /four\n" in seen), seen


def test_an_action_of_a_native_node_is_called_and_cancelled(living: LivingStage, tmp_path: Path, native: Start) -> None:
    _, said = native("counter")
    with bridging_domain(living, tmp_path / "ads") as found:
        connected(found, "counter", "count")
        component = caller(
            living,
            **{"count()": (Wire(node("counter"), "count()"),), "far": (Wire(node("counter"), "count/feedback"),)},
        )

        def counted() -> bool:  # what is published before a subscription is known is lost, as in ROS 2
            assert component.ask("count", {"order": 5}).value == {"sequence": [0, 1, 1, 2, 3]}
            return bool(component.heard)

        assert until(counted, STARTS)
        assert component.heard[0]["feedback"]["partial_sequence"].tolist()[:3] == [0, 1, 1]
        assert component.ask("count", {"order": -2}).detail == "the action /count does not accept the goal"
        assert component.ask("count", {"order": -1}).detail == "the goal of the action /count was aborted"
        assert component.ask("count", {"order": 100}, 1.0).status is CallStatus.LATE
        assert until(lambda: "canceled 100\n" in said), said


def test_a_native_lifecycle_node_is_configured_and_activated(
    living: LivingStage, tmp_path: Path, native: Start
) -> None:
    _, said = native("managed")
    with bridging_domain(living, tmp_path / "ads") as found:
        connected(found, "managed", "managed/change_state", "managed/get_state")
        assert until(lambda: said[-1:] == ["active\n"]), (said, found.causes())
        released = living.call(node("managed"), "release", Release(1, living.supervisor, "task~1"))
        assert until(lambda: released)
        assert until(lambda: said[-1] == "inactive\n"), said
