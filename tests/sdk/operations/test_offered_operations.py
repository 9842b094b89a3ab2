"""A component answers the calls of its operations: who is served, once, and what is refused or cancelled."""

from __future__ import annotations

import json
from concurrent.futures import Future
from functools import partial
from typing import Any

import pytest

from selfconf.bus.port import Replies
from selfconf.model.profile import CALL_MARK, Ports, Profile, needed_operation
from selfconf.model.signal_fields import SignalField, SignalFields
from selfconf.model.term import IRI, XSD_NAMESPACE
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Apply, Cause
from selfconf.sdk.code_thread import CodeThread
from selfconf.sdk.component import Component
from selfconf.sdk.operations import MOST_CALLS, MOST_PAYLOAD
from selfconf.sdk.runtime import ComponentRuntime
from tests.sdk.operations.photographs import (
    ALBUM,
    ALBUM_PROFILE,
    CALLING,
    CAMERA,
    CAMERA_PROFILE,
    DIARY,
    IMAGE,
    Album,
    Camera,
    request_of,
)
from tests.sdk.stage import KEYS, THEM, Stage, apply, release, reserve


class Served:
    """A camera on a stage that acts, and may be called by the album."""

    def __init__(self, component: Component | None = None, fields: dict[IRI, SignalFields] | None = None) -> None:
        self.camera = component or Camera()
        self.stage = Stage(profile=ALBUM_PROFILE)
        self.runtime = ComponentRuntime(
            self.stage.network.node(), KEYS, CAMERA_PROFILE, self.camera, "life-c", fields=fields
        )
        self.stage.profile = CAMERA_PROFILE
        self.stage.call(apply(callers={"takePhoto" + CALL_MARK: (ALBUM,)}))

    def ask(self, request: bytes, operation: str = "takePhoto", caller: IRI = ALBUM) -> Replies:
        """The replies to a request of a component, whatever it says."""
        replies: list[Replies] = []
        self.stage.caller.ask(KEYS.operation(CAMERA, operation, caller), request, 1.0, replies.append)
        assert self.stage.network.run(lambda: bool(replies), 5.0)
        return replies[0]


def test_a_request_that_comes_twice_is_served_once() -> None:
    served = Served()
    request = request_of(ALBUM)
    assert served.ask(request).samples
    assert served.ask(request) == Replies()


def test_requests_that_were_answered_keep_none_out() -> None:
    served = Served()
    for _ in range(MOST_CALLS + 1):
        assert served.ask(request_of(ALBUM)).samples


def test_only_who_is_connected_is_answered() -> None:
    served = Served()
    assert json.loads(served.ask(request_of(ALBUM)).samples[0].payload) == {"by": "camera", "sent": None}
    stranger = IRI("urn:c:stranger")
    refused = served.ask(request_of(stranger), caller=stranger)
    assert refused.samples == ()
    assert refused.errors == ("stranger is not connected to the operation 'takePhoto' of camera",)


def test_who_asks_in_the_name_of_another_is_refused() -> None:
    """The key says who asks, which rules can hold a component to; the stamp has to say the same."""
    served = Served()
    refused = served.ask(request_of(ALBUM), caller=DIARY)
    assert refused.samples == ()
    assert refused.errors == ("not a request: it is stamped by album, and asked by another component",)
    assert served.ask(request_of(ALBUM)).samples


def test_an_answer_that_was_promised_is_cancelled_when_the_component_is_stopped() -> None:
    promise: Future[Any] = Future()
    served = Served(Camera(reply=lambda request: promise))
    replies: list[Replies] = []
    served.stage.caller.ask(KEYS.operation(CAMERA, "takePhoto", ALBUM), request_of(ALBUM), 5.0, replies.append)
    served.stage.let_pass(0.1)
    served.stage.call(release())
    assert served.stage.network.run(lambda: bool(replies), 5.0)
    assert promise.cancelled()
    assert replies[0].errors == ("camera ended the call before it answered",)


def test_what_breaks_that_was_promised_before_a_stop_is_no_failure_of_what_was_started_since() -> None:
    promise: Future[Any] = Future()
    promise.set_running_or_notify_cancel()  # as an executor does that has begun with it: it cannot be cancelled
    served = Served(Camera(reply=lambda request: promise))
    replies: list[Replies] = []
    served.stage.caller.ask(KEYS.operation(CAMERA, "takePhoto", ALBUM), request_of(ALBUM), 5.0, replies.append)
    served.stage.let_pass(0.1)
    served.stage.call(release(2))
    assert served.stage.call(apply(3)).active
    promise.set_exception(OSError("the lens was closed as it was stopped"))
    served.stage.let_pass(0.1)
    assert replies[0].errors == ("camera ended the call before it answered",)
    assert served.runtime.active
    assert served.stage.fails == []


