"""The forms of a Thing Description: by which HTTP request something is read, written, called or followed.

Of several forms for an operation the first counts that a bridge can use. What it can use is HTTP without URI variables,
to a host that it may reach, with security schemes for which it has credentials; `ThingForms.problems` says in sentences
what came of the others. (W3C Web of Things Thing Description 1.1, sections 5.3.4 and 8.3.1.)
"""

from __future__ import annotations

import base64
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import quote, urljoin, urlsplit, urlunsplit

from selfconf.bridging.wot.credentials import Credentials, origin

METHODS = {
    "readproperty": "GET",
    "writeproperty": "PUT",
    "observeproperty": "GET",
    "invokeaction": "POST",
    "subscribeevent": "GET",
}
"""The method of an operation where its form names none (section 8.3.1, table 30)."""
WITHOUT_OP = METHODS.keys() - {"observeproperty"}
"""The operations that a form may serve if it does not say which; its affordance decides among them."""
FOLLOWED = ("sse", "longpoll")
"""The subprotocols by which a bridge follows a property or an event."""
JSON = "application/json"
_KNOWN_METHODS = frozenset(("GET", "PUT", "POST", "PATCH", "DELETE"))


@dataclass(frozen=True, slots=True)
class ThingForm:
    """One HTTP request that can be made: `repr` shows neither its headers nor what a security scheme adds to its URL."""

    url: str
    method: str
    media: str = JSON
    """The media type of what is sent and of what is answered."""
    subprotocol: str = ""
    headers: Mapping[str, str] = field(default_factory=dict, repr=False)
    query: tuple[tuple[str, str], ...] = field(default=(), repr=False)

    def __str__(self) -> str:
        return f"{self.method} {self.url}"


class ThingForms:
    """The forms of one thing."""

    def __init__(
        self, description: Mapping[str, Any], place: str, credentials: Credentials, reachable: Callable[[str], bool]
    ) -> None:
        """`place` is where the description comes from, from which a form counts if there is no base.

        `reachable` says of a host whether requests may go there.
        """
        said = description.get("base")
        self._base = said if isinstance(said, str) else place
        self._security = description.get("security")
        definitions = description.get("securityDefinitions")
        self._definitions: Mapping[str, Any] = definitions if isinstance(definitions, dict) else {}
        self._credentials, self._reachable = credentials, reachable
        self.problems: dict[str, None] = {}
        """Why forms cannot be used: sentences, each once, in order."""

    def find(self, affordance: Mapping[str, Any], operation: str, subprotocols: Iterable[str] = ("",)) -> ThingForm | None:
        """The first form for an operation that can be used, by one of some subprotocols, the first preferred."""
        forms = [one for one in _as_list(affordance.get("forms")) if isinstance(one, dict) and _serves(one, operation)]
        for subprotocol in subprotocols:
            for form in forms:
                if form.get("subprotocol", "") == subprotocol:
                    found = self._form(form, operation)
                    if isinstance(found, ThingForm):
                        return found
                    self.problems[found] = None
        return None

    def _form(self, form: Mapping[str, Any], operation: str) -> ThingForm | str:
        """The request that a form stands for, or a sentence that says why it cannot be made."""
        href = form.get("href")
        if not isinstance(href, str):
            return "a form has no href"
        if "{" in href:
            return f"the form {href[:80]!r} has URI variables, which a signal does not set"
        try:
            url = _plain(urljoin(self._base, href))
            where = origin(url)
        except ValueError:
            return f"the form {href[:80]!r} leads to no http or https URL"
        host = urlsplit(url).hostname or ""
        if not self._reachable(host):
            return f"its forms lead to {host}, which its description does not come from; allow it with --host {host}"
        method = form.get("htv:methodName", METHODS[operation])
        if method not in _KNOWN_METHODS:
            return f"the form {href[:80]!r} has the HTTP method {str(method)[:20]!r}"
        headers: dict[str, str] = {}
        query: list[tuple[str, str]] = []
        for name in _as_list(form.get("security", self._security)):
            trouble = self._secure(str(name), where, url, headers, query)
            if trouble:
                return trouble
        media = form.get("contentType", JSON)
        media = media if isinstance(media, str) and media.isascii() and media.isprintable() else JSON
        return ThingForm(url, method, media, str(form.get("subprotocol", "")), headers, tuple(query))

    def _secure(
        self, name: str, where: str, url: str, headers: dict[str, str], query: list[tuple[str, str]]
    ) -> str | None:
        """Add what a security scheme asks for (section 5.3.3); a sentence if that cannot be had."""
        scheme = self._definitions.get(name)
        kind = scheme.get("scheme") if isinstance(scheme, dict) else None
        if kind == "nosec":
            return None
        if not isinstance(scheme, dict) or kind not in ("basic", "bearer", "apikey"):
            return f"it asks for the security scheme {str(kind or name)[:40]!r}; a bridge knows nosec, basic, bearer, apikey"
        told = self._credentials.for_url(url)
        wanted = {"basic": ("username", "password"), "bearer": ("token",), "apikey": ("key",)}[kind]
        missing = [member for member in wanted if member not in told]
        if missing:
            return f"{where} asks for {' and '.join(missing)}; put them into a file and give it with --credentials"
        value = told[wanted[0]]
        if kind == "basic":
            value = "Basic " + base64.b64encode(f"{value}:{told['password']}".encode()).decode()
        elif kind == "bearer":
            value = f"Bearer {value}"
        place = scheme.get("in", "query" if kind == "apikey" else "header")
        field_name = scheme.get("name", "Authorization" if place == "header" else "")
        if not isinstance(field_name, str) or not field_name or not _is_token(field_name):
            return f"its security scheme {name[:40]!r} does not say the name of its {str(place)[:20]}"
        if place == "header":
            headers[field_name] = value
        elif place == "query":
            query.append((field_name, value))
        elif place == "cookie":
            headers["Cookie"] = f"{field_name}={quote(value, safe='')}"
        else:
            return f"its security scheme {name[:40]!r} goes into {str(place)[:20]!r}; a bridge knows header, query, cookie"
        return None


def _plain(url: str) -> str:
    """A URL without what no request carries: a fragment, a user name, a password. Raises ValueError."""
    parts = urlsplit(url)
    if not url.isprintable() or " " in url:
        raise ValueError("no URL")
    return urlunsplit((parts.scheme.lower(), parts.netloc.rpartition("@")[2], parts.path or "/", parts.query, ""))


def _serves(form: Mapping[str, Any], operation: str) -> bool:
    """Whether a form is for an operation; one that does not say it is for those of its affordance but to observe."""
    return operation in _as_list(form["op"]) if "op" in form else operation in WITHOUT_OP


def _is_token(name: str) -> bool:
    """Whether a text can name a header (RFC 9110, section 5.6.2), and so a cookie or a part of a query too."""
    return name.isascii() and all(letter.isalnum() or letter in "!#$%&'*+-.^_`|~" for letter in name)


def _as_list(value: Any) -> list[Any]:
    return [] if value is None else value if isinstance(value, list) else [value]
