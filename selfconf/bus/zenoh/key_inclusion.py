"""Which key expressions of Zenoh another one includes, as Zenoh itself says."""

from __future__ import annotations

import zenoh


def includes(wide: str, narrow: str) -> bool:
    """Return whether all keys of the second expression are keys of the first; not so of a text that is none."""
    try:
        return bool(zenoh.KeyExpr(wide).includes(zenoh.KeyExpr(narrow)))
    except zenoh.ZError:
        return False
