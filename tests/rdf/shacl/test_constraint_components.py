"""Which predicates of a document are those of its own constraint components."""

from __future__ import annotations

from selfconf.rdf.shacl import component_parameters
from selfconf.rdf.turtle import document as turtle
from tests.lab import PREFIXES, iri


def test_the_paths_of_the_parameters_of_all_components_are_found() -> None:
    text = """
        :One a sh:ConstraintComponent ; sh:parameter [ sh:path :low ] , [ sh:path :high ; sh:optional true ] .
        :Two a sh:ConstraintComponent ; sh:parameter [ sh:path _:odd ] .
        :other sh:parameter [ sh:path :nothing ] .
    """
    assert component_parameters(turtle.parse(PREFIXES + text, "shapes.ttl")) == {iri("low"), iri("high")}
