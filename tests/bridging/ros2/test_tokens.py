"""The tokens of rmw_zenoh: read and written as others write them, and refused where they are of another dialect."""

from __future__ import annotations

import pytest

from selfconf.bridging.ros2.tokens import RosEndpoint, RosNodeId, RosQuality, RosToken
from selfconf.errors import PeerError
from selfconf.ros2 import MessageType
from tests.ros2.test_messages import STRING_HASH

SESSION = "7d08a94e8fbbdcc55aff222861c243a4"
NODE_KEY = f"@ros2_lv/7/{SESSION}/0/0/NN/%/%front%left/lidar"
TOPIC_KEY = (
    f"@ros2_lv/7/{SESSION}/0/3/MP/%/%front%left/lidar/%front%scan/std_msgs::msg::dds_::String_/{STRING_HASH}/{{}}"
)


def test_a_token_of_a_node_is_read_and_written() -> None:
    token = RosToken.parse(NODE_KEY)
    assert token == RosToken(RosNodeId(7, SESSION, 0), "/front/left", "lidar")
    assert token.full_name == "/front/left/lidar"
    assert token.key() == NODE_KEY


def test_a_node_without_a_namespace_has_a_name_with_a_slash() -> None:
    token = RosToken.parse(f"@ros2_lv/0/{SESSION}/0/0/NN/%/%/talker")
    assert token.full_name == "/talker"
    assert token.key() == f"@ros2_lv/0/{SESSION}/0/0/NN/%/%/talker"


def test_a_token_of_a_topic_says_where_messages_travel() -> None:
    key = TOPIC_KEY.format("::,10:,:,:,,")
    token = RosToken.parse(key)
    kind = MessageType("std_msgs/msg/String", STRING_HASH)
    assert token.endpoint == RosEndpoint(3, "MP", "/front/scan", kind, RosQuality(depth=10))
    assert token.endpoint.key(7) == f"7/front/scan/std_msgs::msg::dds_::String_/{STRING_HASH}"
    assert token.key() == key


def test_a_service_and_its_client_are_read_and_written() -> None:
    for kind in ("SS", "SC"):
        key = f"@ros2_lv/7/{SESSION}/0/3/{kind}/%/%/lidar/%reset/std_srvs::srv::dds_::Empty_/{STRING_HASH}/::,10:,:,:,,"
        token = RosToken.parse(key)
        assert token.endpoint is not None
        assert (token.endpoint.kind, token.endpoint.type.name) == (kind, "std_srvs/srv/Empty")
        assert token.endpoint.key(7) == f"7/reset/std_srvs::srv::dds_::Empty_/{STRING_HASH}"
        assert token.key() == key


@pytest.mark.parametrize(
    ("text", "quality"),
    [
        ("::,:,:,:,,", RosQuality()),
        ("2::,5:,:,:,,", RosQuality(reliable=False, depth=5)),
        (":1:,1000:,:,:,,", RosQuality(transient_local=True, depth=1000)),
        ("::2,:,:,:,,", RosQuality(keep_all=True)),
        ("::,:0,25000000:,:,,", RosQuality(period=0.025)),
        ("::,:2,0:,:,,", RosQuality(period=2.0)),
    ],
)
def test_a_quality_of_service_is_read_and_written(text: str, quality: RosQuality) -> None:
    assert RosQuality.parse(text) == quality
    assert str(quality) == text


@pytest.mark.parametrize(
    "text", ["", "::", "::,x:,:,:,,", "::,-5:,:,:,,", "::,:a,:,:,,", "::,:,:,:,,:", f"::,:{'9' * 400},:,:,,"]
)
def test_what_is_no_quality_of_service_is_refused(text: str) -> None:
    with pytest.raises(PeerError, match="no quality of service"):
        RosQuality.parse(text)


def test_a_deadline_that_is_none_promises_nothing() -> None:
    assert RosQuality.parse("::,:9223372036,854775807:,:,,").period is None


def test_humble_is_refused_by_a_sentence_of_its_own() -> None:
    key = TOPIC_KEY.format("::,10:,:,:,,").replace(STRING_HASH, "TypeHashNotSupported")
    with pytest.raises(PeerError, match="/front/left/lidar have no hash, as in humble; a bridge speaks with jazzy"):
        RosToken.parse(key)


@pytest.mark.parametrize(
    "key",
    [
        "",
        "@ros2_lv/7",
        NODE_KEY.replace("/7/", "/x/"),
        NODE_KEY + "/%scan",
        NODE_KEY.replace("NN", "MP"),
        TOPIC_KEY.format("::,10:,:,:,,").replace("std_msgs::msg::dds_::String_", "String"),
        TOPIC_KEY.format("::,10:,:,:,,").replace("std_msgs::msg::dds_::String_", "Std::msg::dds_::String_"),
        TOPIC_KEY.format("*"),
        TOPIC_KEY.format("::,10:,:,:,,").replace("%front%scan", "%front%%scan"),
        TOPIC_KEY.format("::,10:,:,:,,").replace("%front%scan", "%"),
        NODE_KEY + "x" * 5000,
        NODE_KEY + "\x1b[2J\n",
    ],
)
def test_what_is_no_token_is_refused(key: str) -> None:
    with pytest.raises(PeerError):
        RosToken.parse(key)


@pytest.mark.parametrize(
    ("offered", "wanted", "why"),
    [
        (RosQuality(), RosQuality(), None),
        (RosQuality(transient_local=True), RosQuality(reliable=False), None),
        (RosQuality(reliable=False), RosQuality(), "best_effort, not reliable"),
        (RosQuality(), RosQuality(transient_local=True), "volatile, not transient_local"),
        (RosQuality(), RosQuality(period=0.1), "with no deadline, not one of 0.1 s"),
        (RosQuality(period=0.2), RosQuality(period=0.1), "with a deadline of 0.2 s, not one of 0.1 s"),
        (RosQuality(period=0.1), RosQuality(period=0.2), None),
    ],
)
def test_a_publisher_is_connected_that_offers_what_a_subscription_asks(
    offered: RosQuality, wanted: RosQuality, why: str | None
) -> None:
    assert offered.falls_short_of(wanted) == why
