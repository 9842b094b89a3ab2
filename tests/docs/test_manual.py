"""The manual's examples: each command and each session on a page is run, and says what the page says."""

from __future__ import annotations

import doctest
import re
import shlex
from pathlib import Path

import pyoxigraph as ox
import pytest

import selfconf
from selfconf.api.answer import Answer
from selfconf.cli.main import main
from selfconf.model.configuration import Configuration

ROOT = Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"^```console\n\$ selfconf (.+)\n((?:.*\n)*?)```$", re.MULTILINE)


SESSION = re.compile(r"^```pycon\n(.*?)^```$", re.MULTILINE | re.DOTALL)

PAGE = (ROOT / "docs" / "search.md").read_text("utf-8")
EXAMPLES = BLOCK.findall(PAGE)
"""Each command of the page on the search, and what it prints."""
PATTERNS = BLOCK.findall((ROOT / "docs" / "patterns.md").read_text("utf-8"))
"""Each command of the page of patterns."""


@pytest.mark.parametrize(("command", "output"), [*EXAMPLES, *PATTERNS], ids=lambda text: text.partition("\n")[0])
def test_a_command_says_what_its_page_says(
    command: str, output: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(ROOT)
    code = main(shlex.split(command))
    said = capsys.readouterr()
    assert said.out + said.err == output
    assert code == (1 if output.startswith("no configuration") else 2 if "not decided" in output else 0)


def test_nothing_is_said_to_come_from_an_index_on_which_it_is_not() -> None:
    pages = [ROOT / "README.md", *(ROOT / "docs").glob("*.md"), *(ROOT / "selfconf").rglob("*.py")]
    promise = re.compile(r"install '?\"?selfconf(\[|['\"`]|\s*$)", re.MULTILINE)
    assert [page for page in pages if promise.search(page.read_text("utf-8"))] == []


@pytest.mark.parametrize("lost", [0, 1, 2, 4, 8, 16, 32, 42, 63])
@pytest.mark.parametrize("first", ["courseError", "watts"])
def test_the_design_that_is_proved_is_the_right_one_whichever_thrusters_are_lost(lost: int, first: str) -> None:
    pytest.importorskip("pysat")
    folder = ROOT / "examples" / "patterns"
    vehicle = (folder / "submarine.ttl").read_text("utf-8")
    for number in range(1, 7):
        if lost >> number - 1 & 1:
            vehicle = re.sub(rf":thruster-{number} a (?s:.)*? \] \.\n", "", vehicle)
    survey = (folder / "survey.ttl").read_text("utf-8")
    if first == "watts":
        survey = survey.replace(":courseError", ":other").replace(":watts", ":courseError").replace(":other", ":watts")
    answer = selfconf.configure(selfconf.template(survey), selfconf.read(vehicle), strategy="best")
    assert isinstance(answer, Answer)
    exact = first == "courseError" and not lost
    assert answer["controller"][0].short == ("six-thruster-controller" if exact else "drifting-controller")
    assert len(answer.recruits) == (6 if exact else 0)
    assert answer.optimum is not None
    assert answer.optimum.proved


def test_the_page_has_examples() -> None:
    assert len(EXAMPLES) == 6
    assert len(PATTERNS) == 6


def test_the_instance_on_the_page_goes_through_the_stages_as_printed() -> None:
    pytest.importorskip("pysat")
    blocks = SESSION.findall(PAGE)
    assert len(blocks) == 9
    session = doctest.DocTestParser().get_doctest("\n".join(blocks), {}, "docs/search.md", "docs/search.md", 0)
    said: list[str] = []
    assert doctest.DocTestRunner().run(session, out=said.append).failed == 0, "".join(said)


def test_the_queries_of_the_page_on_tasks_find_what_is_deployed() -> None:
    queries = re.findall(r"^```sparql\n(.*?)^```$", (ROOT / "docs" / "tasks.md").read_text("utf-8"), re.M | re.S)
    home = selfconf.read(ROOT / "examples" / "peis-home")
    task = selfconf.template(ROOT / "examples" / "navigate.ttl").bind(robot=":Astrid", goal="(AT BEDROOM)")
    answer = selfconf.configure(task, home)
    assert isinstance(answer, Configuration)
    failure = (
        ":now prov:wasInfluencedBy [ a sc:Failure ; sc:component :person-tracker ; sc:cause 'fail' ;"
        " sc:detail 'out of view' ]"
    )
    store = ox.Store()
    prefixes = {"sc": "https://w3id.org/selfconf#", "prov": "http://www.w3.org/ns/prov#", "": "urn:t:"}
    declared = "".join(f"@prefix {name}: <{iri}> .\n" for name, iri in prefixes.items())
    store.load((answer.to_turtle() + declared + failure + " .").encode(), format=ox.RdfFormat.TURTLE)
    found = [list(store.query(query, prefixes={"sc": prefixes["sc"]})) for query in queries]
    assert [len(rows) for rows in found] == [5, 4, 1]
    assert [term.value for term in found[2][0]] == ["urn:t:person-tracker", "fail", "out of view"]
