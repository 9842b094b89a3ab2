"""The files of `tests/bad`, each of which is wrong in the way that its first line promises.

To validate all of them takes seconds, so each is validated once in a process and the reports are shared.
Where tests run in several processes, `tests/harness/schedule.py` gives all tests that do so to one of them.
"""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

from selfconf import library
from selfconf.model.diagnostic import Report
from selfconf.rdf.validation import SourceText, validate_texts

BAD = tuple(sorted((Path(__file__).parent / "bad").glob("*.ttl")))


def promised(path: Path) -> list[str]:
    """The problems that the first line of a bad file promises, as `line:column severity[code]`."""
    return path.read_text("utf-8").partition("\n")[0].removeprefix("# expect: ").split(", ")


def promised_codes(path: Path) -> frozenset[str]:
    """The codes of the problems that the first line of a bad file promises."""
    return frozenset(re.findall(r"\[([^]]+)\]", ", ".join(promised(path))))


def source(path: Path) -> SourceText:
    """A file as validation takes it."""
    return SourceText(str(path), path.read_bytes(), path.resolve().as_uri())


@cache
def checked(path: Path) -> Report:
    """The report of one bad file that is validated alone, with the shapes and ontologies that ship."""
    return validate_texts([source(path)], *shipped())


@cache
def shipped() -> tuple[tuple[SourceText, ...], tuple[SourceText, ...]]:
    """The shapes and the ontologies that ship."""
    return tuple(map(source, library.shapes())), tuple(map(source, library.ontologies()))
