"""How well `validate` finds mistakes that were made on purpose: recall, place, false alarms, time and memory.

`python -m benchmarks.fuzz` takes good files, makes one change in each, and validates the result alone. Of a mistake it
is known where it is and which codes would name it; changes that mean nothing must not be complained of. Prints a table
in Markdown, and ends with 1 where a goal is missed. `--number` and `--seed` choose the changes, `--smoke` makes a few.
"""

from __future__ import annotations

import argparse
import random
import re
import resource
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import pyoxigraph as ox

from benchmarks.machine import described, table
from benchmarks.validate import HEAD, advertisement
from selfconf import library
from selfconf.rdf.validation import SourceText, validate_texts

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
RECALL, PLACE, SECONDS, MEMORY = 1.0, 0.95, 10.0, 1 << 30
"""What is wanted: of the mistakes all found, so many at their place, seconds and octets for one file at most."""
SYNTAX = frozenset(("SC-S01",))


@dataclass(frozen=True, slots=True)
class Changed:
    """A text with one change, where it is, and which codes name it; without codes it changes nothing that matters."""

    text: str
    offset: int
    codes: frozenset[str]


Change = Callable[[str, random.Random], "Changed | None"]


def _at(text: str, chance: random.Random, pattern: str, instead: str, *codes: str, group: int = 0) -> Changed | None:
    """One place where a pattern is found, with something else in it."""
    places = list(re.finditer(pattern, text))
    if not places:
        return None
    found = chance.choice(places)
    start, end = found.span(group)
    return Changed(text[:start] + found.expand(instead) + text[end:], start, frozenset(codes))


def _put(pattern: str, instead: str, *codes: str, group: int = 0) -> Change:
    return lambda text, chance: _at(text, chance, pattern, instead, *codes, group=group)


def misspelt(text: str, chance: random.Random) -> Changed | None:
    """A term with two letters swapped."""
    places = list(re.finditer(r"(?<=[\s,;\[(])(?:sc|rob):([A-Za-z]{5,})", text))
    if not places:
        return None
    found = chance.choice(places)
    word, start = found[1], found.start(1)
    at = chance.choice([k for k in range(1, len(word) - 1) if word[k] != word[k + 1]])
    swapped = word[:at] + word[at + 1] + word[at] + word[at + 2 :]
    return Changed(text[:start] + swapped + text[found.end(1) :], found.start(), frozenset(("SC-L01", "SC-L02")))


def converted(text: str, chance: random.Random) -> Changed | None:
    """The same triples as N-Triples, in any order."""
    triples = (quad.triple for quad in ox.parse(text, format=ox.RdfFormat.TURTLE, base_iri="file:///x/"))
    lines = (ox.serialize(triples, format=ox.RdfFormat.N_TRIPLES) or b"").decode().splitlines()
    chance.shuffle(lines)
    return Changed("\n".join(lines), 0, frozenset())


_STATEMENT_END = r'(?<=[\w"\]]) (\.)\n'
_LOOSE_PORT = '_:x sc:name "x" ; sc:signalType <https://w3id.org/selfconf/robotics#Audio> .\n'
"""A port that no component has; not every file has a prefix for its signal type."""
MISTAKES: dict[str, Change] = {
    "two letters of a term swapped": misspelt,
    "a prefix that is not declared": _put(r"(?<=[\s,;\[(])(rob|sc):\w", "robb:x", "SC-S01"),
    "a namespace with a slip": _put(r"@prefix sc: <https://w3id.org/(selfconf)#>", "selfcnf", "SC-L06", group=1),
    "a namespace with http": _put(r"@prefix sc: <(https)://w3id.org/selfconf#>", "http", "SC-L06", group=1),
    "a dot forgotten": _put(_STATEMENT_END + r"(?=\S)", "", "SC-S01", group=1),
    "a bracket forgotten": _put(r"(?<=\w) (\])", "", "SC-S01", group=1),
    "a quotation mark forgotten": _put(r'sc:name "[^"]*(")', "", "SC-S01", group=1),
    "a name that is a number": _put(r'sc:name ("[^"]*") ; sc:signalType', "5", "SC-A07", group=1),
    "a name in a language": _put(r'sc:name ("[^"]*") ; sc:signalType', r'"x"@en', "SC-A07", group=1),
    "a signal type in quotation marks": _put(r"sc:signalType (rob:\w+)", r'"rob:Audio"', "SC-A08", group=1),
    "a signal type forgotten": _put(r"\[ sc:name \"[^\"]*\"( ; sc:signalType rob:\w+)", "", "SC-L18", group=1),
    "a preference in words": _put(r"sc:preference (\d+)", r'"high"', "SC-A04", group=1),
    "two preferences": _put(r"sc:preference (\d+)", r"\1 , 99", "SC-A04", group=1),
    "a port that nothing has": _put(r"\Z", _LOOSE_PORT, "SC-L17"),
    "a type in quotation marks": _put(r"a (sc:Component), ", r'"sc:Component"', "SC-A02", "SC-A03", group=1),
}  # fmt: skip
HARMLESS: dict[str, Change] = {
    "a comment": _put(r"(?<= ;)\n", " # a ; comment . with ] signs\n"),
    "blanks": _put(r" (?=[;.,\]])", "\n\t  "),
    "ends of lines as on Windows": lambda text, _: Changed(text.replace("\n", "\r\n"), 0, frozenset()),
    "another order of lines": converted,
    "a semicolon more": _put(_STATEMENT_END, ";.", group=1),
    "quotation marks of three": _put(r'(?<= )"([\w .-]+)"(?= [;\]])', r'"""\1"""'),
    "a datatype behind blanks": _put(r"\Z", "<urn:x> <urn:p> \"5\" ^^ <http://www.w3.org/2001/XMLSchema#integer> .\n"),
    "a prefix like a keyword": _put(r"\Z", "@prefix a.b: <urn:x:> . <urn:x> a a.b:T ; a.b:p true , 007 .\n"),
    "an integer of 5,000 digits": _put(r"\Z", f"<urn:x> <urn:p> {'9' * 5_000} .\n"),
}  # fmt: skip


