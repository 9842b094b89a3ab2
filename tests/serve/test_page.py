"""The page in a real browser: it shows a failure as it happens, looks back in time, and runs nothing of strangers."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterator
from typing import Any

import pytest

from tests.cli.processes import Home
from tests.lab import PREFIXES

sync_api = pytest.importorskip("playwright.sync_api", reason="playwright, which drives a browser, is not installed")
CHROMIUM = os.environ.get("SELFCONF_CHROMIUM") or shutil.which("chromium") or shutil.which("chromium-browser")
pytestmark = [
    pytest.mark.process,
    pytest.mark.slow,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium; SELFCONF_CHROMIUM names one"),
]
HOSTILE = "<img src=x onerror=document.title='caught'><script>document.title='caught'</script>"
EVIL = f'{PREFIXES}<https://example.org/peis-home#evil> a sc:Component, <urn:x:%3Cb%3E> ; rdfs:label "{HOSTILE}" .'


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Home]:
    """The paper's ecology, with one component that means harm, and a task that runs."""
    home = Home(tmp_path_factory.mktemp("page"))
    (home.folder / "ads" / "evil.ttl").write_text(EVIL)
    home.site("peis-home", "ads")
    home.components("sonar", "encoder", "tracker", "odometry", "control", "drive")
    home.run().act("running")
    yield home
    home.close()


@pytest.fixture(scope="module")
def url(home: Home) -> str:
    """Where a server shows that ecology."""
    said = home.selfconf("serve", "--ecology", home.ecology, "--port", "0").line()
    found = re.search(r"http://\S+/", said)
    assert found is not None, said
    return found[0]


@pytest.fixture
def page(url: str) -> Iterator[Any]:
    """The page in a browser that notes what goes wrong and whom it asks; a refused query is what a test may ask for."""
    with sync_api.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1280, "height": 800})
        trouble: list[str] = []
        page.on("pageerror", lambda error: trouble.append(str(error)))
        page.on(
            "console",
            lambda message: (
                trouble.append(message.text) if "error" in message.type and "400" not in message.text else None
            ),
        )
        page.on("request", lambda request: None if request.url.startswith(url) else trouble.append(request.url))
        page.goto(url)
        page.get_by_role("button", name="person-tracker").first.wait_for()
        yield page
        browser.close()
    assert trouble == []


def test_a_failure_is_seen_as_it_happens_and_can_be_looked_back_at(home: Home, page: Any) -> None:
    position = page.locator(".box", has_text="position")
    sync_api.expect(position.locator(".face .name")).to_have_text("person-tracker")
    (home.folder / "tracker.fail").touch()
    sync_api.expect(position.locator(".face .name")).to_have_text("absolute-odometry")
    sync_api.expect(position.locator(".caption")).to_contain_text("instead of person-tracker: it failed")
    sync_api.expect(page.locator(".events")).to_contain_text(
        "absolute-odometry takes over position from person-tracker"
    )
    page.get_by_role("button", name="the configuration runs").click()
    sync_api.expect(position.locator(".face .name")).to_have_text("person-tracker")
    page.get_by_role("button", name="Back to now").click()
    sync_api.expect(position.locator(".face .name")).to_have_text("absolute-odometry")


def test_what_a_stranger_wrote_stays_text(page: Any) -> None:
    page.get_by_role("button", name="evil").click()
    sync_api.expect(page.locator(".detail .lead")).to_have_text(HOSTILE)
    sync_api.expect(page.locator(".detail .turtle")).to_contain_text(HOSTILE)
    assert page.locator(".detail img, .detail script").count() == 0
    sync_api.expect(page).not_to_have_title("caught")


def test_the_page_is_used_by_keyboard(page: Any) -> None:
    page.keyboard.press("/")
    page.keyboard.type("thinking")
    page.keyboard.press("Tab")
    while page.evaluate("document.activeElement.className") != "component":
        page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    sync_api.expect(page.locator(".detail .title")).to_have_text("thinking-cap")
    page.keyboard.press("Escape")
    sync_api.expect(page.locator(".detail .hint")).to_be_visible()


def test_a_question_in_sparql_is_answered_on_the_page(page: Any) -> None:
    page.get_by_role("button", name="Query").click()
    page.get_by_role("button", name="Who feeds whom").click()
    sync_api.expect(page.locator(".answer tbody tr")).to_have_count(4)
    page.locator("#sparql").fill("SELEKT")
    page.keyboard.press("Control+Enter")
    sync_api.expect(page.locator(".answer")).to_contain_text("it begins with 'SELEKT'")
