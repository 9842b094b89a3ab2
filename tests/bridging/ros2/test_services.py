"""Services as operations: a component calls a node's, a node calls a component's, and a node another one's."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import pytest

from selfconf.bus.port import Replies
from selfconf.model.term import IRI
from selfconf.protocol.messages import Reserve, Wire
from selfconf.sdk import Component, Refused, Response, Signal
from tests.bridging.ros2.nodes import ADD_KEY, DOMAIN, BridgedDomain, StandIn, bridging_domain, node
from tests.sdk.living import LivingStage, until

pytest.importorskip("rosbags", reason="the extra `ros2` is not installed")
LONG = 40.0
"""Seconds that a call may take on a busy machine: the first one of a service makes the code that reads it."""
CALL, ADDER = "add()", IRI("urn:c:adder")
PARTS = "https://w3id.org/selfconf/ros2/example_interfaces/srv/AddTwoInts"
TYPES = f"sc:request <{PARTS}_Request> ; sc:response <{PARTS}_Response>"
OTHER_KEY = "lab_msgs::srv::dds_::Brew_/RIHS01_" + "0" * 64


def asked(a: int, b: int) -> bytes:
    """A request of AddTwoInts."""
    return b"\x00\x01\x00\x00" + struct.pack("<qq", a, b)


def answered(total: int) -> bytes:
    """A response of AddTwoInts."""
    return b"\x00\x01\x00\x00" + struct.pack("<q", total)


def adds(payload: bytes, attachment: bytes) -> tuple[bytes, bytes]:
    """A server, as rmw_zenoh has it: the attachment comes back with the time of the response."""
    number, _, size, identifier = struct.unpack("<qqB16s", attachment)
    return answered(sum(struct.unpack("<qq", payload[4:]))), struct.pack("<qqB16s", number, 2, size, identifier)


class Adder(Component):
    """Calls for sums, and adds; it knows nothing of ROS 2."""

    def __init__(self) -> None:
        self.answers: list[Response] = []
        self.requests: list[Signal] = []

    def called(self, operation: str, request: Signal) -> Any:
        self.requests.append(request)
        if request["a"] < 0:
            raise Refused("I count upwards only")
        if request["a"] == 0:
            return b"\x89PNG"
        return {"sum": request["a"] + request["b"]}


def adder(living: LivingStage, ends: str, **more: Any) -> Adder:
    """A component with operations that is active."""
    kind = living.advertised(Adder, f"<{ADDER}> a sc:Component, :Adder ; {ends} .")
    component = living.component(kind())
    held = living.call(ADDER, "reserve", Reserve(1, living.supervisor, "task~1"))
    assert until(lambda: held)
    answers = living.apply(ADDER, **more)
    assert until(lambda: answers and answers[0].active), answers
    return component


def replies_to(found: BridgedDomain, client: StandIn, service: str, payload: bytes) -> Replies:
    """What comes of a call of a service, which is repeated until somebody serves it."""
    calls = [client.asks(service, payload)]

    def replied() -> bool:
        if calls[-1] == [Replies()]:
            calls.append(client.asks(service, payload))
        return bool(calls[-1])

    assert until(replied, LONG), found.complaints
    return calls[-1][0]


def test_a_component_calls_the_service_of_a_node(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        server = found.node("server")
        server.serves("/lab/add", adds)
        server.serves("/lab/brew", lambda payload, attachment: (b"tea", attachment), OTHER_KEY)
        server.serves("/lab/garbled", lambda payload, attachment: (b"\x00", attachment))
        names = ("lab/add()", "lab/brew()", "lab/garbled()")
        assert until(lambda: found.is_complete("server", "lab/add", "lab/brew", "lab/garbled"))
        found.activate("server", dict.fromkeys(names, (ADDER,)))
        wires = {f"{name}()": (Wire(node("server"), other),) for name, other in zip("sbg", names, strict=True)}
        needs = " , ".join(f'[ sc:name "{name}" ; {TYPES} ]' for name in "sbg")
        component = adder(living, f"sc:needsOperation {needs}", inputs=wires)

        def ask(operation: str, request: Any, media: str = "") -> Response:
            known = len(component.answers)
            component.call(operation, request, answered=component.answers.append, seconds=LONG, media=media)
            assert until(lambda: len(component.answers) > known, LONG)
            return component.answers[-1]

        assert ask("s", {"a": 20, "b": 22}).value == {"sum": 42}
        assert ask("s", {"a": 20, "c": 22}).detail == (
            "what adder asks has c, which example_interfaces/srv/AddTwoInts_Request has not"
        )
        assert ask("s", asked(1, 2)).detail == (
            "what adder asks is no request of example_interfaces/srv/AddTwoInts by its hash"
        )
        assert ask("b", {"milk": True}).detail.startswith("the fields of lab_msgs/srv/Brew are not known")
        media = f'application/cdr; type="lab_msgs/srv/Brew"; hash=RIHS01_{"0" * 64}'
        assert ask("b", b"\x00\x01\x00\x00milk", media).value == b"tea"
        assert ask("g", {}).detail.startswith("what the service /lab/garbled answers is no ")
        assert found.causes() == []


def test_a_node_calls_a_component_and_ros_sees_who_serves(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        client, tokens = found.node("client"), list[str]()
        client.token("SC", "/add", key=ADD_KEY)
        client.bus.watch(f"@ros2_lv/{DOMAIN}/**/SS/**", lambda key, alive: tokens.append(key) if alive else None)
        component = adder(living, f'sc:hasOperation [ sc:name "add" ; {TYPES} ]', callers={"add()": (node("client"),)})
        assert until(lambda: found.is_complete("client", "add"))
        found.activate("client", **{CALL: (Wire(ADDER, CALL),)})
        (sample,) = replies_to(found, client, "/add", asked(20, 22)).samples
        assert sample.payload == answered(42)
        number, _, size, identifier = struct.unpack("<qqB16s", sample.attachment)
        assert (number, size, identifier) == (7, 16, b"c" * 16)
        assert component.requests[-1].value == {"a": 20, "b": 22}
        assert any("/SS/%/%/selfconf_bridge/%add/" in key for key in tokens)
        assert replies_to(found, client, "/add", asked(-1, 0)).errors == ("I count upwards only",)
        assert "AddTwoInts_Request" in replies_to(found, client, "/add", b"short").errors[0]
        (error,) = replies_to(found, client, "/add", asked(0, 1)).errors
        assert error.startswith("what is answered is no example_interfaces/srv/AddTwoInts_Response")


def test_a_call_of_several_clients_is_made_once(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        clients = [found.node(name) for name in ("one", "two")]
        for client in clients:
            client.token("SC", "/add", key=ADD_KEY)
        callers = tuple(node(client.name) for client in clients)
        component = adder(living, f'sc:hasOperation [ sc:name "add" ; {TYPES} ]', callers={CALL: callers})
        assert until(lambda: found.advertised().count('sc:name "add"') == 2)
        for client in clients:
            found.activate(client.name, **{CALL: (Wire(ADDER, CALL),)})
        assert until(lambda: found.complained("/add: several nodes call it"))
        known = len(component.requests)
        for client in clients:
            assert replies_to(found, client, "/add", asked(20, 22)).samples[0].payload == answered(42)
        assert len(component.requests) == known + 2


def test_a_component_answers_while_no_node_serves_however_servers_come_and_go(
    living: LivingStage, tmp_path: Path
) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        client, server = found.node("client"), found.node("server")
        client.token("SC", "/add", key=ADD_KEY)
        server.serves("/add", adds)
        component = adder(living, f'sc:hasOperation [ sc:name "add" ; {TYPES} ]', callers={CALL: (node("client"),)})
        assert until(lambda: found.is_complete("client", "add") and found.is_complete("server", "add"))
        found.activate("client", **{CALL: (Wire(ADDER, CALL),)})
        assert until(lambda: found.complained("/add: a node of ROS 2 serves it"))
        server.close()
        assert replies_to(found, client, "/add", asked(20, 22)).samples[0].payload == answered(42)
        known = len(component.requests)
        assert known
        tokens: list[bool] = []
        client.bus.watch(f"@ros2_lv/{DOMAIN}/**/SS/**", lambda key, alive: tokens.append(alive))
        assert until(lambda: tokens == [True])
        found.node("server").serves("/add", adds)
        assert until(lambda: tokens == [True, True, False])
        assert replies_to(found, client, "/add", asked(1, 2)).samples[0].payload == answered(3)
        assert len(component.requests) == known


def test_a_node_calls_another_one_by_another_name(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        server, client = found.node("server"), found.node("client")
        server.serves("/one/add", adds)
        client.token("SC", "/two/add", key=ADD_KEY)
        client.token("SC", "/one/add", key=ADD_KEY)
        assert until(lambda: found.is_complete("server", "one/add") and found.is_complete("client", "two/add"))
        found.activate("server", {"one/add()": (node("client"),)})
        wire = (Wire(node("server"), "one/add()"),)
        found.activate("client", **{"two/add()": wire, "one/add()": wire})
        assert replies_to(found, client, "/two/add", asked(1, 2)).samples[0].payload == answered(3)
        assert until(lambda: found.complained("/one/add: a node of ROS 2 serves it"))
        server.close()
        assert until(lambda: not found.lives("server"))
        assert "server" in replies_to(found, client, "/two/add", asked(1, 2)).errors[0]
