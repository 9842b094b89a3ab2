"""Units by their spellings."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from selfconf.importing.units import COMMON_CODES, SPELLINGS, unit_of
from selfconf.rdf.vocabulary import UNIT

QUDT = "http://qudt.org/vocab/unit/"


@pytest.mark.parametrize(
    ("spelling", "name"),
    [
        ("degree celsius", "DEG_C"), ("Degree  Celsius", "DEG_C"), ("°C", "DEG_C"), ("CEL", "DEG_C"), ("%", "PERCENT"),
        ("lux", "LUX"), ("Lux", "LUX"), ("m/s", "M-PER-SEC"), ("mW", "MilliW"), ("MW", "MegaW"), ("s", "SEC"),
        ("ms", "MilliSEC"), ("kWh", "KiloW-HR"), ("KWH", "KiloW-HR"), ("hPa", "HectoPA"), ("P1", "PERCENT"),
        ("mbar", "MilliBAR"), ("Volt", "V"), ("rpm", "REV-PER-MIN"), ("pH", "PH"),
        (QUDT + "DEG_C", "DEG_C"), ("https://qudt.org/vocab/unit/NUM", "NUM"),
        ("http://www.ontology-of-units-of-measure.org/resource/om-2/degreeCelsius", "DEG_C"),
        ("http://www.ontology-of-units-of-measure.org/resource/om-2/metrePerSecond-Time", "M-PER-SEC"),
    ],
)  # fmt: skip
def test_a_spelling_means_a_unit(spelling: str, name: str) -> None:
    assert unit_of(spelling) == UNIT[name]


@pytest.mark.parametrize(
    "spelling", ["", "C", "F", "degrees", "S", "Mbar", "Mg/m3", "furlong", QUDT, QUDT + "a b", "MS"]
)
def test_what_is_not_known_or_could_be_two_units_is_none(spelling: str) -> None:
    assert unit_of(spelling) is None


def test_every_spelling_of_the_table_means_its_unit_and_no_other() -> None:
    spellings = Counter(spelling for each in SPELLINGS.values() for spelling in each)
    assert len(spellings) > 200
    assert [spelling for spelling, times in spellings.items() if times > 1] == []
    for name, each in SPELLINGS.items():
        assert {unit_of(spelling) for spelling in each} == {UNIT[name]}
    assert set(COMMON_CODES.values()) <= SPELLINGS.keys()
    assert {code: unit_of(code) for code in COMMON_CODES} == {code: UNIT[name] for code, name in COMMON_CODES.items()}


def test_the_page_has_the_table() -> None:
    page = (Path(__file__).parents[2] / "docs" / "from-wot.md").read_text("utf-8")
    rows = {line for line in page.splitlines() if line.startswith("| `unit:")}
    assert rows == {
        f"| `unit:{name}` | {', '.join(f'`{spelling}`' for spelling in each)} |" for name, each in SPELLINGS.items()
    }
