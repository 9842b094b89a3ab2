"""A line of a log: whom it concerns, and its time for people."""

from __future__ import annotations

from selfconf.model.log_line import LogLine
from selfconf.model.term import IRI

CLOCK, LAMP = IRI("https://example.org/x#clock"), IRI("https://example.org/x#lamp")
LINE = LogLine("2026-11-22T06:30:01.000Z", "stdout", (CLOCK, LAMP), "two words ")


def test_a_line_concerns_each_component_of_its_process_by_iri_or_local_name() -> None:
    assert all(LINE.concerns(name) for name in ("", "clock", CLOCK, "lamp"))
    assert not LINE.concerns("x#clock")
    assert LINE.body()["components"] == [CLOCK, LAMP]


def test_its_time_is_shown_as_it_is_here_and_what_is_no_time_as_it_stands() -> None:
    assert len(LINE.local_time) == len("06:30:01.000")
    assert LINE._replace(time="torn").local_time == "torn"
