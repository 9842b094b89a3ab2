"""`selfconf serve`, as a process beside a real ecology: it shows, it is noticed by nobody, and it ends cleanly."""

from __future__ import annotations

import http.client
import importlib.util
import json
import re
import signal
import socket
from contextlib import ExitStack
from pathlib import Path
from typing import Any, cast
from urllib.parse import quote

import pyoxigraph as ox
import pytest

from selfconf.cli.main import parser
from selfconf.rdf.vocabulary import SC
from tests.cli.command import run
from tests.cli.processes import Home, Program, component_of

pytest.importorskip("starlette", reason="the extra `serve` is not installed")
pytestmark = [pytest.mark.process]


class Browser:
    """Asks a server that was started."""

    def __init__(self, program: Program) -> None:
        said = program.line()
        found = re.search(r"http://127\.0\.0\.1:(\d+)/", said)
        assert found is not None, said + program.complaints
        self.port = int(found[1])

    def get(self, path: str, **headers: str) -> tuple[int, bytes]:
        """The status and the body of an answer."""
        line = http.client.HTTPConnection("127.0.0.1", self.port, timeout=30)
        line.request("GET", path, headers=headers)
        answer = line.getresponse()
        found = answer.status, answer.read()
        line.close()
        return found

    def state(self) -> Any:
        """All that the page is told."""
        return json.loads(self.get("/state")[1])


@pytest.fixture
def ecology(home: Home) -> Home:
    home.site("peis-home", "ads")
    home.components("sonar", "encoder", "tracker", "odometry", "control", "drive", "pippi")
    return home


def serve(home: Home, *options: str) -> tuple[Program, Browser]:
    """A server of an ecology, once it listens."""
    program = home.selfconf("serve", "--ecology", home.ecology, "--port", "0", *options)
    return program, Browser(program)


def test_servers_end_by_ctrl_c_by_sigterm_and_with_their_terminal(ecology: Home) -> None:
    ignored = signal.getsignal(signal.SIGHUP) is signal.SIG_IGN  # as under nohup
    for number in (signal.SIGINT, signal.SIGTERM, *(() if ignored else (signal.SIGHUP,))):
        server, browser = serve(ecology)
        assert browser.get("/")[0] == 200
        assert server.end(number) == 0, number


@pytest.mark.slow
def test_a_failure_is_seen_in_the_page_and_by_sparql_and_servers_come_and_go_unnoticed(ecology: Home) -> None:
    server, browser = serve(ecology, "--history", "history")
    running = ecology.run()
    running.act("running")
    assert ecology.until(lambda: [t["phase"] for t in browser.state()["tasks"].values()] == ["running"])
    second, other = serve(ecology)
    assert ecology.until(lambda: len(other.state()["components"]) == 7)
    second.send(signal.SIGSTOP)  # a server that hears nothing holds nobody up
    stream = http.client.HTTPConnection("127.0.0.1", browser.port, timeout=30)
    stream.request("GET", "/changes")
    events = stream.getresponse()
    (ecology.folder / "tracker.fail").touch()
    told = b""
    while b"absolute-odometry" not in told:
        told += events.readline()
    assert component_of("tracker").encode() in told
    stream.close()
    lost, again = running.act("lost"), running.act("running")
    assert again["time"] - lost["time"] < 2
    second.end(signal.SIGKILL)

    def chosen() -> bool:
        text = "ASK { ?c a sc:Configuration ; sc:assignment [ sc:component <%s> ; sc:replaces <%s> ] }"
        asked = text % (component_of("odometry"), component_of("tracker"))
        return bool(json.loads(browser.get(f"/sparql?query={quote(asked)}")[1])["boolean"])

    assert ecology.until(chosen)
    assert b'selfconf_component_losses_total{cause="fail"} 1' in browser.get("/metrics")[1]
    assert len(json.loads(browser.get("/things")[1])) == 7
    assert server.end(signal.SIGTERM) == 0
    assert running.end(signal.SIGINT) == 0
    _, later = serve(ecology, "--history", "history")
    ended = quote("SELECT ?c { ?c a sc:Configuration ; prov:invalidatedAtTime ?ended }")
    assert ecology.until(lambda: later.get("/healthz")[0] == 200)
    assert ecology.until(lambda: component_rows(later.get(f"/sparql?query={ended}")[1]) == 1)


def component_rows(body: bytes) -> int:
    """How many solutions an answer has."""
    return len(json.loads(body)["results"]["bindings"])


