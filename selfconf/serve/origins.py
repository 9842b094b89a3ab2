"""Which pages of other origins may ask the server from within a browser, by the CORS protocol of the Fetch standard.

A browser on this machine reaches the server for whatever page it shows, so a page from anywhere could read the ecology,
or keep it busy by costly queries. The first is what browsers prevent by themselves, the second is not: so a request
from another origin is refused before it costs anything, unless the operator has named that origin. One that is named
may ask what the standards offer, SPARQL and the directory, and not what people look at: signals, logs and tasks.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from urllib.parse import urlsplit

SHARED = ("/sparql", "/search/sparql", "/things", "/events", "/.well-known/wot")
"""What a page of an origin that is named may ask for, and what lies below."""
PERMISSION_LASTS = "600"
"""Seconds for which a browser may remember what it may do."""
SHARED_METHODS = "GET, HEAD, POST"
REQUEST_HEADERS = "Accept, Content-Type, Last-Event-ID"
"""The headers that a request may have besides those that need no permission."""
RESPONSE_HEADERS = "Link, Retry-After"
"""The headers of an answer that its page may read besides those that need no permission."""


class Origins:
    """The origins whose pages may ask; each is written as browsers send it, such as `https://yasgui.example`."""

    def __init__(self, named: Collection[str]) -> None:
        self._named = frozenset(named)

    def refusal(self, headers: Mapping[str, str], path: str) -> str:
        """Why a request is refused that a page of another origin has made; empty for every other one."""
        origin, site = headers.get("origin", ""), headers.get("sec-fetch-site", "none")
        own = site == "same-origin" or _place(origin) == headers.get("host", "").lower()
        if origin and not own:
            if origin not in self._named:
                return f"a page of {origin} may not ask this server; `selfconf serve --allow-origin ORIGIN` lets it"
            return "" if _is_shared(path) else f"a page of {origin} may ask {', '.join(SHARED)}, and nothing else"
        # Pictures, scripts and frames are asked for without an origin; so is a document to which a link leads.
        embedded = site in ("cross-site", "same-site") and headers.get("sec-fetch-dest") != "document"
        return "this server is not to be embedded in a page of another origin" if embedded and not origin else ""

    def headers(self, headers: Mapping[str, str]) -> dict[str, str]:
        """What an answer says to the browser that has asked."""
        if not self._named:
            return {}
        origin = headers.get("origin", "")
        if origin not in self._named:
            return {"Vary": "Origin"}
        return {
            "Vary": "Origin",
            "Access-Control-Allow-Origin": origin,
            "Access-Control-Expose-Headers": RESPONSE_HEADERS,
        }

    def preflight(self, method: str, headers: Mapping[str, str]) -> dict[str, str] | None:
        """The answer to a browser that asks whether its page may ask; None for any other request."""
        asks = method == "OPTIONS" and "access-control-request-method" in headers
        if not asks or headers.get("origin", "") not in self._named:
            return None
        local = "access-control-request-private-network" in headers  # of a page from outside for a server in here
        return {
            "Access-Control-Allow-Methods": SHARED_METHODS,
            "Access-Control-Allow-Headers": REQUEST_HEADERS,
            "Access-Control-Max-Age": PERMISSION_LASTS,
            **({"Access-Control-Allow-Private-Network": "true"} if local else {}),
        }


def _place(origin: str) -> str:
    """Host and port of an origin; empty for what is none."""
    try:
        return urlsplit(origin).netloc
    except ValueError:  # a bracket of IPv6 that is never closed
        return ""


def _is_shared(path: str) -> bool:
    return any(path == one or path.startswith(f"{one}/") for one in SHARED)
