"""Messages of ROS 2: types by name and hash, CDR read and written, and what is none refused in a sentence."""

from __future__ import annotations

import random
import struct
from array import array
from typing import Any

import orjson
import pytest

from selfconf.ros2 import messages
from selfconf.ros2.messages import MessageError, MessageMedia, MessageType, read_media

pytest.importorskip("rosbags", reason="the extra `ros2` is not installed")
STRING_HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
"""As rmw_zenoh of jazzy writes it."""
STRING = MessageType("std_msgs/msg/String", STRING_HASH)
HELLO = b"\x00\x01\x00\x00" + struct.pack("<I", 6) + b"hello\x00"


def usual(name: str) -> MessageType:
    found = messages.usual_type(name)
    assert found is not None
    return found


def test_a_message_is_read_and_written_as_ros_does() -> None:
    messages.load()
    assert usual("std_msgs/msg/String") == STRING
    assert messages.message_fields(HELLO, STRING) == {"data": "hello"}
    assert messages.message({"data": "hello"}, STRING) == HELLO


def test_a_type_is_made_once_for_all_distributions() -> None:
    first, *others = messages._stores()  # made anew they would take as long for each distribution
    for name in ("std_srvs/srv/Trigger_Request", "std_srvs/srv/Trigger_Response"):
        assert all(store.types[name] is first.types[name] for store in others)
        assert all(store.hash_rihs01(name) == first.hash_rihs01(name) for store in others)


