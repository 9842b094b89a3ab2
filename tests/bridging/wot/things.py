"""Things read from descriptions in a test."""

from __future__ import annotations

import json
from typing import Any

from selfconf.bridging.wot.credentials import ThingCredentials
from selfconf.bridging.wot.forms import ThingForms
from selfconf.importing import DescribedThing, ImportLedger, SourceDocument, described_things


def described(description: dict[str, Any], shown: str = "lamp.td.json") -> DescribedThing:
    """The one thing of a description."""
    source = SourceDocument(shown, "lamp.td.json", json.dumps(description).encode())
    (thing,) = described_things([source], ImportLedger("urn:test:", lambda error: None))
    return thing


def forms_of(description: dict[str, Any], told: dict[str, dict[str, str]] | None = None, place: str = "") -> ThingForms:
    """The forms of a description, by some credentials; requests may go to every host but those of `elsewhere`."""
    return ThingForms(description, place, ThingCredentials(told or {}), lambda host: host != "elsewhere.example")
