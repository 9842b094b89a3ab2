"""Key expressions of Zenoh, as the network in memory understands them."""

from __future__ import annotations

from functools import lru_cache


@lru_cache(maxsize=1 << 14)
def intersects(left: str, right: str) -> bool:
    """Whether two key expressions meet: `*` is one chunk, `**` any number of them, neither stands for `@...`.

    Of a chunk that ends with `$*` the beginning is compared.
    """
    return _intersect(left.split("/"), right.split("/"))


def _intersect(left: list[str], right: list[str]) -> bool:
    if not left or not right:
        return all(chunk == "**" for chunk in left or right)
    if left[0] == "**":
        return _intersect(left[1:], right) or (_wild(right[0]) and _intersect(left, right[1:]))
    if right[0] == "**":
        return _intersect(right, left)
    return (_covers(left[0], right[0]) or _covers(right[0], left[0])) and _intersect(left[1:], right[1:])


def _covers(pattern: str, chunk: str) -> bool:
    """Whether a chunk is what another one means, which may be `*`, or `a$*`: whatever begins with an `a`."""
    return pattern == chunk or (pattern == "*" and _wild(chunk)) or _begins(pattern, chunk)


def _begins(pattern: str, chunk: str) -> bool:
    return pattern.endswith("$*") and chunk.startswith(pattern.removesuffix("$*"))


def _wild(chunk: str) -> bool:
    return not chunk.startswith("@")
