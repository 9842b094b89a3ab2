"""`partition`: who could play each role, why the others could not, and each role spelt out for other tools."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path

import pyoxigraph as ox
import pyshacl
import pytest
from rdflib import Graph, URIRef

from selfconf.cli.main import main
from selfconf.rdf.advertisements import read_advertisements
from selfconf.rdf.sparql.dataset import Dataset
from tests.cli.command import each, run
from tests.cli.endpoints import oxigraph
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES, iri, write_advertisements

RICH = PREFIXES + (
    ":rich a sc:Template ; sc:roles ( :fine :other ) ."
    ":fine a sc:Role ; sh:or ( [ sh:class rob:PositionSensor ] [ sh:class rob:MotorDrive ] ) ;"
    "  sh:not [ sh:hasValue :pippi-drive ] ;"
    "  sh:property [ sh:path :accuracy ; sh:minCount 1 ; sh:datatype xsd:decimal ; sh:maxInclusive 0.5 ] ,"
    "  [ sh:path :maker ; sh:pattern '^a' ; sh:flags 'i' ; sh:minLength 2 ; sh:nodeKind sh:Literal ; sh:maxCount 1 ] ."
    ":other a sc:Role ;"
    "  sh:xone ( [ sh:class :Special ] [ sh:path rob:place ; sh:in ( :kitchen 1 ) ; sh:minCount 1 ] ) ;"
    "  sc:sets [ sc:parameterType :Mode ; sc:value 1 ] ."
)
RICH_ADS = PREFIXES + "\n".join(
    f":c{number} a sc:Component, {kind} ; {said} ; sc:hasParameter [ sc:name 'mode' ; sc:parameterType :Mode ] ."
    for number, (kind, said) in enumerate(
        (
            ("rob:PositionSensor", ":accuracy 0.2 ; :maker 'acme'"),
            ("rob:PositionSensor", ":accuracy 0.2 , 0.7"),
            ("rob:MotorDrive", ":accuracy 0.5 ; :maker 'Acme', 'Bolt' ; rob:place :kitchen"),
            ("rob:MotorDrive, :Special", ":accuracy 1 ; sc:preference 3"),
            ("rob:PositionSensor, :Special", ":accuracy 0.1 ; rob:place :kitchen ; :maker :acme"),
            ("rob:PositionSensor", ":accuracy 0.4 ; sc:preference 5 ; rob:place 1"),
            (":Encoder", "rob:place 2 , :kitchen"),
        )
    )
)


@pytest.fixture
def home(tmp_path: Path) -> tuple[str, ...]:
    """The paper's task and ecology, as arguments."""
    (tmp_path / "navigate.ttl").write_text(NAVIGATE)
    ads = write_advertisements(tmp_path / "ads")
    bound = ("--bind", "robot=:Astrid", "--bind", "goal=x")
    return str(tmp_path / "navigate.ttl"), *bound, "--ads", str(ads)


