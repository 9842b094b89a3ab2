"""From nothing to a running task on two hosts, by typing what the page says; where the machine has namespaces."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.access.two_hosts import ROOT
from tests.harness.effort import of_keys

NAMESPACE = ["unshare", "-rn"]
TOOLS = ("unshare", "nsenter", "ip")


def has_namespaces() -> bool:
    """Whether this user may make two network namespaces with a cable between them."""
    if not all(map(shutil.which, TOOLS)):
        return False
    tried = subprocess.run([*NAMESPACE, "ip", "link", "add", "v0", "type", "veth"], capture_output=True, check=False)
    return tried.returncode == 0


@of_keys
@pytest.mark.process
def test_two_hosts_become_an_ecology_with_keys_by_one_page(tmp_path: Path) -> None:
    if not has_namespaces():
        pytest.skip("this user may make no network namespaces here")
    followed = subprocess.run(
        [*NAMESPACE, sys.executable, "-m", "tests.access.two_hosts", str(tmp_path)],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert followed.returncode == 0, followed.stderr
    assert "site.attic" in followed.stdout
    assert followed.stdout.count("refused: nothing") == 2
    (running,) = (one for one in map(parsed, followed.stdout.splitlines()) if one.get("act") == "running")
    players = {component for role in running["configuration"]["roles"] for component in role["components"]}
    assert players == {"https://example.org/my-home#clock", "https://example.org/my-home#display"}


def parsed(line: str) -> dict[str, object]:
    """A line of JSON; nothing for another."""
    found: dict[str, object] = json.loads(line) if line.startswith("{") else {}
    return found
