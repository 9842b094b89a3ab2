"""The page in a real browser: it shows a failure as it happens, looks back in time, and runs nothing of strangers.

Where `AXE_CORE` names the file `axe.min.js` of axe-core (from npm), it is also checked whether everybody can use it.
"""

from __future__ import annotations

import asyncio
import json
import os
import re
import signal
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

import pytest
from starlette.requests import Request
from starlette.responses import Response

from selfconf.access import Principal, PrincipalKind
from selfconf.protocol.messages import TaskRecord
from selfconf.serve import fits
from selfconf.serve.board import Board
from selfconf.serve.look_endpoint import Onlookers
from selfconf.serve.metrics import Metrics
from selfconf.serve.problems import problem
from selfconf.serve.watching.change import Body, EcologyChange
from tests.cli.processes import Home, dormant
from tests.harness.effort import thorough
from tests.lab import PREFIXES, iri
from tests.sdk.living import until
from tests.serve.chromium import CHROMIUM, Chromium, Page
from tests.serve.shown import advertised, found, serving

pytestmark = [
    pytest.mark.process,
    pytest.mark.slow,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium; SELFCONF_CHROMIUM names one"),
]
HOSTILE = "<img src=x onerror=document.title='caught'><script>document.title='caught'</script>"
EVIL = f'{PREFIXES}<https://example.org/peis-home#evil> a sc:Component, <urn:x:%3Cb%3E> ; rdfs:label "{HOSTILE}" .'
TALK = 'print("hello <b>there</b>", flush=True)\n'
SIZES = [(1320, 780, False), (390, 844, True)]
AXE = os.environ.get("AXE_CORE")
CHECKED = "axe.run(document, { resultTypes: ['violations'] }).then((found) => found.violations)"
Shown = tuple[Page, Callable[[EcologyChange], object]]
"""A page, and what changes the board that it shows."""
FIRST = "the configuration runs: sonar-array, wheels, person-tracker, thinking-cap, astrid-drive"
POSITION = "[...document.querySelectorAll('.box')].find((box) => box.textContent.includes('position'))"


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Home]:
    """The paper's ecology, with one component that means harm, and a task that runs."""
    home = Home(tmp_path_factory.mktemp("page"))
    (home.folder / "ads" / "evil.ttl").write_text(EVIL)
    (home.folder / "components.py").write_text(TALK + (home.folder / "components.py").read_text())
    dormant(home, "tracker")
    home.site("peis-home", "ads")
    home.components("sonar", "encoder", "odometry", "control", "drive")
    home.run().act("running")
    yield home
    home.close()


@pytest.fixture(scope="module")
def url(home: Home) -> str:
    """Where a server shows that ecology; with keys, such as may hear signals."""
    keys: tuple[str, ...] = ()
    if home.authority is not None:
        home.authority.issue(Principal(PrincipalKind.CONFIGURATOR, "page"), home.folder / "page-keys")
        keys = "--keys", str(home.folder / "page-keys")
    said = home.selfconf("serve", "--ecology", home.ecology, "--port", "0", *keys).line()
    found = re.search(r"http://\S+/", said)
    assert found is not None, said
    return found[0]


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Chromium]:
    """A browser."""
    browser = Chromium(tmp_path_factory.mktemp("browser"))
    yield browser
    browser.close()


def untroubled(page: Page) -> None:
    """Close a page in which nothing went wrong, and which asked nobody but its server."""
    page.close()
    assert page.trouble == []


@pytest.fixture
def page(browser: Chromium, url: str) -> Iterator[Page]:
    """The page, in which nothing goes wrong, and which asks nobody but its server."""
    page = browser.page(url)
    page.says("#components", "person-tracker")
    yield page
    untroubled(page)


@pytest.fixture
def shown(browser: Chromium) -> Iterator[Callable[[Board], Shown]]:
    """Shows a board in the browser; what it returns changes the board."""
    with ExitStack() as ends:

        def show(board: Board) -> Shown:
            address, change = ends.enter_context(serving(board))
            page = browser.page(address)
            ends.callback(lambda: untroubled(page))
            page.says("#link", "live")
            return page, change

        yield show


def player(page: Page) -> str:
    """Who plays the role `position` in the diagram."""
    return str(page.value(f"{POSITION}?.querySelector('.face .name').textContent"))


