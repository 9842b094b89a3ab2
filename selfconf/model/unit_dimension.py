"""Whether two units of QUDT measure one thing, as metres and millimetres do: told from their local names.

QUDT composes the names of units: a prefix (`MilliM`), a power (`M2`), factors joined by `-` and divisors behind `PER`
(`KiloM-PER-HR`, `N-M`). Of names that are composed of units listed here the dimension is known, of others it is not.
"""

from __future__ import annotations

import re
from collections import Counter
from functools import lru_cache

from selfconf.model.term import IRI

_PREFIX = re.compile(
    "(?:Yotta|Zetta|Exa|Peta|Tera|Giga|Mega|Kilo|Hecto|Deca|Deci|Centi|Milli|Micro|Nano|Pico|Femto|Kibi|Mebi|Gibi)"
    "(?=[A-Z])"
)
_FACTOR = re.compile(r"([A-Z]+(?:_[A-Z_]+)?)([0-9]*)")
_UNITS: dict[str, str] = {
    "M": "length", "IN": "length", "FT": "length", "YD": "length", "MI": "length", "MI_N": "length", "AU": "length",
    "GM": "mass", "LB": "mass", "OZ": "mass", "TONNE": "mass", "TON_Metric": "mass",
    "SEC": "time", "MIN": "time", "HR": "time", "DAY": "time", "WK": "time", "MO": "time", "YR": "time",
    "HZ": "frequency", "REV-PER-MIN": "frequency",
    "RAD": "angle", "DEG": "angle", "ARCMIN": "angle", "ARCSEC": "angle", "REV": "angle", "GRAD": "angle",
    "K": "temperature", "DEG_C": "temperature", "DEG_F": "temperature", "DEG_R": "temperature",
    "A": "current", "V": "voltage", "OHM": "resistance", "FARAD": "capacitance", "C": "charge", "H": "inductance",
    "N": "force", "LB_F": "force", "KiloGM_F": "force",
    "J": "energy", "CAL": "energy", "EV": "energy", "BTU_IT": "energy",
    "W": "power", "HP": "power",
    "PA": "pressure", "BAR": "pressure", "ATM": "pressure", "PSI": "pressure", "TORR": "pressure",
    "L": "volume", "GAL_US": "volume",
    "LUX": "illuminance", "LM": "luminous flux", "CD": "luminous intensity",
    "BIT": "information", "BYTE": "information",
    "UNITLESS": "ratio", "PERCENT": "ratio", "PPM": "ratio", "PPB": "ratio", "FRACTION": "ratio",
    "MOL": "amount", "T": "magnetic flux density", "GAUSS": "magnetic flux density",
}  # fmt: skip
_SPELT_OUT = {
    "M": "metre meter", "GM": "gram gramme", "KiloGM": "kilogram kilogramme kg", "SEC": "second sec s", "MIN": "minute",
    "HR": "hour h", "HZ": "hertz hz", "RAD": "radian", "DEG": "degree", "K": "kelvin", "DEG_C": "celsius",
    "A": "ampere", "V": "volt", "OHM": "ohm", "N": "newton", "J": "joule", "W": "watt", "PA": "pascal",
    "L": "litre liter",
    "LUX": "lux lx", "PERCENT": "percent", "BYTE": "byte", "MilliM": "millimetre millimeter mm",
    "CentiM": "centimetre centimeter cm", "KiloM": "kilometre kilometer km", "MilliSEC": "millisecond ms",
    "M-PER-SEC": "mps", "IN": "inch", "FT": "foot feet", "MI": "mile", "BAR": "bar",
}  # fmt: skip
_MEANT = {word: unit for unit, words in _SPELT_OUT.items() for word in words.split()}
"""The units that words of a language stand for, in the singular."""
_COMPOSED = {
    "volume": {"length": 3},
    "frequency": {"time": -1},
    "force": {"mass": 1, "length": 1, "time": -2},
    "pressure": {"mass": 1, "length": -1, "time": -2},
    "energy": {"mass": 1, "length": 2, "time": -2},
    "power": {"mass": 1, "length": 2, "time": -3},
    "charge": {"current": 1, "time": 1},
    "voltage": {"mass": 1, "length": 2, "time": -3, "current": -1},
    "resistance": {"mass": 1, "length": 2, "time": -3, "current": -2},
    "capacitance": {"mass": -1, "length": -2, "time": 4, "current": 2},
    "inductance": {"mass": 1, "length": 2, "time": -2, "current": -2},
    "magnetic flux density": {"mass": 1, "time": -2, "current": -1},
    "luminous flux": {"luminous intensity": 1},
    "illuminance": {"luminous intensity": 1, "length": -2},
}
"""The dimensions of this list that are composed of others of it, as in the International System of Units."""
_NUMBERS = ("angle", "ratio")
"""Those that are mere numbers in that system: they count where there is nothing else, so `RAD-PER-SEC` is as `HZ`."""

Dimension = frozenset[tuple[str, int]]
"""Base dimensions with their powers."""


@lru_cache(maxsize=1024)
def dimension(unit: IRI) -> Dimension | None:
    """What a unit measures; None where its name does not tell.

    >>> dimension(IRI("http://qudt.org/vocab/unit/MilliM")) == dimension(IRI("http://qudt.org/vocab/unit/FT"))
    True
    """
    name = unit.short
    if name in _UNITS:
        return _composed(Counter({_UNITS[name]: 1}))
    found: Counter[str] = Counter()
    above, per, below = name.rpartition("PER-")
    factors = [(1, one) for one in (above.removesuffix("-") if per else below).split("-") if one or not per]
    factors += [(-1, one) for one in below.split("-") if per]
    for sign, factor in factors:
        measured = _measured(factor)
        if measured is None:
            return None
        found[measured[0]] += sign * measured[1]
    return _composed(found)


def _measured(factor: str) -> tuple[str, int] | None:
    """What one factor of a unit measures, and its power."""
    if factor in _UNITS:
        return _UNITS[factor], 1
    match = _FACTOR.fullmatch(_PREFIX.sub("", factor, count=1))
    if match is None or match[1] not in _UNITS:
        return None
    return _UNITS[match[1]], int(match[2] or 1)


def _composed(found: Counter[str]) -> Dimension:
    whole: Counter[str] = Counter()
    for name, power in found.items():
        for part, times in _COMPOSED.get(name, {name: 1}).items():
            whole[part] += power * times
    rest = {name: power for name, power in whole.items() if power}
    measured = {name: power for name, power in rest.items() if name not in _NUMBERS}
    return frozenset((measured or rest).items())


def meant_unit(unit: IRI) -> str | None:
    """The name that QUDT has for a unit whose name is spelt out, as in `unit:metres`; None for any other name.

    >>> meant_unit(IRI("http://qudt.org/vocab/unit/metres"))
    'M'
    """
    if dimension(unit) is not None:
        return None
    word = unit.short.casefold()
    return _MEANT.get(word) or _MEANT.get(word.removesuffix("s"))


def differ_in_dimension(one: IRI, other: IRI) -> bool | None:
    """Whether two units measure different things; None where that is not known."""
    first, second = dimension(one), dimension(other)
    return None if first is None or second is None else first != second
