"""Whose a component is that several sites advertise: what a person has said, kept beside the keys of a host."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from selfconf.errors import AuthorError
from selfconf.model.term import IRI

FILE = "believed.json"
"""Its name in a folder of keys."""


def believed(folder: Path) -> Mapping[IRI, str]:
    """The site that is believed for each component for which a person has said so. Raises AuthorError."""
    path = folder / FILE
    try:
        said = json.loads(path.read_text())
    except FileNotFoundError:
        return {}
    except (OSError, ValueError) as error:
        raise AuthorError(f"cannot be read: {error}", file=str(path)) from None
    if not isinstance(said, dict) or not all(isinstance(site, str) for site in said.values()):
        raise AuthorError("is no object of components, each with the name of a site", file=str(path))
    return {IRI.unchecked(component): site for component, site in said.items()}


def believe(folder: Path, component: IRI, site: str) -> None:
    """Note that a component is that of a site. Raises AuthorError."""
    path = folder / FILE
    said = {**believed(folder), component: site}
    temporary = path.with_suffix(".new")
    try:
        temporary.write_text(json.dumps(said, indent=1, sort_keys=True) + "\n")
        temporary.replace(path)
    except OSError as error:
        raise AuthorError(f"cannot be written: {error.strerror}", file=str(path)) from None
