"""Sessions of Zenoh: the endpoint that is meant, and one sentence where there is none."""

from __future__ import annotations

import socket
import subprocess
import sys
import time
from contextlib import ExitStack
from pathlib import Path

import pytest

from selfconf.access import Authority, PrincipalKind, open_keys
from selfconf.bus.zenoh import ANYWHERE_ON_LOOPBACK, Security, open_session, with_port
from selfconf.bus.zenoh.session import FREE_DESCRIPTORS, GREETING
from selfconf.errors import NetworkError
from selfconf.protocol.endpoints import LISTENING_PORTS, endpoint_port


def test_port_zero_becomes_a_free_port() -> None:
    head, _, port = with_port(ANYWHERE_ON_LOOPBACK).rpartition(":")
    assert head == "tcp/127.0.0.1"
    assert int(port) in LISTENING_PORTS


def test_an_endpoint_with_a_port_stays_as_it_is() -> None:
    assert with_port("tcp/192.0.2.1:7447") == "tcp/192.0.2.1:7447"


@pytest.mark.parametrize("name", ["so?", "mine;yours", "caf\udce9"])
def test_a_folder_of_keys_that_zenoh_cannot_be_told_is_named(name: str, tmp_path: Path) -> None:
    folder = Authority.init(tmp_path / name).path
    shown = open_keys(folder).credentials((PrincipalKind.SITE,))
    with pytest.raises(NetworkError, match=r"^Zenoh cannot read .*; give the folder of keys another name$"):
        open_session("router", ["tls/127.0.0.1:0"], security=Security(shown))


def test_an_address_of_another_host_has_no_free_port_here() -> None:
    with pytest.raises(NetworkError, match=r"^cannot listen on tcp/192\.0\.2\.1:0: "):
        with_port("tcp/192.0.2.1:0")


@pytest.mark.parametrize(
    "endpoint",
    ["127.0.0.1:7447", "home", "tcp/127.0.0.1", "tcp/127.0.0.1:port", "tcp/127.0.0.1:65536", "udp/localhost"],
)
def test_what_is_no_endpoint_is_told_how_one_is_written(endpoint: str) -> None:
    for way in ({"listen": [endpoint]}, {"connect": [endpoint], "connect_seconds": 60.0}):
        with pytest.raises(NetworkError, match=r"is no endpoint; write it like tcp/127\.0\.0\.1:7447$"):
            open_session("client" if "connect" in way else "router", **way)


@pytest.mark.parametrize("mode", ["client", "router"])
def test_what_has_keys_speaks_to_none_without(mode: str, tmp_path: Path) -> None:
    shown = Authority.init(tmp_path / "keys").credentials((PrincipalKind.SITE,))
    way = {"connect" if mode == "client" else "listen": ["tcp/127.0.0.1:7447"]}
    with pytest.raises(
        NetworkError, match=r"^tcp/.* is without keys, and keys are given; write tls/127\.0\.0\.1:7447$"
    ):
        open_session(mode, **way, security=Security(shown))


def test_an_endpoint_may_be_of_any_protocol_that_zenoh_speaks(tmp_path: Path) -> None:
    for endpoint in (with_port("udp/127.0.0.1:0"), f"unixsock-stream/{tmp_path}/hub"):
        router = open_session("router", listen=[endpoint])
        try:
            open_session("client", connect=[endpoint], connect_seconds=5.0).close()
        finally:
            router.close()


LET_GO = """
import os, threading, time
from selfconf.access import Authority, PrincipalKind, open_keys
from selfconf.bus.zenoh import ANYWHERE_ON_LOOPBACK, Security, open_session, with_port
from selfconf.bus.zenoh.receivers import callback
endpoint = with_port(ANYWHERE_ON_LOOPBACK)
gone, hub = (open_session("router", listen=[one]) for one in (with_port(ANYWHERE_ON_LOOPBACK), endpoint))
client = open_session("client", connect=[endpoint], connect_seconds=10.0)
gone.close()
came = threading.Event()
def changed(event):
    if str(event.kind) == "SampleKind.PUT":
        came.set()
        time.sleep(0.2)  # a callback that takes long
listener = client.info.declare_transport_events_listener(callback(changed))
hub.close()
hub = open_session("router", listen=[endpoint])
assert came.wait(20.0)
began = time.monotonic()
del gone
print(time.monotonic() - began, flush=True)
os._exit(0)
"""
"""A router is let go of while a callback for a link that has come waits for its turn in Python."""


