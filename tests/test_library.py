"""The one door to the ontologies and shapes that ship with selfconf."""

from __future__ import annotations

from pathlib import Path

from selfconf import library
from selfconf.rdf.turtle import document as turtle

ROOT = Path(__file__).resolve().parent.parent


def test_the_ontologies_and_shapes_of_the_checkout_are_found() -> None:
    assert {path.name for path in library.ontologies()} >= {"selfconf.ttl", "robotics.ttl", "peis-home.ttl"}
    assert {path.name for path in library.shapes()} >= {"advertisement.ttl", "template.ttl", "task.ttl"}
    assert library.ontologies() == sorted((ROOT / "ontology").glob("*.ttl"))
    assert library.shapes() == sorted((ROOT / "shapes").glob("*.ttl"))


def test_all_of_them_are_turtle() -> None:
    for path in (*library.ontologies(), *library.shapes()):
        assert turtle.parse(path.read_bytes(), str(path)).statements
