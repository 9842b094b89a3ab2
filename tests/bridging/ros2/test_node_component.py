"""A node as a component: messages are relayed as the bytes they are, read only where no node receives them."""

from __future__ import annotations

import json
import math
import struct
from pathlib import Path

import pytest
import zenoh
import zenoh.ext

from selfconf import ros2
from selfconf.bridging.ros2 import node_component
from selfconf.bridging.ros2.node_component import written
from selfconf.bus.port import Request, Urgency
from selfconf.model.term import IRI
from selfconf.protocol.messages import Wire
from selfconf.sdk import Signal
from tests.bridging.ros2.nodes import DOMAIN, STRING_KEY, StandIn, bridging_domain, node, reader, text
from tests.ros2.test_messages import STRING_HASH
from tests.sdk.living import LivingStage, until

pytest.importorskip("rosbags", reason="the extra `ros2` is not installed")
OTHER_HASH = "RIHS01_" + "0" * 64


def test_what_a_node_publishes_goes_to_another_topic_byte_by_byte(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        talker, listener = found.node("talker"), found.node("listener")
        publish, heard = talker.publishes("/one/chatter"), listener.hears("/chatter")
        found.activate("talker")
        found.activate("listener", chatter=(Wire(node("talker"), "one/chatter"),))

        def arrives() -> bool:
            publish(text("hello"))
            return bool(heard)

        assert until(arrives)
        assert heard[0].payload == text("hello")
        number, nanoseconds, size, identifier = struct.unpack("<qqB16s", heard[0].attachment)
        assert (size, len(identifier)) == (16, 16)
        assert number == 1
        assert nanoseconds % 10**9 == 0  # the time of the message, not of the relay


def test_a_component_reads_the_fields_of_a_message_or_a_signal_of_what_it_says(
    living: LivingStage, tmp_path: Path
) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        publish = found.node("talker").publishes("/chatter")
        found.activate("talker")
        component = reader(living, text=(Wire(node("talker"), "chatter"), Wire(node("talker"), "chatter as Text")))

        def arrives() -> bool:
            publish(text("hello"))
            return {str(value) for value, _ in component.heard} == {"{'data': 'hello'}", "{'text': 'hello'}"}

        assert until(arrives), component.heard


def test_a_message_that_no_signal_can_say_is_relayed_all_the_same(living: LivingStage, tmp_path: Path) -> None:
    kind = ros2.usual_type("sensor_msgs/msg/Temperature")
    assert kind is not None
    key = f"sensor_msgs::msg::dds_::Temperature_/{kind.hash}"
    unknown, known = (ros2.message({"temperature": each}, kind) for each in (math.nan, 21.5))
    with bridging_domain(living, tmp_path / "ads") as found:
        publish = found.node("sensor").publishes("/inside", key=key)
        heard = found.node("display").hears("/shown", key=key)
        found.activate("sensor")
        found.activate("display", shown=(Wire(node("sensor"), "inside"),))

        def arrives() -> bool:
            publish(unknown)
            return bool(heard)

        assert until(arrives)
        publish(known)
        assert until(lambda: heard[-1].payload == known)
        sentence = "/inside: what /sensor publishes is no signal on 'inside as Temperature', as that has nan as"
        assert sum(one.startswith(sentence) for one in found.complaints) == 1
        assert found.causes() == []


def test_an_object_is_published_as_a_message_and_ros_sees_who_publishes(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        listener = found.node("listener")
        heard, tokens = listener.hears("/chatter"), list[str]()
        listener.bus.watch(f"@ros2_lv/{DOMAIN}/**", lambda key, alive: tokens.append(key) if alive else None)
        component = reader(living)
        found.activate("listener", chatter=(Wire(IRI("urn:c:reader"), "text"),))

        def arrives() -> bool:
            component.emit("text", {"data": "hello"})
            return bool(heard)

        assert until(arrives)
        component.emit("text", {"text": "good evening"})
        assert until(lambda: heard[-1].payload == text("good evening"))
        assert heard[0].payload == text("hello")
        assert until(lambda: any(f"/MP/%/%/selfconf_bridge/%chatter/{STRING_KEY}/" in key for key in tokens))
        assert any(key.endswith("/NN/%/%/selfconf_bridge") for key in tokens)


def test_what_came_over_a_topic_is_not_brought_there_twice(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        publish, heard = found.node("talker").publishes("/chatter"), found.node("listener").hears("/chatter")
        found.activate("talker")
        found.activate("listener", chatter=(Wire(node("talker"), "chatter"),))
        component = reader(living, text=(Wire(node("talker"), "chatter"),))

        def arrives() -> bool:
            publish(text(str(len(heard))))
            return len(component.heard) > 5

        assert until(arrives)
        assert until(lambda: len(heard) >= len(component.heard))
        assert len({sample.attachment[-16:] for sample in heard}) == 1  # all of them by the talker itself


def test_a_type_of_another_hash_is_not_relayed(living: LivingStage, tmp_path: Path) -> None:
    other = STRING_KEY.replace(STRING_HASH, OTHER_HASH)
    with bridging_domain(living, tmp_path / "ads") as found:
        publish, heard = found.node("talker").publishes("/one", key=other), found.node("listener").hears("/two")
        found.activate("talker")
        found.activate("listener", two=(Wire(node("talker"), "one"),))

        def refused() -> bool:
            publish(text("hello"))
            return found.complained("/two: what talker issues is no std_msgs/msg/String by its hash")

        assert until(refused)
        assert heard == []
        assert found.causes() == []


def test_an_object_that_cannot_be_a_message_is_a_sentence(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        heard = found.node("listener").hears("/chatter")
        strange = found.node("stranger").hears("/mood", key=f"lab_msgs::msg::dds_::Mood_/{OTHER_HASH}")
        component = reader(living)
        source = (Wire(IRI("urn:c:reader"), "text"),)
        found.activate("listener", chatter=source)
        found.activate("stranger", mood=source)

        def refused() -> bool:
            component.emit("text", {"words": "hello"})
            return found.complained("has words, which std_msgs/msg/String has not") and found.complained(
                "the fields of lab_msgs/msg/Mood are not known"
            )

        assert until(refused)
        assert heard == strange == []
        assert sum("has words" in one for one in found.complaints) == 1


@pytest.mark.parametrize("heading", [None, "north", 10**400, math.inf])
def test_an_object_that_cannot_be_translated_is_a_sentence(heading: object) -> None:
    kind = ros2.usual_type("geometry_msgs/msg/PoseStamped")
    assert kind is not None
    pose = Signal({"x": 1.0, "y": 2.0, "theta": heading, "frame": ""}, IRI("urn:c:odometry"), 0.0, 1)
    with pytest.raises(ros2.MessageError, match=r"^is no PlanarPose2D: "):
        written(pose, kind)


def test_broken_bytes_are_blamed_on_the_node_that_publishes_them(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        broken, fine = found.node("broken").publishes("/broken"), found.node("fine").publishes("/fine")
        for name in ("broken", "fine"):
            found.activate(name)
        component = reader(living, text=(Wire(node("broken"), "broken"), Wire(node("fine"), "fine")))

        def fails() -> bool:
            broken(b"\x00\x01\x00\x00\xff\xff\xff\xff")
            return bool(found.causes())

        assert until(fails)
        assert found.causes()[0].startswith("what /broken publishes on /broken is no std_msgs/msg/String")

        def arrives() -> bool:
            fine(text("hello"))
            return bool(component.heard)

        assert until(arrives)


def test_what_is_published_without_an_attachment_is_passed_over(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        talker = found.node("talker")
        talker.publishes("/chatter")
        found.activate("talker")
        stray = talker.bus.publisher(f"{DOMAIN}/chatter/{STRING_KEY}", Urgency.SIGNAL)

        def complained() -> bool:
            stray.put(text("hello"), b"short")
            return found.complained("/chatter: passed over what was published there: an attachment of 5 octets")

        assert until(complained)


def test_of_two_publishers_of_a_topic_none_is_guessed(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        talkers = [found.node("one"), found.node("two")]
        publish, _ = [talker.publishes("/chatter") for talker in talkers]
        found.activate("one")
        component = reader(living, text=(Wire(node("one"), "chatter"),))

        def complained() -> bool:
            publish(text("hello"))
            return found.complained("/chatter: 2 nodes publish there, and which message is whose cannot be said")

        assert until(complained)
        assert component.heard == []
        talkers[1].close()

        def arrives() -> bool:
            publish(text("hello"))
            return bool(component.heard)

        assert until(arrives)


def test_a_flood_is_cut_and_named(living: LivingStage, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(node_component, "MOST_MESSAGES", 20)
    with bridging_domain(living, tmp_path / "ads") as found:
        publish = found.node("talker").publishes("/chatter")
        found.activate("talker")

        def flooded() -> bool:
            for _ in range(200):
                publish(text("hello"))
            return found.complained("/chatter: more than 20 messages a second; the rest is dropped")

        assert until(flooded)
        assert found.causes() == []


def test_what_a_publisher_keeps_is_asked_for(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        talker: StandIn = found.node("talker")
        talker.publishes("/map", ":1:,1:,:,:,,")
        key = f"{DOMAIN}/map/{STRING_KEY}"

        def answer(request: Request) -> None:  # as the cache of an advanced publisher of Zenoh does
            request.reply(key, text("the map"), struct.pack("<qqB16s", 1, 10**9, 16, b"-" * 16))
            request.finish()

        talker.bus.serve(f"{key}/@adv/pub/1/2/_", answer)
        assert until(lambda: found.lives("talker"))
        component = reader(living, text=(Wire(node("talker"), "map"),))
        found.activate("talker")
        assert until(lambda: component.heard)
        assert component.heard[0] == ({"data": "the map"}, 1.0)


def joining(stage: LivingStage) -> zenoh.Config:
    """How a session of somebody else joins the network of a stage."""
    found = zenoh.Config()
    found.insert_json5("mode", '"client"')
    found.insert_json5("connect/endpoints", json.dumps([stage.endpoint]))
    return found


def test_who_comes_late_to_a_topic_gets_what_was_relayed_before(living: LivingStage, tmp_path: Path) -> None:
    latched = ":1:,1:,:,:,,"
    with bridging_domain(living, tmp_path / "ads") as found, zenoh.open(joining(living)) as late:
        publish, heard = found.node("server").publishes("/map", latched), found.node("viewer").hears("/shown", latched)
        found.activate("server")
        found.activate("viewer", shown=(Wire(node("server"), "map"),))

        def arrives() -> bool:
            publish(text("the map"))
            return bool(heard)

        assert until(arrives)
        got: list[bytes] = []
        history = zenoh.ext.HistoryConfig(detect_late_publishers=True)  # as rmw_zenoh's subscriptions of this kind do
        zenoh.ext.declare_advanced_subscriber(
            late,
            f"{DOMAIN}/shown/{STRING_KEY}",
            lambda sample: got.append(bytes(sample.payload)),
            history=history,
            subscriber_detection=True,
        )
        assert until(lambda: got)
        assert got[0] == text("the map")
