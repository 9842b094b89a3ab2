"""The ontologies of selfconf and of a user, and the hierarchy that a reasoning mode takes from them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from selfconf import entailment, files, library
from selfconf.api.document_texts import DocumentText, file_text
from selfconf.model.hierarchy import Hierarchy, Reasoning
from selfconf.model.immutable import replace
from selfconf.model.term import IRI
from selfconf.rdf import turtle
from selfconf.rdf.reasoning import READ, hierarchy
from selfconf.rdf.sparql import QUERY_PREFIXES, Dataset

if TYPE_CHECKING:
    from selfconf.query import Question

_RELEVANT = {Reasoning.SYNTACTIC: (), Reasoning.SUBCLASS: READ, Reasoning.OWL_RL: None}
"""The predicates of which a mode looks at the statements; None for all."""


def ontology_texts(paths: Iterable[Path]) -> tuple[DocumentText, ...]:
    """What is in the ontologies that paths stand for. Raises AuthorError for what is not there or is no text."""
    return tuple(map(file_text, files.ontology_files(paths)))


def hierarchy_of(reasoning: Reasoning, ontologies: Sequence[DocumentText] = ()) -> Hierarchy:
    """The hierarchy that a reasoning mode lets the roles see, by the ontologies of selfconf and by others.

    Raises TurtleError for one that cannot be read, also in the mode `syntactic`, which uses none of it.
    """
    shipped = () if reasoning is Reasoning.SYNTACTIC else ontology_texts(library.ontologies())
    return _of_texts(reasoning, (*shipped, *ontologies))


# A caller that asks again and again under one large ontology waits for it once.
@lru_cache(maxsize=2)
def _of_texts(reasoning: Reasoning, texts: tuple[DocumentText, ...]) -> Hierarchy:
    documents = [turtle.read_ontology(*text, _RELEVANT[reasoning]) for text in texts]
    return hierarchy(documents, reasoning, entailment.entailed_hierarchy)


def with_ontologies(dataset: Dataset, question: Question, ontologies: Sequence[Path]) -> tuple[Dataset, Question]:
    """A dataset with ontologies, each a named graph, and a question that may use their prefixes."""
    prefixes: dict[str, str] = {}
    for path in files.ontology_files(ontologies):
        document = turtle.read_ontology(*file_text(path))
        prefixes |= document.prefixes
        dataset.add(IRI.unchecked(files.base(path)), document.triples())
    lent = {name: base for name, base in prefixes.items() if name and name not in QUERY_PREFIXES}
    return dataset, replace(question, prefixes=lent)
