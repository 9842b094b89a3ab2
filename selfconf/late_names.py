"""Packages whose names are loaded when they are first used, so that a program pays for what it needs alone."""

from __future__ import annotations

import sys

TYPE_CHECKING = False
"""As type checkers know it. `typing` is loaded later, where Ctrl-C is no traceback any more (`__main__`)."""

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from typing import Any


def late_names(package: str, home: Mapping[str, str]) -> Callable[[str], Any]:
    """Return the `__getattr__` of a package (PEP 562); `home` says in which of its modules each name is defined.

    It raises AttributeError for any other name.
    """

    def load(name: str) -> Any:
        if name not in home:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        from importlib import import_module

        found = getattr(import_module(f"{package}.{home[name]}"), name)
        setattr(sys.modules[package], name, found)
        return found

    return load
