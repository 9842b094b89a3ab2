"""The README tells the truth: its files and commands are taken from it and run."""

from __future__ import annotations

import os
import re
import shlex
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest

pytestmark = pytest.mark.process

README = Path(__file__).parents[2] / "README.md"
FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
PATIENCE = 40.0


def blocks() -> Iterator[tuple[str, str]]:
    """Language and text of each block in the section on one's own component."""
    section = README.read_text().partition("## Your own component")[2].partition("\n## ")[0]
    for match in FENCE.finditer(section):
        yield match.group(1), match.group(2)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with the files that the README shows."""
    for language, text in blocks():
        name = text.partition("\n")[0].removeprefix("# ")
        if language in ("turtle", "python"):
            (tmp_path / name).write_text(text)
    return tmp_path


def commands() -> list[list[str]]:
    """The selfconf commands of the section, in order."""
    lines = [line for language, text in blocks() if language == "console" for line in text.splitlines()]
    return [shlex.split(line.removeprefix("$ "))[1:] for line in lines if line.startswith("$ selfconf ")]


def start(arguments: list[str], folder: Path) -> subprocess.Popen[str]:
    """One of the commands, begun in the folder."""
    environment = {**os.environ, "SELFCONF_RUNTIME_DIR": str(folder / "runtime")}
    command = [sys.executable, "-m", "selfconf", *arguments]
    return subprocess.Popen(
        command, cwd=folder, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )


def test_the_readme_shows_a_component_to_copy(folder: Path) -> None:
    assert {path.name for path in folder.iterdir()} >= {"clock.ttl", "clock.py", "display.ttl", "tell-the-time.ttl"}
    assert len(commands()) == 5


def test_the_commands_of_the_readme_do_what_it_says(folder: Path) -> None:
    validate, configure, query, _, cellar = commands()
    outcomes = []
    for arguments in (validate, configure, query, cellar):
        process = start(arguments, folder)
        words, _ = process.communicate(timeout=PATIENCE)
        outcomes.append((process.returncode, words))
    assert [code for code, _ in outcomes] == [0, 0, 0, 1], outcomes
    assert ":clock time" in outcomes[1][1]
    assert "kitchen" in outcomes[2][1]
    assert "place is kitchen, not cellar" in outcomes[3][1]


def test_the_readme_component_runs_until_it_is_interrupted(folder: Path) -> None:
    process = start(next(arguments for arguments in commands() if arguments[0] == "run"), folder)
    assert process.stdout is not None
    said = []
    for line in process.stdout:
        said.append(line)
        if re.fullmatch(r"\d\d:\d\d:\d\d\n", line):
            process.send_signal(signal.SIGINT)
            break
    rest, _ = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0, "".join(said) + rest
    assert "taken down" in rest


def test_the_examples_are_what_the_readme_shows(folder: Path) -> None:
    examples = README.parent / "examples" / "clock"
    for name in ("clock.ttl", "display.ttl"):
        shown = (folder / name).read_text().partition("\n")[2]
        assert shown == (examples / name).read_text()


def running(folder: Path, word: bytes) -> list[int]:
    """The processes that run in a folder and have a word in their command line."""
    found = []
    for entry in Path("/proc").iterdir():
        with suppress(OSError):
            if entry.name.isdigit() and (entry / "cwd").resolve() == folder.resolve():
                found += [int(entry.name)] if word in (entry / "cmdline").read_bytes() else []
    return found


def test_a_crashed_component_is_started_again_by_its_site(folder: Path) -> None:
    arguments = next(arguments for arguments in commands() if arguments[0] == "run")
    process = start(arguments, folder)
    assert process.stdout is not None
    said, killed = [], False
    for line in process.stdout:
        said.append(line)
        if re.fullmatch(r"\d\d:\d\d:\d\d\n", line):
            if killed:
                break
            killed = True
            for number in running(folder, b"display.py"):
                os.kill(number, signal.SIGKILL)
    process.send_signal(signal.SIGINT)
    rest, _ = process.communicate(timeout=PATIENCE)
    assert "LOST   :display: crash" in "".join(said)
    assert process.returncode == 0, "".join(said) + rest


def test_a_run_whose_words_cannot_be_written_ends(folder: Path) -> None:
    arguments = next(arguments for arguments in commands() if arguments[0] == "run")
    environment = {**os.environ, "SELFCONF_RUNTIME_DIR": str(folder / "runtime")}
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "selfconf", *arguments],
            cwd=folder,
            env=environment,
            stdout=full,
            stderr=full,
            timeout=PATIENCE,
            check=False,
        )
    assert done.returncode == 2
