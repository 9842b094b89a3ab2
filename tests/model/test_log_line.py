"""A line of a log: whom it concerns, and when it was printed."""

from __future__ import annotations

from datetime import datetime, timezone

from selfconf.model.log_line import LogLine
from selfconf.model.term import IRI

CLOCK, LAMP = IRI("https://example.org/x#clock"), IRI("https://example.org/x#lamp")
LINE = LogLine("2026-11-22T06:30:01.000Z", "stdout", (CLOCK, LAMP), "two words ")


def test_a_line_concerns_each_component_of_its_process_by_iri_or_local_name() -> None:
    assert all(LINE.concerns(name) for name in ("", "clock", CLOCK, "lamp"))
    assert not LINE.concerns("x#clock")
    assert LINE.body()["components"] == [CLOCK, LAMP]


def test_its_moment_is_in_seconds_of_the_unix_epoch_and_what_is_no_time_has_none() -> None:
    assert LINE.moment == datetime(2026, 11, 22, 6, 30, 1, tzinfo=timezone.utc).timestamp()
    assert LINE._replace(time="torn").moment is None
