"""HTTP towards a real server: what is sent, and how every bad answer becomes one sentence within its bounds."""

from __future__ import annotations

import asyncio
import ssl
from array import array
from collections.abc import Callable
from functools import reduce
from http.server import BaseHTTPRequestHandler
from pathlib import Path
from typing import Any

import pytest

from selfconf.bridging.wot.forms import ThingForm
from selfconf.bridging.wot.thing_client import (
    CONNECTIONS,
    IDLE_FOR_ACTIONS,
    ThingAnswer,
    ThingClient,
    ThingError,
    UnsendableValueError,
)
from tests.bridging.thing_server import ThingServer, reply
from tests.bridging.wot.thing_requests import LIMITS, Start, asked, trouble

DEEP: list[Any] = reduce(lambda inner, _: [inner], range(100_000), list[Any]())
"""A value that no version of Python writes as JSON: 3.12 and later write more levels than those before."""


def test_a_value_is_read_written_and_sent(thing_server: Start) -> None:
    server = thing_server()
    server.values["/on"] = False

    async def work(client: ThingClient) -> list[ThingAnswer]:
        read, write = ThingForm(server.url + "/on", "GET"), ThingForm(server.url + "/on", "PUT")
        before = await client.read(read)
        await client.send(write, True)
        await client.send(ThingForm(server.url + "/blink", "POST"), None, action=True)
        return [before, await client.read(read)]

    assert asked(work) == [ThingAnswer(False), ThingAnswer(True)]
    assert server.sent("PUT") == [b"true"]
    assert server.sent("POST") == [b""]
    put = next(one for one in server.received if one.method == "PUT")
    assert put.headers["Content-Type"] == "application/json"


def test_outputs_that_are_followed_leave_room_for_requests_to_their_host(thing_server: Start) -> None:
    server = thing_server()
    server.values["/on"] = True
    server.answers["/poll"] = server.say_nothing

    async def work(client: ThingClient) -> ThingAnswer:
        poll = ThingForm(server.url + "/poll", "GET", subprotocol="longpoll")
        followed = [asyncio.ensure_future(client.wait(poll)) for _ in range(CONNECTIONS + 3)]
        while len(server.received) < len(followed):
            await asyncio.sleep(0.01)
        try:
            return await client.read(ThingForm(server.url + "/on", "GET"))
        finally:
            for one in followed:
                one.cancel()

    assert asked(lambda client: asyncio.wait_for(work(client), 30.0)) == ThingAnswer(True)


def test_actions_that_take_long_leave_room_for_requests_to_their_host(thing_server: Start) -> None:
    server = thing_server()
    server.values["/on"] = True
    server.posts["/move"] = server.say_nothing

    async def work(client: ThingClient) -> ThingAnswer:
        move = ThingForm(server.url + "/move", "POST")
        called = [asyncio.ensure_future(client.call(move, None)) for _ in range(CONNECTIONS + 3)]
        while len(server.received) < CONNECTIONS:
            await asyncio.sleep(0.01)
        try:
            return await client.read(ThingForm(server.url + "/on", "GET"))
        finally:
            for one in called:
                one.cancel()

    assert asked(lambda client: asyncio.wait_for(work(client), 30.0)) == ThingAnswer(True)


def test_an_action_is_not_called_by_a_connection_that_its_thing_may_be_closing(thing_server: Start) -> None:
    server = thing_server()
    asked_by: list[object] = []

    def move(handler: BaseHTTPRequestHandler) -> None:
        if handler.client_address in asked_by:  # it has closed it as the request was on its way
            handler.close_connection = True
        else:
            reply(handler, b"1")
        asked_by.append(handler.client_address)

    server.posts["/move"] = move

    async def work(client: ThingClient) -> list[ThingAnswer]:
        form = ThingForm(server.url + "/move", "POST")
        first = await client.call(form, None)
        await asyncio.sleep(1.1 * IDLE_FOR_ACTIONS)  # nothing is asked for so long
        return [first, await client.call(form, None)]

    assert asked(work) == [ThingAnswer(1)] * 2


def test_a_form_sends_what_its_security_asks_for(thing_server: Start) -> None:
    server = thing_server()
    server.values["/on"] = 1
    form = ThingForm(server.url + "/on?a=1", "GET", headers={"X-Key": "k"}, query=(("api", "s p"),))
    assert asked(lambda client: client.read(form)).value == 1
    (one,) = server.received
    assert one.path == "/on?a=1&api=s+p"
    assert one.headers["X-Key"] == "k"
    assert one.headers["Accept-Encoding"] == "identity"


