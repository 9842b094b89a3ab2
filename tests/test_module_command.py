"""A module is run as a program with the path of imports that the program has which runs it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from selfconf.module_command import module_command


@pytest.fixture
def folder_of_a_stranger(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, which holds modules of Python's own names."""
    for name in ("json", "runpy", "selfconf"):
        (tmp_path / f"{name}.py").write_text("raise SystemExit('a stranger runs')\n", "utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.process
@pytest.mark.usefixtures("folder_of_a_stranger")
def test_what_lies_in_the_current_folder_is_not_run() -> None:
    done = subprocess.run(module_command("json.tool"), input="[1]", capture_output=True, text=True, check=False)
    assert (done.stdout.split(), done.stderr) == (["[", "1", "]"], "")


@pytest.mark.process
@pytest.mark.usefixtures("folder_of_a_stranger")
def test_no_file_of_the_current_folder_takes_part_in_a_query() -> None:
    script = "import sys; sys.path.remove(''); import selfconf as sc; print(sc.read().query('ASK {}'))"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert (done.stdout, done.stderr) == ("True\n", "")


@pytest.mark.process
def test_what_this_program_finds_is_found_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "gerätë 'x'"
    folder.mkdir()
    (folder / "told.py").write_text("import sys\nprint(__name__, sys.argv[1:])\n", "utf-8")
    monkeypatch.setattr(sys, "path", [tmp_path, str(folder), *sys.path])  # Python passes over what is no text
    done = subprocess.run(module_command("told", "-x", "ä b"), capture_output=True, encoding="utf-8", check=False)
    assert (done.stdout, done.stderr) == ("__main__ ['-x', 'ä b']\n", "")
