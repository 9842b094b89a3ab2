"""The two ends of a connection, each a process: `python -m benchmarks.signals.ends PROGRAM source|sink ENDPOINT`.

What they are to do comes as lines of JSON on stdin, what they have measured goes as such lines to stdout; they end with
their stdin. Times are those of the monotonic clock, which all processes of a machine share.

The programs are `selfconf`, `bare` Zenoh, and `least`: as few lines of Python as keep what a signal is promised to be.
Its source is named, with the life, the number and the time; numbers go out in their order; it is read on another thread
than Zenoh's, so that slow code holds nothing up; as many wait as events may need, the newest; none is read twice.
"""

from __future__ import annotations

import json
import os
import sys
import threading
import time
from collections import deque
from collections.abc import Callable
from pathlib import Path
from typing import Any

import orjson
import zenoh

from selfconf.bus.zenoh import client, open_session
from selfconf.bus.zenoh.receivers import callback
from selfconf.model.term import IRI
from selfconf.protocol.stamps import StampReader, StampWriter
from selfconf.sdk import Component, Host, Signal
from selfconf.sdk.code_thread import CodeThread
from selfconf.sdk.inputs.signal_queue import EVENTS

ECOLOGY = "signals"
FOLDER_VARIABLE = "SIGNALS_BENCHMARK_FOLDER"
KEY, LEAST_KEY = "bare/out", "least/out"
OUTPUTS = {"JSON": "scan", "bytes": "picture"}
"""The output that carries signals of each form."""
Emit = Callable[[str, Any, int], None]
"""Issues a value of a form, as the signal of that number."""


