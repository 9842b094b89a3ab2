"""Turtle from strangers: reading, validating and judging it opens no file and no socket, and comes to an end."""

from __future__ import annotations

import socket
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from selfconf import entailment, library, partition, read, template
from selfconf.api.validation import LARGEST_FILE
from selfconf.bus.port import LARGEST_REPLIES
from selfconf.deployment import task_folder
from selfconf.discovery import ecology_view, inquiry
from selfconf.errors import AuthorError, QueryError
from selfconf.model.codes import PREAMBLE
from selfconf.model.diagnostic import Report
from selfconf.model.profile import LONGEST_PORT_NAME
from selfconf.model.wording import LONGEST_REMARK
from selfconf.protocol import activation, codec, json_values, task_queue
from selfconf.query import process as asking
from selfconf.query.endpoint import ENDPOINT_PATIENCE
from selfconf.rdf import conformance as shacl
from selfconf.rdf.advertisements import accepted_shapes
from selfconf.rdf.advertisements import reader as advertisements
from selfconf.rdf.eligibility import acceptance
from selfconf.rdf.eligibility.partitioner import Partitioner
from selfconf.rdf.permitted_fields import DEEPEST_SHAPE
from selfconf.rdf.shacl import patterns
from selfconf.rdf.sparql import read_only as queries
from selfconf.rdf.sparql.dataset import Dataset
from selfconf.rdf.tasks import bindings, templates
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.turtle import formats
from selfconf.rdf.validation import checking, file_check
from selfconf.rdf.validation.checking import SourceText, validate_texts
from selfconf.sdk import operations, payloads
from selfconf.sdk.inputs import signal_order
from selfconf.sdk.runtime import runtime
from tests.harness.effort import thorough
from tests.hostile_words import HONEST, KINDS, stranger
from tests.hostile_words import TEMPLATE as TEMPLATE_FOR_STRANGERS

SHAPES = [SourceText(path.name, path.read_bytes()) for path in library.shapes()]
ONTOLOGIES = [SourceText(path.name, path.read_bytes()) for path in library.ontologies()]
TUNER = ":tuner a sc:Component, rob:Tuner .\n"
TEMPLATE = ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class rob:Tuner .\n"
ACTS = ("open", "os.listdir", "os.scandir", "subprocess.Popen", "os.system", "urllib.Request", "ftplib.connect")
seen: list[str] | None = None


def _watch(event: str, arguments: tuple[object, ...]) -> None:
    if seen is not None and (event in ACTS or event.startswith("socket.")):
        seen.append(f"{event} {arguments[:1]}")


sys.addaudithook(_watch)  # for good: an audit hook cannot be taken away


@contextmanager
def nothing_opened() -> Iterator[None]:
    """Fails if the block opens a file or a socket, whoever does it; what it has to import is there already."""
    global seen
    seen = []
    try:
        yield
        assert not seen
    finally:
        seen = None


@pytest.fixture
def trap(tmp_path: Path) -> Iterator[tuple[str, str]]:
    """The IRIs of a file and of a server that nobody may touch."""
    file = tmp_path / "secret.ttl"
    file.write_text("<urn:secret> <urn:is> <urn:out> .")
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.setblocking(False)
        yield file.as_uri(), f"http://127.0.0.1:{server.getsockname()[1]}/x.ttl"
        assert not [said for said in heard(server) if b"x.ttl" in said]


def heard(server: socket.socket) -> Iterator[bytes]:
    """What those said first who have connected: programs of other tests may look for one that had this port before."""
    with suppress(BlockingIOError):
        while True:
            with server.accept()[0] as connection, suppress(OSError):
                connection.settimeout(1)
                yield connection.recv(4096)


def check(text: str) -> Report:
    return validate_texts([SourceText("a.ttl", (PREAMBLE + text).encode())], SHAPES, ONTOLOGIES)


def judge(template: str, advertisement: str = TUNER) -> tuple[int, ...]:
    """How many components are eligible for each role."""
    task = bindings.complete(templates.read_task(turtle.parse(PREAMBLE + template, "t.ttl", "file:///")))
    found, _ = advertisements.read_document(turtle.parse(PREAMBLE + advertisement, "a.ttl", "file:///"))
    return tuple(len(role) for role in Partitioner(task).partition(found).candidates)


