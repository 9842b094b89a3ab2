"""Whose a component is that several sites advertise: what a person has said, kept beside the keys of a host.

Where no person has said whose, it belongs to no site, but that on its own host a site goes on with its own.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Set
from pathlib import Path

from selfconf.atomic_write import READABLE, write_atomically
from selfconf.errors import AuthorError
from selfconf.model.term import IRI
from selfconf.protocol.keys import checked_name

FILE = "believed.json"
"""The name of the file in a folder of keys."""


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


def claims(
    advertised: Mapping[str, frozenset[IRI]], decided: Mapping[IRI, str], here: str, gone: Set[str] = frozenset()
) -> tuple[dict[str, frozenset[IRI]], dict[IRI, list[str]]]:
    """Return which components belong to each of some sites, of which one is `here`, and which are disputed by which.

    `advertised` is what each site advertises, `decided` the site that is believed for a component. Those that are
    `gone` lose what they advertised to the one that advertises it now, unless they are believed. What is believed to be
    that of a site which has not been seen is disputed by the one that advertises it.
    """
    claiming: dict[IRI, list[str]] = {}
    for site, components in sorted(advertised.items()):
        for component in components:
            claiming.setdefault(component, []).append(site)
    owners, disputed = dict[IRI, str](), dict[IRI, list[str]]()
    for component, sites in claiming.items():
        present = [site for site in sites if site not in gone] or sites
        if decided.get(component) in sites:
            owners[component] = decided[component]
        elif len(present) == 1 and decided.get(component, present[0]) in advertised:
            owners[component] = present[0]
        else:
            disputed[component] = sites

    def belongs(component: IRI, site: str) -> bool:
        return site == (here if component in disputed else owners[component])

    owned = {site: frozenset(c for c in some if belongs(c, site)) for site, some in advertised.items()}
    return owned, disputed


def believe(folder: Path, component: IRI, site: str) -> None:
    """Note that a component is that of a site. Raises AuthorError, also for what can be the name of none."""
    path = folder / FILE
    said = {**believed(folder), component: checked_name(site, "a site")}
    try:
        write_atomically(path, f"{json.dumps(said, indent=1, sort_keys=True)}\n".encode(), READABLE)
    except OSError as error:
        raise AuthorError(f"cannot be written: {error.strerror}", file=str(path)) from None
