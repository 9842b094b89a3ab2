"""What is wrong with a SPARQL query, in a few words: the parser names every token that it expected, not the cause."""

from __future__ import annotations

import re
from collections.abc import Container, Mapping

import pyoxigraph as ox

from selfconf.model.curie import SCHEMES
from selfconf.rdf.sparql.prologue import PROLOGUE
from selfconf.rdf.sparql.read_only import fault, hidden, says, without

BEGINNINGS = ("PREFIX", "BASE", "SELECT", "ASK", "CONSTRUCT", "DESCRIBE")
_DECLARED = re.compile(r"\bprefix\s+([^\s:]*)\s*:", re.IGNORECASE)
_PREFIX = re.compile(r"(?<![\w?$@:.-])((?:[^\W\d_][\w.-]*)?):(?!//)")
_IRI = re.compile(rf"(?<![\w?$@:.<-])({'|'.join(SCHEMES)}):[^\s<>{{}}]")
_COMPLAINT = re.compile(r"error at (\d+):(\d+): expected (?:one of )?(.*)", re.DOTALL)
_SENTENCE = re.compile(r"(?:^|, )([A-Z][A-Za-z]*(?: [A-Za-z*]+){2,})(?=,|$)")
_THIS = ox.Variable("this")
_PAIRS = {"(": ")", "[": "]", "{": "}"}
_LEFT_OUT = {"MINUS": "FILTER NOT EXISTS { ... }", "VALUES": "FILTER (?value IN (...))"}
"""What the query of a shape may not have (SHACL, 5.3.1), each with what to write for it."""
LONGEST_EXCERPT = 30
"""Characters of the query that are shown."""


def why_not_asked(text: str, prefixes: Mapping[str, str], word: str = "select") -> str | None:
    """Why the query of a shape, to which some prefixes are declared, is not asked, in a sentence; None if it may be.

    It is the value of sh:select or of sh:ask, as `word` says. pySHACL takes a SELECT without $this for one that finds
    nothing, where SHACL has none (5.2.1).
    """
    reason = fault(text)
    if reason is not None:
        return reason
    try:
        answer = ox.Store().query(text, prefixes=dict(prefixes))
    except SyntaxError as error:
        return f"This is not SPARQL: {mistake(text, str(error), prefixes)}."
    except RuntimeError as error:  # it calls a function that is not there
        return f"This query cannot be answered: {error}."
    for left_out, instead in _LEFT_OUT.items():
        if says(text, left_out):
            return f"The query of a shape has no {left_out} (SHACL, 5.3.1); write {instead}."
    if word == "ask":
        return None if isinstance(answer, ox.QueryBoolean) else "The value of sh:ask has to be an ASK query."
    if not isinstance(answer, ox.QuerySolutions) or _THIS not in answer.variables:
        return "The value of sh:select has to be a SELECT query that selects $this."
    return None


def mistake(text: str, complaint: str, known: Container[str]) -> str:
    """What is wrong with a query that Oxigraph complains of; `known` are the prefixes it need not declare."""
    code = PROLOGUE.sub("", without(text, "#"), count=1)
    if not code:
        return "it is empty"
    if re.split(r"[^\w:]", code, maxsplit=1)[0].upper() not in BEGINNINGS:
        return f"it begins with {_short(code)}; a query only asks, by SELECT, ASK, CONSTRUCT or DESCRIBE"
    bare = without(text, "#", '"', "'", "<")
    declared = set(_DECLARED.findall(bare))
    for scheme in _IRI.findall(bare):
        if scheme not in declared and scheme not in known:
            return f"an IRI stands in angle brackets: <{scheme}:...>"
    for prefix in _PREFIX.findall(bare):
        if prefix not in declared and prefix not in known:
            return f"the prefix {prefix}: is not declared; begin with PREFIX {prefix}: <...>"
    found = _COMPLAINT.fullmatch(complaint)
    if found is None:
        return " ".join(complaint.split())
    line, column = int(found[1]), int(found[2])
    unpaired = _unpaired(text)
    if unpaired is not None and unpaired[:2] <= (line, column):
        return f"at {unpaired[0]}:{unpaired[1]} the '{unpaired[2]}' closes what is not open"
    place = f"at {line}:{column}"
    sentence = _SENTENCE.search(found[3])
    if sentence is not None:
        return f"{place}: {sentence[1]}"
    rest = "\n".join(text.split("\n")[line - 1 :])[column - 1 :]
    return f"{place} something is wrong before {_short(rest)}" if rest.strip() else f"{place} it ends too soon"


def _unpaired(text: str) -> tuple[int, int, str] | None:
    """Line and column of the first bracket of a query that closes another than the last open one, or none; and it.

    The parser goes on behind a bracket too many, and complains of a later place, mostly of the end.
    """
    line, column, awaited = 1, 0, [""]
    for mark in hidden(text):
        line, column = (line + 1, 0) if mark == "\n" else (line, column + 1)
        if mark in _PAIRS:
            awaited.append(_PAIRS[mark])
        elif mark in _PAIRS.values() and mark != awaited.pop():
            return line, column, mark
    return None


def _short(text: str) -> str:
    """The first word of a text, in quotes."""
    word = text.split(maxsplit=1)[0]
    return f"'{word if len(word) <= LONGEST_EXCERPT else word[:LONGEST_EXCERPT] + '...'}'"
