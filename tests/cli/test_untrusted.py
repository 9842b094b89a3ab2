"""What strangers advertise on the bus: commands read it, and open, ask, start and paint nothing because of it."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress

import pytest

from selfconf.cli.terminal import COLOURS
from selfconf.model.term import IRI
from tests.cli.processes import PATIENCE, Home
from tests.cli.strangers import GUILTY, Strangers, Trap
from tests.lab import PREFIXES, iri

pytestmark = pytest.mark.process

OWN = PREFIXES + (
    "@prefix owl: <http://www.w3.org/2002/07/owl#> .\n@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .\n"
)
POSE = "a sc:Component, rob:PositionSensor ; sc:hasOutput [ sc:name 'pose' ; sc:signalType rob:PlanarPose2D ]"
READS = [
    "SELECT $this FROM <FILE> FROM NAMED <WEB> WHERE { $this ?p ?o }",
    "SELECT $this WHERE { $this ?p ?o . SERVICE <WEB> { ?s ?p ?o } }",
    "SELECT $this WHERE { $this ?p ?o . ser\\\\u0076ice <WEB> { ?s ?p ?o } }",
    "SELECT $this WHERE { GRAPH <FILE> { $this ?p ?o } }",
]
SHAPES = "".join(f"sh:sparql [ sh:select '''{query}''' ] ; " for query in READS)
LAUGHS = "_:l0 :p 1 . " + "".join(f"_:l{n} :p _:l{n - 1} ; :q ( _:l{n - 1} _:l{n - 1} ) . " for n in range(1, 60))
HOSTILE = {
    "imports": f":imports {POSE} ; owl:imports <FILE> , <WEB> ; sh:shapesGraph <WEB> ; rdfs:seeAlso <FILE> . "
    "<FILE> a owl:Ontology ; owl:imports <WEB> .",
    "queries": f":queries {POSE} ; {SHAPES} sh:targetClass rob:PositionSensor . "
    f"rob:PositionSensor a sh:NodeShape ; {SHAPES} sh:entailment <WEB> .",
    "updates": f":updates {POSE} ; sh:rule [ a sh:SPARQLRule ; sh:construct 'LOAD <FILE>' ; sh:update 'LOAD <WEB>' ] .",
    "scripts": f":scripts {POSE} . rob:PositionSensor a sh:NodeShape ; "
    "sh:js [ sh:jsFunctionName 'f' ; sh:jsLibrary [ sh:jsLibraryURL '<WEB>' , <FILE> ] ] .",
    "commands": f":commands {POSE} ; sc:grounding [ sc:command 'cat PATH' ] .",
    "patterns": f":patterns {POSE} ; rdfs:label '{'a' * 60}!' ; sh:pattern '^(a+)+$' . "
    "rob:PositionSensor a sh:NodeShape ; sh:property [ sh:path rdfs:label ; sh:pattern '^(a+)+$' ] .",
    "literals": f":literals {POSE} ; rdfs:label '{'x' * 900_000}' .",
    "brackets": f":brackets {POSE} ; :p {'[ :p ' * 5_000}1{' ]' * 5_000} .",
    "lists": f":lists {POSE} ; :p {'( ' * 5_000}1{' )' * 5_000} .",
    "laughs": f":laughs {POSE} ; :p _:l59 . {LAUGHS}",
    "circles": f":circles {POSE} ; sc:hasInput _:c ; :p _:c . _:c sc:name 'c' ; sc:signalType rob:Text ; "
    "rdf:first _:c ; rdf:rest _:c ; :p _:c .",
    "terminal": f":terminal {POSE} ; rdfs:label '\\u001B[2J\\u0007' ;"
    " sc:hasOutput [ sc:name '\\u001B[2Jx' ; sc:signalType rob:Text ] .",
    "forged": ":somebody-else a sc:Component, rob:PositionSensor .",
    "stolen": f":person-tracker {POSE} ; sc:preference 1000 . :stolen {POSE} .",
}
LINKED = b'{"@context": "WEB", "@id": "urn:x"}'
"""Not Turtle at all, as the rest of what a stranger sends."""


@pytest.fixture(scope="module")
def trap(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Trap]:
    """What nobody may touch."""
    trap = Trap(tmp_path_factory.mktemp("trap"))
    yield trap
    trap.close()


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory, trap: Trap) -> Iterator[Home]:
    """The paper's ecology, with a site of strangers in it; whatever is started from now on is watched."""
    home = Home(tmp_path_factory.mktemp("home"))
    home.site("peis-home", "ads")
    home.components("sonar", "encoder", "tracker", "odometry", "control", "drive")
    said = {iri(name): trap.set(OWN + text).encode() for name, text in HOSTILE.items()}
    said[IRI("urn:linked")] = LINKED.replace(b"WEB", trap.web.encode())
    said[IRI("urn:bytes")] = b"\xff\x00\xfe"
    said[IRI("urn:much")] = OWN.encode() + b"#" * (2 << 20)
    nonsense = [(b"", b"no page"), (b"", b"\xff" * 100)]
    strangers = Strangers(home.keys, home.endpoint("peis-home"), said, nonsense, home.authority)
    home.environment["PYTHONPATH"] = os.pathsep.join((str(trap.program), home.environment["PYTHONPATH"]))
    assert home.until(lambda: discovered_sites(home) == {"peis-home", "strangers"}), (
        "with keys hubs are opened anew before"
    )
    yield home
    strangers.close()
    home.close()