def test_what_is_not_given_is_zero_and_arrays_are_those_of_numpy() -> None:
    scan = usual("sensor_msgs/msg/LaserScan")
    fields = messages.message_fields(messages.message({"ranges": [1, 2.5], "header": {"frame_id": "x"}}, scan), scan)
    assert fields["header"] == {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": "x"}
    assert fields["ranges"].tolist() == [1.0, 2.5]
    assert fields["angle_min"] == 0.0
    transforms = usual("tf2_msgs/msg/TFMessage")
    payload = messages.message({"transforms": [{"child_frame_id": "a"}, {}]}, transforms)
    assert [one["child_frame_id"] for one in messages.message_fields(payload, transforms)["transforms"]] == [
        "a",
        "",
    ]


@pytest.mark.parametrize(
    ("fields", "kind", "words"),
    [
        ({"data": 3}, "std_msgs/msg/String", "is no std_msgs/msg/String"),
        ({"text": "x"}, "std_msgs/msg/String", "has text, which std_msgs/msg/String has not"),
        ("x", "std_msgs/msg/String", "is no object"),
        ({"header": 3}, "sensor_msgs/msg/LaserScan", "is no object, where std_msgs/msg/Header has fields"),
        ({"ranges": ["far"]}, "sensor_msgs/msg/LaserScan", r"has a value that is no float32\[\]"),
        ({"ranges": [1e39]}, "sensor_msgs/msg/LaserScan", r"has a value that is no float32\[\]"),
        ({"data": [1.7]}, "std_msgs/msg/Int32MultiArray", r"has a value that is no int32\[\]"),
        ({"data": "12"}, "std_msgs/msg/Int32MultiArray", r"has a value that is no int32\[\]"),
        ({"data": array("h", [300])}, "sensor_msgs/msg/Image", r"has a value that is no uint8\[\]"),
        ({"data": array("b", [-1])}, "sensor_msgs/msg/Image", r"has a value that is no uint8\[\]"),
        ({"sec": 1 << 40}, "builtin_interfaces/msg/Time", "is no builtin_interfaces/msg/Time"),
        ({"covariance": [0.1] * 35}, "geometry_msgs/msg/PoseWithCovariance", "Unexpected array length"),
        ({"names": "speed"}, "rcl_interfaces/srv/GetParameters_Request", r"has a value that is no string\[\]"),
        ({"transforms": {}}, "tf2_msgs/msg/TFMessage", r"no geometry_msgs/msg/TransformStamped\[\]"),
        ({"data": orjson.loads("[" * 1020 + "]" * 1020)}, "std_msgs/msg/Bool", "where a bool is true or false"),
        ({"data": "false"}, "std_msgs/msg/Bool", "has 'false', where a bool is true or false"),
    ],
)
def test_an_object_that_is_no_message_is_said_to_be_none(fields: Any, kind: str, words: str) -> None:
    with pytest.raises(MessageError, match=words):
        messages.message(fields, usual(kind))


def test_what_is_read_of_a_message_of_any_type_can_be_written_again() -> None:
    state = usual("lifecycle_msgs/msg/State")  # constants of a type are no fields
    assert messages.message_fields(messages.message({}, state), state) == {"id": 0, "label": ""}
    for name in messages._stores()[0].fielddefs:
        kind = usual(name)
        payload = messages.message({}, kind)
        assert messages.message(messages.message_fields(payload, kind), kind) == payload, name


def test_an_array_of_numbers_may_be_written_in_several_ways() -> None:
    numbers = usual("std_msgs/msg/UInt8MultiArray")
    wanted = messages.message({"data": [0, 7, 255]}, numbers)
    for given in ((None, 7.0, 255), bytes((0, 7, 255)), bytearray((0, 7, 255)), array("d", (0, 7, 255))):
        assert messages.message({"data": given}, numbers) == wanted


def test_whole_numbers_are_written_exactly_though_a_double_has_not_all_of_them() -> None:
    for name, given in {"UInt64": [1, None, (1 << 63) + 1], "Int64": [(1 << 53) + 1, 1.0, -(1 << 63)]}.items():
        kind = usual(f"std_msgs/msg/{name}MultiArray")
        read = messages.message_fields(messages.message({"data": given}, kind), kind)["data"]
        assert read.tolist() == [one or 0 for one in given]


def test_a_byte_has_no_sign() -> None:
    one, several = usual("std_msgs/msg/Byte"), usual("std_msgs/msg/ByteMultiArray")
    assert messages.message_fields(messages.message({"data": 200}, one), one) == {"data": 200}
    payload = messages.message({"data": [0, 200, 255]}, several)
    assert payload.endswith(b"\x00\xc8\xff")
    assert messages.message_fields(payload, several)["data"].tolist() == [0, 200, 255]


def test_a_type_is_known_by_its_hash() -> None:
    assert messages.is_known(STRING)
    assert not messages.is_known(STRING._replace(hash="RIHS01_" + "0" * 64))
    assert not messages.is_known(MessageType("lab_msgs/msg/Mood", STRING_HASH))
    assert messages.usual_type("lab_msgs/msg/Mood") is None


def test_a_media_type_says_the_type_and_where_it_was_published() -> None:
    assert read_media(STRING.media()) == MessageMedia(STRING, "")
    assert read_media(STRING.media("7/chatter")) == MessageMedia(STRING, "7/chatter")
    assert read_media("application/cdr") is None
    assert read_media("image/png") is None


def test_a_signal_is_received_as_its_fields_if_its_type_is_known() -> None:
    assert messages.received(HELLO, STRING.media("7/chatter")) == {"data": "hello"}
    unknown = STRING._replace(hash="RIHS01_" + "0" * 64)
    assert messages.received(HELLO, unknown.media()) == HELLO
    assert messages.received(HELLO, "image/png") == HELLO
    assert messages.received({"on": True}, "") == {"on": True}


def test_broken_bytes_are_refused_and_nothing_else_happens() -> None:
    chance = random.Random(20)
    broken = 0
    for name in (
        "std_msgs/msg/String",
        "sensor_msgs/msg/PointCloud2",
        "tf2_msgs/msg/TFMessage",
        "sensor_msgs/msg/Image",
    ):
        kind = usual(name)
        whole = messages.message({}, kind)
        for _ in range(500):
            octets = bytearray(whole + chance.randbytes(chance.randrange(40)))
            for _ in range(chance.randrange(1, 4)):
                octets[chance.randrange(len(octets))] = chance.randrange(256)
            try:
                messages.check_message(bytes(octets[: chance.randrange(len(octets) + 1)]), kind)
            except MessageError:
                broken += 1
    assert broken > 1000
