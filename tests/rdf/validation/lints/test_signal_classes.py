"""Lints about classes of signals in the place of components and ports, and the other way round."""

from __future__ import annotations

import pytest

from tests.rdf.validation.lints.linted_text import TEMPLATE, lints, only

CAMERA = ":a a sc:Component, rob:Camera ; "
PORT = CAMERA + "sc:hasInput [ sc:name 'x' ; sc:signalType rob:Image ; sc:accepts "


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        (":a a sc:Component, rob:Camera, rob:Image .", ":a a sc:Component, rob:Camera, rob:Sensor ."),
        (
            CAMERA + "sc:hasOutput [ sc:name 'x' ; sc:signalType rob:Camera ] .",
            CAMERA + "sc:hasOutput [ sc:name 'x' ; sc:signalType rob:Image ] .",
        ),
        (
            CAMERA + "sc:hasOperation [ sc:name 'x' ; sc:response rob:Camera ] .",
            CAMERA + "sc:hasOperation [ sc:name 'x' ; sc:response rob:Image ] .",
        ),
        (
            PORT + "[ sh:class rob:Image ] ] .",
            PORT + "[ sh:property [ sh:path sc:signalType ; sh:hasValue rob:Image ] ] ] .",
        ),
        (
            TEMPLATE + ":r sh:property [ sh:path sc:hasOutput ; sh:hasValue rob:Image ] .",
            TEMPLATE + ":r sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue rob:Image ] .",
        ),
        (
            TEMPLATE + ":r sh:property [ sh:path sc:hasOutput ; sh:minCount 1 ; sh:in ( rob:Image ) ] .",
            TEMPLATE + ":r sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:in ( rob:Image ) ] .",
        ),
        (
            TEMPLATE + ":r sh:property [ sh:path sc:hasOutput ; sh:class rob:Image ] .",
            TEMPLATE + ":r sh:property [ sh:path sc:hasOutput ; sh:minCount 1 ] .",
        ),
        (
            TEMPLATE + ":r sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:class rob:Image ] .",
            TEMPLATE + ":r sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue rob:Image ] .",
        ),
        (
            TEMPLATE + ":r sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue rob:Camera ] .",
            TEMPLATE + ":r sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue :Unknown ] .",
        ),
    ],
)
def test_a_class_that_is_not_one_of_what_stands_there_is_noticed(wrong: str, right: str) -> None:
    found = only(wrong)
    assert found.code == "SC-L28"
    assert found.hint
    assert not lints(right)


def test_a_class_of_both_components_and_signals_is_left_alone() -> None:
    both = ":Both a owl:Class ; rdfs:label 'both' ; rdfs:subClassOf rob:Camera , rob:Image .\n"
    assert not lints(both + ":a a sc:Component, :Both ; sc:hasOutput [ sc:name 'x' ; sc:signalType :Both ] .")