def selfconf(home: Home, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run a command to its end, watched."""
    command = [sys.executable, "-m", "selfconf", *arguments, *home.arguments()]
    return subprocess.run(
        command, cwd=home.folder, env=home.environment, capture_output=True, text=True, timeout=PATIENCE, check=False
    )


def discovered_sites(home: Home) -> set[str]:
    """The sites whose components `discover` lists."""
    done = selfconf(home, "discover", "--format", "json")
    return {row["site"] for row in json.loads(done.stdout)["components"]} if done.returncode == 0 else set()


@pytest.mark.parametrize(
    "act", ["open(FILE)", "__import__('urllib.request').request.urlopen(WEB)", "__import__('os').system('ls')"]
)
def test_whoever_touches_the_trap_is_ended(home: Home, trap: Trap, act: str) -> None:
    program = act.replace("FILE", repr(str(trap.file))).replace("WEB", repr(trap.web))
    done = subprocess.run([sys.executable, "-c", program], env=home.environment, capture_output=True, check=False)
    assert done.returncode == GUILTY


def test_discover_lists_strangers_and_touches_nothing(home: Home, trap: Trap) -> None:
    done = selfconf(home, "discover", "--format", "json")
    assert done.returncode == 0, done.stderr
    body = json.loads(done.stdout)
    found = {row["component"]: row["site"] for row in body["components"]}
    assert found[iri("person-tracker")] == "peis-home"
    assert {iri(name) for name in ("imports", "queries", "scripts", "commands", "laughs", "lists")} <= found.keys()
    assert not found.keys() & {iri("somebody-else"), "urn:linked", "urn:bytes", "urn:much"}
    for component in ("urn:linked", "urn:bytes", "urn:much"):
        assert done.stderr.count(f"left out {component}") == 1, done.stderr
    assert not trap.visited


def test_query_reads_strangers_and_touches_nothing(home: Home, trap: Trap) -> None:
    done = selfconf(home, "query", "SELECT ?s ?o WHERE { ?s rdfs:label ?o FILTER (STRLEN(?o) < 99) }")
    assert done.returncode == 0, done.stderr
    assert "terminal" in done.stdout
    assert not trap.visited


def on_a_terminal(home: Home, *arguments: str) -> str:
    """What a command writes on a terminal."""
    ours, theirs = os.openpty()
    with os.fdopen(ours, "rb", buffering=0) as screen:
        command = [sys.executable, "-m", "selfconf", *arguments, *home.arguments()]
        with subprocess.Popen(command, cwd=home.folder, env=home.environment, stdout=theirs, stderr=theirs):
            os.close(theirs)
            shown = b""
            with suppress(OSError):  # the end of a terminal
                while more := screen.read(1 << 16):
                    shown += more
    return shown.decode()


@pytest.mark.parametrize(
    "command",
    [
        ("discover",),
        ("query", "SELECT ?o WHERE { ?s rdfs:label|sc:hasOutput/sc:name ?o FILTER (STRLEN(?o) < 99) }"),
        ("partition", "navigate.ttl", "--bind", "robot=:Astrid", "--bind", "goal=x"),
    ],
)
def test_the_words_of_strangers_do_not_steer_a_terminal(home: Home, command: tuple[str, ...]) -> None:
    shown = on_a_terminal(home, *command)
    assert "\\x1b[2J" in shown
    own = ("2K", "0m", *(f"{colour}m" for colour in COLOURS.values()))  # a line of progress, and what `paint` makes
    for sequence in own:
        shown = shown.replace(f"\x1b[{sequence}", "")
    assert all(letter.isprintable() or letter in "\r\n" for letter in shown)


def test_run_works_among_strangers_and_touches_nothing(home: Home, trap: Trap) -> None:
    run = home.run()
    running = run.act("running")["configuration"]
    assert iri("person-tracker") in [component for role in running["roles"] for component in role["components"]]
    assert run.end(signal.SIGINT) == 0
    assert "GUILTY" not in run.complaints
    assert not trap.visited
