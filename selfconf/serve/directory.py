"""The directory API of W3C WoT Discovery (Recommendation of 2023-12-05): it fills itself, nothing can be written."""

from __future__ import annotations

import hashlib
import json
from typing import Any
from urllib.parse import quote, urlencode

from starlette.datastructures import QueryParams
from starlette.requests import Request
from starlette.responses import Response

from selfconf.model.term import IRI
from selfconf.rdf import turtle
from selfconf.rdf.sparql import QUERY_PREFIXES
from selfconf.serve.board import THING_EVENTS, Board
from selfconf.serve.event_stream import streamed
from selfconf.serve.negotiation import acceptable, accepted_by
from selfconf.serve.problems import problem
from selfconf.serve.things import DISCOVERY_CONTEXT, TD, directory_description

JSON_LD_MEDIA = "application/ld+json"


class Directory:
    """Answers what things there are, and tells when they come, change and go."""

    def __init__(self, board: Board) -> None:
        self._board = board

    async def itself(self, request: Request) -> Response:
        """`/.well-known/wot`: the directory's own description."""
        return Response(json.dumps(directory_description(str(request.base_url).rstrip("/"))), media_type=TD)

    async def things(self, request: Request) -> Response:
        """`/things`: all descriptions, or a page of them, as an array or a collection."""
        if (fault := _fault(request.query_params)) is not None:
            return fault
        try:
            offset = _whole(request.query_params.get("offset", "0"), 0)
            said = request.query_params.get("limit")
            limit = None if said is None else _whole(said, 1)
        except ValueError:
            return problem(400, "offset takes a whole number, limit one above zero")
        form = request.query_params.get("format", "array")
        if form not in ("array", "collection"):
            return problem(400, f"the format is array or collection, not {form!r}")
        components = sorted(self._board.advertised)
        end = len(components) if limit is None else min(offset + limit, len(components))
        more = {"limit": limit, "format": None if form == "array" else form}
        here, after = _page(offset=offset or None, **more), _page(offset=end, **more)
        follows = end < len(components)
        tag = f'"{hashlib.blake2s(repr(components).encode(), digest_size=8).hexdigest()}"'
        links = [f'<{after}>; rel="next"'] if follows else []
        links.append(f'</things>; rel="canonical"; etag={tag}')
        whole: dict[str, object] = {"@context": DISCOVERY_CONTEXT, "@type": "ThingCollection", "@id": here}
        whole |= {"total": len(components), **({"next": after} if follows else {})}

        def written() -> str:
            members = f"[{', '.join(self._board.descriptions[component] for component in components[offset:end])}]"
            if form == "array":
                return members
            return f'{json.dumps(whole, ensure_ascii=False)[:-1]}, "members": {members}}}'

        body = self._board.shared(here, written)
        return Response(body, media_type=JSON_LD_MEDIA, headers={"Link": ", ".join(links)})

    async def thing(self, request: Request) -> Response:
        """`/things/{id}`: one description; as Turtle, the advertisement itself."""
        found = self._board.advertised.get(IRI.unchecked(request.path_params["id"]))
        if found is None:
            return problem(404, "no component of this IRI is advertised; /things lists them all")
        media = acceptable(accepted_by(request), [TD, JSON_LD_MEDIA, "application/json", "text/turtle"])
        if not media:
            return problem(406, f"a component is described as {TD} or text/turtle")
        component = found.advertisement.component
        headers = {"Vary": "Accept", "Link": f'</things/{quote(component, safe="")}>; rel="canonical"'}
        if media[0] == "text/turtle":
            text = turtle.pretty_turtle(found.advertisement.triples, QUERY_PREFIXES)
            return Response(text, media_type="text/turtle", headers=headers)
        return Response(self._board.descriptions[component], media_type=media[0], headers=headers)

    async def events(self, request: Request) -> Response:
        """`/events` and `/events/{type}`: server-sent events; with `diff` not the `id` alone, but what is new."""
        kind = request.path_params.get("kind")
        if kind is not None and kind not in THING_EVENTS:
            return problem(404, f"there are events of the types {', '.join(THING_EVENTS)}")
        whole = request.query_params.get("diff", "false").lower() in ("true", "1", "")
        last = request.headers.get("last-event-id", "")

        def worded(data: Any) -> object:
            return data if whole else {"id": data["id"]}

        return streamed(request, self._board.stream.lines(THING_EVENTS if kind is None else (kind,), last, worded))


def _fault(parameters: QueryParams) -> Response | None:
    """What is wrong with the parameters of a list beside their values.

    An optional feature that is missing is an error, not passed over (WoT Discovery, section 7.3: 501 or 400), as a
    client that asked for another order would take this one for it.
    """
    for name in ("offset", "limit", "format"):
        if len(parameters.getlist(name)) > 1:
            return problem(400, f"{name} is given more than once")
    for name in ("sort_by", "sort_order"):
        if name in parameters:
            return problem(501, f"there is no {name}: things are listed in the order of their IRIs alone")
    return None


def _page(**parameters: int | str | None) -> str:
    """The address of a page of the list, with those parameters that are given."""
    given = urlencode({name: value for name, value in parameters.items() if value is not None})
    return f"/things?{given}" if given else "/things"


def _whole(text: str, least: int) -> int:
    if (
        not (text.isascii() and text.isdecimal()) or int(text) < least
    ):  # `int` also takes `1_0`, and digits of any script
        raise ValueError(text)
    return int(text)