HOSTILE = [
    "<urn:o> a owl:Ontology ; owl:imports <{file}> , <{web}> .",
    ":tuner owl:imports <{file}> , <{web}> ; sh:shapesGraph <{web}> ; rdfs:seeAlso <{file}> .",
    "@base <{web}> . <> sh:shapesGraph <{file}> ; sh:entailment <{web}> .",
    ":tuner sc:grounding [ sc:command 'touch {file}' ] .",
    ':tuner :note \'{{ "@context": "{web}" }}\' .',
    ":x a sh:NodeShape ; sh:targetClass sc:Component ; sh:js [ sh:jsLibrary [ sh:jsLibraryURL <{web}> ] ] .",
]
QUERIES = [
    "SELECT $this FROM <{file}> WHERE {{ $this ?p ?o }}",
    "SELECT $this FROM <{web}> WHERE {{ $this ?p ?o }}",
    "SELECT $this FROM NAMED <{file}> WHERE {{ $this a ?t GRAPH ?g {{ ?s ?p ?o }} }}",
    "SELECT $this WHERE {{ $this a ?t . GRAPH <{file}> {{ ?s ?p ?o }} }}",
    "SELECT $this WHERE {{ $this a ?t . SERVICE <{web}> {{ ?s ?p ?o }} }}",
    "SELECT $this WHERE {{ $this a ?t . SERVICE SILENT <{web}> {{ ?s ?p ?o }} }}",
    "SELECT $this WHERE {{ $this a ?t . ser\\\\u0076ice <{web}> {{ ?s ?p ?o }} }}",
]
BEYOND = ":r sh:sparql [ sh:select '''{query}''' ] ."


@pytest.fixture(autouse=True)
def warm() -> None:
    """Whatever is imported late, and whatever is read once, is there before anybody watches."""
    check(TUNER + TEMPLATE + BEYOND.format(query="SELECT $this WHERE { $this a sc:Input }"))
    judge(TEMPLATE + BEYOND.format(query="SELECT $this WHERE { $this a <urn:x> }"))


@pytest.mark.parametrize("text", HOSTILE)
def test_hostile_turtle_opens_nothing(text: str, trap: tuple[str, str]) -> None:
    hostile = text.format(file=trap[0], web=trap[1]) + TUNER
    with nothing_opened():
        check(hostile)
        check(TEMPLATE + hostile)
        assert judge(TEMPLATE, hostile) == (1,)
        judge(TEMPLATE + ":r sh:pattern '.' ." + hostile)


@pytest.mark.parametrize("query", QUERIES)
def test_the_query_of_a_role_opens_nothing(query: str, trap: tuple[str, str]) -> None:
    template = TEMPLATE + BEYOND.format(query=query.format(file=trap[0], web=trap[1]))
    with nothing_opened():
        assert {found.code for found in check(template).diagnostics} <= {"SC-T13"}
        with suppress(AuthorError):
            judge(template)


@pytest.mark.parametrize("query", [*QUERIES, "LOAD <{file}>", "SELECT * FROM <{file}> WHERE {{ ?s ?p ?o }}"])
def test_a_query_to_the_ecology_reads_nothing_else(query: str, trap: tuple[str, str]) -> None:
    dataset = Dataset()
    dataset.add_advertisements(advertisements.read_document(turtle.parse(PREAMBLE + TUNER, "a.ttl"))[0])
    with nothing_opened():
        try:
            answer = dataset.query(query.replace("$this", "?this").format(file=trap[0], web=trap[1]))
            assert "secret" not in "".join(map(str, answer))
        except QueryError:
            pass


def test_an_advertisement_cannot_bring_shapes_or_axioms_along() -> None:
    smuggled = """
:tuner a sh:NodeShape ; sh:targetClass rob:Tuner ; sh:in () ; rdfs:subClassOf rob:Speaker ; :near :speaker .
:speaker a sc:Component, rob:Speaker ; owl:sameAs :tuner ; sh:closed true .
rob:Tuner rdfs:subClassOf sc:Template ; owl:equivalentClass rob:Speaker .
rob:Tuner sh:property [ sh:path rdf:type ; sh:maxCount 0 ] .
rob:place rdfs:subPropertyOf rdf:type . :r sh:in () .
"""
    found, _ = advertisements.read_document(turtle.parse(PREAMBLE + TUNER + smuggled, "a.ttl"))
    said = {(str(predicate), str(value)) for one in found for _, predicate, value in one.triples}
    assert not [pair for pair in said if any("shacl#" in part or "owl#" in part for part in pair)]
    assert not [pair for pair in said if "subClassOf" in pair[0] or "subPropertyOf" in pair[0]]
    beyond = TEMPLATE + ":r sh:nodeKind sh:IRI ; sh:not [ sh:class sc:Template ] ."
    assert judge(beyond, TUNER + smuggled) == judge(beyond) == (1,)
    assert judge(beyond, TUNER + smuggled + ":radio a sc:Component, rob:Tuner .") == (2,)