def accessible(page: Page) -> None:
    """Where axe-core is at hand, it finds nothing serious."""
    if AXE is None:
        return
    page.value(Path(AXE).read_text())
    faults = page.value(CHECKED)
    serious = [(one["id"], one["nodes"][0]["html"]) for one in faults if one["impact"] in ("serious", "critical")]
    assert serious == []


def test_signals_log_and_roles_of_a_component_are_shown_while_it_is_looked_at(page: Page) -> None:
    page.click("person-tracker")
    page.until("Boolean(document.querySelector('.signals .rate')?.textContent.match(/[0-9.]+[/]s/))")
    page.says(".signals code", "frame map")
    page.says(".log", "hello <b>there</b>")
    page.says(".fits", "position of navigateplays it")
    page.click("pippi-drive")
    page.says(".fits", "drive of navigatenearly: support is Pippi, not Astrid")
    page.says(".log", "It has printed nothing")
    accessible(page)


def test_a_failure_is_seen_as_it_happens_and_can_be_looked_back_at(home: Home, page: Page) -> None:
    assert player(page) == "person-tracker"
    (home.folder / "tracker.fail").touch()
    page.until(f"{POSITION}.querySelector('.face .name').textContent === 'absolute-odometry'")
    page.until(f"{POSITION}.textContent.includes('instead of person-tracker, which failed')")
    page.says(".events", "absolute-odometry takes over position from person-tracker")
    page.says("#below", "person-tracker failed: told to")
    page.click(FIRST)
    page.until(f"{POSITION}.querySelector('.face .name').textContent === 'person-tracker'")
    page.click("Back to now")
    page.until(f"{POSITION}.querySelector('.face .name').textContent === 'absolute-odometry'")


def test_what_would_mend_a_task_that_waits_is_found_while_its_refusal_is_looked_at(home: Home, page: Page) -> None:
    run = home.run("--name", "second", "--wait")
    run.act("waiting")
    page.until("[...document.querySelectorAll('.task')].some((one) => one.textContent.includes('second'))")
    page.value("[...document.querySelectorAll('.task')].find((one) => one.textContent.includes('second')).click()")
    page.says("#below", "Not to be had")
    page.says(".refusal", "no component that is free is eligible for the role")
    page.says(".refusal", "add one more component for the role")
    assert run.end(signal.SIGINT) == 0


def test_what_a_stranger_wrote_stays_text(page: Page) -> None:
    page.click("evil")
    page.says(".detail .lead", HOSTILE)
    page.says(".detail .turtle", HOSTILE)
    assert page.value("document.querySelectorAll('.detail img, .detail script').length") == 0
    assert "caught" not in page.value("document.title")


def test_nothing_leaves_this_machine_even_where_a_script_would(browser: Chromium, url: str) -> None:
    page = browser.page(url)
    page.value("fetch('https://example.org/').catch(() => 0)")
    page.value(
        "new Promise((done) => { const one = new Image(); one.onerror = done; one.src = 'http://example.org/x' })"
    )
    page.close()
    assert any("Content Security Policy" in one for one in page.trouble)
    assert not [one for one in browser.outside if "example.org" in one]


def test_the_page_is_used_by_keyboard(page: Page) -> None:
    page.press("/")
    page.write("thinking")
    page.until("document.querySelectorAll('button.component').length === 1")
    page.press("Tab")
    while page.value("document.activeElement.className") != "component":
        page.press("Tab")
    page.press("Enter")
    page.says(".detail .title", "thinking-cap")
    page.press("Escape")
    page.says(".detail", "Choose a component")


def test_questions_in_sparql_are_answered_and_their_faults_shown_where_they_are(page: Page) -> None:
    page.click("Query")
    page.click("Which component feeds which")
    page.until("document.querySelectorAll('.answer tbody tr').length === 4")
    for number in range(6):
        page.value(f"document.querySelectorAll('#examples button')[{number}].click()")
        page.until("!['', 'asking'].includes(document.querySelector('#asked').textContent)")
    for text, wrong in (
        ("SELEKT", "SELEKT"),
        ("SELECT ?x WHERE {\n  ?x a sc:Component ;\n    foo:bar ?y\n}", "foo:bar"),
        ("ASK {\n  ?a ?b }", "}"),
    ):
        page.value(f"document.querySelector('#sparql').value = {json.dumps(text)}")
        page.value("document.querySelector('#sparql').focus()")
        page.press("Enter", control=True)
        page.until(f"document.querySelector('#painted mark')?.textContent === {json.dumps(wrong)}")
        assert page.value("document.activeElement.id") == "sparql"
    page.says(".answer", "it ends too soon")
    accessible(page)
    page.click("Who is there")
    page.click("thinking-cap", ".answer button")
    page.says(".detail .title", "thinking-cap")


