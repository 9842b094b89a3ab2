"""Clients that nobody here wrote: node-wot reads the directory of Things, YASGUI on a page of another origin asks."""

from __future__ import annotations

import functools
import http.server
import json
import re
import subprocess
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.cli.processes import PATIENCE, Home
from tests.foreign import node_command, npm_packages
from tests.harness.effort import at_night
from tests.lab import iri
from tests.serve.chromium import CHROMIUM, Chromium

pytestmark = [at_night, pytest.mark.process]
HERE = Path(__file__).parent
ROLES = "SELECT ?component WHERE { GRAPH ?component { ?component a sc:Component } } ORDER BY ?component"


@pytest.fixture
def home(tmp_path: Path) -> Iterator[Home]:
    """An ecology of which nothing but a site is there."""
    home = Home(tmp_path)
    home.site("peis-home", "ads")
    yield home
    home.close()


def served(home: Home, *options: str) -> str:
    """Where a server shows the ecology."""
    said = home.selfconf("serve", "--ecology", home.ecology, "--port", "0", *options).line()
    found = re.search(r"http://\S+/", said)
    assert found is not None, said
    return found[0]


def test_node_wot_reads_the_directory(home: Home) -> None:
    packages = npm_packages("@node-wot/core@0.9.2", "@node-wot/binding-http@0.9.2")
    command, environment = node_command(packages, HERE / "directory_client.js", served(home))
    read = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=PATIENCE, check=True)
    found = json.loads(read.stdout)
    assert iri("person-tracker") in found["things"]
    assert found["retrieved"] == found["things"][0]
    assert len(found["explored"]) == len(found["things"])
    assert "person-tracker" in found["explored"]


class Silent(http.server.SimpleHTTPRequestHandler):
    """Serves files, and says nothing of it."""

    def log_message(self, format: str, *arguments: object) -> None:
        """Nothing."""


@pytest.fixture
def yasgui(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of a page with YASGUI in it, at an origin of its own."""
    build = npm_packages("@triply/yasgui@4.2.28") / "node_modules" / "@triply" / "yasgui" / "build"
    handler = functools.partial(Silent, directory=str(build))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield f"http://127.0.0.1:{server.server_address[1]}/"
        server.shutdown()
        thread.join()


@pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium; SELFCONF_CHROMIUM names one")
@pytest.mark.parametrize("allowed", [True, False])
def test_yasgui_asks_from_a_page_of_another_origin(home: Home, yasgui: str, tmp_path: Path, allowed: bool) -> None:
    endpoint = served(home, *(("--allow-origin", yasgui.rstrip("/")) if allowed else ()))
    browser = Chromium(tmp_path / "browser")
    try:
        page = browser.page(f"{yasgui}yasgui.html")
        page.until("typeof Yasgui !== 'undefined'")
        page.value(
            "document.body.innerHTML = '<div id=\"here\"></div>'; localStorage.clear();"
            f" globalThis.gui = new Yasgui(here, {{ requestConfig: {{ endpoint: '{endpoint}sparql' }} }}); 0"
        )
        query = f"PREFIX sc: <https://w3id.org/selfconf#> {ROLES}"
        page.value(f"gui.getTab().yasqe.setValue({json.dumps(query)}); gui.getTab().yasqe.query().catch(() => 0); 0")
        if allowed:
            page.until("here.innerText.includes('person-tracker')")
        else:
            page.until("Boolean(document.querySelector('.errorResult'))")
            assert "person-tracker" not in page.text("body")
        page.close()
    finally:
        browser.close()
