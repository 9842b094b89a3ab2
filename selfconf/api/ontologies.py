"""The ontologies of selfconf and of a user, and the hierarchy that a reasoning mode takes from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from selfconf import entailment, files, library
from selfconf.api.reading import Text, file_text
from selfconf.model.hierarchy import Hierarchy, Reasoning
from selfconf.model.term import IRI
from selfconf.rdf import turtle
from selfconf.rdf.reasoning import READ, hierarchy
from selfconf.rdf.sparql import QUERY_PREFIXES, Dataset

if TYPE_CHECKING:
    from selfconf.query import Question

_RELEVANT = {Reasoning.SYNTACTIC: (), Reasoning.SUBCLASS: READ, Reasoning.OWL_RL: None}
"""The predicates of which a mode looks at the statements; None for all."""


def hierarchy_of(reasoning: Reasoning, ontologies: Sequence[Path] = ()) -> Hierarchy:
    """The hierarchy that a reasoning mode lets the roles see; a folder stands for all ontologies below it.

    Raises AuthorError for what is not there or cannot be read, also in the mode `syntactic`, which uses none of it.
    """
    own = files.ontology_files(ontologies)
    if reasoning is Reasoning.SYNTACTIC:
        # Standard input, which can be read once, is left to the mode that an explanation may look at afterwards.
        return _of_texts(reasoning, tuple(file_text(path) for path in own if path != files.STDIN))
    return _of_texts(reasoning, tuple(map(file_text, (*library.ontologies(), *own))))


# A caller that asks again and again under one large ontology waits for it once.
@lru_cache(maxsize=2)
def _of_texts(reasoning: Reasoning, texts: tuple[Text, ...]) -> Hierarchy:
    documents = [turtle.read_ontology(*text, _RELEVANT[reasoning]) for text in texts]
    return hierarchy(documents, reasoning, entailment.entailed_hierarchy)


def with_ontologies(dataset: Dataset, question: Question, ontologies: Sequence[Path]) -> tuple[Dataset, Question]:
    """A dataset with ontologies, each a named graph, and a question that may use their prefixes."""
    prefixes: dict[str, str] = {}
    for path in files.ontology_files(ontologies):
        document = turtle.read_ontology(*file_text(path))
        prefixes |= document.prefixes
        dataset.add(IRI.unchecked(path.resolve().as_uri()), document.triples())
    lent = {name: base for name, base in prefixes.items() if name and name not in QUERY_PREFIXES}
    return dataset, replace(question, prefixes=lent)
