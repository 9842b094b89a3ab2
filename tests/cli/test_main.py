"""The command line as a whole: a command loads what it needs, and help tells of all."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from selfconf.cli.main import COMMANDS, NO_THREAD, command, main

ROOT = Path(__file__).resolve().parents[2]
ACTIONS = ("keys init", "keys issue", "keys renew", "keys show", "keys revoke", "bridge wot", "bridge ros2")
LOADED = """
import sys
from selfconf.cli.main import main
code = main(sys.argv[1:])
print(*sorted(sys.modules), file=sys.stderr)
sys.exit(code)
"""


def test_validating_what_is_right_loads_neither_the_network_nor_a_reasoner(tmp_path: Path) -> None:
    (tmp_path / "a.ttl").write_text("<urn:a> a <https://w3id.org/selfconf#Component> , <urn:Kind> .")
    command = [sys.executable, "-c", LOADED, "validate", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    loaded = set(done.stderr.split())
    assert "selfconf.cli.validate" in loaded
    assert loaded.isdisjoint(("zenoh", "rdflib", "pyshacl", "owlrl", "selfconf.cli.run", "selfconf.cli.configure"))


def test_where_no_thread_can_begin_a_sentence_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def no_thread(*_: object, **__: object) -> None:
        raise RuntimeError(NO_THREAD)

    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(tmp_path))
    begin = "_start_new_thread" if hasattr(threading, "_start_new_thread") else "_start_joinable_thread"  # since 3.13
    monkeypatch.setattr(threading, begin, no_thread)
    assert main(["site", str(tmp_path), "--ecology", "crowded"]) == 2
    said = capsys.readouterr().err
    assert said.startswith("selfconf site: the system lets it begin no further thread; allow more by `ulimit -u`")
    assert "Traceback" not in said


def test_another_fault_of_the_program_is_not_taken_for_a_lack_of_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(_: object) -> int:
        raise RuntimeError("it is broken")

    monkeypatch.setattr(command("new"), "run", broken)
    with pytest.raises(RuntimeError, match="it is broken"):
        main(["new", "component", "clock"])


def test_what_the_system_refuses_is_one_sentence(
    capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(_: object) -> int:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "clock.ttl")

    monkeypatch.setattr(command("new"), "run", full)
    assert main(["new", "component", "clock"]) == 2
    assert capfd.readouterr().err == "selfconf new: clock.ttl: No space left on device\n"


def test_the_version_is_an_answer(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["--version"])
    assert ended.value.code == 0
    said = capsys.readouterr()
    assert said.out.startswith("selfconf ")
    assert (said.out.count("\n"), said.err) == (1, "")


def test_help_lists_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["--help"])
    assert ended.value.code == 0
    said = capsys.readouterr().out
    assert all(f"\n    {name}" in said for name in COMMANDS)


@pytest.mark.parametrize("name", [*COMMANDS, *ACTIONS])
def test_every_command_has_help_with_an_example(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main([*name.split(), "--help"])
    assert ended.value.code == 0
    assert "example:\n" in capsys.readouterr().out


@pytest.mark.parametrize("name", COMMANDS)
def test_the_files_of_an_example_are_there(name: str) -> None:
    lines = command(name).EXAMPLE.splitlines()
    assert all(line.startswith("  ") for line in lines)
    if name != "new":
        words = [
            word for line in lines for word in line.split() if word.endswith(".ttl") or word.startswith("examples")
        ]
        assert [word for word in words if not (ROOT / word).exists()] == []


def test_a_command_that_there_is_not_is_misuse(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["validat"])
    assert ended.value.code == 2
    assert "validate" in capsys.readouterr().err
