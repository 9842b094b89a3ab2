"""The origin of a URL: its scheme, host and port, by which two servers are different ones; and who asks it, if it says.

A user name and a password in a URL are never sent, and would stand in messages and logs.
"""

from __future__ import annotations

from urllib.parse import urlsplit

from selfconf.errors import AuthorError

_USUAL_PORTS = {"http": 80, "https": 443}


def http_origin(url: str) -> str:
    """The origin of an http or https URL (RFC 6454): scheme, host and port, the usual port left out.

    Raises ValueError for what is no such URL.
    """
    parts = urlsplit(url)
    scheme = parts.scheme.lower()
    if scheme not in _USUAL_PORTS or not parts.hostname:
        raise ValueError(f"{url!r} is no http or https URL")
    host = f"[{parts.hostname}]" if ":" in parts.hostname else parts.hostname
    port = parts.port
    return f"{scheme}://{host}" if port in (None, _USUAL_PORTS[scheme]) else f"{scheme}://{host}:{port}"


def check_without_user(url: str) -> None:
    """Raise AuthorError for a URL with a user name or a password in it, in words that tell neither."""
    try:
        _, at, host = urlsplit(url).netloc.rpartition("@")
    except ValueError:  # no URL at all, of which its reader complains
        return
    if at:
        raise AuthorError(f"the URL of {host} has a user name or a password in it, which are not sent; leave them out")
