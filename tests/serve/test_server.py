"""Where a server listens, and what it says when it cannot."""

from __future__ import annotations

import pytest

from selfconf.errors import AuthorError, NetworkError
from selfconf.serve.server import bound


def test_a_port_that_is_taken_is_a_sentence() -> None:
    with bound("127.0.0.1", 0) as place:
        port = place.getsockname()[1]
        with pytest.raises(
            NetworkError, match=f"cannot listen on port {port} of 127.0.0.1 .*give another one by --port"
        ):
            bound("127.0.0.1", port)


def test_what_is_no_address_is_a_sentence() -> None:
    with pytest.raises(AuthorError, match="no address of this machine"):
        bound("no such host", 0)
    with pytest.raises(NetworkError, match="cannot listen"):
        bound("192.0.2.1", 0)
