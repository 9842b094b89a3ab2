"""Whether units measure one thing, told from their names in QUDT."""

from __future__ import annotations

import pytest

from selfconf.importing.units import SPELLINGS
from selfconf.model.term import IRI
from selfconf.model.unit_dimension import differ_in_dimension, dimension, meant_unit
from selfconf.rdf.vocabulary import UNIT


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("M", "MilliM"),
        ("M", "FT"),
        ("KiloM-PER-HR", "M-PER-SEC"),
        ("M3", "L"),
        ("W", "J-PER-SEC"),
        ("HZ", "PER-SEC"),
        ("DEG_C", "K"),
        ("M-PER-SEC2", "CentiM-PER-SEC2"),
        ("N", "KiloGM-M-PER-SEC2"),
        ("PA", "N-PER-M2"),
        ("J", "N-M"),
        ("W", "V-A"),
        ("OHM", "V-PER-A"),
        ("C", "A-HR"),
        ("FARAD", "C-PER-V"),
        ("H", "V-SEC-PER-A"),
        ("T", "N-PER-A-M"),
        ("LUX", "LM-PER-M2"),
        ("RAD-PER-SEC", "REV-PER-MIN"),
        ("DEG-PER-SEC", "HZ"),
    ],
)
def test_units_of_one_dimension(one: str, other: str) -> None:
    assert differ_in_dimension(UNIT[one], UNIT[other]) is False


@pytest.mark.parametrize(
    ("one", "other"),
    [("M", "SEC"), ("M", "M2"), ("N-M", "N"), ("RAD", "RAD-PER-SEC"), ("K", "W"), ("DEG", "PERCENT"), ("A", "C")],
)
def test_units_of_different_dimensions(one: str, other: str) -> None:
    assert differ_in_dimension(UNIT[one], UNIT[other]) is True


@pytest.mark.parametrize("name", ["Zorkmid", "M-PER-Zorkmid", "", "-", "PER-", "MilliMilliM"])
def test_of_a_name_that_is_not_understood_nothing_is_said(name: str) -> None:
    assert dimension(IRI(f"urn:unit/{name}")) is None
    assert differ_in_dimension(UNIT.M, IRI(f"urn:unit/{name}")) is None


def test_spellings_that_are_one_unit_have_a_dimension_for_the_most_part() -> None:
    known = [name for name in SPELLINGS if dimension(UNIT[name]) is not None]
    assert len(known) > len(SPELLINGS) * 0.8


@pytest.mark.parametrize(
    ("name", "meant"),
    [("metres", "M"), ("m", None), ("Hz", "HZ"), ("seconds", "SEC"), ("mm", "MilliM"), ("M", None), ("Zorkmid", None)],
)
def test_a_name_that_is_spelt_out_means_a_unit(name: str, meant: str | None) -> None:
    assert meant_unit(UNIT[name]) == meant
