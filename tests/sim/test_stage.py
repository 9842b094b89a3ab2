"""What is waited for in a demo: until it holds, or what it takes has ended, or time is up."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace
from typing import cast

import pytest

import selfconf
from sim import stage
from sim.crew import Crew, Line
from sim.stage import DemoError, Stage


class ToldCrew:
    """Processes of which it is given what they will say."""

    def __init__(self, *said: tuple[str, str | None]) -> None:
        self.left = [Line(*one) for one in said]
        self.started: list[tuple[str, ...]] = []

    def start(self, name: str, *arguments: str) -> int:
        self.started.append((name, *arguments))
        return 0

    def lines(self, seconds: float) -> Iterator[Line]:
        while self.left:
            yield self.left.pop(0)


def staged(*said: tuple[str, str | None]) -> tuple[Stage, ToldCrew, list[str]]:
    """A stage, its crew, and what it tells."""
    crew, told = ToldCrew(*said), list[str]()
    return Stage(cast(Crew, crew), told.append), crew, told


def test_it_hears_no_more_than_it_takes_until_something_holds() -> None:
    one, crew, told = staged(("a", "first"), ("a", "second"), ("a", "third"))
    one.until(lambda: len(told) == 2, 60.0, (), "the second word")
    assert [line.text for line in crew.left] == ["third"]


def test_what_a_process_says_last_counts_before_its_end() -> None:
    one, _, told = staged(("world", "ready"), ("world", None))
    one.until(lambda: bool(told), 60.0, ("world",), "the world was there")


def test_a_vital_process_that_ends_or_has_ended_long_before_is_not_waited_for() -> None:
    one, _, _ = staged(("other", None), ("world", None))
    with pytest.raises(DemoError, match="world has ended before it was there"):
        one.until(lambda: False, 60.0, ("world",), "it was there")
    one.listen(0.0)
    with pytest.raises(DemoError, match="other has ended before the end"):
        one.until(lambda: False, 60.0, ("other",), "the end")


def test_what_does_not_come_to_hold_is_told_with_the_time_that_it_was_given() -> None:
    one, _, _ = staged()
    with pytest.raises(DemoError, match="0 s have passed before the end"):
        one.until(lambda: False, 0.0, (), "the end")


def test_a_site_is_connected_to_the_one_before(monkeypatch: pytest.MonkeyPatch) -> None:
    one, crew, _ = staged()
    there = [SimpleNamespace(site=name, endpoint=f"tcp/{name}:1") for name in ("hall", "bath")]
    monkeypatch.setattr(selfconf, "sites", lambda ecology: there)
    one.site("hall")
    one.site("bath")
    assert "--connect" not in crew.started[0]
    assert crew.started[1][-4:-2] == ("--connect", "tcp/hall:1")
    assert one.endpoint == "tcp/bath:1"


@pytest.mark.parametrize(
    ("said", "ports"),
    [
        ([(stage.PAGE, "http://127.0.0.1:8000/")], 1),
        ([(stage.PAGE, None), (stage.PAGE, "http://127.0.0.1:1/")], 2),
    ],
)
def test_a_page_that_cannot_be_served_at_the_usual_port_is_served_at_another(
    said: list[tuple[str, str | None]], ports: int
) -> None:
    one, crew, _ = staged(*said)
    one.serve()
    assert len(crew.started) == ports


def test_a_page_that_cannot_be_served_at_all_ends_the_demo() -> None:
    one, _, _ = staged((stage.PAGE, None), (stage.PAGE, None))
    with pytest.raises(DemoError, match="cannot be served"):
        one.serve()
