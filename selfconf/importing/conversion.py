"""One import from beginning to end: sources are gathered, read by the importer of their format, and written as Turtle.

Each importer takes all sources at once, because those of one format may speak of each other: a system of its nodes, a
model of what it extends. What it cannot read it hands over as an error and goes on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import field
from pathlib import Path

from selfconf import files
from selfconf.errors import AuthorError, NamespaceError
from selfconf.importing.folder import FileState, write_folder
from selfconf.importing.imported import ImportedDocument, Omission, Renaming
from selfconf.importing.ledger import ImportLedger
from selfconf.importing.naming import absolute
from selfconf.importing.owl_s import import_services
from selfconf.importing.peis import import_peis
from selfconf.importing.rdf_documents import import_rdf
from selfconf.importing.ros2 import import_nodes
from selfconf.importing.sources import SourceDocument, gather
from selfconf.importing.turtle_text import turtle
from selfconf.importing.wot import import_things
from selfconf.model.immutable import immutable

Importer = Callable[[Iterable[SourceDocument], ImportLedger], Iterable[ImportedDocument]]


@immutable
class ImportFormat:
    """A format that can be imported: its name, the endings of its files in a folder, and what reads it."""

    name: str
    endings: tuple[str, ...]
    importer: Importer


IMPORT_FORMATS = {
    each.name: each
    for each in (
        ImportFormat("wot", (".json", ".jsonld"), import_things),
        ImportFormat("ros2", (".ros2", ".rossystem", ".nodl.xml"), import_nodes),
        ImportFormat("owl-s", (".owls", ".owl", ".rdf", ".ttl"), import_services),
        ImportFormat("peis", (".cmp",), import_peis),
        ImportFormat("rdf", files.ONTOLOGY, import_rdf),
    )
}
"""The formats, by their names."""


@immutable
class ImportedFile:
    """A Turtle file that an import has written, or that was there as it would be written."""

    path: Path
    state: FileState
    document: ImportedDocument


@immutable
class ImportReport:
    """What an import has written, what it has left out or renamed, and what it could not read."""

    form: str
    files: tuple[ImportedFile, ...]
    left_out: tuple[Omission, ...]
    renamed: tuple[Renaming, ...]
    unreadable: tuple[AuthorError, ...] = field(default=())


def import_documents(
    form: str, read: Callable[[ImportLedger], Iterable[ImportedDocument]], out: Path, namespace: str | None = None
) -> ImportReport:
    """Write what an importer reads, which notes in a ledger what it leaves out, as Turtle files in a folder.

    The namespace is what the IRIs of components begin with to which their source gives none. Raises AuthorError if the
    folder cannot be written to, or the namespace cannot be one; what cannot be read is in the report.
    """
    if namespace is not None and (absolute(namespace) is None or namespace[-1] not in "#/:"):
        raise NamespaceError(namespace)
    unreadable: list[AuthorError] = []
    ledger = ImportLedger(namespace or f"urn:selfconf:{form}:", unreadable.append)
    documents = {f"{ledger.names.file(document.name)}.ttl": document for document in read(ledger)}
    states = write_folder(out, {name: turtle(document, form) for name, document in documents.items()})
    files = tuple(ImportedFile(out / name, states[name], document) for name, document in documents.items())
    return ImportReport(form, files, ledger.omissions(), tuple(ledger.names.renamed), tuple(unreadable))


def import_descriptions(form: str, given: Sequence[str], out: Path, namespace: str | None) -> ImportReport:
    """Import files, folders and URLs of a format, which is a name of `IMPORT_FORMATS`, as `import_documents` does."""
    known = IMPORT_FORMATS[form]

    def read(ledger: ImportLedger) -> Iterable[ImportedDocument]:
        return known.importer(gather(given, known.endings, ledger.unreadable), ledger)

    return import_documents(form, read, out, namespace)
