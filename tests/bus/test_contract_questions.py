"""The contract of a bus, kept by the memory bus and by the Zenoh bus: questions and their answers."""

from __future__ import annotations

import pytest

from selfconf.bus.memory import questions
from selfconf.bus.port import Replies, Request, Sample
from selfconf.bus.zenoh import bus as zenoh_bus
from tests.bus.nets import Net, payloads


def test_a_question_without_a_queryable_ends_at_once_with_nothing(net: Net, top: str) -> None:
    node = net.node()
    replies: list[Replies] = []
    began = node.now()
    node.ask(f"{top}/@ctl/state", b"", 5.0, replies.append)
    assert net.until(lambda: bool(replies))
    assert replies == [Replies((), (), True)]
    assert node.now() - began < 2.0


def test_a_question_is_answered_with_what_came_along(net: Net, top: str) -> None:
    one, two = net.node(), net.node()

    def answer(request: Request) -> None:
        request.reply(f"{top}/@ctl/state", b"got " + request.payload + request.attachment, b"page")
        request.finish()

    two.serve(f"{top}/@ctl/*", answer)
    net.settle()
    replies: list[Replies] = []
    one.ask(f"{top}/@ctl/state", b"it", 5.0, replies.append, b" and more")
    assert net.until(lambda: bool(replies))
    assert replies == [Replies((Sample(f"{top}/@ctl/state", b"got it and more", b"page"),))]


def test_a_question_reaches_all_queryables_and_ends_with_the_last(net: Net, top: str) -> None:
    asking = net.node()
    waiting: list[Request] = []
    for name in ("a", "b", "c"):

        def answer(request: Request, name: str = name) -> None:
            request.reply(f"{top}/site/{name}/ads/1", name.encode())
            request.reply(f"{top}/site/{name}/ads/2", name.encode())
            waiting.append(request)

        net.node().serve(f"{top}/site/{name}/ads/**", answer)
    net.settle()
    replies: list[Replies] = []
    asking.ask(f"{top}/site/*/ads/**", b"", 5.0, replies.append)
    assert net.until(lambda: len(waiting) == 3)
    for request in waiting[:2]:
        request.finish()
    net.settle()
    assert not replies
    waiting[2].finish()
    assert net.until(lambda: bool(replies))
    assert sorted(payloads(list(replies[0].samples))) == [b"a", b"a", b"b", b"b", b"c", b"c"]
    assert replies[0].complete


def test_several_replies_on_one_key_all_arrive(net: Net, top: str) -> None:
    asking = net.node()
    for name in ("a", "b"):

        def answer(request: Request, name: str = name) -> None:
            request.reply(f"{top}/cfg", name.encode())
            request.finish()

        net.node().serve(f"{top}/cfg", answer)
    net.settle()
    replies: list[Replies] = []
    asking.ask(f"{top}/cfg", b"", 5.0, replies.append)
    assert net.until(lambda: bool(replies))
    assert sorted(payloads(list(replies[0].samples))) == [b"a", b"b"]


def test_of_an_answer_that_is_too_large_the_rest_is_dropped(
    net: Net, top: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in (questions, zenoh_bus):
        monkeypatch.setattr(module, "LARGEST_REPLIES", 1000)
    asking, answering = net.node(), net.node()

    def answer(request: Request) -> None:
        for _ in range(15):
            request.reply(f"{top}/cfg", b"x" * 100)
        request.finish()

    answering.serve(f"{top}/cfg", answer)
    net.settle()
    replies: list[Replies] = []
    asking.ask(f"{top}/cfg", b"", 5.0, replies.append)
    assert net.until(lambda: bool(replies))
    assert len(replies[0].samples) == 10
    assert not replies[0].complete


def test_a_refusal_is_heard_with_its_reason(net: Net, top: str) -> None:
    one, two = net.node(), net.node()

    def answer(request: Request) -> None:
        request.refuse("not today, nor \udcff")
        request.finish()

    two.serve(f"{top}/@ctl/apply", answer)
    net.settle()
    replies: list[Replies] = []
    one.ask(f"{top}/@ctl/apply", b"", 5.0, replies.append)
    assert net.until(lambda: bool(replies))
    assert replies == [Replies((), ("not today, nor ?",), True)]


def test_a_queryable_that_never_finishes_is_not_waited_for_longer_than_asked(net: Net, top: str) -> None:
    asking, quick, stuck = net.node(), net.node(), net.node()
    kept: list[Request] = []

    def answer(request: Request) -> None:
        request.reply(f"{top}/a", b"quick")
        request.finish()

    quick.serve(f"{top}/a", answer)
    stuck.serve(f"{top}/b", kept.append)
    net.settle()
    replies: list[Replies] = []
    began = asking.now()
    asking.ask(f"{top}/*", b"", 0.3, replies.append)
    assert net.until(lambda: bool(replies))
    assert 0.2 < asking.now() - began < 2.0
    assert payloads(list(replies[0].samples)) == [b"quick"]
    assert not replies[0].complete
    assert replies[0].errors == ()
    for request in kept:
        request.reply(f"{top}/b", b"late")
        request.finish()
    net.settle()
    assert len(replies) == 1


def test_an_answer_may_come_after_a_while_and_finishing_twice_does_nothing(net: Net, top: str) -> None:
    one, two = net.node(), net.node()
    kept: list[Request] = []
    two.serve(f"{top}/a", kept.append)
    net.settle()
    replies: list[Replies] = []
    one.ask(f"{top}/a", b"", 5.0, replies.append)
    assert net.until(lambda: bool(kept))
    net.settle()
    kept[0].reply(f"{top}/a", b"at last")
    kept[0].finish()
    kept[0].finish()
    assert net.until(lambda: bool(replies))
    assert payloads(list(replies[0].samples)) == [b"at last"]


def test_a_queryable_that_was_undone_is_not_asked(net: Net, top: str) -> None:
    one, two = net.node(), net.node()
    asked: list[Request] = []
    undo = two.serve(f"{top}/a", asked.append)
    net.settle()
    undo()
    undo()
    net.settle()
    replies: list[Replies] = []
    one.ask(f"{top}/a", b"", 5.0, replies.append)
    assert net.until(lambda: bool(replies))
    assert not asked


def test_a_broad_question_does_not_reach_a_control_call(net: Net, top: str) -> None:
    one, two = net.node(), net.node()
    asked: list[Request] = []
    two.serve(f"{top}/@ctl/*", asked.append)
    net.settle()
    replies: list[Replies] = []
    one.ask(f"{top}/**", b"", 5.0, replies.append)
    assert net.until(lambda: bool(replies))
    assert not asked
