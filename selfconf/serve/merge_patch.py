"""What has changed from one JSON object to another, as a JSON Merge Patch (RFC 7396)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def merge_patch(before: Mapping[str, Any], after: Mapping[str, Any]) -> dict[str, Any]:
    """The members that are others, or new, and null for those that are gone; objects in them in the same way.

    Both are as JSON is read. Neither may hold null, which such a patch cannot say.
    """
    patch: dict[str, Any] = {member: None for member in before if member not in after}
    for member, value in after.items():
        known = before.get(member)
        if isinstance(known, dict) and isinstance(value, dict):
            if inner := merge_patch(known, value):
                patch[member] = inner
        elif repr(known) != repr(value):  # to Python 1 is equal to true
            patch[member] = value
    return patch
