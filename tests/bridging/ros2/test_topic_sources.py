"""Which node a message is from: known where one publishes, learned where one is left, never guessed."""

from __future__ import annotations

from selfconf.bridging.ros2.topic_sources import TopicSources

ONE, TWO = ("a", "/node"), ("b", "/node")


def test_the_only_publisher_is_the_one() -> None:
    sources = TopicSources()
    assert sources.node(b"1") is None
    sources.add((ONE, 1))
    assert sources.node(b"1") == ONE
    assert sources.node(b"2") is None
    assert len(sources) == 1


def test_a_publisher_that_comes_later_is_told_from_those_that_are_known() -> None:
    sources = TopicSources()
    sources.add((ONE, 1))
    assert sources.node(b"1") == ONE
    sources.add((TWO, 1))
    assert sources.node(b"2") == TWO
    assert sources.node(b"1") == ONE


def test_of_two_that_are_unknown_none_is_guessed_until_one_has_gone() -> None:
    sources = TopicSources()
    sources.add((ONE, 1))
    sources.add((TWO, 1))
    assert sources.node(b"1") is None
    sources.remove((TWO, 1))
    assert sources.node(b"1") == ONE
    sources.remove((ONE, 1))
    assert sources.node(b"1") is None
