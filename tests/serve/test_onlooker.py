"""What is seen of a component that is looked at: signals with rates, and its log; only meanwhile, and not much."""

from __future__ import annotations

from typing import Any

import pytest

from selfconf.bus.memory import MemoryBus, Network
from selfconf.bus.port import Request, Urgency
from selfconf.model.log_line import LogLine
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import LogPart, LogQuestion, SignalEncoding
from selfconf.protocol.stamps import StampWriter
from selfconf.serve.onlooker import BYTES_A_SECOND, GLANCE, LOG_LINES, LONGEST_TOLD, Onlooker
from tests.lab import iri
from tests.serve.shown import found

KEYS, TRACKER = Keys("lab"), iri("person-tracker")


class Stage:
    """The tracker and its site on a simulated network, and somebody who looks at the tracker."""

    def __init__(self) -> None:
        self.network = Network()
        self.tracker, self.site = self.network.node(), self.network.node()
        self.followed: list[bool] = []
        self.pose = self.tracker.publisher(KEYS.output(TRACKER, "pose"), Urgency.SIGNAL, self.followed.append)
        self.stamps, self.number, self.bytes = StampWriter(TRACKER, "life"), 0, 0
        self.told: list[tuple[str, Any]] = []
        bus: MemoryBus = self.network.node()
        self.onlooker = Onlooker(bus, KEYS, found("tracker"), lambda kind, body: self.told.append((kind, body)))

    def put(self, payload: bytes, raw: bool = False, encoding: SignalEncoding | None = None) -> None:
        self.number += 1
        self.bytes += len(payload) * (self.followed[-1:] == [True])
        self.pose.put(payload, self.stamps.write(self.number, 5.0, raw, encoding or SignalEncoding()))

    def put_each(self, seconds: float, number: int, payload: bytes = b"{}", raw: bool = False) -> None:
        for one in range(number):
            self.tracker.later(seconds * (one + 1), lambda: self.put(payload, raw))
        self.let_pass(seconds * number + 0.5)

    def let_pass(self, seconds: float) -> None:
        self.network.run(lambda: False, seconds)

    def all(self, kind: str) -> list[Any]:
        return [body for told, body in self.told if told == kind]


@pytest.fixture
def stage() -> Stage:
    return Stage()


def test_signals_are_told_with_their_rate_and_in_glances(stage: Stage) -> None:
    stage.onlooker.begin()
    stage.put_each(0.02, 400, b'{"x": 1.5}')
    latest = stage.all("signals")[-1]["pose"]
    assert (latest["text"], latest["time"]) == ('{"x": 1.5}', 5.0)
    assert latest["rate"] == pytest.approx(50.0, rel=0.05)
    assert len(stage.all("signals")) < 8.5 / 0.25
    assert stage.followed.count(True) == pytest.approx(8.5 / 0.7, abs=2)
    stage.onlooker.end()
    stage.let_pass(5.0)
    assert stage.followed[-1] is False
    told = len(stage.told)
    stage.put_each(0.1, 10)
    assert len(stage.told) == told


def test_nothing_is_followed_any_more_where_looking_has_ended_between_two_glances(stage: Stage) -> None:
    stage.onlooker.begin()
    stage.put_each(0.001, GLANCE)
    assert stage.followed[-1] is False
    stage.onlooker.end()
    stage.let_pass(5.0)
    assert stage.followed[-1] is False


def test_of_a_camera_no_more_is_taken_than_a_network_can_spare(stage: Stage) -> None:
    stage.onlooker.begin()
    stage.put_each(0.05, 600, bytes(200_000), raw=True)
    assert stage.bytes < 31 * BYTES_A_SECOND + 4 * 200_000
    last = stage.all("signals")[-1]["pose"]
    assert last["text"] == "<200000 bytes>"
    assert any(body["pose"]["rate"] == pytest.approx(20.0, rel=0.05) for body in stage.all("signals"))


