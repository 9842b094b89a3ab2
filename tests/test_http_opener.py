"""HTTP without redirects: an answer that leads elsewhere is an error that says where, and nothing goes there."""

from __future__ import annotations

import threading
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from urllib.error import HTTPError

import pytest

from selfconf.http_opener import http_opener


class _Redirecting(BaseHTTPRequestHandler):
    """Answers everything with the way to another place, but for that place."""

    def do_GET(self) -> None:
        self.send_response(204 if self.path == "/there" else 302)
        self.send_header("Location", "/there")
        self.end_headers()

    def log_message(self, format: str, *values: object) -> None:
        """Nothing is printed."""


def test_a_redirect_is_the_answer_and_is_not_followed() -> None:
    with HTTPServer(("127.0.0.1", 0), _Redirecting) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            url = f"http://127.0.0.1:{server.server_port}"
            with http_opener().open(f"{url}/there", timeout=10.0) as reply:
                assert reply.status == 204
            with pytest.raises(HTTPError) as redirected:
                http_opener().open(f"{url}/here", timeout=10.0)
            assert (redirected.value.code, redirected.value.headers["Location"]) == (302, "/there")
            redirected.value.close()
        finally:
            server.shutdown()
            thread.join()


def test_nothing_but_http_is_opened(tmp_path: Path) -> None:
    (tmp_path / "secret").write_text("x")
    for url in ((tmp_path / "secret").as_uri(), "data:,x", "ftp://127.0.0.1/x"):
        assert http_opener().open(url, timeout=1.0) is None, url