@pytest.mark.parametrize(("width", "height", "dark"), SIZES)
def test_it_fits_a_desk_and_a_phone_by_day_and_by_night(
    browser: Chromium, url: str, width: int, height: int, dark: bool
) -> None:
    page = browser.page(url, width, height, dark)
    page.until("document.querySelectorAll('.box').length === 5")
    assert page.value("document.documentElement.scrollWidth") <= width
    light = page.value("getComputedStyle(document.documentElement).backgroundColor").split("(")[1].split(",")[0]
    assert (int(light) < 128) is dark
    page.click("thinking-cap")
    page.says(".detail .title", "thinking-cap")
    accessible(page)
    page.close()


def refused_task() -> Body:
    """A task that waits: one role has nobody, a component nearly fits it, and something would mend it."""
    refusal = {
        "reasons": [{"code": "x", "role": iri("drive"), "message": "nobody is eligible for drive"}],
        "near_misses": [
            {"role": iri("drive"), "component": iri("pippi-drive"), "obstacle": "support is Pippi, not Astrid"}
        ],
        "repairs": [{"code": "x", "role": iri("drive"), "message": "let drive have another support"}],
        "message": "",
    }
    facts = {
        "priority": 0,
        "beginning": 1.0,
        "since": 1.0,
        "epoch": 0,
        "host": "",
        "process": 0,
        "template": "x#navigate",
    }
    lists: Body = {"components": [], "owed": [], "dropped": {}, "lost": {}, "configuration": None, "refusal": refusal}
    return {
        "name": "navigate",
        "configurator": "c1",
        "phase": "waiting",
        "over": False,
        "detached": False,
        **facts,
        **lists,
    }


@pytest.mark.parametrize("ended", [{}, {"phase": "refused", "over": True}], ids=["waits", "has ended"])
def test_a_refusal_is_one_screen_with_what_would_mend_it(
    board: Board, shown: Callable[[Board], Shown], ended: Body
) -> None:
    board.apply(EcologyChange(tasks={"navigate~1": refused_task() | ended}))
    page, change = shown(board)
    held = {"act": "lost", "cause": "refused", "component": iri("drive"), "detail": "another task holds it"}
    again = [{**one, "task": "navigate~1", "time": 1.0} for one in (held, {"act": "waiting"})]
    change(EcologyChange(events=(*again, *again)))
    page.says(".events", "the task waits")
    assert page.value("document.querySelectorAll('.event').length") == 2
    for text in ("nobody is eligible for drive", "support is Pippi, not Astrid", "let drive have another support"):
        page.says(".refusal", text)
    bottom, seen = page.value("[document.querySelector('.refusal').getBoundingClientRect().bottom, innerHeight]")
    assert bottom < seen
    accessible(page)
    page.click("pippi-drive", ".refusal button")
    page.says(".detail .title", "pippi-drive")


def test_what_is_inside_of_a_composite_is_a_task_below_the_one_that_holds_it(
    board: Board, shown: Callable[[Board], Shown]
) -> None:
    (body,) = advertised("tracker").components.values()
    assert body is not None
    whole, part = iri("person-tracker"), iri("absolute-odometry")

    def plays(component: str) -> Body:
        role = {"role": iri("position"), "components": [component]}
        running = {"roles": [role], "connections": [], "recruits": [], "bindings": {}}
        return {
            **refused_task(),
            "phase": "running",
            "refusal": None,
            "configuration": running,
            "components": [component],
        }

    tasks = {
        "eyes~1": {**plays(part), "name": "eyes", "beginning": 0.0, "inside_of": whole},
        "outer~1": {**plays(whole), "name": "outer", "inside_of": None},
    }
    board.apply(EcologyChange(components={whole: {**body, "inside": "look"}}, tasks=tasks))
    page, _ = shown(board)
    page.until("document.querySelectorAll('.task .name').length === 2")
    assert page.value("[...document.querySelectorAll('.task .name')].map((one) => one.textContent)") == [
        "outer",
        "eyes",
    ]
    page.until("document.querySelector('.box.composite .name').textContent === 'person-tracker'")
    page.click("inside of person-tracker · running", ".task")
    page.until("document.querySelector('.box .name').textContent === 'absolute-odometry'")
    page.click("person-tracker", "#components button")
    page.click("eyes", ".detail button")