CATASTROPHE = ":r sh:property [ sh:path rdfs:label ; sh:pattern '^(a+)+$' ] ."
LABEL = "<http://www.w3.org/2000/01/rdf-schema#label>"
SLOW_QUERY = f":r sh:sparql [ sh:select '''SELECT $this {{ $this {LABEL} ?l FILTER regex(?l, '^(a+)+$') }}''' ] ."
VICTIM = TUNER + f":tuner rdfs:label '{'a' * 40}!' ."


@pytest.mark.parametrize("more", [CATASTROPHE, SLOW_QUERY], ids=["pattern", "query"])
def test_a_catastrophic_pattern_is_judged_as_any_other(more: str) -> None:
    matching = VICTIM.replace("!", "")
    expected = [(0,), (1,)] if more is CATASTROPHE else [(1,), (0,)]  # a query finds what violates
    assert [judge(TEMPLATE + more, said) for said in (VICTIM, matching)] == expected


def processor_seconds(*advertisements: str) -> tuple[list[list[str]], list[str], float]:
    """Who is eligible for each role of the hostile task, who is left out, and how long that takes."""
    task = template(TEMPLATE_FOR_STRANGERS)
    began = time.process_time()
    found = partition(task, read(*advertisements))
    seconds = time.process_time() - began
    eligible = [[component.short for component in found[role].eligible] for role in found]
    return eligible, [one.component for one in found.inquiry.left_out], seconds


@thorough
@pytest.mark.slow
def test_a_thousand_hostile_advertisements_change_no_answer_and_cost_seconds_at_most() -> None:
    strangers = [stranger(kind, number) for kind in KINDS for number in range(100)]
    processor_seconds(HONEST)  # loads what is loaded once
    alone, none, before = processor_seconds(HONEST)
    eligible, left_out, after = processor_seconds(HONEST, *strangers)
    assert eligible == alone == [["cam-1", "cam-2"], ["ear-1", "ear-2"], ["arm-1", "arm-2"], ["screen"]]
    assert none == []
    assert len(left_out) == len(set(left_out)) == 200  # those beyond regular languages, and those in crowds
    assert after - before < 3  # some 0.9 s; a single one of them once took years


@pytest.mark.parametrize("kind", KINDS)
def test_each_kind_of_stranger_is_kept_out_alone(kind: str) -> None:
    eligible, left_out, _ = processor_seconds(HONEST, stranger(kind, 1))
    assert eligible == [["cam-1", "cam-2"], ["ear-1", "ear-2"], ["arm-1", "arm-2"], ["screen"]]
    assert len(left_out) == (kind in ("beyond", "crowd"))


def test_a_file_that_takes_too_long_ends_in_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(file_check, "FILE_SECONDS", 0.3)
    triples = "\n".join(f":x{n} sh:nodeKind :y{n} ." for n in range(20_000))
    report = check(triples)
    assert [found.code for found in report.diagnostics] == ["SC-S05"]
    assert report.unreadable == {"a.ttl"}


