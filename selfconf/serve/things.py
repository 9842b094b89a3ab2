"""A component as a W3C Thing Description 1.1: its outputs are properties that can be observed, FAIL is an event.

What a consumer cannot do over the forms is stated in the terms of selfconf: inputs, which follow outputs, operations,
which answer the components that a configuration connects, and operational parameters, which a configurator sets for the
task that holds the component.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from selfconf.model.profile import CALL_MARK, Input, Output, Profile
from selfconf.protocol.keys import Keys
from selfconf.rdf.vocabulary import LABEL, RDFS, SC, UNIT
from selfconf.serve.json_ld import CONTEXT, in_languages, members, name_of

TD_CONTEXTS = ["https://www.w3.org/2019/wot/td/v1", "https://www.w3.org/2022/wot/td/v1.1"]
"""Those of both versions, in this order: so TD 1.1 (section 5.3.1.1) wants it where consumers may know 1.0 alone."""
DISCOVERY_CONTEXT = "https://www.w3.org/2022/wot/discovery"
"""That of directories and of their collections (W3C WoT Discovery)."""
TD = "application/td+json"
"""The media type of one Thing Description."""
_SECURITY = {"securityDefinitions": {"nosec_sc": {"scheme": "nosec"}}, "security": ["nosec_sc"]}


def thing_description(profile: Profile, keys: Keys) -> dict[str, Any]:
    """The Thing Description of a component of an ecology; its forms are the keys of the ecology on Zenoh.

    Its title is the component's label, or its local name. Its properties are members of JSON-LD; what has no member of
    TD is said in the terms of selfconf, but for shapes and frames of ports and what a site or configurator heeds.
    """
    title, labels = in_languages("title", profile.values(LABEL))
    comment, comments = in_languages("description", profile.values(RDFS.comment))
    in_words = *((LABEL, one) for one in labels), *((RDFS.comment, one) for one in comments)
    others = ((predicate, value) for predicate, value in profile.properties if predicate not in (LABEL, RDFS.comment))
    description: dict[str, Any] = {
        "@context": [*TD_CONTEXTS, CONTEXT],
        "@type": sorted(map(name_of, profile.types)),
        "id": str(profile.component),
        "title": profile.component.short or str(profile.component),
        **title,
        **comment,
        **members((*in_words, *others)),
        **_SECURITY,
        "properties": {
            port.name: {
                **({"@type": [*map(name_of, port.signals)]} if port.signals else {}),
                **({} if port.unit is None else {"unit": str(port.unit)}),
                **({} if port.rate is None else {"sc:rate": {"sc:value": port.rate, "sc:unit": {"@id": UNIT.HZ}}}),
                "readOnly": True,
                "observable": True,
                "forms": [
                    _form(keys.output(profile.component, port.name), ["observeproperty", "unobserveproperty"]),
                    _form(keys.output(profile.component, port.name), ["readproperty"]),
                ],
            }
            for port in profile.signal_outputs
        },
        "events": {
            "fail": {
                "@type": name_of(SC.Failure),
                "title": "FAIL",
                "description": "the component cannot go on",
                "forms": [_form(keys.fail(profile.component), ["subscribeevent", "unsubscribeevent"])],
            }
        },
    }
    return {**description, **{member: said for member, said in _own_terms(profile).items() if said}}


def _own_terms(profile: Profile) -> dict[str, list[dict[str, Any]]]:
    """What is said in the terms of selfconf."""
    return {
        "sc:hasInput": [
            {
                "sc:name": port.name,
                "sc:signalType": [{"@id": str(signal)} for signal in port.signals],
                **({"sc:unit": {"@id": str(unit)}} if (unit := port.condition and port.condition.unit) else {}),
                **({"sc:optional": True} if port.optional else {}),
            }
            for port in profile.signal_inputs
        ],
        "sc:hasOperation": [*map(_operation, profile.operations)],
        "sc:needsOperation": [*map(_operation, profile.needed_operations)],
        "sc:hasParameter": [
            {"sc:name": one.name, "sc:parameterType": {"@id": str(one.type)}} for one in profile.parameters
        ],
    }


def _operation(port: Input | Output) -> dict[str, Any]:
    types = ("sc:request", port.request), ("sc:response", port.response)
    said = {member: {"@id": str(kind)} for member, kind in types if kind is not None}
    optional = {"sc:optional": True} if isinstance(port, Input) and port.optional else {}
    return {"sc:name": port.name.removesuffix(CALL_MARK), **said, **optional}


def _form(key: str, operations: list[str]) -> Mapping[str, Any]:
    return {"href": f"zenoh:{key}", "contentType": "application/json", "op": operations}


def directory_description(base: str) -> dict[str, Any]:
    """The Thing Description of the directory itself, for the introduction at `/.well-known/wot`."""

    def event(kind: str) -> dict[str, Any]:
        form = {"href": f"/events/{kind}{{?diff}}", "op": "subscribeevent", "subprotocol": "sse"}
        return {
            "data": {"type": "object", "properties": {"id": {"type": "string"}}},
            "uriVariables": {"diff": {"type": "boolean"}},
            "forms": [{**form, "response": {"contentType": "text/event-stream"}}],
        }

    query = {"query": {"title": "A valid SPARQL 1.1 query", "type": "string"}}
    return {
        "@context": [*TD_CONTEXTS, DISCOVERY_CONTEXT],
        "@type": "ThingDirectory",
        "title": "Components of a selfconf ecology",
        "id": "urn:selfconf:directory",
        "base": base,
        **_SECURITY,
        "properties": {
            "things": {
                "readOnly": True,
                "uriVariables": {
                    "offset": {"type": "number", "default": 0},
                    "limit": {"type": "number"},
                    "format": {"type": "string", "enum": ["array", "collection"], "default": "array"},
                },
                "type": "array",  # as it is asked for without `format`: a client reads nothing of no type
                "items": {"type": "object"},
                "forms": [
                    {
                        "href": "/things{?offset,limit,format}",
                        "htv:methodName": "GET",
                        "contentType": "application/ld+json",
                    }
                ],
            }
        },
        "actions": {
            "retrieveThing": {
                "uriVariables": {"id": {"type": "string", "format": "iri-reference"}},
                "output": {"type": "object"},
                "safe": True,
                "idempotent": True,
                "forms": [{"href": "/things/{id}", "htv:methodName": "GET", "contentType": TD}],
            },
            "searchSPARQL": {
                "uriVariables": query,
                "output": {"type": "object"},
                "safe": True,
                "idempotent": True,
                "forms": [{"href": "/search/sparql{?query}", "htv:methodName": "GET"}],
            },
        },
        "events": {
            "thingCreated": event("thing_created"),
            "thingUpdated": event("thing_updated"),
            "thingDeleted": event("thing_deleted"),
        },
    }
