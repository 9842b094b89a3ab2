"""What users hang into their CI: the lines of `docs/ci.md`, the action and the hook install selfconf and run it."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from selfconf.cli.main import command, parser
from tests.harness.effort import at_night, thorough

pytestmark = pytest.mark.process

yaml = pytest.importorskip("yaml", reason="PyYAML is not installed")
ROOT = Path(__file__).parents[2]
ACTION: dict[str, Any] = yaml.safe_load((ROOT / "action.yml").read_text())
HOOKS: list[dict[str, Any]] = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text())
PAGE = (ROOT / "docs" / "ci.md").read_text()
BLOCKS: list[Any] = [yaml.safe_load(block) for block in re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL)]
GOOD = """\
@prefix : <https://example.org/home#> .
@prefix sc: <https://w3id.org/selfconf#> .
@prefix rob: <https://w3id.org/selfconf/robotics#> .
:tuner a sc:Component, rob:Tuner .
"""
WRONG = GOOD.replace(", rob:Tuner", "")
STRANGE = GOOD.replace("rob:Tuner", "rob:Toaster")
Validated = Callable[..., subprocess.CompletedProcess[str]]
VOCABULARY = "<https://w3id.org/selfconf/robotics#Toaster> a <http://www.w3.org/2002/07/owl#Class> .\n"


def runner(folder: Path) -> Path:
    """A user's repository, and a runner beside it on which selfconf is installed."""
    (folder / "repo" / "my robots").mkdir(parents=True)
    program = folder / "runner" / "selfconf" / "bin" / "selfconf"
    program.parent.mkdir(parents=True)
    program.write_text(f'#!/bin/sh\nexec {shlex.quote(sys.executable)} -m selfconf "$@"\n')
    program.chmod(0o755)
    return folder / "repo"


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """A repository of this test alone."""
    return runner(tmp_path)


@pytest.fixture(scope="module")
def offline() -> dict[str, str]:
    """What lets pip install selfconf without a network: what it builds on and depends on is this Python's own."""
    pytest.importorskip("hatchling", reason="hatchling, which builds the wheel, is not installed")
    packages = sysconfig.get_path("purelib")
    return {"PIP_NO_INDEX": "1", "PIP_NO_DEPS": "1", "PIP_NO_BUILD_ISOLATION": "0", "PYTHONPATH": packages}


def python_of(folder: Path) -> Path:
    """A Python that makes environments without pip, which takes seconds to unpack: `offline` has that of this one."""
    program = folder / "python"
    program.write_text(
        f"#!/bin/sh\npython={shlex.quote(sys.executable)}\n"
        '[ "$1 $2" != "-m venv" ] || exec "$python" -m venv --without-pip "$3"\nexec "$python" "$@"\n'
    )
    program.chmod(0o755)
    return program


