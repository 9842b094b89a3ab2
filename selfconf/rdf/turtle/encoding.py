"""The encoding of a text, which is UTF-8 in every format that is read here, and where a text is not in it.

Oxigraph passes over bytes that are not UTF-8 in comments, and names no place of others; so they are looked for before.
"""

from __future__ import annotations

from selfconf.errors import TurtleError


def first_not_utf_8(octets: bytes) -> tuple[int, int, str] | None:
    """Of a text that is not UTF-8 the line and column of the first such byte, from one, and the sentence about it."""
    if octets.isascii():  # fifty times as fast as decoding, and no copy
        return None
    try:
        octets.decode()
    except UnicodeDecodeError as error:
        before = octets[: error.start].decode("utf-8-sig")
        said = f"this is not UTF-8: the byte 0x{octets[error.start]:02X} cannot stand here"
        return before.count("\n") + 1, len(before) - before.rfind("\n"), said
    return None


def check_utf_8(octets: bytes, source: str) -> None:
    """Raises TurtleError for a text that is not UTF-8, with the place."""
    found = first_not_utf_8(octets)
    if found is not None:
        line, column, said = found
        raise TurtleError(f"{said}; save the file in the encoding UTF-8", file=source, line=line, column=column)
