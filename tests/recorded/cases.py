"""All that is recorded: a thousand random ecologies, the examples, what is wrong in tests/bad, and misuse.

Each group has a folder to work in; files of random ecologies are written there first.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from tests.recorded.answers import Answer, Case, answered, folder
from tests.recorded.ecologies import generated

ROOT = Path(__file__).resolve().parents[2]
ECOLOGIES = 1_000
_TEMPLATE = ("template.ttl", "--ads", "ads")


def ecologies(here: Path) -> Iterator[tuple[str, Answer]]:
    """What is answered about random ecologies, which are written into folders of a folder."""
    for seed in range(ECOLOGIES):
        ecology = generated(seed)
        place = write(ecology.files, here / f"{seed:04}")
        with folder(place):
            for case in _cases(seed, ecology.options, ecology.ontology):
                yield case.name, answered(case)


def write(files: Mapping[str, str], place: Path) -> Path:
    """Files in a folder; the folder."""
    for name, text in files.items():
        path = place / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return place


def digest(count: int = ECOLOGIES) -> str:
    """A digest of the files and options of all random ecologies, which tells whether the generator has changed."""
    found = hashlib.sha256()
    for seed in range(count):
        ecology = generated(seed)
        found.update(repr((sorted(ecology.files.items()), ecology.options)).encode())
    return found.hexdigest()


def _cases(seed: int, options: tuple[str, ...], ontology: tuple[str, ...]) -> Iterator[Case]:
    name = f"ecology-{seed:04}"
    task = (*_TEMPLATE, *options)
    yield Case(f"{name} configure json", ("configure", *task, "--format", "json"))
    form = {1: "text", 2: "turtle", 3: "mermaid"}.get(seed % 15)
    if form:
        yield Case(f"{name} configure {form}", ("configure", *task, "--format", form))
    judged = tuple(option for option in options if option != "--what-if")
    if "--steps" in judged:
        place = judged.index("--steps")
        judged = judged[:place] + judged[place + 2 :]
    asked = (*_TEMPLATE, *judged)
    if seed % 15 == 4:
        yield Case(f"{name} partition json", ("partition", *asked, "--format", "json"))
    if seed % 40 == 5:
        yield Case(f"{name} partition text", ("partition", *asked))
        yield Case(f"{name} partition shape", ("partition", *asked, "--show", "shape"))
        yield Case(f"{name} partition sparql", ("partition", *asked, "--show", "sparql"))
    if seed % 100 == 6:
        yield Case(f"{name} validate json", ("validate", "template.ttl", "ads", *ontology, "--format", "json"))
    if seed % 250 == 7:
        query = "SELECT ?c ?kind WHERE { ?c a sc:Component, ?kind } ORDER BY ?c ?kind"
        yield Case(f"{name} query json", ("query", query, "--ads", "ads", "--format", "json"))


NAVIGATE = ("examples/navigate.ttl", "--ads", "examples/peis-home")
ASTRID = ("--bind", "robot=:Astrid", "--bind", "goal=(AT BEDROOM)")
RADIO = ("examples/radio.ttl", "--ads", "examples/radio")
WATCH = ("examples/watch.ttl", "--ads", "examples/watch")
CLOCK = ("examples/clock/tell-the-time.ttl", "--ads", "examples/clock")
TASKS: Mapping[str, tuple[str, ...]] = {
    "navigate": (*NAVIGATE, *ASTRID),
    "navigate, any robot": (*NAVIGATE, "--bind", "goal=x"),
    "navigate without a goal": NAVIGATE,
    "navigate, owl-rl": (*NAVIGATE, *ASTRID, "--reasoning", "owl-rl"),
    "navigate, subclass": (*NAVIGATE, *ASTRID, "--reasoning", "subclass", "--ontology", "ontology/peis-home.ttl"),
    "radio": (*RADIO, "--bind", "room=:living-room"),
    "radio in the bedroom": (*RADIO, "--bind", "room=:bedroom", "--bind", "station=101.1"),
    "radio in any room": RADIO,
    "radio without speakers": ("examples/radio.ttl", "--ads", "examples/radio/tuner.ttl", "--bind", "room=:bedroom"),
    "watch": WATCH,
    "watch, best": (*WATCH, "--strategy", "best"),
    "watch, paper": (*WATCH, "--strategy", "paper"),
    "clock": CLOCK,
    "clock in the cellar": (*CLOCK, "--bind", "room=:cellar"),
}
"""The tasks of the examples, bound as the documentation binds them."""


def examples() -> Iterator[Case]:
    """Every command that needs no living ecology, over the examples."""
    for name, task in TASKS.items():
        for form in ("json", "text", "turtle", "mermaid"):
            yield Case(f"{name}, configure {form}", ("configure", *task, "--format", form))
        yield Case(f"{name}, what if", ("configure", *task, "--what-if", "--format", "json"))
        yield Case(f"{name}, partition json", ("partition", *task, "--format", "json"))
        yield Case(f"{name}, partition text", ("partition", *task))
    yield Case("watch, one step", ("configure", *WATCH, "--steps", "1"))
    yield Case("watch, one step, json", ("configure", *WATCH, "--steps", "1", "--format", "json"))
    yield Case("watch, what if, text", ("configure", *WATCH, "--what-if"))
    for kind in ("shape", "sparql"):
        yield Case(f"navigate, {kind}", ("partition", *NAVIGATE, *ASTRID, "--show", kind))
    for path in ("examples", "ontology", "examples/clock/display.ttl"):
        yield Case(f"validate {path}", ("validate", path, "--format", "json"))
    select = "SELECT ?c ?kind ?place WHERE { ?c a ?kind OPTIONAL { ?c rob:place ?place } } ORDER BY ?c ?kind"
    for form in ("table", "json", "csv", "tsv"):
        yield Case(f"query {form}", ("query", select, "--ads", "examples/peis-home", "--format", form))
    ask = "ASK { GRAPH ?g { ?c a rob:PositionSensor } }"
    yield Case("query, yes or no", ("query", ask, "--ads", "examples/peis-home", "--format", "json"))
    above = "SELECT ?c WHERE { ?c a/rdfs:subClassOf* rob:Sensor } ORDER BY ?c"
    options = ("--ads", "examples/peis-home", "--ontology", "ontology/robotics.ttl", "--format", "json")
    yield Case("query with an ontology", ("query", above, *options))
    yield Case("query, few rows", ("query", select, "--ads", "examples", "--rows", "2", "--format", "json"))


def bad() -> Iterator[Case]:
    """What `validate` says of the files of tests/bad, in every form."""
    yield Case("tests/bad", ("validate", "tests/bad", "--format", "json"))
    few = tuple(f"tests/bad/{name}.ttl" for name in ("bound-twice", "objects-missing", "loop-of-two", "rate-of-input"))
    for form in ("text", "github", "sarif", "junit"):
        yield Case(f"a few of tests/bad as {form}", ("validate", *few, "--format", form))
    yield Case("validate --explain", ("validate", "--explain", "SC-A01"))
    yield Case("validate --explain what is no code", ("validate", "--explain", "SC-Z99"))


COMMANDS = (
    "new", "validate", "partition", "configure", "query", "site", "discover", "run", "status", "stop", "demo",
)  # fmt: skip


def misuse() -> Iterator[Case]:
    """Help and misuse of every command, and those for a living ecology where nothing lives."""
    for command in COMMANDS:
        yield Case(f"{command} --help", (command, "--help"))
        yield Case(f"{command} --no-such-option", (command, "--no-such-option"))
        if command not in ("demo", "discover", "status", "stop"):
            yield Case(f"{command} alone", (command,))
    for typed in (
        (),
        ("--help",),
        ("configurate",),
        ("configure", "--format", "yaml"),
        ("configure", "--reasoning", "some", "examples/watch.ttl"),
        ("configure", "--strategy", "worst", "examples/watch.ttl"),
        ("configure", "--steps", "0", *WATCH),
        ("configure", "--seconds", "0", *WATCH),
        ("configure", "--seconds", "soon", *WATCH),
        ("configure", "examples/nowhere.ttl", "--ads", "examples"),
        ("configure", "examples/watch.ttl", "--ads", "examples/nowhere"),
        ("configure", "examples/watch.ttl", "--ads"),
        ("configure", "examples/watch", "--ads", "examples/watch"),
        ("configure", "examples/watch/deep-tracker.ttl", "--ads", "examples/watch"),
        ("configure", "examples/watch.ttl", "--ads", "examples/watch.ttl"),
        ("configure", *NAVIGATE, "--bind", "robot"),
        ("configure", *NAVIGATE, "--bind", "robot=_:b"),
        ("configure", *NAVIGATE, "--bind", "robot=nope:Astrid"),
        ("configure", *NAVIGATE, "--bind", "robot=text"),
        ("configure", *NAVIGATE, "--bind", "pilot=:Astrid"),
        ("configure", *NAVIGATE, *ASTRID, "--bind", "robot=:Pippi"),
        ("configure", *NAVIGATE, *ASTRID, "--template", ":nowhere"),
        ("configure", *NAVIGATE, *ASTRID, "--template", '"text"'),
        ("configure", *NAVIGATE, *ASTRID, "--ontology", "ontology/nowhere.ttl"),
        ("configure", *NAVIGATE, *ASTRID, "--reasoning", "subclass", "--ontology", "README.md"),
        ("configure", "-", "--ads", "-"),
        ("configure", *WATCH, "--endpoint", "http://127.0.0.1:1/query"),
        ("configure", "examples/watch.ttl", "--endpoint", "file:///etc"),
        ("configure", "examples/watch.ttl"),
        ("configure", "examples/watch.ttl", "--strategy", "best", "--ads", "examples/peis-home"),
        ("configure", *RADIO, "--strategy", "best"),
        ("configure", "tests/bad/role-untyped.ttl", "--ads", "examples"),
        ("configure", "tests/bad/statement-unfinished.ttl", "--ads", "examples"),
        ("partition", "examples/watch.ttl"),
        ("partition", *WATCH, "--show", "prose"),
        ("validate", "examples/nowhere.ttl"),
        ("validate", "LICENSE"),
        ("validate", "examples", "--ontology", "ontology/nowhere.ttl"),
        ("validate", "examples", "--format", "html"),
        ("query", "SELECT", "--ads", "examples/watch"),
        ("query", "SELECT ?c WHERE { ?c a nope:Thing }", "--ads", "examples/watch"),
        ("query", "INSERT DATA { :a :b :c }", "--ads", "examples/watch"),
        ("query", "ASK { ?s ?p ?o }", "--ads", "examples/watch", "--rows", "0"),
        ("query", "ASK { ?s ?p ?o }", "--ads", "examples/watch", "--format", "turtle"),
        ("query", "CONSTRUCT { ?s ?p ?o } WHERE { ?s ?p ?o }", "--ads", "examples/watch", "--format", "csv"),
        ("query", "nowhere.rq", "--ads", "examples/watch"),
        ("query", "ASK { ?s ?p ?o }"),
        ("site", "examples/nowhere", "--ecology", "home"),
        ("site", "examples/clock", "--ecology", "no/name"),
        ("run", "examples/nowhere.ttl", "--ads", "examples"),
        ("run", *WATCH, "--policy", "forget"),
        ("run", *NAVIGATE),
        ("discover",),
        ("discover", "--format", "json"),
        ("discover", "--ecology", "nowhere"),
        ("status",),
        ("status", "--format", "json"),
        ("stop",),
        ("stop", "--format", "json"),
        ("new", "gadget", "fridge"),
        ("new", "component", "no name"),
        ("demo", "--scene", "opera"),
        ("demo", "--speed", "backwards"),
    ):
        yield Case(" ".join(("selfconf", *typed)), typed)


def on_tree(cases: Callable[[], Iterator[Case]]) -> Iterator[tuple[str, Answer]]:
    """What is answered in the root of the tree."""
    with folder(ROOT):
        for case in cases():
            yield case.name, answered(case)


def scaffolds(here: Path) -> Iterator[tuple[str, Answer]]:
    """What `new` writes: which files is structure, what is in them are sentences."""
    with folder(here):
        for kind in ("component", "template", "ontology"):
            answer = answered(Case("", ("new", kind, f"my-{kind}")))
            written = {path.name: path.read_text() for path in sorted(here.iterdir()) if f"my-{kind}" in path.name}
            yield f"new {kind}", Answer({**answer.structure, "files": list(written)}, {**answer.sentences, **written})
            again = Case(f"new {kind} again", ("new", kind, f"my-{kind}"))
            yield again.name, answered(again)
            check = Case(f"validate what new {kind} writes", ("validate", ".", "--format", "json"))
            yield check.name, answered(check)
