"""Inlining: documents of Turtle as statements, with what is said of a blank node inside the statement that leads to it.

Making an object of every triple costs more than parsing it. So Oxigraph's parser is connected to Oxigraph's own
serialiser, a few hundred triples at a time, and what comes out is text in one layout only: a line for each predicate of
a subject, which is a statement (`selfconf.rdf.advertisements.statement_table`).

Blank nodes become part of the statement that leads to them: `sc:hasInput [ sc:name "pose" ; ... ]`, as their author
wrote them. That is sound where exactly one statement leads to each blank node: where it is written in brackets or as a
list, and of those with labels, where no other statement has the label (`labelled`). Else labels become names before
(`selfconf.rdf.advertisements.segments`).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import islice

import pyoxigraph as ox

from selfconf.rdf import turtle
from selfconf.rdf.advertisements.statement_table import END, NotInlinableError, Statement, StatementTable, bracketed
from selfconf.rdf.permitted_fields import NEXT
from selfconf.rdf.vocabulary import FIRST, NIL, REST

CHUNK_TRIPLES = 512
"""Triples that are written at a time: the text of so many stays in the processor's cache."""
_DEPTH = 30
"""How deep blank nodes may lie in blank nodes, where these are not written one after the other."""
_CELL = [f"<{FIRST}>", f"<{REST}>"]
_TAKEN: list[str] = []
"""In the place of what is said of a blank node, once that is part of a statement."""
_TRIPLE = re.compile(rb"(?:<[^<>]*>|_:\S+) <[^<>]*> [^\n]* \.\r?\n")
"""A line of N-Triples, which is Turtle that takes a quarter less time to parse."""
_OBJECT = re.compile(r'<[^<>]*>|"(?:[^"\\]|\\.)*"(?:@[A-Za-z0-9-]+|\^\^<[^<>]*>)?|[^\s",<>]+')


def inlined(
    text: bytes, source: str, base: str | None, statements: StatementTable
) -> dict[str, list[Statement]] | None:
    """What a document without labels of blank nodes says of each named subject, blank nodes inlined.

    None where that cannot be done: blank nodes that no statement leads to, or that are components. Raises TurtleError.
    """
    try:
        try:
            subjects = _while_reading(text, base, statements)
        except NotInlinableError:
            subjects = None
        if subjects is not None:
            return subjects
        return _afterwards(ox.parse(text, format=ox.RdfFormat.TURTLE, base_iri=base), statements)
    except (SyntaxError, MemoryError) as error:
        raise turtle.not_turtle(error, source, text) from None
    except NotInlinableError:
        return None


# complexity: this loop is most of what loading costs; a call for each of its branches would add a tenth
def _while_reading(text: bytes, base: str | None, statements: StatementTable) -> dict[str, list[Statement]] | None:
    """Inline while reading; None where what brackets say does not come just before or after them, as in lists."""
    triples = ox.parse(text, format=ox.RdfFormat.TURTLE, base_iri=base)
    subjects: dict[str, list[Statement]] = {}
    nodes: dict[str, str] = {}
    known, take = statements.get, nodes.pop
    said: list[Statement] = []
    add, last = said.append, ""
    predicate = node = content = ""
    # Every microsecond in this loop is one twentieth of what an advertisement costs.
    while segment := ox.serialize(islice(triples, CHUNK_TRIPLES), format=ox.RdfFormat.TURTLE):
        for lines in segment[: -len(END)].decode().split(END):
            subject, _, rest = lines.partition(" ")
            if subject != last:
                if subject[0] == "_":
                    if "_:" in rest:
                        rest = NEXT.join([_with_brackets(line, take) for line in rest.split(NEXT)])
                    if subject == node:  # a string at the end of the brackets comes after them
                        content = f"{content}{NEXT}{rest}" if content else rest
                        line = f"{predicate} [ {content} ]"
                        said[-1] = known(line) or statements[line]
                    else:
                        nodes[subject] = f"{nodes[subject]}{NEXT}{rest}" if subject in nodes else rest
                    continue
                last = subject
                said = subjects[subject] if subject in subjects else subjects.setdefault(subject, [])
                add = said.append
            for line in rest.split(NEXT):
                statement = known(line)
                if statement is None:
                    if "_:" in line and _leads(line):
                        predicate, _, node = line.partition(" ")
                        content = take(node, "")
                        line = f"{predicate} [ {content} ]"
                        statement = known(line)
                    if statement is None:
                        statement = statements[line]
                add(statement)
    return None if nodes else subjects