@pytest.mark.parametrize("under_way", [False, True])
def test_an_answer_that_was_promised_ends_when_an_actuator_comes_to_rest(under_way: bool) -> None:
    promise: Future[Any] = Future()
    if under_way:
        promise.set_running_or_notify_cancel()
    served, replies = Served(Camera(reply=lambda request: promise)), list[Replies]()
    callers = {"takePhoto" + CALL_MARK: (ALBUM,)}
    served.stage.caller.ask(KEYS.operation(CAMERA, "takePhoto", ALBUM), request_of(ALBUM), 5.0, replies.append)
    served.stage.let_pass(0.1)
    served.stage.call(apply(2, callers=callers, rests=True))
    served.stage.let_pass(0.1)
    assert promise.cancelled() is not under_way
    served.stage.call(apply(2, callers=callers))
    if under_way:
        promise.set_exception(OSError("the lens was closed as it was stopped"))
    served.stage.let_pass(0.1)
    assert replies[0].errors == ("camera ended the call before it answered",)
    assert served.runtime.active


def test_an_actuator_that_rests_refuses_to_be_called() -> None:
    served, callers = Served(), {"takePhoto" + CALL_MARK: (ALBUM,)}
    served.stage.call(apply(2, callers=callers, rests=True))
    assert served.ask(request_of(ALBUM)).errors == ("camera is at rest",)
    served.stage.call(apply(2, callers=callers))
    assert served.ask(request_of(ALBUM)).samples


def test_a_promise_that_comes_to_another_one_is_no_answer() -> None:
    """A request would wait forever, and after 64 of them no other one would be served."""
    promise: Future[Any] = Future()
    promise.set_result(Future())
    served = Served(Camera(reply=lambda request: promise))
    (said,) = served.ask(request_of(ALBUM)).errors
    assert said == "its answer is nothing that JSON can say: an object of type Future is nothing of JSON"
    served.stage.let_pass(0.1)
    assert [fail.cause for fail in served.stage.fails] == [Cause.MALFORMED]


@pytest.mark.parametrize("ended", ["the caller is connected no more", "the caller waits no longer"])
@pytest.mark.parametrize("shared", [False, True])
def test_an_answer_that_nobody_waits_for_is_cancelled(ended: str, shared: bool) -> None:
    promise: Future[Any] = Future()
    promises: list[Future[Any]] = [promise, promise if shared else Future()]
    unused = iter(promises)
    served, replies = Served(Camera(reply=lambda request: next(unused))), list[Replies]()
    served.stage.call(apply(2, callers={"takePhoto" + CALL_MARK: (ALBUM, DIARY)}))
    patience = b"0.5" if "longer" in ended else b""
    for caller, attachment in ((ALBUM, patience), (DIARY, b"50")):
        key = KEYS.operation(CAMERA, "takePhoto", caller)
        served.stage.caller.ask(key, request_of(caller), 60.0, replies.append, attachment)
        served.stage.let_pass(0.1)
    if not patience:
        served.stage.call(apply(3, callers={"takePhoto" + CALL_MARK: (DIARY,)}))
    served.stage.let_pass(1.0)
    assert [one.cancelled() for one in promises] == [not shared, False]
    promises[1].set_result("a photo")
    served.stage.let_pass(0.1)
    assert [sample.payload for sample in replies[-1].samples] == [b'"a photo"']


def test_who_waits_no_longer_for_an_answer_of_several_is_refused_at_once_and_keeps_none_out() -> None:
    promise: Future[Any] = Future()
    served, replies = Served(Camera(reply=lambda request: promise)), dict[int, Replies]()
    served.stage.call(apply(2, callers={"takePhoto" + CALL_MARK: (ALBUM, DIARY)}))

    def ask(caller: IRI, number: int, attachment: bytes) -> None:
        key = KEYS.operation(CAMERA, "takePhoto", caller)
        served.stage.caller.ask(key, request_of(caller), 60.0, partial(replies.setdefault, number), attachment)
        served.stage.let_pass(0.05)

    ask(ALBUM, 1, b"")
    for number in range(2, MOST_CALLS + 5):
        ask(DIARY, number, b"0.1")
    served.stage.let_pass(0.2)
    assert {one.errors for one in replies.values()} == {("camera ended the call before it answered",)}
    assert replies.keys() == {*range(2, MOST_CALLS + 5)}
    ask(DIARY, 0, b"")
    served.stage.call(apply(3, callers={"takePhoto" + CALL_MARK: (DIARY,)}))
    served.stage.let_pass(0.1)
    assert replies[1].errors
    promise.set_result("a photo")
    served.stage.let_pass(0.1)
    assert [sample.payload for sample in replies[0].samples] == [b'"a photo"']


