"""Where a server listens, and what it says when it cannot."""

from __future__ import annotations

import asyncio
import errno
import os
from collections.abc import Iterable, Mapping
from pathlib import Path

import pytest

from selfconf.bus.memory import Network
from selfconf.errors import AuthorError, NetworkError
from selfconf.query import StandingQuestion
from selfconf.rdf.vocabulary import ROB
from selfconf.serve import server
from selfconf.serve.application import LOOPBACK
from selfconf.serve.board import Board
from selfconf.serve.connections import config_of
from selfconf.serve.look_endpoint import Onlookers
from selfconf.serve.server import FIRST_LOOK, Record, bound, names_at
from selfconf.serve.watching.change import Body
from selfconf.serve.watching.history import History
from tests.lab import ADVERTISEMENTS
from tests.serve.asgi import served
from tests.serve.shown import advertised


def test_a_port_that_is_taken_is_a_sentence() -> None:
    with bound("127.0.0.1", 0) as place:
        port = place.getsockname()[1]
        with pytest.raises(NetworkError, match=f"cannot listen on port {port} of 127.0.0.1 .*give another one by port"):
            bound("127.0.0.1", port)


def test_what_is_no_address_is_a_sentence() -> None:
    with pytest.raises(AuthorError, match="no address of this machine"):
        bound("no such host", 0)
    with pytest.raises(AuthorError, match=r"^'127\.0\.0\.\.1' with port 0 is no address of this machine"):
        bound("127.0.0..1", 0)
    with pytest.raises(NetworkError, match="cannot listen"):
        bound("192.0.2.1", 0)


@pytest.mark.parametrize(("link", "ticks"), [("tcp/127.0.0.1:7447", 1), ("", FIRST_LOOK * 10)])
def test_it_is_said_to_listen_once_questions_are_answered_or_the_ecology_stays_silent(
    board: Board, monkeypatch: pytest.MonkeyPatch, link: str, ticks: int
) -> None:
    """A program that asks as soon as it reads where the server listens gets an answer, and no 503."""
    monkeypatch.setattr(server, "ending_signals", lambda: ())
    said: list[str] = []
    onlookers = Onlookers(Network().node(), board)

    async def play() -> None:
        program = server._Server(config_of(served(board)), board, onlookers, lambda: said.append("listening"))
        board.link = ""
        await program.on_tick(0)
        assert said == []
        board.link = link
        for _ in range(2):
            await program.on_tick(ticks)

    asyncio.run(play())
    assert said == ["listening"]


def test_on_this_machine_a_server_is_asked_by_names_of_this_machine_alone() -> None:
    assert set(names_at("127.0.0.1")) == LOOPBACK
    assert set(names_at("127.0.0.2")) == LOOPBACK | {"127.0.0.2"}
    assert set(names_at("::1")) >= LOOPBACK
    assert not names_at("0.0.0.0")


def test_what_a_full_disk_keeps_from_the_history_can_be_asked_for_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def full(history: History, graphs: Mapping[str, bytes], events: Iterable[Body]) -> Mapping[str, bytes]:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(History, "note", full)
    record = Record(tmp_path)
    try:
        record.note(advertised(*ADVERTISEMENTS))
        asked = StandingQuestion(f"ASK {{ ?c a <{ROB.PositionSensor}> }}", ["application/sparql-results+json"])
        assert b"true" in record.dataset.ask(asked)[1]
    finally:
        record.close()
    assert "missing in the history" in caplog.text
