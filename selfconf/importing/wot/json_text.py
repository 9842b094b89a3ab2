"""JSON as strangers write it: with a limit of depth, with the line of a mistake, and without silent losses."""

from __future__ import annotations

import json
import re
from collections import Counter
from typing import Any

from selfconf.errors import AuthorError
from selfconf.importing.sources import SourceDocument
from selfconf.model.immutable import immutable

DEEPEST_JSON = 100
"""How deep arrays and objects may be nested; descriptions need about ten levels, the parser allows a thousand."""
_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|([\[{])|([\]}])', re.DOTALL)
_CONSTANT = re.compile(r'"(?:[^"\\]|\\.)*"|(NaN|-?Infinity)', re.DOTALL)
_SURROGATE = re.compile(r"\\u[dD][89a-fA-F]")


@immutable
class JsonText:
    """A JSON document, and the names that occur twice in one of its objects: only the last value of each counts."""

    value: Any
    repeated: tuple[str, ...]


def parse_json(source: SourceDocument) -> JsonText:
    """Read a JSON document. Raises AuthorError with line and column where it is none."""
    text = source.text()
    _check_depth(text, source)
    repeated: list[str] = []

    def members(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        found = dict(pairs)
        if len(found) < len(pairs):
            repeated.extend(name for name, times in Counter(name for name, _ in pairs).items() if times > 1)
        return found

    def no_number(name: str) -> None:
        offset = next(token.start() for token in _CONSTANT.finditer(text) if token[1])
        raise source.mistake(f"this is not JSON: {name} is no number of JSON", offset)

    try:
        value = json.loads(text, object_pairs_hook=members, parse_constant=no_number)
        if _SURROGATE.search(text):  # halves of a pair make a character together, and none alone
            json.dumps(value, ensure_ascii=False).encode()
    except json.JSONDecodeError as error:
        message = f"this is not JSON: {error.msg[0].lower()}{error.msg[1:]}"
        raise AuthorError(message, file=source.shown, line=error.lineno, column=error.colno) from None
    except UnicodeEncodeError:
        raise AuthorError(
            "a string in it has half of a surrogate pair, which is no character", file=source.shown
        ) from None
    except ValueError:
        raise AuthorError("a number in it has more digits than can be read", file=source.shown) from None
    return JsonText(value, tuple(repeated))


def one_or_several(value: Any) -> list[Any]:
    """What a member of a Thing Description holds: its value, or the values in its array; nothing where it is none."""
    return [] if value is None else value if isinstance(value, list) else [value]


def _check_depth(text: str, source: SourceDocument) -> None:
    """Raises AuthorError where it is nested too deep; short of that many brackets there is nothing to look at."""
    if text.count("{") + text.count("[") <= DEEPEST_JSON:
        return
    depth = 0
    for token in _TOKEN.finditer(text):
        if token[1]:
            depth += 1
            if depth > DEEPEST_JSON:
                message = f"its JSON is nested more than {DEEPEST_JSON} levels deep, which no description needs"
                raise source.mistake(message, token.start())
        elif token[2]:
            depth -= 1