@pytest.mark.parametrize("ended", ["the caller is connected no more", "the caller waits no longer"])
def test_a_request_that_has_waited_for_the_code_until_nobody_wanted_it_is_not_served(ended: str) -> None:
    stage, code, camera = Stage(profile=ALBUM_PROFILE), CodeThread(inline=False), Camera()
    ComponentRuntime(stage.network.node(), KEYS, CAMERA_PROFILE, camera, "life-c", code)

    def call(message: Apply) -> None:
        stage.caller.ask(KEYS.call(CAMERA, "apply"), encode(message), 5.0, lambda replies: None)
        stage.let_pass(0.1)

    def poll() -> None:
        code.poll()
        stage.let_pass(0.1)

    call(apply(callers={"takePhoto" + CALL_MARK: (ALBUM,)}))
    poll()
    replies: list[Replies] = []
    stage.caller.ask(KEYS.operation(CAMERA, "takePhoto", ALBUM), request_of(ALBUM), 9.0, replies.append, b"1.5")
    stage.let_pass(0.1)  # the code is busy
    if "connected" in ended:
        call(apply(2, callers={"takePhoto" + CALL_MARK: (DIARY,)}))
    else:
        stage.let_pass(2.0)
    poll()
    assert camera.requests == []
    connected = "album is not connected to the operation 'takePhoto' of camera"
    waited = "camera was busy for longer than album waits for 'takePhoto'"
    assert replies[0].errors == (connected if "connected" in ended else waited,)


@pytest.mark.parametrize("patience", [b"long", b"-1", b"inf", b"nan", b"\xff"])
def test_a_request_that_does_not_say_how_long_is_waited_is_refused(patience: bytes) -> None:
    served, replies = Served(), list[Replies]()
    key = KEYS.operation(CAMERA, "takePhoto", ALBUM)
    served.stage.caller.ask(key, request_of(ALBUM), 1.0, replies.append, patience)
    assert served.stage.network.run(lambda: bool(replies), 5.0)
    assert replies[0].errors[0].startswith("not a request: ")


def test_a_component_that_is_released_is_connected_to_nobody() -> None:
    served = Served()
    served.stage.call(release())
    assert served.ask(request_of(ALBUM)).errors == ("album is not connected to the operation 'takePhoto' of camera",)


def test_who_is_connected_no_more_is_refused_while_others_go_on() -> None:
    served = Served()
    served.stage.call(apply(2, callers={"takePhoto" + CALL_MARK: (DIARY,)}))
    assert served.ask(request_of(ALBUM)).errors
    assert served.ask(request_of(DIARY), caller=DIARY).samples


def test_each_task_that_shares_a_component_has_its_callers() -> None:
    served = Served()
    served.stage.call(apply(1, THEM, callers={"takePhoto" + CALL_MARK: (DIARY,)}))
    assert served.ask(request_of(ALBUM)).samples
    assert served.ask(request_of(DIARY), caller=DIARY).samples
    served.stage.call(release())
    assert not served.ask(request_of(ALBUM)).samples
    assert served.ask(request_of(DIARY), caller=DIARY).samples


@pytest.mark.parametrize(
    ("request_", "reason"),
    [
        (b"", "not a request: not a message"),
        (request_of(ALBUM, b"{"), "not a request: Expecting property name"),
        (
            request_of(ALBUM, bytes(MOST_PAYLOAD + 1)),
            f"not a request: a request of {MOST_PAYLOAD + 1} bytes is too large",
        ),
        (b'raw{"kind": "stamp"}\n1', "not a request: a message of kind 'stamp' lacks"),
    ],
)
def test_what_is_no_request_is_refused(request_: bytes, reason: str) -> None:
    (error,) = Served().ask(request_).errors
    assert error.startswith(reason)


def test_an_operation_that_there_is_not_is_refused() -> None:
    assert Served().ask(request_of(ALBUM), "develop film").errors == ("camera offers no operation 'develop film'",)


def test_a_component_without_a_method_for_its_operation_says_so() -> None:
    assert Served(Component()).ask(request_of(ALBUM)).errors == ("'takePhoto' is advertised, and not written yet",)


def test_an_answer_that_is_not_of_its_type_is_malformed() -> None:
    text = SignalFields(IRI("urn:c:Text"), (SignalField("text", IRI(XSD_NAMESPACE + "string")),))
    served = Served(Camera(reply=lambda request: {"text": 3}), {IRI("urn:c:Image"): text})
    (error,) = served.ask(request_of(ALBUM)).errors
    assert error.startswith("its answer ")
    served.stage.let_pass(0.1)
    assert [fail.cause for fail in served.stage.fails] == [Cause.MALFORMED]


def test_a_request_that_is_not_of_its_type_is_the_fault_of_the_caller() -> None:
    text = SignalFields(IRI("urn:c:Text"), (SignalField("text", IRI(XSD_NAMESPACE + "string")),))
    stage = Stage(Album(), Profile(ALBUM, ports=Ports((needed_operation("other", None, IMAGE),))))
    profile = Profile(DIARY, ports=Ports((needed_operation("photo", IRI("urn:c:Text"), None),)))
    diary = Album()
    ComponentRuntime(stage.network.node(), KEYS, profile, diary, "life-d", fields={IRI("urn:c:Text"): text})
    stage.profile = profile
    stage.call(reserve(inputs=CALLING))
    stage.call(apply(inputs=CALLING))
    diary.ask({"text": 3})
    stage.let_pass(0.1)
    assert [(fail.component, fail.cause) for fail in stage.fails] == [(DIARY, Cause.MALFORMED)]
