"""The services that are known: their hashes are those that other implementations compute."""

from __future__ import annotations

import pytest

from selfconf.ros2 import messages
from selfconf.ros2.definitions import FEEDBACK_MESSAGE, GET_RESULT, SEND_GOAL
from selfconf.ros2.messages import MessageType, ServiceParts
from selfconf.ros2.services import KNOWN_ACTIONS, SERVICES

pytest.importorskip("rosbags", reason="the extra `ros2` is not installed")
# Of AddTwoInts as the design of rmw_zenoh says it, of actions as the type descriptions of jazzy and lyrical have them,
# of the others as hiroz 0.2.1, a native implementation, has them.
HASHES = {
    "example_interfaces/srv/AddTwoInts": "e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a",
    "action_msgs/srv/CancelGoal": "573d8b0a534451d7bc2ac8c5ffde8ac14b8593b7001175d0cd6516dcbeb8689a",
    "example_interfaces/action/Fibonacci_SendGoal": "d1a57fb2a4afe8c21e34fb10db206f16ce6729b28531141472df92277c55b557",
    "example_interfaces/action/Fibonacci_GetResult": "1b0de0d5d29dc955d92f546706568428632771db13ec84c15ec1c1a59f424a57",
    "action_tutorials_interfaces/action/Fibonacci_SendGoal": (
        "a0603060ed69fe2dfbd1a6f3b982a1749957ef346e4a4d2b311a05e305ec37bb"
    ),
    "tf2_msgs/action/LookupTransform_SendGoal": "4646ff5706c86b04d0a1098d329951a9731a7517e16702905de6073cc72c8530",
    "tf2_msgs/action/LookupTransform_GetResult": "3cd1715751899e3167b5aec3e4ac194f7da9e8493a77285f9f6a4c914f5e8b24",
    "rcl_interfaces/srv/DescribeParameters": "845b484d71eb0673dae682f2e3ba3c4851a65a3dcfb97bddd82c5b57e91e4cff",
    "rcl_interfaces/srv/GetParameters": "bf9803d5c74cf989a5de3e0c2e99444599a627c7ff75f97b8c05b01003675cbc",
    "rcl_interfaces/srv/GetParameterTypes": "da199c878688b3e530bdfe3ca8f74cb9fa0c303101e980a9e8f260e25e1c80ca",
    "rcl_interfaces/srv/ListParameters": "3e6062bfbb27bfb8730d4cef2558221f51a11646d78e7bb30a1e83afac3aad9d",
    "rcl_interfaces/srv/SetParameters": "56eed9a67e169f9cb6c1f987bc88f868c14a8fc9f743a263bc734c154015d7e0",
    "rcl_interfaces/srv/SetParametersAtomically": "0e192ef259c07fc3c07a13191d27002222e65e00ccec653ca05e856f79285fcd",
}


def found(name: str) -> ServiceParts:
    """The parts of a service that is known."""
    kind = messages.usual_type(name)
    assert kind is not None
    known = messages.service_parts(kind)
    assert known is not None
    return known


@pytest.mark.parametrize("name", HASHES)
def test_a_service_has_the_hash_that_others_compute(name: str) -> None:
    assert messages.usual_type(name) == MessageType(name, f"RIHS01_{HASHES[name]}")


@pytest.mark.parametrize("name", SERVICES)
def test_the_parts_of_a_service_are_written_and_read(name: str) -> None:
    for kind, text in zip(found(name), SERVICES[name].split("---"), strict=True):
        fields = messages.message_fields(messages.message({}, kind), kind)
        assert list(fields) == [line.split()[1] for line in text.split("\n") if line]


@pytest.mark.parametrize("name", KNOWN_ACTIONS)
def test_the_feedback_of_an_action_is_written_and_read(name: str) -> None:
    kind = messages.usual_type(name + FEEDBACK_MESSAGE)
    assert kind is not None
    assert list(messages.message_fields(messages.message({}, kind), kind)) == ["goal_id", "feedback"]


def test_the_feedback_of_an_action_has_the_hash_that_others_compute() -> None:
    name, number = "example_interfaces/action/Fibonacci_FeedbackMessage", "c1de71afd52e49a89c53d8262366884185bc0a02f78c"
    assert messages.usual_type(name) == MessageType(name, f"RIHS01_{number}e051c4e46b0a7fe59bb2")


@pytest.mark.parametrize("name", KNOWN_ACTIONS)
def test_the_services_of_an_action_are_known(name: str) -> None:
    assert next(iter(messages.message_fields(*sent(name + SEND_GOAL)))) == "goal_id"
    assert list(messages.message_fields(*sent(name + GET_RESULT))) == ["goal_id"]


def sent(name: str) -> tuple[bytes, MessageType]:
    """A request of a service, and its type."""
    kind = found(name).request
    return messages.message({}, kind), kind


def test_a_character_has_the_hash_that_others_compute() -> None:
    """As hiroz 0.2.1 has it: an octet."""
    number = "3ad2d04dd29ba19d04b16659afa3ccaedd691914b02a64e82e252f2fa6a586a9"
    kind = MessageType("std_msgs/msg/Char", f"RIHS01_{number}")
    assert messages.usual_type(kind.name) == kind
    assert messages.message_fields(messages.message({"data": 65}, kind), kind) == {"data": 65}


def test_a_request_without_fields_has_an_octet() -> None:
    assert messages.message({}, found("std_srvs/srv/Trigger").request) == b"\x00\x01\x00\x00\x00"


def test_a_service_of_another_hash_is_not_known() -> None:
    assert messages.service_parts(MessageType("std_srvs/srv/Trigger", "RIHS01_" + "0" * 64)) is None
