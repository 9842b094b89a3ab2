"""Cutting a document into pieces makes of it what reading it whole makes of it, or leaves it to that."""

from __future__ import annotations

import contextlib
import time

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from selfconf.errors import TurtleError
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import statement_table
from selfconf.rdf.advertisements.segments import NEW_SEGMENTS, WINDOW, SegmentCache, inlined_document
from selfconf.rdf.turtle import document as turtle
from tests.lab import PREFIXES
from tests.rdf.advertisements.test_loader import GOOD, documents, shape_of

BASE = "file:///folder/a.ttl"
SNIPPETS = st.sampled_from(
    (
        ";", " ;", ".", " . ", " .\n", ",", "[", "]", "(", ")", '"', "'", '"""', "'''", "#", "# x ; y .\n", "\n",
        "\r", " ", "\\", "\\;", "<", ">", "<#me>", "<x:y>", "^^", "@en", "@prefix : <urn:x:> .\n", ":a", "a",
        "PREFIX : <urn:y:>\n", "5.", ".5", "1.e3", "true", "é", "'a;b'", '"a.\\" ; b"', '"""a" ; """', ":p.q", "_",
        "<urn:a;b.c>", "[ :p [ :q [ :r [ ] ] ] ]", ":p.q:r", '"s".:r', ".PREFIX : <urn:z:>", "%20", "<<", "\x00",
        ":a :b :c .", "@base <urn:b:> .",
    )
)  # fmt: skip


