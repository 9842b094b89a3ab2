"""The lints about prefixes: those with two meanings, and namespaces that are nearly, but not quite, known ones.

A component whose prefix has https where http belongs is no component at all.
"""

from __future__ import annotations

from collections.abc import Iterator

from rdflib import SH, Literal

from selfconf.model.diagnostic import Diagnostic, Severity
from selfconf.rdf import vocabulary
from selfconf.rdf.validation.lints.linted_file import LintedFile
from selfconf.rdf.validation.lints.terms import used_terms
from selfconf.rdf.validation.term_index import OWN, namespace

_SH = vocabulary.SH


def prefixes(file: LintedFile) -> Iterator[Diagnostic]:
    """Prefixes with two meanings, and namespaces that are nearly, but not quite, known ones."""
    first: dict[str, str] = {}
    for prefix, iri, offset in file.positions.prefixes:
        if first.setdefault(prefix, iri) != iri:
            message = f"The prefix {prefix}: has been bound to <{first[prefix]}> before, and is now <{iri}>."
            yield file.at(offset, "SC-L05", message)
        if (meant := file.index.confused(iri)) is not None:
            yield _confused(file, iri, meant, offset)


def prefixes_of_queries(file: LintedFile) -> Iterator[Diagnostic]:
    """Prefixes that are declared for queries (`sh:declare`) with another namespace than a known one, or the file's."""
    own = {prefix: iri for prefix, iri, _ in file.positions.prefixes}
    for node, declared in file.graph.subject_objects(SH.namespace):
        statement = file.positions.triples.get((node, SH.namespace, declared))
        iri, prefix = str(declared), str(file.graph.value(node, SH.prefix))
        if statement is None or not isinstance(declared, Literal):
            continue
        if (meant := file.index.confused(iri)) is not None:
            yield _confused(file, iri, meant, statement.object)
        elif own.get(prefix, iri) != iri:
            message = f"The prefix {prefix}: is bound to <{own[prefix]}> in this file, and to <{iri}> in its queries."
            yield file.at(statement.object, "SC-L05", message)


def undeclared_prefixes(file: LintedFile) -> Iterator[Diagnostic]:
    """Namespaces that are nearly known ones and have no prefix: told where the first of their terms stands."""
    told = {iri for _, iri, _ in file.positions.prefixes}
    for term, offset in used_terms(file):
        home = namespace(term)
        meant = None if home in told else file.index.confused(home)
        told.add(home)
        if meant is not None:
            yield _confused(file, home, meant, offset)


def _confused(file: LintedFile, iri: str, meant: str, offset: int) -> Diagnostic:
    severity = Severity.ERROR if meant.startswith(OWN) or meant == _SH.base else Severity.WARNING
    message = f"The namespace <{iri}> is not <{meant}>."
    return file.at(offset, "SC-L06", message, severity, f"Did you mean <{meant}>?")
