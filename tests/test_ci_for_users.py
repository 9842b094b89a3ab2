"""What users hang into their CI: the action and the hook do offline what `docs/ci.md` says."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from selfconf.cli.main import command, parser

yaml = pytest.importorskip("yaml", reason="PyYAML is not installed")
ROOT = Path(__file__).parents[1]
ACTION: dict[str, Any] = yaml.safe_load((ROOT / "action.yml").read_text())
HOOKS: list[dict[str, Any]] = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text())
PAGE = (ROOT / "docs" / "ci.md").read_text()
GOOD = """\
@prefix : <https://example.org/home#> .
@prefix sc: <https://w3id.org/selfconf#> .
@prefix rob: <https://w3id.org/selfconf/robotics#> .
:tuner a sc:Component, rob:Tuner .
"""
WRONG = GOOD.replace(", rob:Tuner", "")
STRANGE = GOOD.replace("rob:Tuner", "rob:Toaster")
VOCABULARY = "<https://w3id.org/selfconf/robotics#Toaster> a <http://www.w3.org/2002/07/owl#Class> .\n"


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """A user's repository, and a runner on which selfconf is installed."""
    (tmp_path / "repo" / "my robots").mkdir(parents=True)
    program = tmp_path / "runner" / "selfconf" / "bin" / "selfconf"
    program.parent.mkdir(parents=True)
    program.write_text(f'#!/bin/sh\nexec {shlex.quote(sys.executable)} -m selfconf "$@"\n')
    program.chmod(0o755)
    return tmp_path / "repo"


def validate_step(repository: Path, paths: str, ontology: str = "") -> subprocess.CompletedProcess[str]:
    """The last step of the action, as a runner would run it."""
    step = ACTION["runs"]["steps"][-1]
    given = {"paths": paths, "ontology": ontology}
    filled = {
        name: re.sub(r"\$\{\{ inputs\.(\w+) \}\}", lambda match: given[match[1]], value)
        for name, value in step["env"].items()
    }
    environment = {**os.environ, **filled, "RUNNER_TEMP": str(repository.parent / "runner")}
    command = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]]
    return subprocess.run(command, cwd=repository, env=environment, capture_output=True, text=True, check=False)


@pytest.mark.parametrize(("text", "code"), [(GOOD, 0), (STRANGE, 0), (WRONG, 1), ("no Turtle", 2)])
def test_the_action_ends_as_validate_ends(repository: Path, text: str, code: int) -> None:
    (repository / "my robots" / "tuner.ttl").write_text(text)
    assert validate_step(repository, "my robots\n").returncode == code


def test_the_action_writes_workflow_commands(repository: Path) -> None:
    (repository / "my robots" / "tuner.ttl").write_text(WRONG)
    assert validate_step(repository, ".").stdout.startswith("::error file=my robots/tuner.ttl,line=4,")


def test_the_action_knows_the_ontologies_it_is_given(repository: Path) -> None:
    (repository / "my robots" / "tuner.ttl").write_text(STRANGE)
    (repository / "my words.ttl").write_text(VOCABULARY)
    assert "::warning" in validate_step(repository, "my robots").stdout
    assert not validate_step(repository, "my robots", "my words.ttl\n").stdout


def test_the_action_is_a_composite_of_shell_steps() -> None:
    assert ACTION["runs"]["using"] == "composite"
    assert all(step["shell"] == "bash" for step in ACTION["runs"]["steps"])
    assert "$GITHUB_ACTION_PATH" in ACTION["runs"]["steps"][0]["run"]


def test_inputs_reach_the_shell_as_variables_and_never_as_code() -> None:
    assert not any("${{" in step["run"] for step in ACTION["runs"]["steps"])


@pytest.mark.parametrize(("text", "code"), [(GOOD, 0), (WRONG, 1)])
def test_the_hook_runs_validate_on_the_files_of_a_commit(repository: Path, text: str, code: int) -> None:
    (hook,) = HOOKS
    file = repository / "my robots" / "tuner.ttl"
    file.write_text(text)
    assert re.search(hook["files"], str(file))
    assert not re.search(hook["files"], "my robots/tuner.ttl.orig")
    entry = [sys.executable, "-m", *shlex.split(hook["entry"])]
    assert subprocess.run([*entry, str(file)], cwd=repository, capture_output=True, check=False).returncode == code


def test_the_page_speaks_of_what_there_is() -> None:
    blocks = [yaml.safe_load(block) for block in re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL)]
    (_, action), (longer,), hooks = blocks
    assert action["with"].keys() | longer["with"].keys() <= ACTION["inputs"].keys()
    assert hooks["repos"][0]["hooks"] == [{"id": HOOKS[0]["id"]}]
    for line in re.findall(r"^\$ selfconf (.*)$", PAGE, re.MULTILINE):
        assert parser().parse_args(shlex.split(line.partition(" >")[0])).run
    assert set(re.findall(r"--format (\w+)", PAGE)) < set(command("validate").FORMATS)
