"""The one door to the ontologies, shapes and JSON Schemas that ship with selfconf.

They are files in a checkout and in an installed wheel. A wheel that is imported as it is, zipped, has none; there they
are unpacked once per process into a temporary folder, because everything that reads Turtle takes a path: its name is
what messages call it, and its place is what relative IRIs are relative to.
"""

from __future__ import annotations

import atexit
import tempfile
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from importlib.abc import Traversable


def ontologies() -> list[Path]:
    """The ontology files of selfconf, sorted by name: the core terms, robotics, the PEIS-Home."""
    return sorted(_folder("ontology").glob("*.ttl"))


def shapes() -> list[Path]:
    """The SHACL shapes files of selfconf, sorted by name: advertisement, configuration, task, template."""
    return sorted(_folder("shapes").glob("*.ttl"))


def schemas() -> list[Path]:
    """The JSON Schemas of what the commands print as JSON, sorted by name: `configure.schema.json` and so on."""
    return sorted(_folder("schemas").glob("*.schema.json"))


_IN_CHECKOUT = {"schemas": "docs/schemas"}
"""Where a folder of the wheel is in a checkout, if it is not at its root."""


def _folder(name: str) -> Path:
    """The folder in the wheel (`selfconf/_data/...`), or else in the checkout."""
    packaged = files("selfconf") / "_data" / name
    if not packaged.is_dir():
        return Path(__file__).resolve().parent.parent / _IN_CHECKOUT.get(name, name)
    if isinstance(packaged, Path):
        return packaged
    folder = Path(_unpacked().name, name)
    if not folder.is_dir():
        _unpack(packaged, folder)
    return folder


@cache
def _unpacked() -> tempfile.TemporaryDirectory[str]:
    """Where the files of a zipped wheel are unpacked; it is removed when the process ends, and not before."""
    folder = tempfile.TemporaryDirectory(prefix="selfconf-")
    atexit.register(folder.cleanup)  # left to itself it goes with a warning
    return folder


def _unpack(packaged: Traversable, folder: Path) -> None:
    folder.mkdir()
    for file in packaged.iterdir():
        (folder / file.name).write_bytes(file.read_bytes())
