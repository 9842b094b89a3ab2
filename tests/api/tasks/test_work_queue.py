"""What is handed to the thread that does what takes long: work and events keep their order, and none is lost."""

from __future__ import annotations

import threading
import time

import pytest

from selfconf.api.tasks import work_queue
from selfconf.api.tasks.work_queue import WorkQueue
from selfconf.model.run_event import EcologyAsked


def test_a_reader_hears_what_has_led_to_a_work_before_that_is_done(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(work_queue, "HELD_UP", 60.0)
    queue, done = WorkQueue(), list[str]()
    before, after = EcologyAsked(), EcologyAsked()
    queue.report(before)
    queue.add(lambda: done.append("searched"))
    queue.report(after)
    assert queue.next(0.0) is before
    assert done == []
    assert queue.next(0.0) is after
    assert done == ["searched"]
    assert queue.next(0.0) is None


def test_a_reader_that_takes_long_over_each_event_holds_up_no_work(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(work_queue, "HELD_UP", 0.0)
    queue, done = WorkQueue(), list[str]()
    events = [EcologyAsked(), EcologyAsked()]
    for event in events:
        queue.report(event)
    queue.add(lambda: done.append("searched"))
    assert queue.next(0.0) is events[0]
    assert done == ["searched"]
    assert queue.next(0.0) is events[1]


def test_a_wake_up_ends_the_wait() -> None:
    queue = WorkQueue()
    queue.wake_up()
    assert queue.next(60.0) is None


def test_where_there_is_nothing_to_do_it_waits() -> None:
    queue, began = WorkQueue(), time.monotonic()
    assert queue.next(0.05) is None
    assert time.monotonic() - began >= 0.05


def test_what_breaks_takes_nothing_with_it_that_waits() -> None:
    queue, done = WorkQueue(), list[str]()
    queue.add(lambda: {}["nothing"])
    queue.add(lambda: done.append("searched"))
    with pytest.raises(KeyError):
        queue.next(0.0)
    queue.next(0.0)
    assert done == ["searched"]


def _forever(begun: threading.Event) -> None:
    begun.set()
    while True:
        pass


@pytest.mark.parametrize("owner", ["", "patrol"])
def test_what_is_abandoned_ends_while_it_is_done(owner: str) -> None:
    queue, begun, done = WorkQueue(), threading.Event(), list[str]()

    def give_up() -> None:
        begun.wait()
        queue.abandon(owner)

    queue.add(lambda: _forever(begun), "patrol")
    queue.add(lambda: done.append("patrol"), "patrol")
    queue.add(lambda: done.append("watch"), "watch")
    other = threading.Thread(target=give_up)
    other.start()
    assert queue.next(0.0) is None
    other.join()
    assert done == (["watch"] if owner else [])
    queue.add(lambda: done.append("again"), "patrol")
    queue.next(0.0)
    assert done[-1] == "again"


def test_one_work_is_abandoned_while_it_is_done_or_before_and_no_other_of_its_owner() -> None:
    queue, begun, done = WorkQueue(), threading.Event(), list[str]()
    first = queue.add(lambda: _forever(begun), "patrol")
    second = queue.add(lambda: done.append("searched"), "patrol")
    queue.add(lambda: done.append("prepared"), "patrol")

    def give_up() -> None:
        begun.wait()
        second()
        first()

    other = threading.Thread(target=give_up)
    other.start()
    assert queue.next(0.0) is None
    other.join()
    assert done == ["prepared"]
    first()
    second()  # both are over
    queue.add(lambda: done.append("again"), "patrol")
    queue.next(0.0)
    assert done == ["prepared", "again"]


def test_what_is_done_for_another_goes_on() -> None:
    queue, done = WorkQueue(), list[str]()

    def work() -> None:
        queue.abandon("watch")
        done.append("patrol")

    queue.add(work, "patrol")
    queue.next(0.0)
    assert done == ["patrol"]


def test_to_abandon_what_is_over_or_not_begun_harms_nothing() -> None:
    queue, done = WorkQueue(), list[str]()
    queue.abandon()
    queue.add(lambda: done.append("searched"))
    queue.next(0.0)
    queue.abandon()
    queue.add(lambda: done.append("waits"))
    queue.abandon()
    assert queue.next(60.0) is None
    assert done == ["searched"]


@pytest.mark.parametrize("how", ["add", "report", "wake_up", "abandon"])
def test_what_is_done_until_there_is_more_ends_as_soon_as_there_is(how: str) -> None:
    queue, begun = WorkQueue(), threading.Event()
    more = {"add": lambda: queue.add(lambda: None), "report": lambda: queue.report(EcologyAsked())}

    def interrupt() -> None:
        begun.wait()
        more.get(how, getattr(queue, how))()

    other = threading.Thread(target=interrupt)
    other.start()
    assert not queue.until_more(lambda: _forever(begun))
    other.join()
    assert (queue.next(0.0) is not None) == (how == "report")


def test_what_is_done_until_there_is_more_comes_to_its_end_where_there_is_nothing() -> None:
    queue, done = WorkQueue(), list[str]()
    assert queue.until_more(lambda: done.append("explained"))
    queue.add(lambda: done.append("searched"))
    assert not queue.until_more(lambda: done.append("explained again"))
    queue.next(0.0)
    assert done == ["explained", "searched"]


def test_what_is_done_until_there_is_more_may_wait_for_a_time_in_which_there_is_nothing() -> None:
    queue, done = WorkQueue(), list[str]()
    queue.abandon()
    assert queue.next(0.0) is None
    threading.Timer(0.05, lambda: queue.add(lambda: done.append("searched"))).start()
    assert not queue.until_more(lambda: done.append("explained"), after=60.0)
    queue.next(0.0)
    assert done == ["searched"]
    assert queue.until_more(lambda: done.append("explained"), after=0.05)
    assert done == ["searched", "explained"]


def test_what_is_done_at_leisure_is_done_anew_when_something_has_come_in_the_middle() -> None:
    queue, begun, done = WorkQueue(), threading.Event(), list[str]()

    def explain() -> None:
        done.append("begun")
        if not begun.is_set():
            _forever(begun)
        done.append("explained")

    def interrupt() -> None:
        begun.wait()
        queue.add(lambda: done.append("searched"))

    queue.at_leisure(explain, "patrol")
    other = threading.Thread(target=interrupt)
    other.start()
    queue.next(60.0)
    other.join()
    while done[-1] != "explained":
        queue.next(60.0)
    assert done == ["begun", "searched", "begun", "explained"]
    assert queue.next(0.0) is None
    assert len(done) == 4


def test_what_is_done_at_leisure_is_the_newest_of_each_owner_that_has_not_ended() -> None:
    queue, done = WorkQueue(), list[str]()
    for owner, what in (("patrol", "first"), ("tidy", "tidied"), ("patrol", "second"), ("watch", "watched")):
        queue.at_leisure(lambda what=what: done.append(what), owner)  # type: ignore[misc]  # a default binds it
    queue.abandon("watch")
    for _ in range(4):
        queue.next(1.0)
    assert done == ["second", "tidied"]
    queue.at_leisure(lambda: done.append("third"), "patrol")
    queue.abandon()
    queue.next(0.3)
    queue.next(0.3)
    assert done == ["second", "tidied"]


def test_what_was_interrupted_at_leisure_comes_after_what_waits_for_others(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(work_queue, "UNDISTURBED", 0.05)
    queue, begun, done = WorkQueue(), threading.Event(), list[str]()
    disturbed = 0

    def explain() -> None:
        done.append("begun")
        if disturbed < 3:
            _forever(begun)

    def disturb() -> None:
        nonlocal disturbed
        while disturbed < 3:
            begun.wait()
            begun.clear()
            disturbed += 1
            queue.add(lambda: done.append("searched"))

    queue.at_leisure(explain, "patrol")
    queue.at_leisure(lambda: done.append("tidied"), "tidy")
    other = threading.Thread(target=disturb)
    other.start()
    while disturbed < 3:
        queue.next(60.0)
    other.join()
    queue.next(0.0)
    assert done == ["begun", "searched", "tidied", "begun", "searched", "begun", "searched"]


def test_what_is_interrupted_at_leisure_again_and_again_is_begun_more_and_more_rarely(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(work_queue, "UNDISTURBED", 0.01)
    monkeypatch.setattr(work_queue, "MOST_UNDISTURBED", 0.04)
    queue, begun = WorkQueue(), threading.Event()
    disturbed, pauses = time.monotonic(), list[float]()

    def explain() -> None:
        pauses.append(time.monotonic() - disturbed)
        _forever(begun)

    def disturb() -> None:
        nonlocal disturbed
        begun.wait()
        begun.clear()
        disturbed = time.monotonic()
        queue.at_leisure(explain, "patrol")  # a refusal that is found again

    queue.at_leisure(explain, "patrol")
    for number in range(5):
        other = threading.Thread(target=disturb)
        other.start()
        while len(pauses) == number:
            queue.next(60.0)
        other.join()
    least = (0.01, 0.02, 0.04, 0.04, 0.04)
    assert [pause for pause, seconds in zip(pauses, least, strict=True) if pause < seconds] == []
    queue.abandon("patrol")
    queue.next(0.0)
    assert queue.next(0.0) is None


def test_what_takes_too_long_at_leisure_is_ended_and_not_begun_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(work_queue, "UNDISTURBED", 0.01)
    monkeypatch.setattr(work_queue, "MOST_AT_LEISURE", 0.1)
    queue, done = WorkQueue(), list[str]()

    def search() -> None:
        done.append("begun")
        _forever(threading.Event())

    queue.at_leisure(search, "patrol")
    for _ in range(3):
        assert queue.next(0.1) is None
    assert done == ["begun"]
    queue.at_leisure(lambda: done.append("tidied"), "tidy")
    while len(done) == 1:
        queue.next(1.0)
    assert done == ["begun", "tidied"]


def test_what_waits_for_leisure_holds_up_no_caller() -> None:
    queue, done = WorkQueue(), list[str]()
    queue.at_leisure(lambda: done.append("explained"), "patrol")
    queue.next(0.0)
    assert done == []


def test_what_breaks_at_leisure_is_not_done_again() -> None:
    queue = WorkQueue()
    queue.at_leisure(lambda: {}["nothing"], "patrol")
    with pytest.raises(KeyError):
        queue.next(60.0)
    assert queue.next(0.0) is None


def test_what_could_not_be_ended_in_another_thread_is_not_begun() -> None:
    queue, done = WorkQueue(), list[object]()
    other = threading.Thread(target=lambda: done.append(queue.until_more(lambda: done.append("explained"))))
    other.start()
    other.join()
    assert done == [False]


def test_what_is_done_now_comes_before_what_waits_and_may_be_abandoned() -> None:
    queue, done, begun = WorkQueue(), list[str](), threading.Event()
    queue.add(lambda: done.append("waits"))
    assert queue.do(lambda: done.append("now"))
    assert done == ["now"]
    threading.Timer(0.05, queue.abandon).start()
    assert not queue.do(lambda: _forever(begun))
