"""What an endpoint of Zenoh says: its host and its port, whatever settings of the link follow."""

from __future__ import annotations

import pytest

from selfconf.protocol.endpoints import endpoint_host, endpoint_port, is_zenoh_endpoint, with_other_port, with_settings


@pytest.mark.parametrize(
    ("endpoint", "host", "port"),
    [
        ("tcp/127.0.0.1:7447", "127.0.0.1", 7447),
        ("tcp/127.0.0.1:7447#iface=eth0;so_rcvbuf=1000", "127.0.0.1", 7447),
        ("tls/[::1]:0?prio=1-3#x=a:b", "::1", 0),
        ("tcp/0.0.0.0:+7447", "0.0.0.0", 7447),
        ("tcp/home:port", "home", None),
        ("unixsock-stream//tmp/x", "", None),
        ("unixsock-stream//tmp/a:80", "/tmp/a", None),
        ("serial//dev/ttyUSB0#baudrate=115200", "", None),
        ("home", "", None),
    ],
)
def test_an_endpoint_has_a_host_and_a_port_or_none(endpoint: str, host: str, port: int | None) -> None:
    assert (endpoint_host(endpoint), endpoint_port(endpoint)) == (host, port)


def test_another_port_keeps_the_settings_of_the_link() -> None:
    assert with_other_port("tls/[::1]:0?prio=1#so_rcvbuf=1000", 7447) == "tls/[::1]:7447?prio=1#so_rcvbuf=1000"


def test_further_settings_of_the_link_follow_those_that_are_there() -> None:
    assert with_settings("tls/[::1]:7447?prio=1", "a=1") == "tls/[::1]:7447?prio=1#a=1"
    assert with_settings("tls/[::1]:7447#b=2", "a=1") == "tls/[::1]:7447#b=2;a=1"


@pytest.mark.parametrize(
    ("text", "right"),
    [
        ("tcp/127.0.0.1:7447", True),
        ("tls/[::1]:0?prio=1-3#x=a:b", True),
        ("unixsock-stream//tmp/x", True),
        ("serial//dev/ttyUSB0#baudrate=115200", True),
        ("bogus", False),
        ("", False),
        ("/x", False),
        ("tcp", False),
        ("tcp/", False),
        ("tcp/home", False),
        ("tcp/home:65536", False),
        ("127.0.0.1:7447", False),
        ("serial/", False),
        ("http://127.0.0.1:8000", False),
        ("https://site.example/", False),
        ("tcp://127.0.0.1:7447", False),
    ],
)
def test_what_can_be_no_endpoint_is_told_apart_before_zenoh_tries_to_reach_it(text: str, right: bool) -> None:
    assert is_zenoh_endpoint(text) is right
