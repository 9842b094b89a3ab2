"""The nodes of a domain: they come, change and go, and what is not understood of them is a sentence."""

from __future__ import annotations

import socket
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path
from typing import cast

import pytest

from selfconf.bridging.bridge import Bridge
from selfconf.bridging.ros2.ros_world import LOOK_WHETHER_IT_LIVES, TOKENS_COMPLETE, RosWorld
from selfconf.bridging.ros2.tokens import RosNodeId, RosToken
from selfconf.bus.memory import Network
from selfconf.bus.zenoh import ZenohBus, client
from selfconf.errors import NetworkError
from selfconf.importing import ImportedDocument
from selfconf.model.term import IRI
from selfconf.protocol.messages import Release
from selfconf.sdk import Component
from tests.bridging.ros2.nodes import DOMAIN, STRING_KEY, StandIn, bridging_domain, node
from tests.sdk.living import LivingStage, until

pytest.importorskip("rosbags", reason="the extra `ros2` is not installed")
ROUTER = Path(__file__).resolve().parents[3] / "examples" / "ros2" / "router.py"


def test_nodes_come_and_go(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        talker = found.node("talker")
        talker.publishes("/chatter")
        assert until(lambda: found.lives("talker"))
        assert f"<{node('talker')}> a sc:Component, ros2:Node" in found.advertised()
        assert 'sc:name "chatter"' in found.advertised()
        talker.close()
        assert until(lambda: not found.lives("talker"))
        assert until(lambda: found.advertised() == "")
        assert found.complaints == [f"/talker is here, in the domain {DOMAIN} of ROS 2"]


@pytest.mark.slow
def test_a_node_that_goes_while_it_acts_fails_by_its_sentence(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        talker = found.node("talker")
        talker.publishes("/chatter")
        found.activate("talker")
        talker.close()
        assert until(lambda: found.causes() == [f"the node /talker has left the domain {DOMAIN} of ROS 2"])
        assert until(lambda: not found.lives("talker"))
        again = found.node("talker")
        again.publishes("/chatter")
        assert until(lambda: found.lives("talker") and "chatter" in found.advertised())
        found.activate("talker")


def test_a_node_that_cannot_be_advertised_for_now_is_so_later(living: LivingStage, tmp_path: Path) -> None:
    folder, away = tmp_path / "ads", tmp_path / "away"
    with bridging_domain(living, folder) as found:
        folder.rename(away)
        found.node("talker").publishes("/chatter")
        assert until(lambda: found.complained("/talker cannot be advertised: No such file or directory"))
        away.rename(folder)
        assert until(lambda: found.lives("talker"))


def test_a_node_that_offers_more_is_advertised_anew_once_it_is_free(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        talker = found.node("talker")
        talker.publishes("/chatter")
        found.activate("talker")
        talker.publishes("/more")
        answers = living.call(node("talker"), "release", Release(2, living.supervisor, "task~1"))
        assert until(lambda: answers)
        assert until(lambda: 'sc:name "more"' in found.advertised() and found.lives("talker"))
        assert found.causes() == []


def test_a_node_that_offers_less_fails(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        talker = found.node("talker")
        talker.publishes("/chatter")
        take_back = talker.token("MP", "/more")
        assert until(lambda: 'sc:name "more"' in found.advertised())
        found.activate("talker")
        take_back()
        assert until(lambda: found.causes() == ["the node /talker offers less than before"])
        assert until(lambda: 'sc:name "more"' not in found.advertised())


def test_a_node_that_makes_an_endpoint_anew_offers_what_it_did_before(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        talker = found.node("talker")
        leave, leave_hidden = talker.token("MS", "/chatter"), talker.token("MS", "/_hidden")
        assert until(lambda: found.is_complete("talker", "chatter"))
        found.activate("talker")
        leave_hidden()
        leave()
        talker.token("MS", "/chatter")
        found.node("later").publishes("/later")
        assert until(lambda: found.is_complete("later", "later"))
        assert found.causes() == []


def test_of_two_nodes_of_one_name_the_first_counts(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        first = found.node("talker")
        first.publishes("/one")
        assert until(lambda: found.lives("talker"))
        found.node("talker").publishes("/two")
        assert until(lambda: found.complained("two nodes are called /talker"))
        assert 'sc:name "two"' not in found.advertised()
        first.close()
        assert until(lambda: 'sc:name "two"' in found.advertised() and found.lives("talker"))


@pytest.mark.slow
def test_a_node_that_another_bridge_stands_for_lives_here_when_that_has_gone(
    living: LivingStage, tmp_path: Path
) -> None:
    talker = StandIn(living.endpoint, "talker", "a" * 32)
    talker.publishes("/chatter")
    with ExitStack() as stack:
        stack.callback(talker.close)
        with bridging_domain(living, tmp_path / "first") as first:
            assert until(lambda: first.lives("talker"))
            second = stack.enter_context(bridging_domain(living, tmp_path / "second"))
            assert until(lambda: second.complained("/talker: urn:selfconf:ros2:42/talker is alive already"))
        assert until(lambda: second.lives("talker"))
        second.activate("talker")
        assert second.causes() == []


class BegunLives:
    """A bridge that notes the lives which it is to begin; the first begins at once, any other takes its time."""

    def __init__(self) -> None:
        self.asked: list[Component] = []
        self._alive = False

    def complain(self, sentence: str) -> None:
        pass

    def advertise(self, component: IRI, document: ImportedDocument) -> None:
        self._alive = False

    def withdraw(self, component: IRI) -> None:
        self._alive = False

    def end_life(self, component: IRI, code: Component) -> None:
        pass

    def lives(self, component: IRI) -> bool:
        return self._alive

    def begin_life(self, component: IRI, code: Component) -> Future[str | None]:
        outcome: Future[str | None] = Future()
        self.asked.append(code)
        if len(self.asked) == 1:
            self._alive = True
            outcome.set_result(None)
        return outcome


def test_a_node_that_is_made_anew_in_its_process_lives_as_the_new_one_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    network, bridge = Network(1), BegunLives()
    bus = network.node()
    monkeypatch.setattr(bus, "watch_link", lambda changed: None, raising=False)
    world = RosWorld(lambda: cast(ZenohBus, bus), DOMAIN, cast(Bridge, bridge))
    token = RosToken(RosNodeId(DOMAIN, "a", 0), "", "talker").key()
    for seconds, alive in ((0.0, True), (LOOK_WHETHER_IT_LIVES - 0.1, False), (0.0, True)):
        network.run(lambda: False, seconds)
        world._changed(token, alive)
    network.run(lambda: False, TOKENS_COMPLETE + LOOK_WHETHER_IT_LIVES)
    assert len(bridge.asked) == 2, "once each: the one before begins no life any more"


def test_qualities_that_ros_does_not_connect_are_named(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        found.node("camera").token("MP", "/image", "2::,5:,:,:,,")
        found.node("viewer").token("MS", "/image")
        found.node("recorder").token("MS", "/image", "2::,5:,:,:,,")
        assert until(lambda: all(found.lives(name) for name in ("camera", "viewer", "recorder")))
        sentence = "/image: /camera publishes best_effort, not reliable as /viewer asks; ROS 2 does not connect them"
        assert until(lambda: found.complained(sentence))
        assert not found.complained("/recorder asks")


def test_humble_and_what_is_no_token_are_named_and_hinder_nothing(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        old = found.node("old")
        old.token("MP", "/chatter", key="std_msgs::msg::dds_::String_/TypeHashNotSupported")
        old.bus.announce(f"@ros2_lv/{DOMAIN}/what")
        old.token("MP", "/long", f"::,10:{'9' * 400},:,:,,")
        found.node("_tool").publishes("/chatter")
        found.node("talker").publishes("/chatter")
        assert until(lambda: found.lives("talker"))
        assert until(lambda: found.complained("the types of the node /old have no hash, as in humble"))
        assert until(lambda: found.complained("is no token of rmw_zenoh"))
        assert until(lambda: found.complained("is no quality of service of rmw_zenoh"))
        assert STRING_KEY not in found.advertised()
        assert "_tool" not in found.advertised()


def free_port() -> int:
    """A port of loopback on which nothing listens."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


@contextmanager
def router_process(port: int) -> Iterator[None]:
    """A router of the examples, killed in the end: what is closed in this process may keep a client's link for good."""
    words = [sys.executable, str(ROUTER), "--port", str(port)]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            assert process.stdout.readline() == f"relaying on tcp/127.0.0.1:{port}\n"
            yield
        finally:
            process.kill()


@pytest.mark.process
def test_a_router_that_goes_and_comes_is_named_though_no_task_holds_a_node(living: LivingStage, tmp_path: Path) -> None:
    lost = "the router of ROS 2 cannot be reached any more; its nodes are gone until it is there again"
    back = "the router of ROS 2 is reached again"
    complaints: list[str] = []
    bridge, port = Bridge(tmp_path, complaints.append), free_port()
    world = partial(RosWorld, partial(client, [f"tcp/127.0.0.1:{port}"]), DOMAIN)
    with ExitStack() as ecology:
        with router_process(port):
            ecology.enter_context(bridge.living(world, living.ecology, living.node))
        assert until(lambda: complaints == [lost]), complaints
        with router_process(port):
            assert until(lambda: complaints == [lost, back]), complaints
            ecology.close()


@pytest.mark.slow
def test_a_router_that_is_not_there_is_said_to_be_missing(living: LivingStage, tmp_path: Path) -> None:
    world = partial(RosWorld, partial(client, ["tcp/127.0.0.1:1"]), DOMAIN)
    bridge = Bridge(tmp_path, lambda words: None)
    with pytest.raises(NetworkError), bridge.living(world, living.ecology, living.node):
        pass
