"""Lints about what outputs in sight could feed: units of one dimension, shapes that one of them conforms to."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf import validate
from tests.lab import PREFIXES


def found(tmp_path: Path, text: str) -> list[str]:
    """The codes of these lints that a file earns."""
    path = tmp_path / "file.ttl"
    path.write_text(PREFIXES + text)
    return [one.code for one in validate([str(path)]).diagnostics if one.code in ("SC-L21", "SC-L22", "SC-L23")]


def component(name: str, link: str, more: str) -> str:
    return f':{name} a sc:Component, rob:Display ; sc:{link} [ sc:name "p" ; sc:signalType rob:Odometry2D{more} ] .\n'


@pytest.mark.parametrize(
    ("outputs", "codes"),
    [
        (["KiloGM"], ["SC-L21"]),
        (["KiloGM", "SEC"], ["SC-L21"]),
        (["MilliM"], []),
        (["KiloGM", "FT"], []),
        (["Zorkmid"], []),
        ([], []),
    ],
)
def test_a_unit_that_no_output_can_be_converted_to_is_told(
    tmp_path: Path, outputs: list[str], codes: list[str]
) -> None:
    text = component("in", "hasInput", " ; sc:unit unit:M")
    text += "".join(component(f"o{n}", "hasOutput", f" ; sc:unit unit:{unit}") for n, unit in enumerate(outputs))
    assert found(tmp_path, text) == codes


@pytest.mark.parametrize(
    ("unit", "codes"),
    [("unit:metres", ["SC-L23"]), ("unit:Hz", ["SC-L23"]), ("unit:M", []), ("unit:Zorkmid", []), (":metre", [])],
)
def test_a_unit_whose_name_is_spelt_out_is_told(tmp_path: Path, unit: str, codes: list[str]) -> None:
    assert found(tmp_path, component("o", "hasOutput", f" ; sc:unit {unit}")) == codes


RATED = " ; sc:rate [ sc:value 5 ; sc:unit unit:HZ ]"
SHAPE = " ; sc:accepts [ sh:property [ sh:path ( sc:rate sc:value ) ; sh:minCount 1 ] ]"


@pytest.mark.parametrize(("outputs", "codes"), [([""], ["SC-L22"]), (["", RATED], []), ([], [])])
def test_a_shape_that_no_output_conforms_to_is_told(tmp_path: Path, outputs: list[str], codes: list[str]) -> None:
    text = component("in", "hasInput", SHAPE)
    text += "".join(component(f"o{n}", "hasOutput", said) for n, said in enumerate(outputs))
    assert found(tmp_path, text) == codes


@pytest.mark.parametrize("wanted", [" ; sc:unit unit:M", SHAPE])
def test_what_a_component_issues_itself_is_no_source_of_its_inputs(tmp_path: Path, wanted: str) -> None:
    itself = component("filter", "hasInput", wanted) + component("filter", "hasOutput", " ; sc:unit unit:KiloGM")
    assert found(tmp_path, itself) == []
    assert len(found(tmp_path, itself + component("other", "hasOutput", " ; sc:unit unit:KiloGM"))) == 1


@pytest.mark.parametrize(
    ("said", "codes"),
    [("<http://qudt.org/schema/qudt/hasUnit> unit:CentiM", ["SC-L23"]), (":of unit:M ; sc:unit unit:M", []), ("", [])],
)
def test_a_unit_by_the_word_of_another_vocabulary_is_told(tmp_path: Path, said: str, codes: list[str]) -> None:
    assert found(tmp_path, component("out", "hasOutput", f" ; {said}")) == codes
