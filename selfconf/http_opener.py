"""HTTP as it is spoken where no redirect is followed: no server chooses with what else this machine talks."""

from __future__ import annotations

from urllib.request import (
    HTTPDefaultErrorHandler,
    HTTPErrorProcessor,
    HTTPHandler,
    HTTPSHandler,
    OpenerDirector,
    ProxyHandler,
)


def http_opener() -> OpenerDirector:
    """Opens http and https and nothing else, and takes a redirect for the answer that it is."""
    opener = OpenerDirector()
    for each in (ProxyHandler, HTTPHandler, HTTPSHandler, HTTPDefaultErrorHandler, HTTPErrorProcessor):
        opener.add_handler(each())
    return opener