def on_runner(repository: Path, script: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """A step as a runner would run it."""
    command = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", script]
    env = {**os.environ, "RUNNER_TEMP": str(repository.parent / "runner"), **environment}
    return subprocess.run(command, cwd=repository, env=env, capture_output=True, text=True, check=False)


def action_step(
    repository: Path, number: int, given: dict[str, str], **environment: str
) -> subprocess.CompletedProcess[str]:
    """A step of the action; what is not given has its default."""
    step = ACTION["runs"]["steps"][number]
    inputs = {name: entry["default"] for name, entry in ACTION["inputs"].items()} | given
    filled = {
        name: re.sub(r"\$\{\{ inputs\.(\w+) \}\}", lambda match: inputs[match[1]], value)
        for name, value in step["env"].items()
    }
    return on_runner(repository, step["run"], **filled, **environment)


@pytest.fixture(scope="module")
def validated(tmp_path_factory: pytest.TempPathFactory) -> Validated:
    """The last step of the action, over a file with some text and beside a vocabulary; the same is asked once."""

    @cache
    def ask(text: str, ontology: str = "", strict: str = "false") -> subprocess.CompletedProcess[str]:
        repository = runner(tmp_path_factory.mktemp("validated"))
        (repository / "my robots" / "tuner.ttl").write_text(text)
        (repository / "my words.ttl").write_text(VOCABULARY)
        return action_step(repository, -1, {"paths": "my robots\n", "ontology": ontology, "strict": strict})

    return ask


@thorough
def test_the_action_installs_the_checkout_it_lies_in(repository: Path, offline: dict[str, str]) -> None:
    shutil.rmtree(repository.parent / "runner")
    (repository / "my robots" / "tuner.ttl").write_text(WRONG)
    python = str(python_of(repository.parent))
    done = action_step(repository, 0, {"python": python}, GITHUB_ACTION_PATH=str(ROOT), **offline)
    assert done.returncode == 0, done.stderr
    done = action_step(repository, -1, {}, **offline)
    assert (done.returncode, done.stdout.partition(",")[0]) == (1, "::error file=my robots/tuner.ttl"), done
    where = 'cd / && "$RUNNER_TEMP/selfconf/bin/python" -c "import selfconf; print(selfconf.__file__)"'
    assert on_runner(repository, where, **offline).stdout.startswith(str(repository.parent / "runner"))


@at_night
def test_the_three_lines_need_one_thing_filled_in(repository: Path, offline: dict[str, str]) -> None:
    shutil.rmtree(repository.parent / "runner")
    lines, _, _ = BLOCKS
    (repository / "robots").mkdir()
    (repository / "robots" / "tuner.ttl").write_text(WRONG)
    install, validate = (step["run"] for step in lines[1:])
    assert "SELFCONF" in install
    (program := repository.parent / "bin" / "python3").parent.mkdir()
    program.symlink_to(sys.executable)
    path = f"{program.parent}{os.pathsep}{os.environ['PATH']}"
    done = on_runner(repository, install.replace("SELFCONF", shlex.quote(str(ROOT))), PATH=path, **offline)
    assert done.returncode == 0, done.stderr
    done = on_runner(repository, validate, **offline)
    assert (done.returncode, done.stdout.partition(",")[0]) == (1, "::error file=robots/tuner.ttl"), done


@pytest.mark.parametrize(("text", "code"), [(GOOD, 0), (STRANGE, 0), (WRONG, 1), ("no Turtle", 2)])
def test_the_action_ends_as_validate_ends(validated: Validated, text: str, code: int) -> None:
    assert validated(text).returncode == code


def test_the_action_writes_workflow_commands(validated: Validated) -> None:
    assert validated(WRONG).stdout.startswith("::error file=my robots/tuner.ttl,line=4,")


def test_the_action_knows_the_ontologies_it_is_given(validated: Validated) -> None:
    assert "::warning" in validated(STRANGE).stdout
    assert not validated(STRANGE, ontology="my words.ttl\n").stdout


def test_warnings_fail_the_action_where_it_is_strict(validated: Validated) -> None:
    assert validated(STRANGE).returncode == 0
    assert validated(STRANGE, strict="true").returncode == 1


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


def test_the_hook_takes_a_folder_of_ontologies_as_the_page_says(repository: Path) -> None:
    (hook,) = HOOKS
    (arguments,) = re.findall(r"`args: \[(--ontology.*?)\]`", PAGE)
    (repository / "vocabulary").mkdir()
    (repository / "vocabulary" / "words.ttl").write_text(VOCABULARY)
    (repository / "tuner.ttl").write_text(STRANGE)
    entry = [sys.executable, "-m", *shlex.split(hook["entry"])]
    for given, code in ((["--warnings-as-errors"], 1), (arguments.split(", "), 0)):
        done = subprocess.run([*entry, *given, "tuner.ttl"], cwd=repository, capture_output=True, check=False)
        assert done.returncode == code, done


def test_the_page_speaks_of_what_there_is() -> None:
    lines, (_, action), hooks = BLOCKS
    assert len(lines) == 3
    assert action["uses"].startswith("./")
    assert action["with"].keys() <= ACTION["inputs"].keys()
    ((local,),) = (repo["hooks"] for repo in hooks["repos"])
    assert local.pop("additional_dependencies") == ["SELFCONF"]
    assert [local] == [{key: value for key, value in hook.items() if key != "description"} for hook in HOOKS]
    for line in re.findall(r"^\$ selfconf (.*)$", PAGE, re.MULTILINE):
        assert parser().parse_args(shlex.split(line.partition(" >")[0])).run
    assert set(re.findall(r"--format (\w+)", PAGE)) < set(command("validate").REPORT_FORMATS)
