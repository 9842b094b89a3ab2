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
_AFFORDANCES = ("properties", "events", "actions")


class ModelReferences:
    """Follows the references of the documents of one import."""

    def __init__(self, documents: Mapping[str, Any], ledger: ImportLedger) -> None:
        self.documents, self.ledger = documents, ledger

    def resolved(self, thing: dict[str, Any], source: SourceDocument, depth: int = 0) -> dict[str, Any]:
        """A thing with the affordances that it takes from others."""
        found = dict(thing)
        links = thing.get("links")
        for link in links if isinstance(links, list) else ():
            if isinstance(link, dict) and link.get("rel") == "tm:extends":
                base = self._found(str(link.get("href")), thing, source, depth)
                if base is not None:
                    found = {**base, **{key: value for key, value in found.items() if key not in _AFFORDANCES}}
                    kinds = (kind for kind in _AFFORDANCES if kind in base or kind in thing)
                    found |= {kind: _patched(base.get(kind), thing.get(kind)) for kind in kinds}
        for kind in _AFFORDANCES:
            if isinstance(found.get(kind), dict):
                found[kind] = {name: self._referred(each, found, source, depth) for name, each in found[kind].items()}
        return found

    def _referred(self, affordance: Any, thing: dict[str, Any], source: SourceDocument, depth: int) -> Any:
        """An affordance with what its `tm:ref` leads to."""
        if not isinstance(affordance, dict) or not isinstance(affordance.get("tm:ref"), str):
            return affordance
        base = self._found(affordance["tm:ref"], thing, source, depth)
        rest = {key: value for key, value in affordance.items() if key != "tm:ref"}
        return rest if base is None else _patched(base, rest)

    def _found(
        self, reference: str, thing: dict[str, Any], source: SourceDocument, depth: int
    ) -> dict[str, Any] | None:
        """What a reference leads to, with its own references followed; None, noted, if that is not at hand."""
        path, _, pointer = reference.partition("#")
        holder: Any = thing
        if path:
            holder = self.documents.get(posixpath.normpath(posixpath.join(posixpath.dirname(source.name), path)))
        target = holder
        for step in pointer.split("/")[1:]:
            step = step.replace("~1", "/").replace("~0", "~")
            target = target.get(step) if isinstance(target, dict) else None
        if not isinstance(target, dict) or depth >= DEEPEST_REFERENCE:
            reason = "what they refer to is not among the sources, and is not fetched"
            self.ledger.leave_out("references to other models", reason, source)
            return None
        if pointer and "tm:ref" in target and isinstance(holder, dict):
            followed = self._referred(target, holder, source, depth + 1)
            return followed if isinstance(followed, dict) else None
        return self.resolved(target, source, depth + 1) if path and not pointer else target


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
