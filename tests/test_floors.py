"""The floors of the house: imports run downward only."""

from __future__ import annotations

import ast
import configparser
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def test_the_floors_are_kept() -> None:
    lint = Path(sys.executable).parent / "lint-imports"
    outcome = subprocess.run([lint, "--no-cache"], cwd=ROOT, capture_output=True, text=True, check=False)
    assert outcome.returncode == 0, outcome.stdout


def test_the_page_of_the_architecture_has_each_package_on_a_floor() -> None:
    contracts = configparser.ConfigParser()
    contracts.read(ROOT / ".importlinter")
    layers = set(re.findall(r"\w+", contracts["importlinter:contract:floors"]["layers"]))
    rows = re.findall(r"^\| \d+ \| .* \|$", (ROOT / "docs" / "architecture.md").read_text("utf-8"), re.MULTILINE)
    assert layers - {"__main__"} - set(re.findall(r"`(\w+)(?:/|\.py)`", "\n".join(rows))) == set()


def test_no_module_has_a_name_that_says_nothing() -> None:
    nothing = {"utils", "util", "helper", "helpers", "manager", "handler", "data", "info", "misc", "common"}
    found = [path for top in ("selfconf", "sim") for path in (ROOT / top).rglob("*.py") if path.stem in nothing]
    assert found == []


def test_every_name_that_a_door_exports_is_explained_there() -> None:
    unexplained = []
    for path in (ROOT / "selfconf").rglob("__init__.py"):
        door = ast.parse(path.read_text("utf-8"))
        explained = " ".join(re.findall(r"`([^`]*)`", ast.get_docstring(door) or ""))
        for node in door.body:
            if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
                names = ast.literal_eval(node.value)
                unexplained += [(path, name) for name in names if not re.search(rf"\b{name}\b", explained)]
    assert unexplained == []


def test_every_module_says_what_it_is() -> None:
    for top in ("selfconf", "sim"):
        for path in (ROOT / top).rglob("*.py"):
            if path.name == "__main__.py":
                continue
            assert path.read_text().startswith(('"""', 'r"""')), path