@pytest.mark.process
def test_the_end_of_a_router_waits_for_no_callback() -> None:
    """No other thread of the program could run meanwhile, the callback included: for ten seconds."""
    done = subprocess.run([sys.executable, "-c", LET_GO], capture_output=True, text=True, timeout=60)
    assert float(done.stdout) < 5.0, done.stderr


def test_those_that_connect_and_stay_silent_keep_no_client_out() -> None:
    endpoint = with_port(ANYWHERE_ON_LOOPBACK)
    with ExitStack() as stack:
        stack.callback(open_session("router", listen=[endpoint]).close)
        for _ in range(300):
            stack.enter_context(socket.create_connection(("127.0.0.1", endpoint_port(endpoint))))
        began = time.monotonic()
        open_session("client", connect=[endpoint]).close()
        assert time.monotonic() - began < GREETING, "nothing has had to time out before"


def test_a_client_without_a_router_names_every_endpoint_that_it_has_asked() -> None:
    asked = [with_port(ANYWHERE_ON_LOOPBACK) for _ in range(2)]
    with pytest.raises(NetworkError) as error:
        open_session("client", connect=asked)
    assert str(error.value).startswith(f"no site answers at {asked[0]}, {asked[1]}; is the endpoint right?")


def test_two_routers_cannot_listen_on_one_endpoint() -> None:
    endpoint = with_port(ANYWHERE_ON_LOOPBACK)
    first = open_session("router", listen=[endpoint])
    try:
        with pytest.raises(NetworkError, match=f"^cannot listen on {endpoint}: the port is in use; port 0"):
            open_session("router", listen=[endpoint])
    finally:
        first.close()


OPENED_WITH_FEW_FILES = (
    "import resource, sys\n"
    "from selfconf.bus.zenoh import session\n"
    "from selfconf.errors import NetworkError\n"
    "most, session.FREE_DESCRIPTORS = map(int, sys.argv[1:])\n"
    "resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))\n"
    "try:\n"
    "    session.open_session('router', ['tcp/127.0.0.1:0'])\n"
    "except NetworkError as error:\n"
    "    print(error)\n"
)


def opened_with_few_files(most: int, needed: int) -> subprocess.CompletedProcess[str]:
    """What a program says that opens a session though it may open so few files."""
    command = [sys.executable, "-c", OPENED_WITH_FEW_FILES, str(most), str(needed)]
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)


@pytest.mark.process
@pytest.mark.parametrize("most", [12, 15, 17, 24, 32])
def test_no_session_begins_where_too_few_files_may_be_opened(most: int) -> None:
    """Zenoh would hang, abort the process, or panic."""
    done = opened_with_few_files(most, FREE_DESCRIPTORS)
    assert done.stdout.startswith(f"Zenoh cannot begin: this program may open {most} files"), done.stderr[-500:]
    assert "ulimit -n" in done.stdout
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.process
def test_a_panic_of_zenoh_is_said_in_a_sentence() -> None:
    """With so few descriptors its threads cannot begin."""
    done = opened_with_few_files(8, 0)
    assert "Zenoh cannot begin (" in done.stdout, done.stderr[-500:]


FORKED = """
import os, sys
from selfconf.bus.zenoh import ANYWHERE_ON_LOOPBACK, client, router
from selfconf.errors import ProgrammerError

bus = router(ANYWHERE_ON_LOOPBACK)
process = os.fork()
if not process:
    bus.close()
    try:
        client(["tcp/127.0.0.1:7447"])
    except ProgrammerError as error:
        sys.exit(str(error))
    sys.exit(1)
print(os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]), bool(bus.link))
"""


def test_a_process_that_was_forked_opens_no_session_and_closes_none() -> None:
    command = [sys.executable, "-W", "ignore::DeprecationWarning", "-c", FORKED]  # Python itself warns of it since 3.12
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout == "1 True\n"
    assert done.stderr.startswith("this process was forked from one that was in an ecology")
