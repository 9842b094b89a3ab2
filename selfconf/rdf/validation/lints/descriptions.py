"""The lints about what a file describes: what another file describes as well, and what depends on its place."""

from __future__ import annotations

from collections.abc import Iterator

from rdflib import RDF, URIRef

from selfconf.model.diagnostic import Diagnostic
from selfconf.rdf import vocabulary
from selfconf.rdf.validation.lints.linted_file import LintedFile

_SC = vocabulary.SC


def repeated_descriptions(file: LintedFile) -> Iterator[Diagnostic]:
    """Components that another file describes as well, and templates that another describes otherwise."""
    for thing, other in file.elsewhere.items():
        offset, short = file.offset(URIRef(thing)), file.short(thing)
        if (URIRef(thing), RDF.type, URIRef(_SC.Component)) in file.graph:
            yield file.at(offset, "SC-L04", f"The component {short} is described in {other} as well.")
        else:
            message = f"The template {short} is described in {other} as well, and not as it is here."
            hint = "Give one of the two another IRI, or describe both alike."
            yield file.at(offset, "SC-L31", message, hint=hint)


def local_components(file: LintedFile) -> Iterator[Diagnostic]:
    """Components whose IRI depends on where the file lies."""
    kinds = file.graph.subjects(RDF.type, URIRef(_SC.Component))
    for component in kinds:
        if isinstance(component, URIRef) and component.startswith("file:"):
            message = "The IRI of this component is relative, so it changes with the place of the file."
            hint = "Declare a prefix, or a @base that starts with https:."
            yield file.at(file.offset(component), "SC-L08", message, hint=hint)
