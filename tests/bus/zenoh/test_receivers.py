"""What Zenoh calls back for a declaration; with sessions, the contract of the bus tests the same."""

from __future__ import annotations

import threading
from types import SimpleNamespace
from typing import Any

import pytest
import zenoh

from selfconf.bus.loop import Loop
from selfconf.bus.port import Sample, Urgency
from selfconf.bus.zenoh import ZenohBus
from selfconf.bus.zenoh.receivers import DirectReceiver, Receiver
from tests.bus.nets import ZenohNet

SAMPLE = Sample("a/b", b"1")


def from_zenoh(payload: bytes = b"1") -> Any:
    """A sample as Zenoh has it."""
    return SimpleNamespace(key_expr="a/b", payload=zenoh.ZBytes(payload), attachment=None)


def test_a_thread_of_zenoh_keeps_its_state_of_python_from_one_call_to_the_next(
    zenoh_router: ZenohBus, top: str
) -> None:
    """What a thread has noted for itself is gone with its state."""
    thread, first, calls = threading.local(), list[int](), list[int]()

    def receive(sample: Sample) -> None:
        number = threading.get_ident()
        if not hasattr(thread, "noted"):
            first.append(number)
        thread.noted = True
        calls.append(number)

    net, followed = ZenohNet(zenoh_router), list[bool]()
    net.node().subscribe(f"{top}/x", receive, direct=True)
    publisher = net.node().publisher(f"{top}/x", Urgency.EVENT, followed.append)
    assert net.until(lambda: followed == [True])
    for _ in range(30):
        publisher.put(b"1")
    assert net.until(lambda: len(calls) == 30)
    assert sorted(first) == sorted(set(calls))
    net.close()


def test_what_is_received_is_called_back_by_the_loop_and_not_before() -> None:
    loop, heard = Loop(), list[Any]()
    receiver = Receiver(loop, heard.append)
    assert receiver.received_message(SAMPLE)
    assert receiver.received_message(SAMPLE, urgent=False)
    receiver.received("a life")
    assert heard == []
    loop.poll()
    assert heard == [SAMPLE, SAMPLE, "a life"]


def test_what_waits_when_a_declaration_is_taken_back_is_not_called_back_any_more() -> None:
    loop, heard, undeclared = Loop(), list[Any](), list[str]()
    receiver = Receiver(loop, heard.append)
    undo = receiver.until(lambda: undeclared.append("once"))
    receiver.received_message(SAMPLE)
    undo()
    loop.poll()
    assert (heard, undeclared) == ([], ["once"])


def test_a_message_for_which_there_is_no_room_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Loop, "MOST_BYTES", 1_000)
    receiver = Receiver(Loop(), print)
    assert receiver.received_message(Sample("a/b", b"x" * 900))
    assert not receiver.received_message(Sample("a/b", b"x" * 900))


def test_a_direct_callback_that_breaks_does_not_end_what_calls_it(caplog: pytest.LogCaptureFixture) -> None:
    def breaks(sample: Sample) -> None:
        raise ValueError(sample.key)

    DirectReceiver("a/b", breaks).received(from_zenoh())
    assert "a direct callback broke" in caplog.text


@pytest.mark.parametrize("declared", ["a/b", "a/*"])
def test_a_direct_callback_is_told_the_key_of_what_comes(declared: str) -> None:
    heard = list[Sample]()
    DirectReceiver(declared, heard.append).received(from_zenoh())
    assert [sample.key for sample in heard] == ["a/b"]


def test_closing_waits_for_a_direct_callback_that_is_under_way() -> None:
    begun, go_on, heard = threading.Event(), threading.Event(), list[bytes]()

    def receive(sample: Sample) -> None:
        begun.set()
        assert go_on.wait(10)
        heard.append(sample.payload)

    receiver = DirectReceiver("a/b", receive)
    receiving = threading.Thread(target=receiver.received, args=(from_zenoh(),))
    receiving.start()
    assert begun.wait(10)
    closing = threading.Thread(target=receiver.close)
    closing.start()
    assert closing.is_alive()
    go_on.set()
    closing.join(10)
    receiving.join(10)
    receiver.received(from_zenoh(b"late"))
    assert heard == [b"1"]