@dataclass
class Counted:
    """What has come of the changes of one kind."""

    changes: int = 0
    found: int = 0
    placed: int = 0
    alarms: int = 0
    slowest: float = 0.0
    missed: list[str] = field(default_factory=list)


def good_files() -> list[str]:
    """Texts of which `validate` says nothing."""
    texts = [HEAD + "".join(advertisement(number) for number in range(start, start + 3)) for start in (0, 3, 6, 10)]
    examples = [path.read_text("utf-8") for path in sorted(EXAMPLES.rglob("*.ttl"))]
    return [text for text in (*texts, *examples) if not _problems(text)]


def _problems(text: str) -> list[tuple[str, int, int]]:
    """The problems of a text: code, line and column of each."""
    source = SourceText("x.ttl", text.encode(), "file:///x/x.ttl")
    given = [
        [SourceText(path.name, path.read_bytes()) for path in found()] for found in (library.shapes, library.ontologies)
    ]
    home = SourceText("home.ttl", (library.ontologies()[0].parent / "peis-home.ttl").read_bytes())
    report = validate_texts([source], given[0], [*given[1], home])
    return [(found.code, found.line, found.column) for found in report.diagnostics]


def measured(number: int, seed: int) -> dict[str, Counted]:
    """So many changes of each kind, counted."""
    chance, texts = random.Random(seed), good_files()
    counted = {name: Counted() for name in (*MISTAKES, *HARMLESS)}
    for name, change in (*MISTAKES.items(), *HARMLESS.items()):
        one = counted[name]
        for _ in range(number):
            changed = next(filter(None, (change(chance.choice(texts), chance) for _ in range(100))), None)
            if changed is None:
                break
            began = time.process_time()
            problems = _problems(changed.text)
            one.slowest = max(one.slowest, time.process_time() - began)
            one.changes += 1
            before = changed.text[: changed.offset]
            line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
            told = [problem for problem in problems if problem[0] in changed.codes]
            one.found += bool(told)
            # A parser notices what is missing at the next token, which may stand on the line below.
            below = 2 if changed.codes == SYNTAX else 0
            one.placed += any(line <= at <= line + below for _, at, _ in told)
            one.alarms += len(problems) if not changed.codes else 0
            if (changed.codes and not told) or (problems and not changed.codes):
                one.missed.append(f"{line}:{column} {problems} {changed.text[max(0, changed.offset - 40) :][:80]!r}")
    return counted


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table; 1 where a goal is missed."""
    parser = argparse.ArgumentParser(description="mistakes made on purpose, and what validate finds of them")
    parser.add_argument("--number", type=int, default=30, help="changes of each kind (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=0, help="which changes (default: %(default)s)")
    parser.add_argument("--smoke", action="store_true", help="one change of each kind, to see that it runs")
    parser.add_argument("--show", action="store_true", help="also print each mistake that is missed, and false alarm")
    given = parser.parse_args(arguments)
    counted = measured(1 if given.smoke else given.number, given.seed)
    wrong, fine = [counted[name] for name in MISTAKES], [counted[name] for name in HARMLESS]
    mistakes, alarms = sum(one.changes for one in wrong), sum(one.alarms for one in fine)
    recall = sum(one.found for one in wrong) / mistakes
    place = sum(one.placed for one in wrong) / mistakes
    slowest = max(one.slowest for one in counted.values())
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss << 10
    print(
        f"{mistakes} mistakes: {100 * recall:.1f} % found, {100 * place:.1f} % in their line; "
        f"{sum(one.changes for one in fine)} changes that mean nothing: {alarms} false alarms; "
        f"at most {slowest:.2f} s for a file, {memory >> 20} MiB for all."
    )
    head = ("change", "made", "found", "in its line", "false alarms", "seconds at most")
    rows = []
    for name, one in counted.items():
        said = (one.found, one.placed, "") if name in MISTAKES else ("", "", one.alarms)
        rows.append([name, *map(str, (one.changes, *said)), f"{one.slowest:.2f}"])
    print(f"\n{table(head, rows)}\n\n{described('selfconf', 'pyshacl', 'rdflib', 'pyoxigraph')}")
    if given.show:
        print("\n".join(f"{name}: {said}" for name, one in counted.items() for said in one.missed), file=sys.stderr)
    missed = recall < RECALL or place < PLACE or alarms or slowest > SECONDS or memory > MEMORY
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
