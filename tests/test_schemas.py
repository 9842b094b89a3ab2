"""The JSON Schemas say exactly what the commands print as JSON: nothing that is printed is missing from them."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator
from dataclasses import fields, replace
from pathlib import Path
from typing import Any, get_args

import jsonschema
import pytest
from referencing import Registry, Resource

from docs import json_schemas
from selfconf import Ecology, library
from selfconf.cli import status
from selfconf.cli.main import COMMANDS, main
from selfconf.cli.run_lines import json_lines
from selfconf.configurator import Phase
from selfconf.configurator.events import Call
from selfconf.model import run_event
from selfconf.model.configuration import Configuration
from selfconf.model.holder import Holder
from selfconf.model.refusal import Reason, Refusal, Undecided
from selfconf.model.relaxation import Relaxation
from selfconf.model.run_event import RunEvent
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause, Status
from selfconf.render.run_events import SENTENCES, event_body
from tests.cli.processes import Home
from tests.recorded import cases
from tests.recorded.answers import Case, folder
from tests.recorded.clock import MILESTONES
from tests.recorded.ecologies import generated
from tests.recorded.record import load

ROOT = Path(__file__).resolve().parent.parent
SCHEMAS = {path.name.removesuffix(".schema.json"): json.loads(path.read_text("utf-8")) for path in library.schemas()}
REGISTRY: Registry[Any] = Registry().with_resources((s["$id"], Resource.from_contents(s)) for s in SCHEMAS.values())
WITHOUT_SCHEMA = {
    "new": "prints no results",
    "site": "prints no results",
    "serve": "prints no results",
    "bridge": "prints no results",
    "demo": "shows the lines of `run` in words",
}
"""Commands that print no JSON, and why."""
CLOCK = ("examples/clock/tell-the-time.ttl", "--ads", "examples/clock")
WATCH = ("examples/watch.ttl", "--ads", "examples/watch")
EXAMPLES: dict[str, tuple[tuple[str, ...], ...]] = {
    "configure": (
        (*CLOCK, "--bind", "room=:kitchen", "--what-if"),
        (*CLOCK, "--bind", "room=:cellar"),
        (*WATCH, "--steps", "1"),
        (*WATCH, "--strategy", "best"),
        ("examples/lookout/approach.ttl", "--ads", "examples/lookout"),
    ),
    "partition": ((*CLOCK, "--bind", "room=:kitchen"), (*WATCH, "--why")),
    "query": (
        ("SELECT ?c ?input WHERE { ?c sc:hasInput/sc:name ?input }", "--ads", "examples/clock"),
        ("ASK { ?c a rob:Display }", "--ads", "examples/clock"),
        ("CONSTRUCT WHERE { ?c a rob:Display }", "--ads", "examples/clock"),
    ),
    "validate": (("tests/bad/bound-twice.ttl",),),
}
"""What is typed for the examples in the schemas of commands that need no living ecology."""


def validator(name: str) -> jsonschema.Draft202012Validator:
    """What judges the answers of a command."""
    return jsonschema.Draft202012Validator(SCHEMAS[name], registry=REGISTRY)


def printed(capsys: pytest.CaptureFixture[str], command: str, *arguments: str) -> Any:
    """What a command prints as JSON, or None where it prints nothing."""
    capsys.readouterr()
    try:
        main([command, *arguments, "--format", "json"])
    except SystemExit:
        return None
    out = capsys.readouterr().out
    return json.loads(out) if out else None


def objects(schema: Any, path: str = "") -> Iterator[tuple[str, dict[str, Any]]]:
    """Every part of a schema that speaks of members, with where it is."""
    if isinstance(schema, dict):
        if "properties" in schema:
            yield path, schema
        for key, part in schema.items():
            if key != "examples":
                yield from objects(part, f"{path}/{key}")
    elif isinstance(schema, list):
        for number, part in enumerate(schema):
            yield from objects(part, f"{path}/{number}")


# What the schemas are.


@pytest.mark.parametrize("name", SCHEMAS)
def test_each_schema_is_one_and_is_named_after_its_file(name: str) -> None:
    schema = SCHEMAS[name]
    jsonschema.Draft202012Validator.check_schema(schema)
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    assert schema["$id"] == f"https://w3id.org/selfconf/schemas/{name}.schema.json"
    assert schema["title"]
    assert schema["description"].endswith(".")


@pytest.mark.parametrize("name", SCHEMAS)
def test_every_object_is_closed_and_every_member_is_described_in_a_sentence(name: str) -> None:
    for path, schema in objects(SCHEMAS[name]):
        if "oneOf" not in schema:
            assert schema.get("additionalProperties") is False, path
        for member, part in schema["properties"].items():
            described = json_schemas.referred(name, part)[1]["description"]
            assert described.endswith("."), (path, member)
            assert ". " not in described, (path, member)


def test_every_command_that_prints_json_has_a_schema() -> None:
    assert set(json_schemas.COMMANDS) == COMMANDS.keys() - WITHOUT_SCHEMA.keys()
    assert set(json_schemas.COMMANDS) <= SCHEMAS.keys()


@pytest.mark.parametrize(
    ("path", "known"),
    [
        ("reasons", {one.code for one in get_args(Reason)}),
        ("repairs", {one.code for one in get_args(Relaxation)} | {"reasoning"}),
    ],
)
def test_the_codes_of_a_refusal_are_those_of_its_facts(path: str, known: set[str]) -> None:
    code = SCHEMAS["refusal"]["properties"][path]["items"]["properties"]["code"]
    assert set(code["enum"]) == known


def test_causes_calls_and_phases_are_those_of_the_protocol() -> None:
    events, deployed = SCHEMAS["run"]["$defs"], SCHEMAS["status"]["items"]["properties"]
    assert events["lost"]["properties"]["cause"]["enum"] == [cause.value for cause in Cause]
    assert events["unreachable"]["properties"]["call"]["enum"] == [call.value for call in Call]
    assert set(deployed["phase"]["examples"]) == {phase.value for phase in Phase} - {"refused"} | {"waiting"}


# What the commands print.


@pytest.mark.parametrize("command", json_schemas.COMMANDS)
def test_the_examples_in_a_schema_keep_to_it(command: str) -> None:
    for example in SCHEMAS[command]["examples"]:
        validator(command).validate(example)


@pytest.mark.usefixtures("asked_here")
@pytest.mark.parametrize("command", EXAMPLES)
def test_the_examples_in_a_schema_are_what_the_command_prints(
    command: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    for example, arguments in zip(SCHEMAS[command]["examples"], EXAMPLES[command], strict=True):
        body = printed(capsys, command, *arguments)
        validator(command).validate(body)
        timed = example if isinstance(example, dict) else {}
        assert (body | {"seconds": timed["seconds"]} if "seconds" in timed else body) == example


@pytest.mark.usefixtures("asked_here")
@pytest.mark.parametrize("case", [one for one in cases.examples() if "json" in one.arguments], ids=lambda one: one.name)
def test_what_is_printed_about_the_examples_keeps_to_the_schema(
    case: Case, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    command, *arguments = [word for word in case.arguments if word not in ("--format", "json")]
    body = printed(capsys, command, *arguments)
    if body is not None:  # what cannot be read is misuse, and prints nothing
        validator(command).validate(body)


def test_what_is_printed_about_random_ecologies_keeps_to_the_schema(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for seed in range(0, cases.ECOLOGIES, 50):
        ecology = generated(seed)
        with folder(cases.write(ecology.files, tmp_path / str(seed))):
            body = printed(capsys, "configure", "template.ttl", "--ads", "ads", *ecology.options)
            if body is not None:
                validator("configure").validate(body)


@pytest.mark.slow
def test_all_answers_that_are_recorded_keep_to_the_schema() -> None:
    """A record has a mark in place of each sentence, and of the seconds only which parts were timed."""
    judges = {name: validator(name) for name in SCHEMAS}
    found: Counter[str] = Counter()
    for name, answer in load("answers")["ecologies"].items():
        command, _, form = name.partition(" ")[2].partition(" ")
        if form != "json" or "stdout" not in answer:
            continue
        body = answer["stdout"]
        if "seconds" in body:
            body = {**body, "seconds": dict.fromkeys(body["seconds"], 0.001)}
        judges[command].validate(body)
        found.update([command, *(member for member in ("cost", "what_if", "status") if member in body)])
        found.update(one["code"] for part in ("reasons", "repairs") for one in body.get(part, ()))
    judges["validate"].validate(load("answers")["bad"]["tests/bad"]["stdout"])
    assert found.keys() >= {"configure", "partition", "validate", "query", "cost", "what_if", "status"}
    codes = {one.code for one in (*get_args(Reason), *get_args(Relaxation))}
    assert found.keys() >= codes - {"contradictory-count", "add-recruits"}


@pytest.mark.parametrize(
    ("need", "said", "output"),
    [
        ('sc:hasInput [ sc:name "light" ; sc:signalType :Light ]', "issues Light", {"signal": "urn:t:Light"}),
        (
            'sc:needsOperation [ sc:name "look" ; sc:request :Text ; sc:response :Image ]',
            "offers an operation Text -> Image",
            {"request": "urn:t:Text", "response": "urn:t:Image"},
        ),
        (
            'sc:hasInput [ sc:name "i" ; sc:signalType :Light ; sc:accepts [ sh:class :Lamp ] ]',
            "issues Light as the sc:accepts of its input asks",
            {
                "signal": "urn:t:Light",
                "accepts": "[ <http://www.w3.org/ns/shacl#class> <urn:t:Lamp> ]",
            },
        ),
    ],
)
def test_recruits_to_add_keep_to_the_schema(
    need: str, said: str, output: dict[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "t.ttl").write_text(
        "@prefix sc: <https://w3id.org/selfconf#> . @prefix sh: <http://www.w3.org/ns/shacl#> . @prefix : <urn:t:> .\n"
        ":t a sc:Template ; sc:roles ( :eye ) . :eye a sc:Role ; sh:class :Eye ; sc:recruits true .\n"
    )
    (tmp_path / "ad.ttl").write_text(
        "@prefix sc: <https://w3id.org/selfconf#> . @prefix sh: <http://www.w3.org/ns/shacl#> . @prefix : <urn:t:> .\n"
        f":e a sc:Component , :Eye ; {need} .\n"
    )
    body = printed(capsys, "configure", str(tmp_path / "t.ttl"), "--ads", str(tmp_path / "ad.ttl"))
    validator("configure").validate(body)
    added = next(one for one in body["repairs"] if one["code"] == "add-recruits")
    assert added["message"] == f"add one more component for the role eye to recruit that {said}"
    assert added["additions"] == [{"role": "urn:t:eye", "count": 1, "outputs": [output], "values": {}}]


def test_a_refusal_for_what_other_tasks_hold_keeps_to_the_schema(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    screen = IRI("https://example.org/my-home#display")
    monkeypatch.setattr(Ecology, "holders", lambda _: {screen: Holder("watch~1", 2, 1.5, "c1")})
    monkeypatch.chdir(ROOT)
    body = printed(capsys, "configure", *CLOCK)
    validator("configure").validate(body)
    assert body["held"] == [{"component": screen, "task": "watch", "priority": 2, "since": 1.5, "configurator": "c1"}]


def test_a_value_that_components_to_add_share_keeps_to_the_schema(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shape = "sh:property [ sh:path :on ; sh:in ( :robot ) ]"
    (tmp_path / "t.ttl").write_text(
        "@prefix sc: <https://w3id.org/selfconf#> . @prefix sh: <http://www.w3.org/ns/shacl#> . @prefix : <urn:t:> .\n"
        ':t a sc:Template ; sc:roles ( :eye :ear ) ; sc:parameter :robot . :robot a sc:Parameter ; sc:name "robot" .\n'
        f":eye a sc:Role ; sh:class :Eye ; {shape} . :ear a sc:Role ; sh:class :Ear ; {shape} .\n"
    )
    (tmp_path / "ad.ttl").write_text("@prefix sc: <https://w3id.org/selfconf#> . <urn:t:e> a sc:Component .\n")
    body = printed(capsys, "configure", str(tmp_path / "t.ttl"), "--ads", str(tmp_path / "ad.ttl"))
    validator("configure").validate(body)
    assert [one.get("shared") for one in body["repairs"] if one["code"] == "add-components"] == [["robot"]]


@pytest.mark.usefixtures("asked_here")
def test_every_kind_of_term_keeps_to_the_schema_of_solutions(capsys: pytest.CaptureFixture[str]) -> None:
    query = 'SELECT * { VALUES (?a ?b ?c) { (<x:y> "text" "Wort"@de) (UNDEF UNDEF 1.5) } BIND(BNODE() AS ?d) }'
    body = printed(capsys, "query", query, "--ads", str(ROOT / "examples" / "clock"))
    validator("query").validate(body)
    kinds = [set(cell) - {"value"} | {cell["type"]} for row in body["results"]["bindings"] for cell in row.values()]
    assert [kind for kind in kinds if "datatype" in kind]
    assert [kind for kind in kinds if "xml:lang" in kind]
    assert {"uri", "bnode", "literal"} <= set().union(*kinds)


# What a run prints.


def acts() -> dict[str, type[RunEvent]]:
    """The class of each act."""
    found = [one for one in vars(run_event).values() if isinstance(one, type) and issubclass(one, RunEvent)]
    return {one.act: one for one in found if one.act}


@pytest.fixture(scope="module")
def outcomes() -> dict[str, Any]:
    """A configuration and refusals as the search answers."""
    from selfconf import configure, read, template

    task, home = template(ROOT / CLOCK[0]), read(ROOT / "examples" / "clock")
    answer, refusal = configure(task, home), configure(task.bind(room=":cellar"), home)
    assert isinstance(answer, Configuration)
    assert isinstance(refusal, Refusal)
    return {
        "configuration": answer,
        "refusal": refusal,
        "with missing sites": replace(refusal, missing_sites=("cellar",)),
        "without reasons": Refusal(refusal.template, ()),
        "out of steps": Undecided(7),
        "out of time": Undecided(seconds=0.5),
    }


def instances(event: type[RunEvent], outcomes: dict[str, Any]) -> Iterator[RunEvent]:
    """Events of a class, with every kind of value for those members that have several."""
    component = IRI("https://example.org/my-home#clock")
    plain: dict[str, Any] = {
        "component": component,
        "source": component,
        "sink": component,
        "sites": ("home", "cellar"),
        "missing": ("cellar",),
        "components": 2,
        "seconds": 0.001,
        "epoch": 3,
        "cause": Cause.CRASH.value,
        "call": Call.APPLY.value,
        "lost": {component: "crash, its liveliness has ended"},
        "owed": (component,),
        "task": "tell-the-time",
        "configuration": outcomes["configuration"],
        "time": 1.5,
    }
    several: dict[str, list[Any]] = {
        "outcome": list(outcomes.values()),
        "refusal": {
            "stopped": [None],
            "refused": [each for each in outcomes.values() if not each],
            "waiting": [None, *(each for each in outcomes.values() if not each)],
        }.get(event.act, []),
    }
    names = [one.name for one in fields(event)]
    facts = {name: plain.get(name, "text") for name in names if name not in several}
    choice = next((name for name in names if name in several), None)
    if choice is None:
        yield event(**facts)
    else:
        yield from (event(**facts, **{choice: value}) for value in several[choice])


def test_each_act_has_its_schema_and_its_sentence_and_each_of_these_its_act() -> None:
    variants = [SCHEMAS["run"]["$defs"][one["$ref"].rpartition("/")[2]] for one in SCHEMAS["run"]["oneOf"]]
    assert [variant["properties"]["act"]["const"] for variant in variants] == list(
        SCHEMAS["run"]["properties"]["act"]["enum"]
    )
    assert set(SCHEMAS["run"]["properties"]["act"]["enum"]) == acts().keys() == SENTENCES.keys()


@pytest.mark.parametrize("act", acts())
def test_every_event_of_a_run_keeps_to_the_schema(act: str, outcomes: dict[str, Any]) -> None:
    judge, events = validator("run"), list(instances(acts()[act], outcomes))
    assert events
    for event in events:
        body = json.loads(json.dumps(event_body(event)))
        judge.validate(body)
        assert not judge.is_valid({**body, "mood": "good"})


def test_a_line_of_a_run_is_the_body_of_its_event(capsys: pytest.CaptureFixture[str]) -> None:
    event = run_event.EcologyAsked(time=2.0)
    json_lines(event)
    assert json.loads(capsys.readouterr().out) == event_body(event)


def test_a_refusal_names_the_sites_that_did_not_answer(outcomes: dict[str, Any]) -> None:
    body = event_body(run_event.TaskRefused(outcomes["with missing sites"]))
    assert body["refusal"]["missing_sites"] == ["cellar"]


def test_a_status_keeps_to_the_schema_whatever_has_been_lost() -> None:
    task, lost = IRI("https://example.org/my-home#tell-the-time"), {"https://example.org/my-home#clock": "crash"}
    body = [
        status._body(Status("c1", "waiting", task, 3, 1.5), {}),
        status._body(Status("c2", "x", task, 3, 1.5, lost=lost), {}),
    ]
    validator("status").validate(json.loads(json.dumps(body)))


@pytest.fixture
def home(tmp_path: Path) -> Iterator[Home]:
    """An ecology of a test's own, without any process yet."""
    home = Home(tmp_path)
    yield home
    home.close()


@pytest.mark.process
def test_what_a_living_ecology_answers_keeps_to_the_schema(home: Home, capsys: pytest.CaptureFixture[str]) -> None:
    home.site("kitchen", str(ROOT / "examples" / "clock"))
    where = home.arguments()
    body = printed(capsys, "discover", *where)
    validator("discover").validate(body)
    assert {each["state"] for each in body["components"]} == {"dormant"}
    running = home.selfconf("run", str(ROOT / CLOCK[0]), "--ecology", home.ecology, "--format", "json")
    said = [running.act(act) for act in ("query", "discovered", "composed", "waking", "running")]
    for command, choice in (
        ("discover", ()),
        ("status", ()),
        ("top", ("--every", "0.2")),
        ("echo", ("clock", "time", "--count", "1")),
        ("why", ("source",)),
        ("stop", ()),
    ):
        body = printed(capsys, command, *where, *choice)
        validator(command).validate(body)
        assert body
    said.append(running.act("stopped"))
    for line in said:
        validator("run").validate(line)
    assert {line["act"] for line in said} >= MILESTONES
    assert running.end() == 0
