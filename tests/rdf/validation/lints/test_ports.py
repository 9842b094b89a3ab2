"""Lints about ports and operations."""

from __future__ import annotations

from tests.rdf.validation.lints.linted_text import lints, only


def test_a_signal_type_of_an_operation_is_passed_over_and_that_of_a_port_is_not() -> None:
    port = ':x a sc:Component, rob:Tuner ; sc:hasOutput [ sc:name "a" ; sc:signalType rob:Audio ] ;'
    for link in ("sc:hasOperation", "sc:needsOperation"):
        assert lints(f'{port} {link} [ sc:name "b" ; sc:request rob:Audio ] .') == []
        assert only(f'{port} {link} [ sc:name "b" ; sc:signalType rob:Audio ] .').code == "SC-L24"


def test_ports_in_parentheses_are_one_problem() -> None:
    ports = "[ sc:name 'a' ; sc:signalType rob:Audio ] [ sc:name 'b' ; sc:signalType rob:Audio ]"
    assert only(f":x a sc:Component, rob:Tuner ; sc:hasOutput ( {ports} ) .").code == "SC-A07"