@st.composite
def mangled(draw: st.DrawFn) -> str:
    """Documents, most of them no Turtle any more."""
    text = draw(documents())
    for _ in range(draw(st.integers(0, 3))):
        at = draw(st.integers(len(PREFIXES) // 2, len(text)))
        text = text[:at] + draw(SNIPPETS) + text[at + draw(st.integers(0, 2)) :]
    return text


def whole(text: str) -> object:
    """What a document says: its named subjects in order, and its triples; or an error with its place."""
    try:
        document = turtle.parse(text.encode(), "a.ttl", BASE)
    except TurtleError as error:
        return str(error)
    return [f"<{s}>" for s in document.statements if isinstance(s, IRI)], shape_of(tuple(document.triples()))


def cut(text: str, known: SegmentCache) -> object:
    """The same from its pieces; None where only the careful reader can tell."""
    try:
        found = inlined_document(text.encode(), "a.ttl", BASE, known)
    except TurtleError as error:
        return str(error)
    if found is None:
        return None
    written = "".join(
        f"{s} {statement_table.NEXT.join(c.text for c in said)}{statement_table.END}" for s, said in found.items()
    )
    return list(found), shape_of(tuple(turtle.parse(written, "").triples()))


@given(mangled())
@example(PREFIXES + f":c1 {GOOD} . PREFIX : <urn:other:> :c1 {GOOD} .")
@example(PREFIXES + f":c1 {GOOD} . @prefix : <urn:other:> . :c1 {GOOD} .")
@example(PREFIXES + f':c1 {GOOD} ; :p "s".PREFIX : <urn:x:> :c2 {GOOD} .')
@example(PREFIXES + f':c1 {GOOD} ; :p """ ; :c2 . """ , \'\'\'a\n; "\'\'\' , "" , "#" ; :q 5. :c2 {GOOD} ; :n 0.5 .')
@example(PREFIXES + f":c1 {GOOD} ; # a ; b .\n :p 1 ;; . # c\n:c2 {GOOD} ;\n. <#c3> {GOOD} .")
@example(PREFIXES + f"<http://a/b/../c> {GOOD} . <x> {GOOD} . :c.1 {GOOD} . :c%20 {GOOD} . :é {GOOD} . : {GOOD} .")
@example(PREFIXES + f":c1 {GOOD} ; :p <#here>, <urn:a;b.c#d>, [ :q ')' ; :r '''.''' ] . :c1 :more 1 .")
@example(PREFIXES + f":c1 ; {GOOD} .")
@example(PREFIXES + ":c1 .")
@example(PREFIXES + f":c1 {GOOD} ; :p :x.")
@example(f"# a ; b\n{PREFIXES}\n# c .\n:c1 {GOOD} . # end")
@example(PREFIXES + "<urn:selfconf:segment:0> a :T . :x a :T .")
@example(PREFIXES + f':c1 {GOOD} .\n<urn:p>"s" ; :q 1 .')
@example(PREFIXES + ":c1 a [ :n 1 ], sc:Component ; a :T .\n")
def test_cutting_makes_of_a_document_what_reading_it_whole_makes_of_it(text: str) -> None:
    known = SegmentCache()
    for found in (cut(text, known), cut(text, known)):  # what was learnt the first time is used the second
        assert found is None or found == whole(text)


def test_what_has_been_read_once_is_not_read_again() -> None:
    known = SegmentCache()
    for number in range(3):
        text = f"# file {number}\n{PREFIXES}\n:c{number} {GOOD} ; :serial {number % 2} ."
        inlined_document(text.encode(), f"{number}.ttl", f"file:///{number}.ttl", known)
    assert (known.seen, known.new) == (9, 4)


def test_where_most_is_new_documents_are_read_whole() -> None:
    known = SegmentCache()
    text = PREFIXES + "".join(
        f":c{number} {GOOD} ; :serial '{number}' ; :label 'c{number}' .\n" for number in range(NEW_SEGMENTS)
    )
    found = inlined_document(text.encode(), "a.ttl", None, known)
    assert found is not None
    assert len(found) == NEW_SEGMENTS
    assert not known.pays


@pytest.mark.parametrize(("longest", "segments"), [(WINDOW, 0), (8 * WINDOW, 5)])
def test_a_document_with_a_sentence_that_is_too_long_is_read_whole(
    longest: int, segments: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("selfconf.rdf.advertisements.segments.LONGEST", longest)
    known, long = SegmentCache(), "a" * 5 * WINDOW
    found = inlined_document(f'{PREFIXES}:c1 {GOOD} ; :label "{long}" . :c2 {GOOD} .'.encode(), "a.ttl", None, known)
    assert found is not None
    assert len(found) == 2
    assert known.seen == segments


def test_relative_names_mean_something_else_in_each_file() -> None:
    known, text = SegmentCache(), f"{PREFIXES}@prefix here: <#> . here:c {GOOD} ; :near here:d , <e> ."
    for name in ("one", "two"):
        found = inlined_document(text.encode(), name, f"file:///{name}", known)
        assert found is not None
        ((subject, said),) = found.items()
        assert subject == f"<file:///{name}#c>"
        assert said[-1].text.endswith(f"<file:///{name}#d> , <file:///e>")


@pytest.mark.parametrize(
    "text",
    ["[" * 50_000, '"""' + "a" * 100_000, "'\\" * 50_000, "[ :p " * 30_000, "<" * 90_000, ":T ; :p :" + "1a" * 50_000,
     ":T ; :p <urn:" + "1/" * 50_000 + "> .", ":T ; :p <http://a/" + "1" * 90_000 + "> .", ':T ; :p "' + '""' * 40_000,
     ":T" + " ; :p _:x" * 10_000 + " .", ":T ; :p ( " + "1 " * 40_000 + ") .", ":T ; :p ( " + "( " * 40_000,
     ":T .\n" + " " * 90_000 + "x", ":T .\n" + "\n" * 90_000 + "x", ":T .\n" + "# #\n" * 20_000 + "x"],
)  # fmt: skip
def test_cutting_takes_no_longer_for_what_is_hostile(text: str) -> None:
    began = time.process_time()
    with contextlib.suppress(TurtleError):
        inlined_document(f"{PREFIXES}:c a {text}".encode(), "a.ttl", BASE, SegmentCache())
    assert time.process_time() - began < 2
