"""Hypothesis strategies for everything that travels."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

from selfconf.model.configuration import Wants
from selfconf.model.log_line import LogLine
from selfconf.model.term import IRI, BlankNode, Literal
from selfconf.protocol.messages import (
    Access,
    Apply,
    CallAnswer,
    Cause,
    End,
    Fail,
    Free,
    Introduction,
    Known,
    LogPart,
    LogQuestion,
    Moved,
    Notice,
    Page,
    RecordedLoss,
    RefusedAttempt,
    Release,
    Reserve,
    SignalEncoding,
    Stamp,
    StateOf,
    Status,
    TaskRecord,
    Verdict,
    Wake,
    Wire,
)

characters = st.characters(exclude_categories=["Cs", "Cc", "Cf", "Zl", "Zp"])
texts = st.text(characters, max_size=20)
names = st.text(characters, min_size=1, max_size=20)
identities = st.from_regex(r"[A-Za-z0-9][A-Za-z0-9._-]{0,20}~[A-Za-z0-9][A-Za-z0-9._-]{0,20}", fullmatch=True)
iris = st.builds(lambda tail: IRI.unchecked(f"https://example.org/{tail}"), texts)
numbers = st.integers(min_value=0, max_value=1 << 62)
seconds = st.floats(allow_nan=False, allow_infinity=False)
supervisors = st.builds(
    lambda name, life: f"selfconf/home/conf/{name}/live/{life}",
    st.from_regex(r"[a-z][a-z0-9]{0,8}", fullmatch=True),
    st.from_regex(r"[0-9a-f]{8}", fullmatch=True),
)
literals = st.one_of(
    st.builds(Literal, texts),
    st.builds(Literal, texts, iris),
    st.builds(
        Literal,
        texts,
        st.just(IRI("http://www.w3.org/1999/02/22-rdf-syntax-ns#langString")),
        st.sampled_from(["en", "sv", "it"]),
    ),
)
terms = st.one_of(iris, st.builds(lambda label: BlankNode(f"_:{label}"), texts), literals)
wires = st.builds(Wire, iris, names, st.none() | st.floats(min_value=1e-3, max_value=1e6))
inputs = st.dictionaries(names, st.lists(wires, max_size=3).map(tuple), max_size=3)
callers = st.dictionaries(names, st.lists(iris, max_size=3).map(tuple), max_size=3)
plain: st.SearchStrategy[Any] = st.recursive(
    st.none() | st.booleans() | numbers | texts,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(texts, inner, max_size=3),
    max_leaves=4,
)
values = st.dictionaries(names, terms, max_size=3)
all_wants = st.builds(
    Wants,
    st.frozensets(st.tuples(names, iris, names), max_size=2),
    values.map(lambda some: frozenset(some.items())),
)
log_lines = st.builds(LogLine, texts, texts, st.lists(iris, max_size=2).map(tuple), texts)
claim: dict[str, st.SearchStrategy[Any]] = {
    "epoch": numbers,
    "supervisor": supervisors,
    "task": texts,
    "life": texts,
    "priority": st.integers(-(1 << 62), 1 << 62),
    "beginning": seconds,
}
"""What every call says."""
by_kind: dict[type, st.SearchStrategy[Any]] = {
    Reserve: st.builds(Reserve, **claim, inputs=inputs, values=values, waits=st.booleans()),
    Apply: st.builds(Apply, **claim, inputs=inputs, standby=inputs, values=values, callers=callers),
    Release: st.builds(Release, **claim),
    StateOf: st.builds(StateOf, texts),
    Notice: st.builds(Notice, names, numbers, texts, st.dictionaries(texts, plain, max_size=3)),
    CallAnswer: st.builds(
        CallAnswer,
        st.sampled_from(Verdict),
        iris,
        texts,
        numbers,
        st.booleans(),
        texts,
        texts,
        texts,
        claim["priority"],
        seconds,
        texts,
        numbers,
        seconds,
        numbers,
        st.dictionaries(texts, numbers, max_size=3),
        inputs,
        callers,
        seconds,
    ),
    Fail: st.builds(Fail, iris, texts, numbers, st.sampled_from(Cause), texts),
    Free: st.builds(Free, iris, texts, texts),
    Introduction: st.builds(Introduction, texts, st.booleans()),
    Access: st.builds(Access, texts, texts, *[st.lists(names, max_size=2).map(tuple)] * 4),
    RefusedAttempt: st.builds(RefusedAttempt, texts, texts, texts, numbers, seconds),
    Moved: st.builds(Moved, iris, texts, inputs, callers),
    Known: st.builds(Known, st.dictionaries(names, numbers, max_size=3)),
    LogQuestion: st.builds(LogQuestion, texts, numbers, texts),
    LogPart: st.builds(LogPart, st.lists(log_lines, max_size=3).map(tuple), texts, st.booleans()),
    Wake: st.builds(Wake, iris, names),
    End: st.builds(End, iris, texts),
    Page: st.builds(
        Page, numbers, numbers, numbers, st.none() | iris, texts, st.booleans(), texts, st.booleans(), texts
    ),
    Stamp: st.builds(
        Stamp,
        iris,
        texts,
        numbers,
        seconds,
        st.builds(SignalEncoding, texts, texts, st.lists(st.integers(0, 1 << 40), max_size=3).map(tuple)),
    ),
    Status: st.builds(
        Status,
        texts,
        texts,
        iris,
        numbers,
        seconds,
        texts,
        numbers,
        st.lists(iris, max_size=3).map(tuple),
        st.dictionaries(texts, plain, max_size=2),
        texts,
        claim["priority"],
        seconds,
        st.lists(iris, max_size=3).map(tuple),
        st.dictionaries(texts, numbers, max_size=2),
        st.none() | iris,
        st.dictionaries(iris, all_wants, max_size=2),
    ),
    TaskRecord: st.builds(
        TaskRecord,
        identities,
        numbers,
        st.booleans(),
        claim["priority"],
        seconds,
        texts,
        texts,
        texts,
        values,
        st.lists(texts, max_size=2).map(tuple),
        st.dictionaries(texts, plain, max_size=2),
        numbers,
        st.dictionaries(texts, plain, max_size=2),
        st.lists(st.builds(RecordedLoss, iris, texts, st.sampled_from(Cause), texts), max_size=2).map(tuple),
    ),
}
"""For each kind of message, any one of it."""
messages = st.one_of(*by_kind.values())
