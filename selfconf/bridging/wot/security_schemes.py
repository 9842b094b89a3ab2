"""The security schemes of a Thing Description: what goes into which part of a request.

A bridge knows `nosec`, `basic`, `bearer` and `apikey`, in a header, a query or a cookie. (W3C Web of Things Thing
Description 1.1, section 5.3.3.)
"""

from __future__ import annotations

import base64
from collections.abc import Callable, Mapping
from typing import Any
from urllib.parse import quote

from selfconf.model.immutable import immutable
from selfconf.model.setting_names import setting

ASKED_FOR = {"basic": ("username", "password"), "bearer": ("token",), "apikey": ("key",)}
"""Which credentials a scheme asks for."""
PROOF_PLACES = ("header", "query", "cookie")
_USUAL_PLACE = {"basic": "header", "bearer": "header", "apikey": "query"}
_AS_TEXT: Mapping[str, Callable[[Mapping[str, str]], str]] = {
    "basic": lambda told: "Basic " + base64.b64encode(f"{told['username']}:{told['password']}".encode()).decode(),
    "bearer": lambda told: f"Bearer {told['token']}",
    "apikey": lambda told: told["key"],
}


class UnusableFormError(Exception):
    """A form that a bridge cannot use; the text is a sentence that says why."""


@immutable
class ProofOfIdentity:
    """What one security scheme adds to a request: a text, in a part of it, by a name; `repr` shows none of it."""

    place: str
    name: str
    text: str

    def __repr__(self) -> str:
        return f"{type(self).__name__}(place={self.place!r})"

    @property
    def header(self) -> tuple[str, str] | None:
        """The header that carries it, if one does."""
        if self.place == "cookie":
            return "Cookie", f"{self.name}={quote(self.text, safe='')}"
        return (self.name, self.text) if self.place == "header" else None


def proof_of_identity(name: str, definition: Any, told: Mapping[str, str], where: str) -> ProofOfIdentity | None:
    """What the scheme of a name adds to a request to an origin with some credentials; None for nothing.

    Raises UnusableFormError.
    """
    scheme: Mapping[str, Any] = definition if isinstance(definition, dict) else {}
    kind = scheme.get("scheme")
    if kind == "nosec":
        return None
    if not isinstance(kind, str) or kind not in ASKED_FOR:
        known = "a bridge knows nosec, basic, bearer and apikey"
        raise UnusableFormError(f"it asks for the security scheme {str(kind or name)[:40]!r}; {known}")
    missing = [member for member in ASKED_FOR[kind] if member not in told]
    if missing:
        advice = f"put them into a file and give it with {setting('credentials')}"
        raise UnusableFormError(f"{where} asks for {' and '.join(missing)}; {advice}")
    place = scheme.get("in", _USUAL_PLACE[kind])
    if place not in PROOF_PLACES:
        known = "a bridge knows header, query and cookie"
        raise UnusableFormError(f"its security scheme {name[:40]!r} goes into {str(place)[:20]!r}; {known}")
    field = scheme.get("name", "Authorization" if place == "header" else "")
    if not isinstance(field, str) or not _is_token(field):
        raise UnusableFormError(f"its security scheme {name[:40]!r} does not say the name of its {place}")
    # The word before a bearer token is that of a header; a query has the token alone (RFC 6750, section 2.3).
    alone = kind == "bearer" and place != "header"
    return ProofOfIdentity(place, field, told["token"] if alone else _AS_TEXT[kind](told))


def _is_token(name: str) -> bool:
    """Whether a text can name a header (RFC 9110, section 5.6.2), and so a cookie or a part of a query too."""
    return bool(name) and name.isascii() and all(letter.isalnum() or letter in "!#$%&'*+-.^_`|~" for letter in name)