def told(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """What the command says."""
    assert main(["partition", *arguments]) in (0, 1)
    return capsys.readouterr().out


def candidates(text: str) -> dict[str, list[str]]:
    """Who is eligible for each role, from the command's JSON."""
    return {role["role"]: role["eligible"] for role in json.loads(text)["roles"]}


def test_the_partition_lists_who_is_eligible_and_what_keeps_the_others_out(
    home: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    text = told(capsys, *home)
    assert ":position  2 eligible\n  1. :person-tracker\n  2. :absolute-odometry\n  kept out\n" in text
    assert re.search(r":drive  1 eligible\n  1. :astrid-drive\n  kept out\n    :pippi-drive: support is Pippi", text)


def test_a_role_that_nobody_can_play_is_an_honest_no(home: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["partition", *home]) == 0
    assert main(["partition", home[0], "--bind", "robot=:Nobody", *home[3:]]) == 1
    assert ":drive  no component is eligible" in capsys.readouterr().out


def test_text_shows_the_nearest_of_many_and_json_all(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "t.ttl").write_text(
        PREFIXES + ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :K ;"
        " sh:property [ sh:path :p ; sh:hasValue 1 ] ."
    )
    ads = PREFIXES + "".join(f":c{k} a sc:Component, :Other ." for k in range(30)) + ":near a sc:Component, :K ; :p 2 ."
    (tmp_path / "ads.ttl").write_text(ads)
    given = str(tmp_path / "t.ttl"), "--ads", str(tmp_path / "ads.ttl")
    text = told(capsys, *given).splitlines()
    assert text[:3] == [":r  no component is eligible", "  kept out", "    :near: p is 2, not 1"]
    assert text[-1] == "    and 23 more; --format json has them all"
    excluded = json.loads(told(capsys, *given, "--format", "json"))["roles"][0]["excluded"]
    assert len(excluded) == 31
    assert excluded[0] == {"component": iri("near"), "of_its_class": True, "obstacles": ["p is 2, not 1"]}


def test_who_may_be_recruited_is_shown(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = PREFIXES + ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :K ; sc:recruits [ sh:class :S ] ."
    (tmp_path / "t.ttl").write_text(text)
    (tmp_path / "ads.ttl").write_text(
        PREFIXES + ":k a sc:Component, :K . " + "".join(f":s{n} a sc:Component, :S . " for n in range(10))
    )
    given = str(tmp_path / "t.ttl"), "--ads", str(tmp_path / "ads.ttl")
    line = "  may recruit " + ", ".join(f":s{n}" for n in range(8)) + " and 2 more"
    assert told(capsys, *given).splitlines()[2] == line
    (role,) = json.loads(told(capsys, *given, "--format", "json"))["roles"]
    assert role["recruits"] == [iri(f"s{n}") for n in range(10)]


def spelt(text: str) -> dict[str, str]:
    """What is printed for each role."""
    parts = re.split(r"^# (\S+)\n", text, flags=re.MULTILINE)[1:]
    return dict(zip(parts[::2], parts[1::2], strict=True))


@pytest.fixture
def rich(tmp_path: Path) -> tuple[str, ...]:
    """Roles with most of what a shape can say, and components on all sides of it."""
    (tmp_path / "rich.ttl").write_text(RICH)
    (tmp_path / "ads.ttl").write_text(RICH_ADS)
    return str(tmp_path / "rich.ttl"), "--ads", str(tmp_path / "ads.ttl")


@pytest.mark.parametrize("given", ["home", "rich"])
@pytest.mark.parametrize("reasoning", ["syntactic", "subclass"])
def test_each_role_as_a_query_gives_the_same_candidates_in_the_same_order(
    given: str, reasoning: str, request: pytest.FixtureRequest, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = (*request.getfixturevalue(given), "--reasoning", reasoning)
    dataset = Dataset()
    folder = Path(arguments[arguments.index("--ads") + 1])
    for path in sorted(folder.glob("*.ttl")) if folder.is_dir() else [folder]:
        dataset.add_advertisements(read_advertisements(path.read_bytes(), path.name)[0])
    found = {}
    for role, query in spelt(told(capsys, *arguments, "--show", "sparql")).items():
        answer = dataset.query(query)
        assert isinstance(answer, ox.QuerySolutions)
        found[role] = [row["component"].value for row in answer]
    assert found == candidates(told(capsys, *arguments, "--format", "json"))
    assert any(found.values())


@pytest.mark.parametrize("given", ["home", "rich"])
def test_each_role_as_a_shape_gives_the_same_candidates(
    given: str, request: pytest.FixtureRequest, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = request.getfixturevalue(given)
    ads, components = Graph(), set[str]()
    folder = Path(arguments[arguments.index("--ads") + 1])
    for path in sorted(folder.glob("*.ttl")) if folder.is_dir() else [folder]:
        ads.parse(path)
        components |= {a.component for a in read_advertisements(path.read_bytes(), path.name)[0]}
    expected = candidates(told(capsys, *arguments, "--format", "json"))
    for role, shape in spelt(told(capsys, *arguments, "--show", "shape")).items():
        shapes = Graph().parse(data=shape, format="turtle")
        _, report, _ = pyshacl.validate(ads, shacl_graph=shapes, focus_nodes=sorted(components), use_shapes=[role])
        outside = {str(node) for node in report.objects(predicate=URIRef("http://www.w3.org/ns/shacl#focusNode"))}
        assert components - outside == set(expected[role])


def test_a_shape_needs_no_ecology(home: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    at = home.index("--ads")
    alone = (*home[:at], *home[at + 2 :])
    assert told(capsys, *alone, "--show", "shape") == told(capsys, *home, "--show", "shape")


def test_a_role_beyond_sparql_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "t.ttl").write_text(
        PREFIXES + ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:property [ sh:path :p ; sh:equals :q ] ."
    )
    assert main(["partition", str(tmp_path / "t.ttl"), "--ads", str(tmp_path / "t.ttl"), "--show", "sparql"]) == 2
    assert "see its shape by --show shape" in capsys.readouterr().err


@pytest.mark.parametrize("what", ["shape", "sparql"])
def test_what_a_role_stands_for_is_no_json(
    what: str, home: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(capsys, "partition", *home, "--show", what, "--format", "json").is_one_sentence("leave out --format")


@pytest.fixture(scope="module")
def endpoint() -> Iterator[str]:
    """A server with the paper's ecology, each advertisement in a graph of its own, and the rich one."""
    with oxigraph(RICH_ADS, {f"urn:{name}": PREFIXES + text for name, text in ADVERTISEMENTS.items()}) as url:
        yield url


def test_an_ecology_behind_an_endpoint_gives_the_same_partition(
    endpoint: str, home: tuple[str, ...], rich: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    for given in (home, rich):
        task = given[: given.index("--ads")]
        expected = candidates(told(capsys, *task, *each("--ads", home[-1], rich[-1]), "--format", "json"))
        assert candidates(told(capsys, *task, "--endpoint", endpoint, "--format", "json")) == expected


def test_configure_asks_an_endpoint_too(
    endpoint: str, home: tuple[str, ...], rich: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    answers = []
    for source in (("--endpoint", endpoint), each("--ads", home[-1], rich[-1])):
        assert main(["configure", *home[: home.index("--ads")], *source]) == 0
        answers.append(capsys.readouterr().out)
    assert answers[0] == answers[1]


def test_an_endpoint_that_is_not_there_is_named(home: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    given = home[: home.index("--ads")]
    assert main(["partition", *given, "--endpoint", "http://127.0.0.1:9/query"]) == 2
    assert "cannot ask http://127.0.0.1:9/query" in capsys.readouterr().err
    assert main(["partition", *given, "--endpoint", "file:///etc/passwd"]) == 2
    assert "http or https" in capsys.readouterr().err
    assert main(["partition", *home, "--endpoint", "http://127.0.0.1:9/query"]) == 2
    assert "give one of them" in capsys.readouterr().err


def test_a_server_that_refuses_the_query_is_quoted(
    endpoint: str, home: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    given = home[: home.index("--ads")]
    assert main(["partition", *given, "--endpoint", endpoint.replace("/query", "/nothing")]) == 2
    assert "answers 404" in capsys.readouterr().err


def test_why_tells_what_each_candidate_costs_and_what_would_come_of_it(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(Path(__file__).parents[2])
    watch = "partition", "examples/watch.ttl", "--ads", "examples/watch", "--why"
    assert main(watch) == 0
    said = capsys.readouterr().out
    assert "1. :corner-camera: preference 10, cost 0.04 / 6; with it all in all 0.24 / 66, 0.13 more on level 1" in said
    assert "2. :stereo-camera: preference 5, cost 0.08 / 9; with it all in all 0.11 / 29, 5 more on level 2" in said
    assert "3. :shelf-camera: no preference, cost 0.08 / 4; chosen, all in all 0.11 / 24" in said


def test_why_without_a_cost_tells_the_order(home: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["partition", *home, "--why"]) == 0
    said = capsys.readouterr().out
    assert ":person-tracker: preference 10; chosen" in said
    assert ":absolute-odometry: no preference; possible, and comes later in the order" in said
