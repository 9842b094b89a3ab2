"""A bus is opened at an endpoint that answers; one that is taken, empty, silent or none is a sentence."""

from __future__ import annotations

import os
import resource
import socket
import threading
import time
from pathlib import Path
from typing import Any

import pytest
from zenoh.handlers import Callback

from selfconf.bus.zenoh import ZenohBus, client, router
from selfconf.bus.zenoh import session as session_setup
from selfconf.errors import NetworkError


def free_endpoint() -> str:
    """An endpoint on which nothing listens."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return f"tcp/127.0.0.1:{probe.getsockname()[1]}"


def test_a_client_without_an_answer_says_where_it_has_asked() -> None:
    endpoint = free_endpoint()
    with pytest.raises(NetworkError, match=f"no site answers at {endpoint}"):
        client([endpoint], seconds=0.2)


@pytest.mark.slow
def test_what_listens_and_stays_silent_is_no_site() -> None:
    with socket.create_server(("127.0.0.1", 0)) as silent:
        began, endpoint = time.monotonic(), f"tcp/127.0.0.1:{silent.getsockname()[1]}"
        with pytest.raises(NetworkError, match=f"what listens at {endpoint} stays silent"):
            client([free_endpoint(), endpoint])
        assert time.monotonic() - began < 5.0


def test_a_router_on_an_endpoint_that_is_taken_says_which(zenoh_router: ZenohBus) -> None:
    with pytest.raises(NetworkError, match=f"cannot listen on {zenoh_router.endpoint}"):
        router(zenoh_router.endpoint)


def shared(source: Any, sink: Any, size: int) -> bool:
    """Whether a payload of that size comes through shared memory, which is set up with the first ones."""
    came: list[bool] = []
    held = sink.declare_subscriber(
        "test/shared", Callback(lambda s: came.append(bool(s.payload.as_shm())), indirect=False)
    )
    publisher = source.declare_publisher("test/shared")
    deadline = time.monotonic() + 10.0
    while not any(came) and len(came) < 20 and time.monotonic() < deadline:
        publisher.put(bytes(size))
        threading.Event().wait(0.02)
    held.undeclare()
    assert came
    return any(came)


def limited(monkeypatch: pytest.MonkeyPatch, folder: Path, capabilities: int = 0, limit: int = 8 << 20) -> None:
    """Make this process one with some capabilities, that may lock so many bytes."""
    status = folder / "status"
    status.write_text(f"Name:\tpython\nCapPrm:\tffff\nCapEff:\t{capabilities:016x}\nSeccomp:\t0\n")
    monkeypatch.setattr(session_setup, "PROCESS_STATUS", status)
    monkeypatch.setattr(resource, "getrlimit", lambda _: (limit, limit))


@pytest.mark.parametrize(
    ("capabilities", "limit", "may"),
    [
        (0, 8 << 20, False),
        (0x1FF & ~(1 << 14), 8 << 20, False),
        (1 << 14, 8 << 20, True),
        (0x1FFFFFFFFFF, 1 << 16, True),
        (0, resource.RLIM_INFINITY, True),
    ],
)
def test_any_memory_is_locked_without_a_limit_or_by_the_capability(
    capabilities: int, limit: int, may: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    limited(monkeypatch, tmp_path, capabilities, limit)
    assert session_setup._locks_any_memory() == may


def test_where_no_capabilities_are_told_memory_is_limited(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    limited(monkeypatch, tmp_path)
    for status in (tmp_path / "none", tmp_path):
        monkeypatch.setattr(session_setup, "PROCESS_STATUS", status)
        assert not session_setup._locks_any_memory()


@pytest.fixture
def may_lock_memory() -> None:
    """A process that Zenoh's shared memory is for."""
    if not session_setup._locks_any_memory():
        pytest.skip("this user may lock too little memory for shared memory; `ulimit -l unlimited`")


def test_memory_that_this_program_may_not_make_files_in_is_not_shared(monkeypatch: pytest.MonkeyPatch) -> None:
    """As in a container of which all is read-only, where Zenoh would open no session."""
    monkeypatch.setattr(session_setup, "ENOUGH_SHARED", 0)
    monkeypatch.setattr(session_setup, "_locks_any_memory", lambda: True)
    assert session_setup._has_shared_memory()
    monkeypatch.setattr(os, "access", lambda path, mode: path != session_setup.SHARED_MEMORY)
    assert not session_setup._has_shared_memory()


@pytest.mark.slow
@pytest.mark.usefixtures("may_lock_memory")
def test_large_payloads_of_clients_that_want_it_go_through_shared_memory(
    zenoh_router: ZenohBus, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    wants = [client([zenoh_router.endpoint], shared_memory=True) for _ in range(2)]
    plain = client([zenoh_router.endpoint])
    with monkeypatch.context() as small:
        small.setattr(session_setup, "ENOUGH_SHARED", 1 << 62)
        in_a_small_container = client([zenoh_router.endpoint], shared_memory=True)
    with monkeypatch.context() as locking_little:
        limited(locking_little, tmp_path)
        of_a_user = client([zenoh_router.endpoint], shared_memory=True)
    source, sink = (bus._session for bus in wants)
    assert shared(source, sink, 2 * session_setup.SHARED_FROM)
    assert not shared(source, sink, session_setup.SHARED_FROM // 2)
    assert not shared(source, plain._session, 2 * session_setup.SHARED_FROM)
    assert not shared(in_a_small_container._session, sink, 2 * session_setup.SHARED_FROM)
    assert not shared(source, of_a_user._session, 2 * session_setup.SHARED_FROM)
    for bus in (*wants, plain, in_a_small_container, of_a_user):
        bus.close()


def test_a_client_for_which_the_hub_has_no_shared_memory_left_goes_without(zenoh_router: ZenohBus) -> None:
    many = [client([zenoh_router.endpoint], shared_memory=True) for _ in range(360)]
    assert all(bus.link for bus in many)
    for bus in many:
        bus.close()


def test_an_endpoint_that_is_none_is_a_sentence() -> None:
    for endpoint in ("127.0.0.1:7447", "tcp/127.0.0.1", "carrier-pigeon/home"):
        with pytest.raises(NetworkError):
            client([endpoint], seconds=0.2)
        with pytest.raises(NetworkError):
            router(endpoint)


def test_a_router_listens_on_loopback_alone_and_tells_where(zenoh_router: ZenohBus) -> None:
    assert zenoh_router.endpoint.startswith("tcp/127.0.0.1:")
    assert not zenoh_router.endpoint.endswith(":0")
    assert zenoh_router.link


def test_a_client_takes_the_endpoint_that_answers(zenoh_router: ZenohBus) -> None:
    bus = client([free_endpoint(), zenoh_router.endpoint])
    assert bus.link
    bus.close()