def test_bytes_and_arrays_travel_too(thing_server: Start) -> None:
    server = thing_server()
    server.answers["/picture"] = lambda handler: reply(handler, b"\x89PNG", media="image/png; q=1")
    picture = ThingForm(server.url + "/picture", "GET", "image/png")
    assert asked(lambda client: client.read(picture)) == ThingAnswer(b"\x89PNG", "image/png")

    async def work(client: ThingClient) -> None:
        await client.send(ThingForm(server.url + "/show", "POST", "image/png"), b"\x89PNG", "image/png")
        await client.send(ThingForm(server.url + "/any", "POST", "application/octet-stream"), b"\x89PNG", "image/png")
        await client.send(ThingForm(server.url + "/say", "POST", "text/plain"), "good evening")
        await client.send(ThingForm(server.url + "/list", "POST"), memoryview(array("d", [1.0, 2.5])))

    asked(work)
    assert server.sent("POST") == [b"\x89PNG", b"\x89PNG", b"good evening", b"[1.0,2.5]"]


def test_an_answer_is_of_the_media_type_of_the_response(thing_server: Start) -> None:
    server = thing_server()
    server.posts["/snap"] = lambda handler: reply(handler, b"\xff\xd8", media="image/jpeg")
    snap = ThingForm(server.url + "/snap", "POST", response="image/jpeg")
    assert asked(lambda client: client.call(snap, {"zoom": 2})) == ThingAnswer(b"\xff\xd8", "image/jpeg")
    (post,) = server.received
    assert (post.headers["Content-Type"], post.headers["Accept"]) == ("application/json", "image/jpeg")


@pytest.mark.parametrize(
    ("value", "media", "words"),
    [
        ({"on": 1}, "text/plain", "takes text/plain"),
        (memoryview(array("d", [1.0])), "text/plain", "takes text/plain"),
        ("\ud800", "text/plain", "takes text/plain"),
        (memoryview(array("d", [float("nan")])), "application/json", "takes application/json"),
        (DEEP, "application/json", "takes application/json"),
        (b"\x89PNG", "application/json", "takes application/json, which cannot be made of image/png"),
        (b"\x89PNG", "image/jpeg", "takes image/jpeg, which cannot be made of image/png"),
    ],
)
def test_what_cannot_be_sent_is_said(value: Any, media: str, words: str) -> None:
    with pytest.raises(UnsendableValueError, match=words):
        asked(lambda client: client.send(ThingForm("http://127.0.0.1:1/", "POST", media), value, "image/png"))


def test_a_certificate_that_is_not_trusted_is_said_and_how_it_is(
    thing_server: Callable[..., ThingServer], tmp_path: Path
) -> None:
    certificates = pytest.importorskip("selfconf.access.certificates", reason="the extra `keys` is not installed")
    certificate, key = certificates.new_authority("a thing")
    shown = tmp_path / "thing.pem"
    shown.write_bytes(certificate.pem + certificates.key_pem(key))
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(shown)
    said = trouble(thing_server(tls=context), "/on")
    assert said.startswith(
        "GET /on does not answer: its certificate is not trusted: self"
    )  # OpenSSL spells it two ways
    assert said.endswith("; SSL_CERT_FILE names a file of the authorities that are")


def test_a_thing_that_speaks_no_tls_is_said_to_speak_none(thing_server: Start) -> None:
    form = ThingForm(thing_server().url.replace("http:", "https:"), "GET")
    with pytest.raises(ThingError, match="does not answer: there is no TLS to speak with it"):
        asked(lambda client: client.read(form))


def test_html_is_no_value(thing_server: Start) -> None:
    server = thing_server()
    server.answers["/on"] = lambda handler: reply(handler, b"<html>login", media="text/html; charset=utf-8")
    assert trouble(server, "/on") == "GET /on answers text/html, where application/json is expected"


@pytest.mark.parametrize("body", [b"{", b"NaN", b"\xff", b"[" * 100_000])
def test_what_is_not_json_is_said_with_its_beginning(thing_server: Start, body: bytes) -> None:
    server = thing_server()
    server.answers["/on"] = lambda handler: reply(handler, body)
    assert trouble(server, "/on").startswith("GET /on answers what is not JSON: b'")


