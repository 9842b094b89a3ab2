"""What a task was at a moment, by its events."""

from __future__ import annotations

from selfconf.render.task_story import NO_CONFIGURATION, story
from tests.render.told_events import EVENTS, HOME, LOST, recruiting, running


def test_what_goes_on_through_a_repair_is_told_since_it_began_and_not_since_the_repair() -> None:
    lost = {**LOST, "time": 30.0, "component": HOME + "astrid-drive"}
    found = story("navigate", EVENTS)
    assert found.unchanged == {HOME + "position": 21.0, HOME + "drive": 10.0}
    assert story("navigate", [*EVENTS, lost, running(31.0, "odometry")]).unchanged[HOME + "drive"] == 31.0
    for between in ({"act": "stopped", "time": 30.0}, {"act": "waiting", "time": 30.0, "refusal": {}}):
        assert set(story("navigate", [*EVENTS, between, running(31.0, "odometry")]).unchanged.values()) == {31.0}


def test_a_task_that_waits_has_no_configuration_since_it_waits() -> None:
    looks = [{"act": "waiting", "time": time, "refusal": {}} for time in (30.0, 60.0, 90.0)]
    assert story("navigate", [*EVENTS, *looks]).since == 30.0
    assert story("navigate", [*EVENTS, *looks, running(100.0, "tracker")]).since == 100.0
    assert story("navigate", [*EVENTS, *looks, running(100.0, "tracker"), *looks[:1]]).since == 30.0


def test_a_task_has_no_configuration_before_it_tells_one_and_the_one_of_then_at_an_earlier_moment() -> None:
    assert story("navigate", EVENTS, at=5.0).configuration is NO_CONFIGURATION
    assert story("navigate", EVENTS, at=15.0).configuration.roles[HOME + "position"] == [HOME + "tracker"]
    assert story("navigate", EVENTS).configuration.roles[HOME + "position"] == [HOME + "odometry"]
    assert story("navigate", EVENTS).configuration.bindings == (HOME + "Astrid",)


def test_what_has_come_has_taken_over_from_what_has_gone_in_its_role_or_as_what_feeds_an_input() -> None:
    assert story("navigate", EVENTS).replaced == {HOME + "odometry": HOME + "tracker"}
    chains = [recruiting(10.0, "converter", "lidar"), recruiting(21.0, "converter", "camera")]
    assert story("locate", chains).replaced == {HOME + "camera": HOME + "lidar"}
    stopped = {"act": "stopped", "time": 30.0}
    assert story("navigate", [EVENTS[0], stopped, running(31.0, "odometry")]).replaced == {}
    revised = {**running(31.0, "odometry"), "revises": 1}
    assert story("navigate", [EVENTS[0], stopped, revised]).replaced == {HOME + "odometry": HOME + "tracker"}


def test_recruits_feed_players_and_each_other() -> None:
    found = story("locate", [recruiting(10.0, "converter", "lidar")]).configuration
    assert found.players == {HOME + one: [HOME + one] for one in ("converter", "lidar")} | {
        HOME + "place": [HOME + "locator"]
    }
    assert found.recruits_of([HOME + "locator"]) == [HOME + "converter"]
    assert found.sinks_of(HOME + "lidar") == [HOME + "converter"]