def test_a_slow_output_stays_followed_and_what_is_large_or_no_signal_is_described(stage: Stage) -> None:
    stage.onlooker.begin()
    stage.put_each(3.0, 3, b'"' + b"x" * 70_000 + b'"')
    assert stage.all("signals")[-1]["pose"]["text"] == "<70002 bytes>"
    stage.let_pass(2.0)
    stage.put(b"\xff")
    stage.let_pass(1.0)
    assert stage.all("signals")[-1]["pose"]["trouble"].startswith("this is no signal: ")
    array = SignalEncoding("image/x-raw", "uint8", (480, 640, 3))
    stage.let_pass(9.0)
    stage.put(bytes(90_000), True, array)
    stage.let_pass(1.0)
    assert stage.all("signals")[-1]["pose"]["text"] == "<image/x-raw of uint8 480 x 640 x 3, 90000 bytes>"


def test_the_log_is_asked_for_at_the_site_and_followed(stage: Stage) -> None:
    asked: list[LogQuestion] = []
    kept = [LogLine("2026-11-22T06:30:01.000Z", "stderr", (TRACKER,), "y" * 9000)]

    def answer(request: Request) -> None:
        question = decode(request.payload, LogQuestion)
        asked.append(question)
        start = int(question.position or "0")
        request.reply(KEYS.log("astrid"), encode(LogPart(tuple(kept[start:]), str(len(kept)))))
        request.finish()

    stage.site.serve(KEYS.log("astrid"), answer)
    stage.onlooker.begin()
    stage.let_pass(3.0)
    (first,) = stage.all("log")
    assert first["anew"]
    (line,) = first["lines"]
    assert (line["stream"], len(line["text"])) == ("stderr", LONGEST_TOLD + 1)
    assert asked[0] == LogQuestion(TRACKER, LOG_LINES)
    kept += [LogLine("2026-11-22T06:30:02.000Z", "stdout", (TRACKER,), str(number)) for number in range(LOG_LINES + 9)]
    stage.let_pass(3.0)
    second = stage.all("log")[-1]
    assert not second["anew"]
    assert [line["text"] for line in second["lines"]] == [str(number) for number in range(9, LOG_LINES + 9)]
    assert len(asked) <= 7
    stage.onlooker.end()
    stage.let_pass(3.0)
    assert len(asked) <= 7


def test_who_prints_more_than_an_answer_holds_is_followed_from_the_end_on(stage: Stage) -> None:
    asked: list[str] = []

    def answer(request: Request) -> None:
        asked.append(decode(request.payload, LogQuestion).position)
        request.reply(KEYS.log("astrid"), encode(LogPart((), "7", more=bool(asked[-1]))))
        request.finish()

    stage.site.serve(KEYS.log("astrid"), answer)
    stage.onlooker.begin()
    stage.let_pass(3.5)
    assert asked[:4] == ["", "7", "", "7"]
    assert stage.all("log") == [{"lines": [], "anew": True}] * 2


def test_a_server_that_may_look_on_only_says_so(stage: Stage) -> None:
    stage.onlooker.excuse()
    stage.put_each(0.1, 5)
    (signals,), (log,) = stage.all("signals"), stage.all("log")
    assert "keys of conf.NAME" in signals["pose"]["trouble"]
    assert signals["pose"] == log


def test_where_no_log_is_told_the_reason_is(stage: Stage) -> None:
    stage.onlooker.begin()
    stage.let_pass(4.0)
    trouble = "the site astrid does not tell what its components have printed"
    assert stage.all("log")[0] == {"trouble": trouble}

    def refuse(request: Request) -> None:
        request.refuse("the site astrid keeps no log")
        request.finish()

    stage.site.serve(KEYS.log("astrid"), refuse)
    stage.let_pass(2.0)
    assert stage.all("log")[-1] == {"trouble": "the site astrid keeps no log"}
