"""The forms of a Thing Description: by which HTTP request something is read, written, called or followed.

Of several forms for an operation the first counts that a bridge can use, those with JSON before those without. What it
can use is HTTP without URI variables, to a host that it may reach, with security schemes for which it has credentials;
`ThingForms.problems` says in sentences what came of the others. (W3C Web of Things Thing Description 1.1, sections
5.3.4 and 8.3.1.)
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import field
from typing import Any
from urllib.parse import urljoin, urlsplit, urlunsplit

from selfconf.bridging.wot.credentials import ThingCredentials
from selfconf.bridging.wot.security_schemes import UnusableFormError, proof_of_identity
from selfconf.http_origin import http_origin
from selfconf.importing import one_or_several
from selfconf.model.immutable import immutable
from selfconf.model.setting_names import setting

USUAL_METHODS = {
    "readproperty": "GET",
    "writeproperty": "PUT",
    "observeproperty": "GET",
    "invokeaction": "POST",
    "subscribeevent": "GET",
}
"""The method of an operation where its form names none (section 8.3.1, table 30)."""
WITHOUT_OP = USUAL_METHODS.keys() - {"observeproperty"}
"""The operations that a form may serve if it does not say which; its affordance decides among them."""
FOLLOWED = ("sse", "longpoll")
"""The subprotocols by which a bridge follows a property or an event."""
JSON = "application/json"
_KNOWN_METHODS = frozenset(("GET", "PUT", "POST", "PATCH", "DELETE"))


@immutable
class ThingForm:
    """One HTTP request that can be made; `repr` shows no header, and nothing that security adds to the URL."""

    url: str
    method: str
    media: str = JSON
    """The media type of what is sent, and of what is answered where `response` is none."""
    subprotocol: str = ""
    response: str = ""
    """The media type of what is answered, if it is another."""
    headers: Mapping[str, str] = field(default_factory=dict, repr=False)
    query: tuple[tuple[str, str], ...] = field(default=(), repr=False)

    @property
    def answered(self) -> str:
        """The media type of what is answered."""
        return self.response or self.media

    def __str__(self) -> str:
        return f"{self.method} {self.url}"


class ThingForms:
    """The forms of one thing."""

    def __init__(
        self,
        description: Mapping[str, Any],
        place: str,
        credentials: ThingCredentials,
        reachable: Callable[[str], bool],
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
        self.tried = 0
        """How many forms were looked at: of those that cannot be used a sentence says why."""

    def find(
        self, affordance: Mapping[str, Any], operation: str, subprotocols: Iterable[str] = ("",)
    ) -> ThingForm | None:
        """The first form for an operation that can be used, by one of some subprotocols, the first preferred.

        One with JSON is preferred too: signals have fields, which nothing is read into but JSON.
        """
        said = one_or_several(affordance.get("forms"))
        serving = [one for one in said if isinstance(one, dict) and _serves(one, operation)]
        forms = sorted(serving, key=lambda one: not is_json(bare(_media(one, JSON))))
        for subprotocol in subprotocols:
            for form in forms:
                if form.get("subprotocol", "") == subprotocol:
                    self.tried += 1
                    try:
                        return self._form(form, operation)
                    except UnusableFormError as error:
                        self.problems[str(error)] = None
        return None

    def _form(self, form: Mapping[str, Any], operation: str) -> ThingForm:
        """The request that a form stands for. Raises UnusableFormError."""
        url, method = self._url(form.get("href")), form.get("htv:methodName", USUAL_METHODS[operation])
        if not isinstance(method, str) or method not in _KNOWN_METHODS:
            raise UnusableFormError(f"a form has the HTTP method {str(method)[:20]!r}")
        where, told = http_origin(url), self._credentials.for_url(url)
        names = one_or_several(form.get("security", self._security))
        found = [proof_of_identity(str(name), self._definitions.get(str(name)), told, where) for name in names]
        proofs = [proof for proof in found if proof is not None]
        response = form.get("response")
        return ThingForm(
            url,
            method,
            _media(form, JSON),
            str(form.get("subprotocol", "")),
            _media(response, "") if isinstance(response, dict) else "",
            dict(proof.header for proof in proofs if proof.header is not None),
            tuple((proof.name, proof.text) for proof in proofs if proof.header is None),
        )

    def _url(self, href: object) -> str:
        """Where a form leads. Raises UnusableFormError."""
        if not isinstance(href, str):
            raise UnusableFormError("a form has no href")
        try:
            # A base may have URI variables, too.
            url = urljoin(self._base, href)
            if "{" in url:
                raise UnusableFormError(f"the form {href[:80]!r} has URI variables, which a signal does not set")
            url = _plain(url)
            http_origin(url)
        except ValueError:
            raise UnusableFormError(f"the form {href[:80]!r} leads to no http or https URL") from None
        host = urlsplit(url).hostname or ""
        if not self._reachable(host):
            raise UnusableFormError(
                f"its forms lead to {host}, which its description does not come from; allow it with"
                f" {setting('host', host)}"
            )
        return url


def bare(media: str) -> str:
    """A media type without its parameters."""
    return media.partition(";")[0].strip().lower()


def is_json(media: str) -> bool:
    """Whether a bare media type is that of JSON."""
    return media == JSON or media.endswith("+json")


def _media(holder: Mapping[str, Any], usual: str) -> str:
    """The media type that a form, or what it says of the response, states."""
    media = holder.get("contentType", usual)
    return media if isinstance(media, str) and media.isascii() and media.isprintable() else usual


def _plain(url: str) -> str:
    """A URL without what no request carries: a fragment, a user name, a password. Raises ValueError."""
    parts = urlsplit(url)
    if not url.isprintable() or " " in url:
        raise ValueError("no URL")
    return urlunsplit((parts.scheme.lower(), parts.netloc.rpartition("@")[2], parts.path or "/", parts.query, ""))


def _serves(form: Mapping[str, Any], operation: str) -> bool:
    """Whether a form is for an operation; one that does not say it is for those of its affordance but to observe."""
    return operation in one_or_several(form["op"]) if "op" in form else operation in WITHOUT_OP
