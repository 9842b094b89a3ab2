"""The one door to the ontologies and shapes that ship with selfconf."""

from __future__ import annotations

from importlib.resources import as_file, files
from pathlib import Path


def _folder(name: str) -> Path:
    """The folder in the wheel (`selfconf/_data/...`), or else at the root of the checkout."""
    packaged = files("selfconf") / "_data" / name
    if packaged.is_dir():
        with as_file(packaged) as folder:
            return folder
    return Path(__file__).resolve().parent.parent / name


def ontologies() -> list[Path]:
    """The ontology files of selfconf, sorted by name: the core terms, robotics, the PEIS-Home."""
    return sorted(_folder("ontology").glob("*.ttl"))


def shapes() -> list[Path]:
    """The SHACL shapes files of selfconf, sorted by name: advertisement, configuration, task, template."""
    return sorted(_folder("shapes").glob("*.ttl"))