def test_a_file_with_a_problem_and_too_many_statements_is_refused_before_it_is_checked(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(checking, "MOST_STATEMENTS", 50)
    monkeypatch.setattr(file_check, "problems_of", None)  # it is not asked
    (problem,) = check("\n".join(f":x{n} sh:nodeKind :y{n} ." for n in range(51))).diagnostics
    assert (problem.code, problem.line) == ("SC-S05", 1)
    assert "51 statements" in problem.message


@pytest.mark.parametrize(
    "text",
    [
        ":x sh:minCount 1 . :tuner :p " + "[ :p " * 5_000 + "1" + " ]" * 5_000 + " ; sc:name 1 .",
        ":x sh:minCount 1 . :tuner :p " + "( " * 5_000 + "1" + " )" * 5_000 + " ; sc:name 1 .",
    ],
    ids=["brackets", "lists"],
)
def test_a_deeply_nested_file_ends_in_an_error(text: str) -> None:
    assert "SC-S05" in {found.code for found in check(text).diagnostics}


@pytest.mark.parametrize("text", ["[ :p " * 5_000 + "1" + " ]" * 5_000, "( " * 5_000 + "1" + " )" * 5_000])
def test_a_deeply_nested_advertisement_is_read(text: str) -> None:
    assert judge(TEMPLATE, f":tuner a sc:Component, rob:Tuner ; :p {text} .") == (1,)


@pytest.mark.parametrize(
    "query",
    ["SELECT $this { $this :p " + "(" * 5_000 + "1" + ")" * 5_000 + "}", "SELECT $this { $this a 1 } #" + "x" * 50_000],
    ids=["nested", "long"],
)
def test_a_query_that_would_hold_up_the_engine_is_not_handed_to_it(query: str) -> None:
    found = check(TEMPLATE + BEYOND.format(query=query)).diagnostics
    assert [each.code for each in found] == ["SC-T13"]


LIMITS = (
    f"a file for `validate` | {LARGEST_FILE >> 20} MiB | SC-S05",
    f"{checking.MOST_STATEMENTS:,} | SC-S05",
    f"{file_check.FILE_SECONDS:g} s | SC-S05",
    f"{DEEPEST_SHAPE} deep, as pySHACL follows them",
    f"{accepted_shapes.LARGEST_SHAPE} statements, {DEEPEST_SHAPE} deep, literals of {accepted_shapes.LONGEST_LITERAL}",
    f"judging all shapes that inputs accept, in processor time | {acceptance.SECONDS:g} s",
    f"{queries.LONGEST_QUERY:,} characters, brackets {queries.DEEPEST_QUERY} deep",
    f"{patterns.PATTERN_SECONDS:g} s, {patterns.LONGEST_TRY:g} s for one value | a component is left out",
    f"{shacl.SHARE_SECONDS:g} s, or twice the time of the slowest component that conforms, if that is more",
    f"up to {shacl.MOST_SHARE_SECONDS:g} s; where the shape takes more than {shacl.SHARE_SECONDS / 4:g} s",
    f"{shacl.FAILURE_SECONDS:g} s for those left out, {shacl.SLOW_SECONDS:g} s for others",
    f"{shacl.SHAPE_SECONDS:g} s | `configure` names the shape",
    f"XML entities of one ontology; none may refer to another | {formats.LARGEST_GROWTH >> 20} MiB",
    f"{entailment.LIMIT:g} s, `SELFCONF_OWL_RL_SECONDS`",
    f"{asking.ANSWER_SECONDS:g} s, `--seconds`",
    f"{asking.MOST_ROWS:,}, `--rows`",
    f"{asking.MEMORY >> 30} GiB",
    f"`configure` or `partition` | {ENDPOINT_PATIENCE:g} s",
    f"the request and the response of a call | {operations.MOST_PAYLOAD >> 20} MiB",
    f"calls that wait for a component | {operations.MOST_CALLS} |",
    f"{inquiry.LARGEST_ADVERTISEMENT >> 20} MiB | it is left out",
    f"what one site advertises | {codec.MOST_ADVERTISED:,} components, {inquiry.LARGEST_SITE >> 20} MiB",
    f"complaints about the answer of one site | {inquiry.MOST_COMPLAINTS} |",
    f"all answers to one question | {LARGEST_REPLIES >> 20} MiB",
    f"{ecology_view.IN_A_ROW} in a row, then one every {ecology_view.BETWEEN_DISCOVERIES:g} s",
    f"lives of one component that are followed | {ecology_view.MOST_LIVES}, the least ones",
    f"a message of the control plane | {codec.LARGEST >> 20} MiB",
    f"outputs that a call lets a component follow | {json_values.MOST_WIRES:,} |",
    f"dimensions of an array in a signal | {json_values.MOST_DIMENSIONS} |",
    f"calls that wait for the code of a component | {runtime.MOST_PENDING} |",
    f"the name of a port, an operation or an operational parameter | {LONGEST_PORT_NAME:,} characters |",
    f"a signal of JSON | {payloads.LARGEST_JSON >> 20} MiB",
    f"a signal whose number is {signal_order.LATE:,} below",
    f"tasks that a site keeps | {task_folder.MOST_RECORDS:,} |",
    f"tasks that share a component, and tasks that wait for it | {activation.MOST_HOLDING} each",
)
"""What the page on limits says of the constants."""
WITHOUT_A_CONSTANT = ("about a thousand deep", "the same limits", "a string or an IRI in it | 16 MiB")


def test_the_page_on_limits_names_the_limits_there_are() -> None:
    page = (Path(__file__).parents[2] / "docs" / "untrusted.md").read_text()
    _, _, *rows = [line for line in page.splitlines() if line.startswith("|")]
    for words in LIMITS:
        assert any(words in row for row in rows), words
    for row in rows:
        assert any(words in row for words in (*LIMITS, *WITHOUT_A_CONSTANT)), row
    assert activation.MOST_HOLDING == task_queue.MOST_WAITING
    assert f"{LONGEST_REMARK:,} characters at most" in page
