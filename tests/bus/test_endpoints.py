"""What an endpoint of Zenoh says: its host and its port, whatever settings of the link follow."""

from __future__ import annotations

import pytest

from selfconf.bus.endpoints import endpoint_host, endpoint_port, with_other_port


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