def _leads(line: str) -> bool:
    """Whether the object of a statement is a blank node. Raises NotInlinableError if it has others besides."""
    said = line[line.index(" ") + 1 :]
    if said.startswith("_:") and " " not in said:
        return True
    if any(found.startswith("_:") for found in _OBJECT.findall(said)):
        raise NotInlinableError
    return False


def _with_brackets(line: str, take: Callable[[str], str]) -> str:
    """A statement about a blank node, with what its own blank node says in brackets."""
    if "_:" not in line or not _leads(line):
        return line
    predicate, _, node = line.partition(" ")
    try:
        return f"{predicate} [ {take(node)} ]"
    except KeyError:
        raise NotInlinableError from None


def labelled(text: bytes, base: str | None, statements: StatementTable) -> dict[str, list[Statement]] | None:
    """What a document says of each named subject, whose blank nodes may have labels, and be described anywhere.

    None where a blank node is that of two statements, where one is a component, or where the text is no Turtle.
    """
    for form in (ox.RdfFormat.N_TRIPLES, ox.RdfFormat.TURTLE) if _TRIPLE.match(text) else (ox.RdfFormat.TURTLE,):
        try:
            return _afterwards(ox.parse(text, format=form, base_iri=base), statements)
        except NotInlinableError:
            return None
        except (SyntaxError, MemoryError):
            pass  # it may be Turtle that begins like N-Triples; or else the careful reader says where it is wrong
    return None


# complexity: the loop over all statements of documents with labels; calls in it would add a fifth
def _afterwards(triples: ox.QuadParser, statements: StatementTable) -> dict[str, list[Statement]]:
    """Inline once all is read, with lists, and each blank node of several objects in a statement of its own."""
    lines: dict[str, list[str]] = {}
    get = lines.get
    while segment := ox.serialize(islice(triples, CHUNK_TRIPLES), format=ox.RdfFormat.TURTLE):
        for block in segment[: -len(END)].decode().split(END):
            subject, _, rest = block.partition(" ")
            said = get(subject)
            if said is None:
                lines[subject] = [rest]
            else:
                said.append(rest)
    names = [subject for subject in lines if subject[0] != "_"]
    known = statements.get
    subjects: dict[str, list[Statement]] = {}
    for name in names:
        subjects[name] = found = []
        for line in NEXT.join(lines.pop(name)).split(NEXT):
            if "_:" in line:
                predicate, _, node = line.partition(" ")
                inner = NEXT.join(get(node, ()))
                if not inner or "_:" in inner or _CELL[0] in inner:
                    found += [statements[each] for each in _nested([line], lines, 0)]
                    continue
                lines[node] = _TAKEN
                line = f"{predicate} [ {inner} ]"
            found.append(known(line) or statements[line])
    if any(said is not _TAKEN for said in lines.values()):
        raise NotInlinableError
    return subjects


def _nested(said: Iterable[str], lines: dict[str, list[str]], depth: int) -> Iterator[str]:
    """Statements with what is said of blank nodes in the place of these, which are taken from `lines`, once."""
    if depth > _DEPTH:
        raise NotInlinableError
    for line in said:
        predicate, _, objects = line.partition(" ")
        if "_:" not in objects:
            yield line
            continue
        for found in _OBJECT.findall(objects):
            yield f"{predicate} {_written(found, lines, depth)}"


def _written(found: str, lines: dict[str, list[str]], depth: int) -> str:
    """An object; a blank node as a list, where it is the first cell of one, or in brackets."""
    if not found.startswith("_:"):
        return found
    members: list[str] = []
    at = found
    while [part.partition(" ")[0] for part in sorted(_said_of(at, lines))] == _CELL:
        first, rest = sorted(_take(at, lines))
        (member,) = _nested([first], lines, depth + 1)
        members.append(member.partition(" ")[2])
        at = rest.partition(" ")[2]
    if not members:
        return bracketed("", _nested(_take(at, lines), lines, depth + 1)).lstrip()
    if at != f"<{NIL}>":
        raise NotInlinableError
    return f"( {' '.join(members)} )"


def _take(node: str, lines: dict[str, list[str]]) -> list[str]:
    """What is said of a blank node. Raises NotInlinableError if another statement has led to it already."""
    if lines.get(node) is _TAKEN:
        raise NotInlinableError
    said = _said_of(node, lines)
    lines[node] = _TAKEN
    return said


def _said_of(node: str, lines: Mapping[str, list[str]]) -> list[str]:
    """The lines about a blank node, of which several may be together."""
    said = lines.get(node)
    return [] if said is None else NEXT.join(said).split(NEXT)