def test_another_sparql_server_asks_it_and_ctrl_c_ends_it_with_streams_open(ecology: Home) -> None:
    server, browser = serve(ecology, "--allow-origin", "HTTPS://yasgui.example:443")
    assert ecology.until(lambda: browser.get("/healthz")[0] == 200)
    assert browser.get("/things", Origin="https://yasgui.example")[0] == 200
    here = f"SERVICE <http://127.0.0.1:{browser.port}/sparql> {{ ?c a <{SC.Component}> }}"
    assert len(list(cast(ox.QuerySolutions, ox.Store().query(f"SELECT ?c {{ {here} }}")))) == 7
    look = http.client.HTTPConnection("127.0.0.1", browser.port, timeout=30)
    look.request("GET", f"/look?component={quote(component_of('tracker'), safe='')}")
    told = look.getresponse()
    while told.readline() != b"event: log\n":
        assert not server.over
    stream = http.client.HTTPConnection("127.0.0.1", browser.port, timeout=30)
    stream.request("GET", "/changes")
    events = stream.getresponse()
    assert events.readline().startswith(b":")
    assert server.end(signal.SIGINT) == 0
    stream.close()
    look.close()
    assert "Traceback" not in server.complaints


def test_ctrl_c_ends_it_with_a_query_and_half_a_request_under_way(ecology: Home) -> None:
    server, browser = serve(ecology)
    assert ecology.until(lambda: browser.get("/healthz")[0] == 200)
    endless = "ASK { GRAPH ?g { ?a ?b ?c . ?d ?e ?f . ?i ?j ?k . ?l ?m ?n . ?o ?p ?q FILTER(?a = 1) } }"
    host = b"Host: 127.0.0.1\r\n"
    half = (
        b"POST /sparql HTTP/1.1\r\nContent-Type: application/sparql-query\r\nContent-Length: 9\r\n" + host + b"\r\nASK"
    )
    with ExitStack() as stack:
        for sent in (f"GET /sparql?query={quote(endless)} HTTP/1.1\r\n".encode() + host + b"\r\n", half):
            line = stack.enter_context(socket.create_connection(("127.0.0.1", browser.port)))
            line.sendall(sent)
        assert browser.get("/healthz")[0] == 200  # what came before has been read
        assert server.end(signal.SIGINT) == 0
    assert server.complaints == ""


def test_a_port_that_is_taken_is_a_sentence(home: Home) -> None:
    home.site("peis-home", "ads")
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        server = home.selfconf("serve", "--ecology", home.ecology, "--port", port)
        assert server.ended() == 2
    assert f"cannot listen on port {port}" in server.complaints


def test_a_port_that_is_none_is_misuse(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(capsys, "serve", "--port", "70000").is_one_sentence("no port")


@pytest.mark.parametrize("origin", ["*", "null", "yasgui.example", "https://yasgui.example/", "https://a b", "ftp://a"])
def test_an_origin_that_is_none_is_misuse(capsys: pytest.CaptureFixture[str], origin: str) -> None:
    assert run(capsys, "serve", "--allow-origin", origin).is_one_sentence("is no origin; it takes SCHEME://HOST")


@pytest.mark.parametrize(
    ("typed", "origin"),
    [
        ("https://yasgui.example:8443", "https://yasgui.example:8443"),
        ("http://yasgui.example:443", "http://yasgui.example:443"),
        ("HTTP://yasgui.example:80", "http://yasgui.example"),
    ],
)
def test_an_origin_is_written_as_browsers_do(typed: str, origin: str) -> None:
    assert parser(["serve"]).parse_args(["serve", "--allow-origin", typed]).origins == [origin]


def test_without_the_extra_it_says_what_to_install(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    assert run(capsys, "serve").is_one_sentence("is missing: starlette and uvicorn; install the extra `serve`")


def test_with_keys_it_is_shown_to_other_hosts_only_if_told_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """By HTTP nobody is asked for keys: who reaches the server sees what they protect."""
    pytest.importorskip("cryptography", reason="the extra `keys` is not installed")
    keys = ("--keys", str(tmp_path / "keys"))
    assert run(capsys, "keys", "init", keys[1]).code == 0
    for host in ("0.0.0.0", "::"):
        assert run(capsys, "serve", *keys, "--host", host).is_one_sentence("sees what read.main may see", "--insecure")
    told = run(capsys, "serve", *keys, "--host", "0.0.0.0", "--insecure", "--ecology", "nowhere")
    assert told.code == 2
    assert "--insecure" not in told.err, "it looks for the ecology"
