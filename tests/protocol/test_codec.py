"""Messages as bytes: what is written is read again, and what strangers write never raises anything but PeerError."""

from __future__ import annotations

import json
import subprocess
import sys
from typing import Any, get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from selfconf.errors import PeerError
from selfconf.protocol.codec import LARGEST, decode, encode
from selfconf.protocol.messages import (
    Apply,
    Free,
    Message,
    Release,
    Reserve,
    StateOf,
)
from tests.protocol import strategies

KINDS: tuple[type[Any], ...] = get_args(Message)
any_json: st.SearchStrategy[Any] = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.sampled_from([10**400, -1, 1 << 70])
    | st.floats()
    | st.text(max_size=5)
    | st.sampled_from(["", "\ud800", "done", "fail", "**", "a//b", "selfconf/**"]),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=5,
)


def read(payload: bytes) -> None:
    """Read bytes as a message of every kind; only PeerError may come of it."""
    for kind in KINDS:
        try:
            message = decode(payload, kind)
        except PeerError:
            continue
        encode(message)


@given(strategies.messages)
def test_every_message_is_read_as_it_was_written(message: Message) -> None:
    assert decode(encode(message), type(message)) == message


def test_messages_of_every_kind_are_tried() -> None:
    assert set(strategies.by_kind) == set(KINDS)


@given(strategies.messages, st.sampled_from(KINDS))
def test_a_message_is_not_taken_for_one_of_another_kind(message: Message, kind: type[Any]) -> None:
    if kind is not type(message):
        with pytest.raises(PeerError):
            decode(encode(message), kind)


@given(st.binary(max_size=60))
def test_any_bytes_raise_nothing_but_a_peer_error(payload: bytes) -> None:
    read(payload)


@given(strategies.messages, st.data())
def test_a_message_with_a_member_replaced_raises_nothing_but_a_peer_error(
    message: Message, data: st.DataObject
) -> None:
    body = json.loads(encode(message))
    member = data.draw(st.sampled_from(sorted(body)))
    value = body[member]
    if isinstance(value, dict | list) and value and data.draw(st.booleans()):
        place = data.draw(st.sampled_from(list(value) if isinstance(value, dict) else range(len(value))))
        value[place] = data.draw(any_json)
    else:
        body[member] = data.draw(any_json)
    read(json.dumps(body).encode())


@given(strategies.messages, st.integers(0, 400), st.binary(max_size=3))
def test_a_message_with_some_bytes_overwritten_raises_nothing_but_a_peer_error(
    message: Message, place: int, noise: bytes
) -> None:
    payload = encode(message)
    read(payload[:place] + noise + payload[place + len(noise) :])


@given(strategies.messages)
def test_a_member_that_is_missing_is_a_peer_error_or_has_a_default(message: Message) -> None:
    body = json.loads(encode(message))
    for member in body:
        read(json.dumps({key: value for key, value in body.items() if key != member}).encode())


@given(strategies.messages, st.text(max_size=5), any_json)
def test_a_newer_peer_may_say_more(message: Message, member: str, value: object) -> None:
    body = json.loads(encode(message))
    if member not in body:
        assert decode(json.dumps({**body, member: value}).encode(), type(message)) == message


def test_a_member_of_the_wrong_type_is_named() -> None:
    text = b'{"kind": "free", "component": "urn:x", "life": 7}'
    with pytest.raises(PeerError, match=r"^the member 'life' of a message of kind 'free': "):
        decode(text, Free)


def test_a_message_that_is_too_large_is_refused_unread() -> None:
    with pytest.raises(PeerError, match="too large"):
        decode(b" " * (LARGEST + 1), Release)


def test_a_message_that_is_nested_too_deep_is_refused() -> None:
    with pytest.raises(PeerError):
        decode(b"[" * 100_000, Release)


@pytest.mark.parametrize("kind", [Reserve, Apply, Release])
def test_a_call_of_an_older_peer_names_no_task_and_no_life(kind: type[Reserve | Apply | Release]) -> None:
    old = json.dumps({"kind": kind.__name__.lower(), "epoch": 7, "supervisor": "s", "inputs": {}}).encode()
    call = decode(old, kind)
    assert (call.epoch, call.task, call.life, call.priority, call.beginning) == (7, "", "", 0, 0.0)


def test_a_question_for_the_state_says_of_which_task_it_is() -> None:
    assert decode(b'{"kind": "state", "task": "tidy~1"}', StateOf) == StateOf("tidy~1")
    with pytest.raises(PeerError, match="task"):
        decode(b'{"kind": "state"}', StateOf)


@pytest.mark.process
@pytest.mark.parametrize("module", ["protocol.codec", "protocol.json_values", "protocol.stamps", "sdk.payloads"])
def test_orjson_imports_nothing_where_a_signal_would_end_it_by_a_crash(module: str) -> None:
    script = f"""
import sys
asked = []
class Noting:
    @staticmethod
    def find_spec(name, path=None, target=None):
        asked.append(name)
sys.meta_path.insert(0, Noting)
import selfconf.{module}
print(*asked[asked.index("orjson.orjson") + 1:][:1])
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert done.stderr == ""
    assert done.stdout.startswith("selfconf.")