def test_an_error_and_a_redirect_are_said(thing_server: Start) -> None:
    server, other = thing_server(), thing_server()
    server.answers["/moved"] = lambda handler: reply(handler, b"", 302, Location=f"{other.url}/on")
    assert trouble(server, "/none") == "GET /none answers 404"
    assert "answers 302, go to " in trouble(server, "/moved")
    assert other.received == []


def test_twenty_megabytes_are_not_read_whether_they_are_announced_or_not(thing_server: Start) -> None:
    server = thing_server()
    size = 20 << 20
    written: list[int] = []

    def announced(handler: BaseHTTPRequestHandler) -> None:
        handler.send_response(200)
        handler.send_header("Content-Type", "application/json")
        handler.send_header("Content-Length", str(size))
        handler.end_headers()
        server.released.wait(30.0)

    def streamed(handler: BaseHTTPRequestHandler) -> None:
        handler.send_response(200)
        handler.send_header("Content-Type", "application/json")
        handler.send_header("Connection", "close")
        handler.end_headers()
        for _ in range(size >> 16):
            written.append(handler.wfile.write(b"1" * (1 << 16)))

    server.answers.update({"/announced": announced, "/streamed": streamed})
    for path in ("/announced", "/streamed"):
        assert trouble(server, path) == f"GET {path} answers more than 1 MiB, which is more than is read"
    assert sum(written) < size


def test_what_is_compressed_is_refused(thing_server: Start) -> None:
    server = thing_server()
    server.answers["/on"] = lambda handler: reply(handler, b"\x1f\x8b", Content_Encoding="gzip")
    assert "compressed" in trouble(server, "/on")


def test_a_thing_that_is_slow_has_its_time_and_no_more(thing_server: Start) -> None:
    server = thing_server()

    def trickle(handler: BaseHTTPRequestHandler) -> None:
        handler.send_response(200)
        handler.send_header("Content-Type", "application/json")
        handler.send_header("Content-Length", "1000")
        handler.end_headers()
        while not server.released.wait(0.05):
            handler.wfile.write(b"1")

    server.answers.update({"/silent": server.say_nothing, "/trickle": trickle})
    for path in ("/silent", "/trickle"):
        assert trouble(server, path, LIMITS) == f"GET {path} has not answered in full within 0.5 s"


def test_nobody_there_is_said_in_few_words(thing_server: Start) -> None:
    server = thing_server()
    server.close()
    assert trouble(server, "/on") == "GET /on does not answer: Connection refused"
    with pytest.raises(ThingError, match="does not answer: Connection refused"):
        asked(lambda client: client.reach(ThingForm(server.url + "/on", "POST")))


@pytest.mark.parametrize("host", ["a..b", "\u00e4..b", 64 * "a"])
def test_a_host_that_no_name_can_be_does_not_answer(host: str) -> None:
    form = ThingForm(f"http://{host}/on", "POST")
    with pytest.raises(ThingError, match=rf"http://{host} does not answer: "):
        asked(lambda client: client.reach(form))
    with pytest.raises(ThingError, match="does not answer: "):
        asked(lambda client: client.send(form, True))


def test_something_that_listens_can_be_reached(thing_server: Start) -> None:
    server = thing_server()
    asked(lambda client: client.reach(ThingForm(server.url + "/on", "POST")))
    assert server.received == []


def test_what_is_not_http_or_breaks_off_is_said_in_few_words(thing_server: Start) -> None:
    server = thing_server()

    def greeting(handler: BaseHTTPRequestHandler) -> None:
        handler.wfile.write(b"HELLO\r\n\r\n")
        handler.close_connection = True

    def half(handler: BaseHTTPRequestHandler) -> None:
        handler.send_response(200)
        handler.send_header("Content-Type", "application/json")
        handler.send_header("Content-Length", "50")
        handler.end_headers()
        handler.wfile.write(b"tr")
        handler.close_connection = True

    server.answers.update({"/greeting": greeting, "/half": half})
    assert trouble(server, "/greeting") == "GET /greeting does not answer: what it sends is not HTTP"
    assert trouble(server, "/half") == "GET /half does not answer: what it sends breaks off"
