"""The credentials by which things let a bridge in: a secret for each origin, from a file that no other user can read.

The file is a JSON object: for each origin, such as `https://192.0.2.7:8443`, an object with what its security scheme
needs: `username` and `password`, or `token`, or `key`. A credential goes to the origin under which it stands and to no
other, whatever a description says. Values stand in no message, log or `repr`.
"""

from __future__ import annotations

import json
import os
import stat
from collections.abc import Mapping
from dataclasses import field
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from selfconf.errors import AuthorError
from selfconf.http_origin import http_origin
from selfconf.model.immutable import immutable

TOLD_BY_NAME = frozenset(("username", "password", "token", "key"))


@immutable
class ThingCredentials:
    """The secrets of each origin, by its name; `repr` shows none of it."""

    by_origin: Mapping[str, Mapping[str, str]] = field(default_factory=dict, repr=False)

    def for_url(self, url: str) -> Mapping[str, str]:
        """The secrets of the origin of a URL; none if the file does not speak of it."""
        return self.by_origin.get(http_origin(url), {})


def read_credentials(path: Path) -> ThingCredentials:
    """Read a file of credentials. Raises AuthorError if it is none, or if others than its owner can read it."""
    try:
        with path.open("rb") as file:
            mode = os.fstat(file.fileno()).st_mode
            if stat.S_IMODE(mode) & (stat.S_IRWXG | stat.S_IRWXO):
                raise AuthorError(f"others can read or change it; type `chmod 600 {path}`", file=str(path))
            octets = file.read()
    except OSError as error:
        raise AuthorError(f"cannot read the credentials: {error.strerror}", file=str(path)) from None
    try:
        found = json.loads(octets)
    except json.JSONDecodeError as error:
        # The message of the parser names what it expected, never what stands there.
        message = f"this is not JSON: {error.msg[0].lower()}{error.msg[1:]}"
        raise AuthorError(message, file=str(path), line=error.lineno, column=error.colno) from None
    except (ValueError, RecursionError):
        raise AuthorError("this is not JSON in UTF-8", file=str(path)) from None
    if not isinstance(found, dict):
        raise AuthorError("credentials are a JSON object with a member for each origin", file=str(path))
    return ThingCredentials({_origin(name, path): _members(name, value, path) for name, value in found.items()})


def _origin(name: str, path: Path) -> str:
    try:
        found, parts = http_origin(name), urlsplit(name)
    except ValueError:
        found, parts = "", urlsplit("")
    if not found or parts.path.strip("/") or parts.query or parts.fragment or "@" in parts.netloc:
        # Without the text itself: of a URL with a password in it this line would show that.
        told = f"a name in it is no origin: more than {found} stands there" if found else "a name in it is no origin"
        raise AuthorError(f"{told}; it is written like https://192.0.2.7:8443", file=str(path))
    return found


def _members(name: str, value: Any, path: Path) -> Mapping[str, str]:
    if (
        not isinstance(value, dict)
        or not value
        or not all(isinstance(each, str) and each and each.isprintable() for each in value.values())
    ):
        raise AuthorError(
            f"the credentials for {http_origin(name)} are an object with texts, each on one line", file=str(path)
        )
    unknown = sorted(value.keys() - TOLD_BY_NAME)
    if unknown:
        known = ", ".join(sorted(TOLD_BY_NAME))
        raise AuthorError(
            f"the credentials for {http_origin(name)} have members other than {known}: {', '.join(unknown)}",
            file=str(path),
        )
    return value
