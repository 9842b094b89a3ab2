"""What a Thing Model takes from others: `tm:ref` into a model, and a link `tm:extends` to one (WoT TD 1.1, section 10).

Both lead to the same document or to another source of the same import, by its relative path; nothing is fetched. What
is taken is changed by what stands beside the reference, as a JSON Merge Patch (RFC 7396).
"""

from __future__ import annotations

import posixpath
from collections.abc import Mapping
from typing import Any

from selfconf.importing.ledger import ImportLedger
from selfconf.importing.sources import SourceDocument

DEEPEST_REFERENCE = 10
"""How many references may lead on to each other; more are a circle, or as good as one."""
MOST_REFERENCES = 1000
"""How many references are followed for one thing: few that lead on to several each would come to very many."""
_AFFORDANCES = ("properties", "events", "actions")
_OWN = ("id", "@id", "links", *_AFFORDANCES)
"""What a model does not hand on as it is to those that extend it."""


class ModelReferences:
    """Follows the references of the documents of one import."""

    def __init__(self, documents: Mapping[str, Any], ledger: ImportLedger) -> None:
        self.documents, self.ledger = documents, ledger

    def resolved(self, thing: dict[str, Any], source: SourceDocument) -> dict[str, Any]:
        """A thing of a source with the affordances that it takes from others; what is not at hand is noted."""
        follower = _Follower(self.documents)
        found = follower.thing(thing, source.name, 0)
        if follower.missed:
            reason = "what they refer to is not among the sources, is too far away, or is a circle; nothing is fetched"
            self.ledger.leave_out("references to other models", reason, source, len(follower.missed))
        return found


class _Follower:
    """Follows the references of one thing. A name is that of the document in which a reference stands."""

    def __init__(self, documents: Mapping[str, Any]) -> None:
        self.documents = documents
        self.followed = 0
        self.missed: set[int] = set()
        """By the identity of the link or affordance in which it stands, each reference that leads to nothing."""

    def thing(self, thing: dict[str, Any], name: str, depth: int) -> dict[str, Any]:
        """A thing with what its links and its affordances refer to."""
        inherited: dict[str, Any] = {}
        links = thing.get("links")
        for link in links if isinstance(links, list) else ():
            if isinstance(link, dict) and link.get("rel") == "tm:extends":
                found = self._found(link, str(link.get("href")), thing, name, depth)
                if found is not None:
                    base = self.thing(found[0], found[2], depth + 1)
                    inherited = _patched(inherited, {key: value for key, value in base.items() if key != "links"})
        own = {kind: self._affordances(thing, kind, name, depth) for kind in _AFFORDANCES if kind in thing}
        taken = {key: value for key, value in inherited.items() if key not in _OWN}
        kinds = {kind: _patched(inherited.get(kind), own.get(kind)) for kind in _AFFORDANCES if kind in inherited}
        return {**taken, **thing, **own, **kinds}

    def _affordances(self, thing: dict[str, Any], kind: str, name: str, depth: int) -> Any:
        found = thing[kind]
        if not isinstance(found, dict):
            return found
        return {key: self._referred(each, thing, name, depth) for key, each in found.items()}

    def _referred(self, affordance: Any, thing: dict[str, Any], name: str, depth: int) -> Any:
        """An affordance with what its `tm:ref` leads to."""
        if not isinstance(affordance, dict) or not isinstance(affordance.get("tm:ref"), str):
            return affordance
        rest = {key: value for key, value in affordance.items() if key != "tm:ref"}
        found = self._found(affordance, affordance["tm:ref"], thing, name, depth)
        return rest if found is None else _patched(self._referred(*found, depth + 1), rest)

    def _found(
        self, stated: dict[str, Any], reference: str, thing: dict[str, Any], name: str, depth: int
    ) -> tuple[dict[str, Any], dict[str, Any], str] | None:
        """What a reference leads to that is stated in a link or affordance, and the document that holds it, by name."""
        path, _, pointer = reference.partition("#")
        holder: Any = thing
        if path:
            name = posixpath.normpath(posixpath.join(posixpath.dirname(name), path))
            holder = self.documents.get(name)
        target = holder
        for step in pointer.split("/")[1:]:
            step = step.replace("~1", "/").replace("~0", "~")
            target = target.get(step) if isinstance(target, dict) else None
        self.followed += 1
        near = depth < DEEPEST_REFERENCE and self.followed <= MOST_REFERENCES
        if not near or not isinstance(target, dict) or not isinstance(holder, dict):
            self.missed.add(id(stated))  # a circle comes to it again and again
            return None
        return target, holder, name


def _patched(base: Any, change: Any) -> Any:
    """A JSON Merge Patch."""
    if not isinstance(change, dict) or not isinstance(base, dict):
        return base if change is None else change
    found = dict(base)
    for key, value in change.items():
        if value is None:
            found.pop(key, None)
        else:
            found[key] = _patched(found[key], value) if isinstance(found.get(key), dict) else value
    return found
