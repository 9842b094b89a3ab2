"""A text with the prefixes of the examples, and what validation tells of it, by the shapes and ontologies that ship."""

from __future__ import annotations

from selfconf import library
from selfconf.model.codes import PREAMBLE
from selfconf.model.diagnostic import Diagnostic
from selfconf.rdf.validation.checking import SourceText, validate_texts

HEAD = PREAMBLE.count("\n")
"""How many lines stand before a text."""
SHAPES = [SourceText(path.name, path.read_bytes()) for path in library.shapes()]
ONTOLOGIES = [SourceText(path.name, path.read_bytes()) for path in library.ontologies()]
TEMPLATE = ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class rob:Lamp .\n"
COSTED = TEMPLATE + ":t sc:cost ( [ sc:term [ sc:property rob:latency ; {} ] ] ) ."


def lints(text: str, head: str = PREAMBLE) -> list[Diagnostic]:
    """All that is told of a text."""
    return list(validate_texts([SourceText("a.ttl", (head + text).encode())], SHAPES, ONTOLOGIES).diagnostics)


def only(text: str, head: str = PREAMBLE) -> Diagnostic:
    """The one thing that is told of a text."""
    (found,) = lints(text, head)
    return found