def value(form: str, size: int) -> Any:
    """A signal of about that many bytes on the wire: of rob:RangeScan in JSON, or a picture as it is."""
    if form == "bytes":
        return b"x" * size
    beams = max(0, (size - 45) // 20)
    return {
        "angles": [round(-1.5 + 0.01 * n, 6) + 1e-7 for n in range(beams)],
        "ranges": [1.25 + n for n in range(beams)],
        "max_range": 12.5,
    }


class SourceEnd:
    """Issues what it is told to, and tells when it has issued each signal."""

    def __init__(self, emit: Emit) -> None:
        self._emit, self._number = emit, 0

    def told(self, order: dict[str, Any]) -> dict[int, float]:
        """Issue signals of a form and size: so many at a rate, or for so many seconds as fast as it goes."""
        form, signal, moments = order["form"], value(order["form"], order["size"]), {}
        begun = time.monotonic()
        if "rate" not in order:
            while time.monotonic() < begun + order["seconds"]:
                self._number += 1
                self._emit(form, signal, self._number)
            return {}
        for count in range(order["count"]):
            threading.Event().wait(max(0.0, begun + count / order["rate"] - time.monotonic()))
            self._number += 1
            moments[self._number] = time.monotonic()
            self._emit(form, signal, self._number)
        return moments


class SinkEnd:
    """Notes when signals arrive, and may take its time with each."""

    def __init__(self) -> None:
        self._moments: dict[int, float] = {}
        self._work = 0.0

    def received(self, number: int) -> None:
        """A signal has arrived and was read."""
        self._moments[number] = time.monotonic()
        if self._work:
            time.sleep(self._work)  # stands for the work of a slow component

    def told(self, order: dict[str, Any]) -> dict[str, Any]:
        """Tell what has arrived and how much memory is used; then begin `anew`, if so told, with slow or quick work."""
        pages = int(Path("/proc/self/statm").read_text().split()[1])
        said: dict[str, Any] = {"count": len(self._moments), "megabytes": pages * os.sysconf("SC_PAGE_SIZE") / 1e6}
        if "anew" in order:
            said["moments"], self._moments = self._moments, {}
            self._work = order["anew"]
        return said


class Source(Component):
    """Has an output for each form."""


class Sink(Component):
    """Hands what it receives to the end."""

    end: SinkEnd

    def received(self, port: str, signal: Signal) -> None:
        """A signal has arrived."""
        self.end.received(signal.sequence)


def obey(end: SourceEnd | SinkEnd) -> None:
    """Do what comes on stdin, until that ends."""
    print(json.dumps("ready"), flush=True)
    for line in sys.stdin:
        print(json.dumps(end.told(json.loads(line))), flush=True)


def selfconf_end(role: str, endpoint: str) -> None:
    """A component of the SDK."""
    over = threading.Event()
    host = Host(client([endpoint], shared_memory=True), ECOLOGY)
    path = Path(os.environ[FOLDER_VARIABLE]) / f"{role}.ttl"
    end: SourceEnd | SinkEnd
    if role == "source":
        Source.advertisement = path
        source = host.add(Source())
        end = SourceEnd(lambda form, signal, _: source.emit(OUTPUTS[form], signal))
    else:
        Sink.advertisement, Sink.end = path, SinkEnd()
        host.add(Sink())
        end = Sink.end

    def work() -> None:
        obey(end)
        over.set()
        host.code.wake_up()

    threading.Thread(target=work, daemon=True).start()
    host.run(over.is_set)
    host.close()


def bare_end(role: str, endpoint: str) -> None:
    """A program that puts, or subscribes: what is sent is numbered, and read when it comes."""
    session = open_session("client", connect=[endpoint])
    if role == "source":
        publishers = _publishers(session, KEY)

        def emit(form: str, signal: Any, number: int) -> None:
            payload = orjson.dumps(signal) if form == "JSON" else signal
            publishers[form].put(payload, attachment=b"%d" % number)

        obey(SourceEnd(emit))
    else:
        end = SinkEnd()
        readers: dict[str, Callable[[bytes], Any]] = {"JSON": orjson.loads, "bytes": len}
        held = [session.declare_subscriber(f"{KEY}/{form}", reader(end, read)) for form, read in readers.items()]
        obey(end)
        held.clear()
    session.close()


def _publishers(session: zenoh.Session, key: str) -> dict[str, zenoh.Publisher]:
    """What a source puts the signals of each output by."""
    drop = zenoh.CongestionControl.DROP
    return {form: session.declare_publisher(f"{key}/{form}", congestion_control=drop) for form in OUTPUTS}


def least_end(role: str, endpoint: str) -> None:
    """A program with the least that keeps what is promised of a signal."""
    session = open_session("client", connect=[endpoint])
    if role == "source":
        publishers = _publishers(session, LEAST_KEY)
        stamps = {form: StampWriter(IRI("urn:signals:least"), "1") for form in OUTPUTS}
        issuing = threading.Lock()

        def emit(form: str, signal: Any, number: int) -> None:
            payload, raw = (orjson.dumps(signal), False) if form == "JSON" else (signal, True)
            with issuing:
                publishers[form].put(payload, attachment=stamps[form].write(number, time.time(), raw))

        obey(SourceEnd(emit))
    else:
        end = SinkEnd()
        code = CodeThread(inline=False)
        threading.Thread(target=code.run, args=(lambda: False,), daemon=True).start()
        readers: dict[str, Callable[[bytes], Any]] = {"JSON": orjson.loads, "bytes": len}
        held = [
            session.declare_subscriber(f"{LEAST_KEY}/{form}", callback(least_reader(code, end, read)))
            for form, read in readers.items()
        ]
        obey(end)
        held.clear()
    session.close()


def least_reader(code: CodeThread, end: SinkEnd, read: Callable[[bytes], Any]) -> Callable[[zenoh.Sample], None]:
    """What Zenoh is to call for a signal, on its own thread: the signal waits until the code's thread has read it."""
    waiting: deque[tuple[bytes, bytes]] = deque(maxlen=EVENTS)
    stamps, newest = StampReader(), 0

    def take() -> None:
        nonlocal newest
        if waiting:
            payload, attachment = waiting.popleft()
            _, stamp = stamps.read(attachment)
            if stamp.sequence > newest:
                newest = stamp.sequence
                signal = Signal(read(payload), stamp.component, stamp.time, stamp.sequence, stamp.encoding.media)
                end.received(signal.sequence)

    def call(sample: zenoh.Sample) -> None:
        attachment = sample.attachment
        if attachment is not None:
            waiting.append((sample.payload.to_bytes(), attachment.to_bytes()))
            code.signal(take)

    return call


def reader(end: SinkEnd, read: Callable[[bytes], Any]) -> Callable[[zenoh.Sample], None]:
    """What Zenoh is to call for a signal; it does so on a thread for the subscription."""

    def call(sample: zenoh.Sample) -> None:
        read(bytes(sample.payload))
        end.received(int(bytes(sample.attachment)) if sample.attachment is not None else 0)

    return call


if __name__ == "__main__":
    {"selfconf": selfconf_end, "bare": bare_end, "least": least_end}[sys.argv[1]](*sys.argv[2:])
