"""Lints about prefixes: namespaces that are nearly known ones."""

from __future__ import annotations

import pytest

from selfconf.model.codes import PREAMBLE
from selfconf.model.diagnostic import Severity
from tests.rdf.validation.lints.linted_text import lints, only


def test_the_namespace_of_a_datatype_without_a_prefix_may_be_nearly_right() -> None:
    found = only(":a a sc:Component, rob:Tuner ; :bands '5'^^<https://www.w3.org/2001/XMLSchema#integer> .")
    assert (found.code, found.hint) == ("SC-L06", "Did you mean <http://www.w3.org/2001/XMLSchema#>?")


def test_a_prefix_that_is_nearly_right_is_told_once_and_not_for_each_signal() -> None:
    head = PREAMBLE.replace("selfconf/robotics#", "selfconf/robotics/")
    text = ":a a sc:Component, rob:Tuner ; sc:hasOutput [ sc:name 'x' ; sc:signalType rob:Audio ] ."
    assert [each.code for each in lints(text, head)] == ["SC-L06"]


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("http://w3id.org/selfconf#", "https://w3id.org/selfconf#"),
        ("https://w3id.org/selfconf/", "https://w3id.org/selfconf#"),
        ("https://www.w3.org/ns/shacl#", "http://www.w3.org/ns/shacl#"),
        ("https://www.w3.org/ns/shacl/", "http://www.w3.org/ns/shacl#"),
    ],
)
def test_nearly_the_namespace_of_selfconf_or_shacl_is_an_error(wrong: str, right: str) -> None:
    found = only(":a a sc:Component, rob:Tuner .", PREAMBLE + f"@prefix x: <{wrong}> .\n")
    assert (found.code, found.severity, found.hint) == ("SC-L06", Severity.ERROR, f"Did you mean <{right}>?")


def test_nearly_the_namespace_of_another_vocabulary_is_a_warning() -> None:
    head = PREAMBLE + "@prefix x: <https://www.w3.org/2000/01/rdf-schema#> .\n"
    assert only(":a a sc:Component, rob:Tuner .", head).severity is Severity.WARNING


def test_a_prefix_may_be_declared_twice_alike() -> None:
    assert not lints("@prefix rob: <https://w3id.org/selfconf/robotics#> .\n:a a sc:Component, rob:Tuner .")
