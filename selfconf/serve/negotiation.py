"""Which media type a client wants most: the header Accept (RFC 9110, section 12.5.1)."""

from __future__ import annotations

from collections.abc import Sequence

from starlette.requests import Request


def accepted_by(request: Request) -> str:
    """The header Accept of a request, which may stand in several lines (RFC 9110, section 5.3); empty without it."""
    return ",".join(request.headers.getlist("accept"))


def acceptable(accept: str, offered: Sequence[str]) -> list[str]:
    """The media types, among those offered, that a client accepts, the best first; of equals the order offered counts.

    An empty header accepts everything.
    """
    ranges = [_range(part) for part in accept.split(",") if part.strip()] or [("*/*", 1.0)]
    weights = {media: _weight(media, ranges) for media in offered}
    return sorted((media for media in offered if weights[media] > 0), key=lambda media: -weights[media])


def _range(part: str) -> tuple[str, float]:
    media, *parameters = (one.strip() for one in part.split(";"))
    weight = 1.0
    for parameter in parameters:
        name, _, value = parameter.partition("=")
        if name.strip().lower() == "q":
            try:
                weight = float(value)
            except ValueError:
                weight = 0.0
    return media.lower(), weight


def _weight(media: str, ranges: Sequence[tuple[str, float]]) -> float:
    """The weight of the most specific range that a media type is in; zero where there is none."""
    whole = [weight for one, weight in ranges if one == media]
    kind = [weight for one, weight in ranges if one == f"{media.partition('/')[0]}/*"]
    anything = [weight for one, weight in ranges if one == "*/*"]
    return next((max(weights) for weights in (whole, kind, anything) if weights), 0.0)
