"""Units of measure by their spellings: what descriptions call a unit, and the term of QUDT that means it.

A spelling is looked up as it is written, because mW and MW, s and S are not the same; if that is not known, in lower
case among the words. What could be two units stays unknown: "C" is a coulomb and a degree Celsius, "F" a farad and a
degree Fahrenheit, "degrees" an angle and a temperature.
"""

from __future__ import annotations

import re

from selfconf.model.term import IRI
from selfconf.rdf.vocabulary import UNIT

SPELLINGS: dict[str, tuple[str, ...]] = {
    "DEG_C": ("°C", "℃", "ºC", "Cel", "degC", "celsius", "degree celsius", "degrees celsius", "celcius", "centigrade"),
    "DEG_F": ("°F", "℉", "ºF", "degF", "fahrenheit", "degree fahrenheit", "degrees fahrenheit"),
    "K": ("K", "kelvin", "kelvins"),
    "PERCENT": ("%", "percent", "percentage", "pct", "per cent"),
    "PERCENT_RH": ("%RH", "% RH", "%rH", "percent relative humidity"),
    "PPM": ("ppm", "parts per million"),
    "PPB": ("ppb", "parts per billion"),
    "LUX": ("lx", "lux", "lumens per square metre"),
    "LM": ("lm", "lumen", "lumens"),
    "CD": ("cd", "candela"),
    "M": ("m", "meter", "metre", "meters", "metres"),
    "CentiM": ("cm", "centimeter", "centimetre", "centimeters", "centimetres"),
    "MilliM": ("mm", "millimeter", "millimetre", "millimeters", "millimetres"),
    "KiloM": ("km", "kilometer", "kilometre", "kilometers", "kilometres"),
    "IN": ("in", "inch", "inches"),
    "FT": ("ft", "foot", "feet"),
    "MI": ("mi", "mile", "miles"),
    "M2": ("m2", "m²", "m^2", "square meter", "square metre", "square meters", "square metres"),
    "M3": ("m3", "m³", "m^3", "cubic meter", "cubic metre", "cubic meters", "cubic metres"),
    "L": ("l", "L", "liter", "litre", "liters", "litres"),
    "MilliL": ("ml", "mL", "milliliter", "millilitre", "milliliters", "millilitres"),
    "GM": ("g", "gram", "grams"),
    "KiloGM": ("kg", "kilogram", "kilograms"),
    "MilliGM": ("mg", "milligram", "milligrams"),
    "SEC": ("s", "sec", "secs", "second", "seconds"),
    "MilliSEC": ("ms", "msec", "millisecond", "milliseconds"),
    "MicroSEC": ("us", "µs", "μs", "microsecond", "microseconds"),
    "MIN": ("min", "mins", "minute", "minutes"),
    "HR": ("h", "hr", "hrs", "hour", "hours"),
    "DAY": ("d", "day", "days"),
    "HZ": ("Hz", "hertz"),
    "KiloHZ": ("kHz", "kilohertz"),
    "MegaHZ": ("MHz", "megahertz"),
    "M-PER-SEC": ("m/s", "m·s-1", "m s-1", "ms-1", "meters per second", "metres per second", "metre per second"),
    "KiloM-PER-HR": ("km/h", "kph", "kmh", "kilometers per hour", "kilometres per hour"),
    "MI-PER-HR": ("mph", "miles per hour"),
    "M-PER-SEC2": ("m/s2", "m/s²", "m/s^2", "meters per second squared", "metres per second squared"),
    "DEG": ("°", "deg", "arcdegree", "arcdegrees", "angular degree", "angular degrees"),
    "RAD": ("rad", "radian", "radians"),
    "DEG-PER-SEC": ("°/s", "deg/s", "degrees per second"),
    "RAD-PER-SEC": ("rad/s", "radians per second"),
    "REV-PER-MIN": ("rpm", "RPM", "rev/min", "revolutions per minute"),
    "W": ("W", "watt", "watts"),
    "KiloW": ("kW", "kilowatt", "kilowatts"),
    "MilliW": ("mW", "milliwatt", "milliwatts"),
    "MegaW": ("MW", "megawatt", "megawatts"),
    "W-HR": ("Wh", "W·h", "watt hour", "watt hours", "watt-hour", "watt-hours"),
    "KiloW-HR": ("kWh", "kW·h", "kilowatt hour", "kilowatt hours", "kilowatt-hour", "kilowatt-hours"),
    "J": ("J", "joule", "joules"),
    "KiloJ": ("kJ", "kilojoule", "kilojoules"),
    "V": ("V", "volt", "volts"),
    "MilliV": ("mV", "millivolt", "millivolts"),
    "A": ("A", "amp", "amps", "ampere", "amperes"),
    "MilliA": ("mA", "milliamp", "milliamps", "milliampere", "milliamperes"),
    "OHM": ("\u03a9", "\u2126", "ohm", "ohms"),
    "N": ("N", "newton", "newtons"),
    "N-M": ("Nm", "N·m", "newton meter", "newton metre", "newton meters", "newton metres"),
    "PA": ("Pa", "pascal", "pascals"),
    "HectoPA": ("hPa", "hectopascal", "hectopascals"),
    "KiloPA": ("kPa", "kilopascal", "kilopascals"),
    "MilliBAR": ("mbar", "millibar", "millibars"),
    "BAR": ("bar", "bars"),
    "PSI": ("psi", "PSI", "pounds per square inch"),
    "DeciB": ("dB", "decibel", "decibels"),
    "MicroGM-PER-M3": ("µg/m3", "μg/m3", "ug/m3", "µg/m³", "μg/m³", "ug/m³", "micrograms per cubic meter"),
    "MilliGM-PER-M3": ("mg/m3", "mg/m³", "milligrams per cubic meter"),
    "L-PER-MIN": ("l/min", "L/min", "lpm", "liters per minute", "litres per minute"),
    "M3-PER-HR": ("m3/h", "m³/h", "cubic meters per hour", "cubic metres per hour"),
    "MicroS-PER-CentiM": ("µS/cm", "μS/cm", "uS/cm", "microsiemens per centimeter"),
    "BYTE": ("byte", "bytes"),
    "PH": ("pH",),
}
"""The spellings of each unit, by its name in QUDT."""
COMMON_CODES = {
    "CEL": "DEG_C", "FAH": "DEG_F", "KEL": "K", "P1": "PERCENT", "59": "PPM", "LUX": "LUX", "LUM": "LM", "CDL": "CD",
    "MTR": "M", "CMT": "CentiM", "MMT": "MilliM", "KMT": "KiloM", "INH": "IN", "FOT": "FT", "SMI": "MI", "MTK": "M2",
    "MTQ": "M3", "LTR": "L", "MLT": "MilliL", "GRM": "GM", "KGM": "KiloGM", "MGM": "MilliGM", "SEC": "SEC",
    "C26": "MilliSEC", "MIN": "MIN", "HUR": "HR", "DAY": "DAY", "HTZ": "HZ", "KHZ": "KiloHZ", "MHZ": "MegaHZ",
    "MTS": "M-PER-SEC", "KMH": "KiloM-PER-HR", "HM": "MI-PER-HR", "MSK": "M-PER-SEC2", "DD": "DEG", "C81": "RAD",
    "2A": "RAD-PER-SEC", "RPM": "REV-PER-MIN", "WTT": "W", "KWT": "KiloW", "MAW": "MegaW", "WHR": "W-HR",
    "KWH": "KiloW-HR", "JOU": "J", "KJO": "KiloJ", "VLT": "V", "2Z": "MilliV", "AMP": "A", "4K": "MilliA", "OHM": "OHM",
    "NEW": "N", "NU": "N-M", "PAL": "PA", "A97": "HectoPA", "KPA": "KiloPA", "MBR": "MilliBAR", "BAR": "BAR",
    "2N": "DeciB", "GQ": "MicroGM-PER-M3", "GP": "MilliGM-PER-M3", "L2": "L-PER-MIN", "MQH": "M3-PER-HR",
}  # fmt: skip
"""The codes of UN/CEFACT Recommendation 20, which schema:unitCode asks for, and the names of their units in QUDT."""
_AS_WRITTEN = {
    **{code: UNIT[name] for code, name in COMMON_CODES.items()},
    **{spelling: UNIT[name] for name, spellings in SPELLINGS.items() for spelling in spellings},
}
_WORD = re.compile(r"[a-z][a-z -]{2,}")
_WORDS = {
    spelling.lower(): iri for spelling, iri in _AS_WRITTEN.items() if _WORD.fullmatch(spelling) and spelling != "mbar"
}
"""The spellings in which upper and lower case make no difference: words, not symbols such as mbar and Mbar."""
_QUDT = tuple(
    f"{scheme}qudt.org/{path}"
    for scheme in ("http://", "https://")
    for path in ("vocab/unit/", "vocab/unit#", "2.1/vocab/unit/", "1.1/vocab/unit#")
)
_OM = ("http://www.ontology-of-units-of-measure.org/resource/om-2/", "http://www.wurvoc.org/vocabularies/om-1.8/")
_NAME = re.compile(r"[A-Za-z0-9_-]+")
_HUMP = re.compile(r"(?<=[a-z])(?=[A-Z])|_")


def unit_of(spelling: str) -> IRI | None:
    """The unit that a spelling means, as a term of QUDT, or None if it is not known.

    A spelling may be an IRI, of QUDT or of the Ontology of units of Measure, whose names are words.
    """
    written = " ".join(spelling.split())
    for base in _QUDT:
        if written.startswith(base):
            name = written.removeprefix(base)
            return UNIT[name] if _NAME.fullmatch(name) else None
    for base in _OM:
        if written.startswith(base):
            written = _HUMP.sub(" ", written.removeprefix(base)).removesuffix("-Time")
    return _AS_WRITTEN.get(written) or _WORDS.get(written.lower())
