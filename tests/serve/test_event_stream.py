"""Server-sent events reach who listens, who was away, and who is slow."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, AsyncIterator

import pytest

from selfconf.serve import event_stream
from selfconf.serve.event_stream import EVENTS_KEPT, WAITING, EventStream


async def heard(lines: AsyncIterator[bytes], number: int) -> list[str]:
    """The next events of a stream, as texts."""
    return [(await anext(lines)).decode() for _ in range(number)]


def test_who_listens_hears_events_of_the_kinds_that_are_wanted() -> None:
    async def play() -> None:
        stream = EventStream()
        lines = stream.lines(["change"], "")
        assert (await anext(lines)).startswith(b": ")
        stream.put("other", 1)
        stream.put("change", {"a": "line\nbreak"})
        (event,) = await heard(lines, 1)
        assert event == f'id: {stream.life}-2\nevent: change\ndata: {{"a": "line\\nbreak"}}\n\n'
        assert stream.listeners == 1
        stream.close()
        assert [line async for line in lines] == []

    asyncio.run(play())


def test_who_is_sent_nothing_is_told_so_though_other_kinds_of_events_come(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(event_stream, "STILL_THERE", 0.1)

    async def play() -> None:
        stream = EventStream()
        lines = stream.lines(["change"], "")
        assert (await anext(lines)).startswith(b": ")

        async def go_on() -> None:
            while True:
                stream.put("other", 1)
                await asyncio.sleep(0.01)  # the rate of the events

        others = asyncio.ensure_future(go_on())
        assert await asyncio.wait_for(heard(lines, 2), 20.0) == [": still there\n\n"] * 2
        others.cancel()

    asyncio.run(play())


def test_who_was_away_hears_what_was_missed() -> None:
    async def play() -> None:
        stream = EventStream()
        for number in range(5):
            stream.put("change", number)
        stream.put("other", 5)
        stream.put("change", 6)
        lines = stream.lines(["change"], f"{stream.life}-3")
        _, *events = await heard(lines, 4)
        assert stream.listeners == 1
        assert isinstance(lines, AsyncGenerator)
        await lines.aclose()
        assert stream.listeners == 0
        assert [event.split("data: ")[1] for event in events] == ["3\n\n", "4\n\n", "6\n\n"]

    asyncio.run(play())


def test_who_was_away_too_long_or_heard_another_server_is_told_to_begin_anew() -> None:
    async def play() -> None:
        stream = EventStream()
        for number in range(EVENTS_KEPT + 2):
            stream.put("change", number)
        for last in (
            f"{stream.life}-1",
            "other-7",
            "nonsense",
            f"{stream.life}-x",
            f"{stream.life}-{EVENTS_KEPT + 99}",
            f"{stream.life}-{'9' * 5000}",
        ):
            lines = stream.lines(["change"], last)
            _, event = await heard(lines, 2)
            assert "event: reset" in event
            stream.put("change", "next")
            assert '"next"' in (await heard(lines, 1))[0]
        assert stream.missed(f"{stream.life}-{stream._kept[0].number - 1}") is not None
        begun = EventStream()
        assert stream.missed(stream.last) == begun.missed(begun.last) == []

    asyncio.run(play())


def test_who_reads_too_slowly_is_left_behind() -> None:
    async def play() -> None:
        stream = EventStream()
        lines = stream.lines(["change"], "")
        await anext(lines)
        waiting = asyncio.create_task(anext(lines))
        await asyncio.sleep(0)  # lets it begin to wait
        for number in range(WAITING + 1):
            stream.put("change", number)
        assert stream.listeners == 0
        ended = await asyncio.gather(waiting, return_exceptions=True)
        assert isinstance(ended[0], StopAsyncIteration)

    asyncio.run(play())
