"""What an output issues, as a reader hears it: with its rate, bounded, and without a trace on the others."""

from __future__ import annotations

import itertools
import json
from collections.abc import Iterator
from functools import partial

import pytest

from selfconf.api.living.echo import SIGNALS_HELD, HeardSignal, echo
from selfconf.api.synchronous_bus import SynchronousBus
from selfconf.bus.memory import MemoryBus, Network
from selfconf.bus.port import Publisher, Urgency
from selfconf.errors import ProgrammerError
from selfconf.model.term import IRI
from selfconf.protocol.messages import SignalEncoding
from selfconf.protocol.stamps import StampWriter

CAMERA = IRI("urn:c:camera")
KEY = "selfconf/lab/c/00/camera/out/image"


class Stage:
    """An output and its reader on a simulated network; the reader begins before the first signal."""

    def __init__(self) -> None:
        self.network = Network()
        self.reader: MemoryBus = self.network.node()
        self.output: Publisher = self.network.node().publisher(KEY, Urgency.SIGNAL)
        self.stamps, self.numbers = StampWriter(CAMERA, "life"), itertools.count(1)
        self.said: list[str] = []
        self.asking = SynchronousBus(self.reader)
        self.heard: Iterator[HeardSignal] = echo(self.asking, partial(self.reader.subscribe, KEY), self.said.append)

    def put(self, payload: bytes, raw: bool = False, encoding: SignalEncoding | None = None) -> None:
        stamp = self.stamps.write(next(self.numbers), 5.0, raw, encoding or SignalEncoding())
        self.output.put(payload, stamp)

    def later(self, seconds: float, payload: bytes) -> None:
        self.reader.later(seconds, lambda: self.put(payload))


def test_signals_come_with_value_stamp_and_rate() -> None:
    stage = Stage()
    for number in range(8):
        stage.later(0.25 * (number + 1), b'{"x": %d}' % number)
    heard = list(itertools.islice(stage.heard, 8))
    assert [one.value["x"] for one in heard] == list(range(8))
    assert [one.stamp.sequence for one in heard] == list(range(1, 9))
    assert heard[0].rate == 0.0
    assert heard[-1].rate == pytest.approx(4.0, rel=0.05)
    assert heard[0].body() == {
        "component": CAMERA,
        "life": "life",
        "sequence": 1,
        "time": 5.0,
        "rate": 0.0,
        "passed_over": 0,
        "value": {"x": 0},
    }


def test_an_old_signal_that_comes_first_counts_for_no_rate() -> None:
    stage = Stage()
    for moment in (0.0, 0.9, 1.9, 2.9):  # the first was issued before, and is issued anew for a new follower
        stage.later(moment, b"{}")
    assert [round(one.rate, 3) for one in itertools.islice(stage.heard, 4)] == [0.0, 0.0, 1.0, 1.0]


def test_bytes_and_arrays_are_described() -> None:
    stage = Stage()
    encoding = SignalEncoding("image/x-raw", "uint8", (2, 3))
    stage.reader.later(0.1, lambda: stage.put(b"abcdef", True, encoding))
    signal = next(stage.heard)
    body = signal.body()
    assert (signal.raw, signal.value, body["bytes"], body["shape"]) == (True, None, 6, [2, 3])
    assert (body["media"], body["datatype"]) == ("image/x-raw", "uint8")


@pytest.mark.parametrize("payload", [b'{"x": NaN}', b"[1e999]", b"-Infinity"])
def test_what_holds_numbers_that_json_has_not_is_described_in_json_and_shown_to_people(payload: bytes) -> None:
    stage = Stage()
    stage.later(0.1, payload)
    signal = next(stage.heard)
    body = json.loads(json.dumps(signal.body()), parse_constant=pytest.fail)
    assert (body["bytes"], "value" in body) == (len(payload), False)
    assert any(word in signal.worded() for word in ("NaN", "Infinity"))


def test_what_comes_too_quickly_is_passed_over_and_counted() -> None:
    stage = Stage()

    def flood() -> None:
        for number in range(SIGNALS_HELD + 10):
            stage.put(b"%d" % number)

    stage.reader.later(0.1, flood)
    first = next(stage.heard)
    stage.network.run(lambda: False, 1.0)
    heard = [first, *itertools.islice(stage.heard, SIGNALS_HELD)]
    assert sum(one.passed_over for one in heard) + len(heard) == heard[-1].stamp.sequence
    assert heard[-1].value == SIGNALS_HELD + 9


def test_what_is_no_signal_is_named_and_passed_over() -> None:
    stage = Stage()

    def strangers() -> None:
        stage.output.put(b"1", b"no stamp")
        stage.put(b"no JSON")
        stage.put(b"7")

    stage.reader.later(0.1, strangers)
    assert next(stage.heard).value == 7
    assert len(stage.said) == 2


def test_no_signal_is_waited_for_once_the_ecology_was_left() -> None:
    stage = Stage()
    stage.later(0.1, b"7")
    assert next(stage.heard).value == 7
    stage.asking.leave()
    with pytest.raises(ProgrammerError, match="the ecology was left"):
        next(stage.heard)
