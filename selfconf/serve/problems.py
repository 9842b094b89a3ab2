"""Errors over HTTP as problem details (RFC 9457): a title, a status, and one sentence that says what to try."""

from __future__ import annotations

import json
from collections.abc import Mapping
from http import HTTPStatus

from starlette.responses import Response

PROBLEM = "application/problem+json"


def problem(status: int, detail: str, headers: Mapping[str, str] | None = None) -> Response:
    """A response that says what is wrong; 406 is one to what the client accepts, as caches have to know."""
    varies = {"Vary": "Accept"} if status == HTTPStatus.NOT_ACCEPTABLE else {}
    body = {"type": "about:blank", "title": HTTPStatus(status).phrase, "status": status, "detail": detail}
    return Response(json.dumps(body, ensure_ascii=False), status, {**varies, **(headers or {})}, PROBLEM)
