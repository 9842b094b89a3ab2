"""The origin of a URL: scheme, host and port."""

from __future__ import annotations

from typing import Any

import pytest

from selfconf.http_origin import http_origin


@pytest.mark.parametrize("url", ["ftp://a/", "lamp", "http:///x", "coap://a", "http://a:99999/"])
def test_only_http_has_an_origin(url: str) -> None:
    with pytest.raises(ValueError, match=r"http|Port|port"):
        http_origin(url)


def test_the_usual_port_is_left_out() -> None:
    said: Any = {"HTTP://A.Example:80/x": "http://a.example", "https://a:443": "https://a", "http://a:8": "http://a:8"}
    assert {url: http_origin(url) for url in said} == said