def test_a_component_that_is_advertised_anew_is_looked_at_anew(shown: Callable[[Board], Shown]) -> None:
    board, one = Board("anew", Metrics()), advertised("tracker")
    ((component, body),) = one.components.items()
    assert body is not None
    board.apply(one)
    page, change = shown(board)
    page.click("person-tracker", "#components button")
    page.says(".signals", "pose")
    change(replace(one, components={component: {**body, "outputs": [{"name": "place", "signals": []}]}}))
    page.says(".signals", "place")


def test_a_component_that_a_server_has_not_found_yet_is_looked_at_again(
    shown: Callable[[Board], Shown], monkeypatch: pytest.MonkeyPatch
) -> None:
    look, asked = Onlookers.respond, list[str]()

    async def respond(self: Onlookers, request: Request) -> Response:
        asked.append(request.url.query)
        return problem(404, "it has just begun") if len(asked) == 1 else await look(self, request)

    monkeypatch.setattr(Onlookers, "respond", respond)
    board = Board("again", Metrics())
    board.apply(advertised("tracker"))
    page, _ = shown(board)
    page.click("person-tracker", "#components button")
    assert until(lambda: len(asked) == 2)
    page.trouble = [one for one in page.trouble if "404" not in one]


def test_what_is_asked_of_a_component_is_asked_no_more_once_another_is_chosen(
    shown: Callable[[Board], Shown], monkeypatch: pytest.MonkeyPatch
) -> None:
    async def judged(_: str, question: Mapping[str, object], __: float) -> list[object]:
        if "person-tracker" in str(question["advertisement"]):
            await asyncio.Event().wait()  # it takes long
        return []

    monkeypatch.setattr(fits, "judged_apart", judged)
    board = Board("chosen", Metrics())
    task = {**refused_task(), "phase": "running", "refusal": None}
    board.apply(replace(advertised("tracker", "encoder"), tasks={"t": task}, records={"t": TaskRecord("t~1", 1)}))
    page, _ = shown(board)
    page.click("person-tracker", "#components button")
    page.says(".fits", "…")
    page.click("wheels", "#components button")
    page.says(".fits", "It fits no role")


def test_a_page_that_has_missed_something_reads_the_advertisement_anew(
    shown: Callable[[Board], Shown], monkeypatch: pytest.MonkeyPatch
) -> None:
    board = Board("missed", Metrics())
    board.apply(advertised("tracker"))
    page, change = shown(board)
    page.click("person-tracker", "#components button")
    page.says(".turtle", "PositionSensor")
    (component,) = board.advertised

    def miss(_: EcologyChange) -> None:
        """What is advertised is another by now, of which the server knows nothing, as it has begun anew."""
        board.advertised[component] = found("tracker", ":person-tracker rob:place :attic .")
        board.stream.close()
        board.stream.life = "other"

    monkeypatch.setattr(board, "apply", miss)
    change(EcologyChange())
    page.says(".turtle", "attic")


@thorough
def test_a_thousand_components_are_grouped_and_found(
    shown: Callable[[Board], Shown],
) -> None:
    board, one = Board("crowd", Metrics()), advertised("tracker")
    (body,) = one.components.values()
    assert body is not None
    crowd = {
        f"urn:c:{n}": {**body, "name": f"sensor-{n}", "places": [f"room-{n % 30}"], "site": f"host-{n % 10}"}
        for n in range(1000)
    }
    board.apply(replace(one, components=crowd, sites={f"host-{n}": {"missing": False} for n in range(10)}))
    page, change = shown(board)
    page.says("#tally", "1000 of 1000 components alive")
    assert page.value("document.querySelectorAll('button.component').length") < 1000
    page.press("/")
    page.write("sensor-777")
    page.until("document.querySelectorAll('button.component').length === 1")
    change(EcologyChange(components={"urn:c:777": {**crowd["urn:c:777"], "state": "absent"}}))
    page.says("#tally", "999 of 1000 components alive")
    accessible(page)
