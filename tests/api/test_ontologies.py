"""A reasoning mode takes its hierarchy from the ontologies of selfconf and of the user."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.api.ontologies import hierarchy_of, with_ontologies
from selfconf.errors import AuthorError
from selfconf.model.hierarchy import Reasoning
from selfconf.query import Question, answer
from selfconf.rdf.sparql import Dataset
from selfconf.rdf.vocabulary import ROB

OWN = (
    "@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .\n@prefix mine: <x:> .\nmine:lamp rdfs:subClassOf <{}> .\n"
)


def test_syntactic_sees_nothing_and_subclass_sees_the_users_own(tmp_path: Path) -> None:
    (tmp_path / "own.ttl").write_text(OWN.format(ROB.Sensor))
    lamp = type(ROB.Sensor)("x:lamp")
    for ontologies in ([tmp_path], [tmp_path / "own.ttl"]):
        assert ROB.Sensor not in hierarchy_of(Reasoning.SYNTACTIC, ontologies).superclasses(lamp)
        assert ROB.Sensor in hierarchy_of(Reasoning.SUBCLASS, ontologies).superclasses(lamp)


@pytest.mark.parametrize("reasoning", list(Reasoning))
def test_an_ontology_that_is_not_there_is_named_in_every_mode(reasoning: Reasoning) -> None:
    with pytest.raises(AuthorError, match="no file or folder nowhere"):
        hierarchy_of(reasoning, [Path("nowhere.ttl")])


def test_a_question_may_use_the_prefixes_of_an_ontology(tmp_path: Path) -> None:
    (tmp_path / "own.ttl").write_text(OWN.format(ROB.Sensor))
    question = Question("ASK { mine:lamp rdfs:subClassOf rob:Sensor }", "table", 10)
    assert answer(*with_ontologies(Dataset(), question, [tmp_path])).text == "true"
