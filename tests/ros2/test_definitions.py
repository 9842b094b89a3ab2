"""Definitions of interfaces of ROS 2: what is read, with which types and hashes, and what is left out and why."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from selfconf.errors import AuthorError
from selfconf.ros2 import definitions, messages
from selfconf.ros2.definitions import InterfaceDefinition, complete_types, defined_types, read_definitions
from selfconf.ros2.messages import MessageType

pytest.importorskip("rosbags", reason="the extra `ros2` is not installed")
DRIVE = """\
# Where to.
geometry_msgs/PoseStamped pose
Mood mood
string<=20[] notes ["a # b"]  # for the driver
---
uint16 NONE=0
uint16 error_code
---
float32 from
builtin_interfaces/Duration[<=3] times
"""


@pytest.fixture
def forgotten() -> Iterator[None]:
    """What a test has learned is forgotten after it."""
    yield
    messages.learn([])


def defined(folder: Path, **texts: str) -> Path:
    """A folder with definitions of the package `lab_msgs`, each by its name, two underscores and its kind."""
    for name, text in texts.items():
        stem, kind = name.split("__")
        path = folder / "share" / "lab_msgs" / kind / f"{stem}.{kind}"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder


def usual(name: str) -> MessageType:
    """A type that is known."""
    found = messages.usual_type(name)
    assert found is not None
    return found


@pytest.mark.usefixtures("forgotten")
def test_an_action_is_called_by_what_its_definition_says(tmp_path: Path) -> None:
    folder = defined(tmp_path, Mood__msg="char letter\nbool good True\n", Drive__action=DRIVE)
    assert messages.learn([folder]) == []
    parts = messages.service_parts(usual("lab_msgs/action/Drive_SendGoal"))
    assert parts is not None
    goal = {"pose": {"header": {"frame_id": "map"}}, "mood": {"letter": 65}, "notes": ["slowly"]}
    said = messages.message_fields(messages.message({"goal": goal}, parts.request), parts.request)
    assert said["goal"]["notes"] == ["slowly"]
    assert said["goal"]["mood"] == {"letter": 65, "good": False}
    assert said["goal"]["pose"]["header"]["frame_id"] == "map"
    feedback = usual("lab_msgs/action/Drive_Feedback")
    payload = messages.message({"from": 2.5, "times": [{"sec": 3}]}, feedback)  # a word of Python as a name
    assert messages.message_fields(payload, feedback) == {"from": 2.5, "times": [{"sec": 3, "nanosec": 0}]}
    messages.learn([])
    assert messages.usual_type("lab_msgs/action/Drive_SendGoal") is None


@pytest.mark.usefixtures("forgotten")
def test_what_is_defined_has_the_hash_that_others_compute(tmp_path: Path) -> None:
    folder = tmp_path / "example_interfaces" / "action"
    folder.mkdir(parents=True)
    text = "\r\n".join(("int32 order", "---", "int32[] sequence", "---", "int32[] sequence", ""))
    (folder / "Fibonacci.action").write_text(text)
    before = usual("example_interfaces/action/Fibonacci_SendGoal")
    messages.learn([tmp_path])
    # The last store is one of those with what was learned.
    assert messages._stores()[-1].hash_rihs01(before.name) == before.hash


@pytest.mark.usefixtures("forgotten")
def test_a_definition_goes_before_that_of_a_distribution_and_leaves_it_known(tmp_path: Path) -> None:
    folder = tmp_path / "std_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "String.msg").write_text("string data\nstring language\n")
    usual_one = usual("std_msgs/msg/String")
    messages.learn([tmp_path])
    other = MessageType("std_msgs/msg/String", messages._stores()[-1].hash_rihs01("std_msgs/msg/String"))
    assert other != usual_one
    assert messages.message_fields(messages.message({"language": "en"}, other), other)["language"] == "en"
    assert list(messages.message_fields(messages.message({}, usual_one), usual_one)) == ["data"]


@pytest.mark.usefixtures("forgotten")
def test_the_environment_names_definitions_for_every_program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SELFCONF_ROS_DEFINITIONS", f"{defined(tmp_path, Mood__msg='bool good')}")
    messages.learn([])  # as at the start of a program, which has learned nothing
    assert messages.is_known(usual("lab_msgs/msg/Mood"))


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("Mood__msg", "bool good\nbool\n", "Mood.msg:2: 'bool' is neither a field nor a constant"),
        ("Mood__msg", "bool good\nint13 bad\n", "Mood.msg: left out, as lab_msgs/msg/Mood has lab_msgs/msg/int13"),
        ("Mood__msg", "bool good\nbool 9bad\n", "Mood.msg:2: 'bool 9bad' is neither"),
        ("Mood__msg", "bool good\nstring good\n", "Mood.msg:2: there is a field good already"),
        ("Mood__msg", "bool good\n---\n", "Mood.msg:2: this begins part 2 of 1"),
        ("Mood__msg", "wstring text\n", "Mood.msg:1: wstring is a type that rosbags does not read"),
        (
            "Ask__srv",
            "bool good\n",
            "Ask.srv:1: the file ends before part 2; lines of three dashes separate the request",
        ),
        ("Drive__action", "---\n", "Drive.action:1: the file ends before part 3"),
        (
            "Mood__msg",
            "Mood mood\n",
            "left out, as lab_msgs/msg/Mood has lab_msgs/msg/Mood, of which the fields are not",
        ),
        (
            "Ask__srv",
            "geometry_msgs/Nothing x\n---\n",
            "lab_msgs/srv/Ask_Request has geometry_msgs/msg/Nothing, of which",
        ),
        ("9__msg", "bool good\n", "lab_msgs/msg/9 is no name of a type"),
    ],
)
@pytest.mark.usefixtures("forgotten")
def test_what_cannot_be_read_is_left_out_with_its_place(tmp_path: Path, name: str, text: str, words: str) -> None:
    folder = defined(tmp_path, Other__msg="bool good", **{name: text})
    (left_out,) = messages.learn([folder])
    assert words in str(left_out)
    assert str(left_out).startswith(str(folder))
    assert messages.usual_type("lab_msgs/msg/Other") is not None


def test_folders_without_definitions_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(AuthorError, match="there is no folder"):
        read_definitions([tmp_path / "missing"], [])
    (tmp_path / "Mood.msg").write_text("bool good")  # in no folder of its kind
    with pytest.raises(AuthorError, match="there is no definition of ROS 2 below"):
        read_definitions([tmp_path], [])
    monkeypatch.setattr(definitions, "MOST_FILES", 1)
    with pytest.raises(AuthorError, match="there are more than 1 definitions"):
        read_definitions([defined(tmp_path, A__msg="", B__msg="")], [])


def test_a_file_that_is_no_text_or_too_long_is_left_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = defined(tmp_path, A__msg="", B__msg="bool good", C__msg="# " + "x" * 50)
    (folder / "share" / "lab_msgs" / "msg" / "A.msg").write_bytes(b"\xff")
    monkeypatch.setattr(definitions, "MOST_OCTETS", 40)
    left_out: list[AuthorError] = []
    assert [each.name for each in read_definitions([folder], left_out)] == ["lab_msgs/msg/B"]
    assert ["cannot be read" in str(left_out[0]), "longer than 40 octets" in str(left_out[1])] == [True, True]


def test_types_are_complete_with_all_that_they_are_made_of() -> None:
    types = defined_types(InterfaceDefinition("a/msg/A", "B b")) | defined_types(
        InterfaceDefinition("a/msg/B", "C[2] c")
    )
    assert complete_types(types, []) == (
        {},
        {
            "a/msg/A": "has a/msg/B, of which the fields are not known",
            "a/msg/B": "has a/msg/C, of which the fields are not known",
        },
    )
    assert complete_types(types, ["a/msg/C"]) == (types, {})


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"label": "é1234567890"}, "has a text of 12 octets in a field that takes 10 at most"),
        ({"counts": [1, 2, 3, 4]}, "has 4 elements in a field that takes 3 at most"),
        ({"tags": ["a"] * 3}, "has 3 elements in a field that takes 2 at most"),
        ({"tags": ["abcdef"]}, "has a text of 6 octets in a field that takes 5 at most"),
        ({"counts": 5}, "has a value that is no int32[]"),
    ],
)
@pytest.mark.usefixtures("forgotten")
def test_no_message_is_written_with_more_than_its_definition_bounds(tmp_path: Path, fields: Any, words: str) -> None:
    text = "string<=10 label\nint32[<=3] counts\nstring<=5[<=2] tags\nint32[] free\n"
    assert messages.learn([defined(tmp_path, Bounded__msg=text)]) == []
    kind = usual("lab_msgs/msg/Bounded")
    full = {"label": "é23456789", "counts": [1, 2, 3], "tags": ["abcde", ""], "free": [1] * 9}
    read = messages.message_fields(messages.message(full, kind), kind)
    assert {name: list(value) if name in ("counts", "free") else value for name, value in read.items()} == full
    with pytest.raises(messages.MessageError, match=re.escape(words)):
        messages.message(full | fields, kind)
