"""File checks in many processes and from memory: the verdicts are those of one process without a memory."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

import pytest

import selfconf as sc
from selfconf.api.file_checks import Remembered
from selfconf.api.validation import check
from selfconf.model.diagnostic import Diagnostic
from selfconf.rdf.validation.checking import FileChecker, UnclearedFile
from tests.harness.effort import thorough


def test_a_remembered_report_is_the_same_and_is_kept_in_the_cache_of_the_user(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    first = sc.validate("tests/bad/bound-twice.ttl", cache=True)
    assert list(tmp_path.rglob("validate/*.json"))
    assert sc.validate("tests/bad/bound-twice.ttl", cache=True) == first == sc.validate("tests/bad/bound-twice.ttl")


BAD = Path(__file__).parents[1] / "bad"


class Counting:
    """Looks at each uncleared file, and notes what it has looked at."""

    def __init__(self) -> None:
        self.names: list[str] = []

    def __call__(self, checker: FileChecker, uncleared: Sequence[UnclearedFile]) -> Iterable[list[Diagnostic]]:
        self.names += [Path(one.source.name).name for one in uncleared]
        return map(checker, uncleared)


@pytest.fixture
def files(tmp_path: Path) -> Path:
    """Some bad files and a good one, in a folder of their own."""
    folder = tmp_path / "files"
    folder.mkdir()
    for path in sorted(BAD.glob("*.ttl"))[::40]:
        (folder / path.name).write_bytes(path.read_bytes())
    (folder / "good.ttl").write_text("<urn:a> a <https://w3id.org/selfconf#Component> , <urn:Kind> .")
    return folder


PROGRAM = """
import os, signal, sys, threading
signal.signal(signal.SIGTERM, lambda *_: None)
from selfconf.api import file_checks, validation
forked = []
os.register_at_fork(before=lambda: forked.append(1))
file_checks.WORTH = 1
os.cpu_count = lambda: 8
stopped = threading.Event()
if sys.argv[1] == "threads":
    threading.Thread(target=stopped.wait).start()
for found in validation.check(sys.argv[2:], each=file_checks.shared).diagnostics:
    print(found)
stopped.set()
print(len(forked))
"""
"""Validates files in eight processes, in a program with a handler of SIGTERM, which these inherit."""


@thorough
@pytest.mark.slow
@pytest.mark.parametrize(("threads", "forks"), [("none", 8), ("threads", 0)])
def test_processes_give_the_verdicts_of_one_and_are_forked_where_there_are_no_threads(
    threads: str, forks: int, files: Path
) -> None:
    ended = subprocess.run(
        [sys.executable, "-c", PROGRAM, threads, str(files)], capture_output=True, text=True, timeout=60, check=True
    )
    *found, forked = ended.stdout.splitlines()
    assert found == [str(one) for one in check([str(files)]).diagnostics]
    assert len(found) > 5
    assert int(forked) == forks


INTERRUPTED = """
import os, signal, time
from selfconf.api import file_checks

signal.signal(signal.SIGINT, signal.default_int_handler)  # what a shell starts in the background ignores it

def check(suspect):
    if suspect == "last":
        os.killpg(0, signal.SIGINT)  # as the terminal does at Ctrl-C
        time.sleep(30)  # the signal ends it at once, unless it is not heard
    return []

file_checks.WORTH = 1
os.cpu_count = lambda: 4
try:
    list(file_checks.shared(check, ["first", *["next"] * 8, "last"]))
except KeyboardInterrupt:
    print("interrupted")
"""
"""Is interrupted, with all its processes, while these check files."""


@pytest.mark.slow
def test_the_processes_say_nothing_when_all_are_interrupted() -> None:
    ended = subprocess.run(
        [sys.executable, "-c", INTERRUPTED],
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
        start_new_session=True,
    )
    assert (ended.stdout, ended.stderr) == ("interrupted\n", "")


LEFT = """
import os, signal
from selfconf.api import file_checks

here = os.getpid()

def check(suspect):
    if suspect == 7 and os.getpid() != here:
        os.kill(os.getpid(), signal.SIGKILL)
    if suspect == 9:
        raise ValueError("nine" if os.getpid() == here else "where another process is")
    return suspect

file_checks.WORTH = 1
os.cpu_count = lambda: 3
try:
    for found in file_checks.shared(check, list(range(12))):
        print(found, end=" ")
except ValueError as error:
    print(error)
"""
"""One process is killed at 7; 9 cannot be checked at all."""


@pytest.mark.slow
def test_what_a_process_leaves_is_checked_by_the_program_and_a_failure_is_told_by_it() -> None:
    ended = subprocess.run([sys.executable, "-c", LEFT], capture_output=True, text=True, timeout=60, check=True)
    assert (ended.stdout, ended.stderr) == ("0 1 2 3 4 5 6 7 8 nine\n", "")


@pytest.mark.slow
def test_memory_gives_the_same_verdicts_and_looks_at_nothing_twice(files: Path, tmp_path: Path) -> None:
    plain, counting = check([str(files)]), Counting()
    for _ in range(3):
        assert check([str(files)], each=Remembered(tmp_path, [str(files)], counting)) == plain
    assert len(counting.names) == len(set(counting.names)) > 5


@pytest.mark.slow
def test_only_what_has_changed_is_looked_at_again(files: Path, tmp_path: Path) -> None:
    first, again = Counting(), Counting()
    for counting in (first, again):
        check([str(files)], each=Remembered(tmp_path, [str(files)], counting))
    assert again.names == []
    changed = files / min(first.names)
    changed.write_text(changed.read_text() + "\n# changed\n")
    counting = Counting()
    check([str(files)], each=Remembered(tmp_path, [str(files)], counting))
    assert counting.names == [changed.name]


@pytest.mark.slow
def test_what_another_file_declares_counts_in_memory_too(files: Path, tmp_path: Path) -> None:
    user = files / "user.ttl"
    user.write_text(
        "@prefix sc: <https://w3id.org/selfconf#> . <urn:u> a sc:Component, <urn:Kind> ;"
        ' sc:hasOutput [ sc:name "x" ; sc:signalType <urn:Noise> ] .'
    )

    def codes() -> list[str]:
        found = check([str(files)], each=Remembered(tmp_path, [str(files)]))
        return [each.code for each in found.diagnostics if each.file == str(user)]

    assert codes() == ["SC-L03"]
    (files / "words.ttl").write_text(
        "<urn:Noise> a <http://www.w3.org/2002/07/owl#Class> ; <http://www.w3.org/2000/01/rdf-schema#label> 'noise' ."
    )
    assert codes() == []
    (files / "words.ttl").unlink()
    assert codes() == ["SC-L03"]


@pytest.mark.slow
@pytest.mark.parametrize(
    "content", ["", "no JSON", "[]", '{"versions": {}}', '{"versions": 1, "outcomes": {"x": [1]}}']
)
def test_a_memory_that_is_broken_or_of_other_versions_is_forgotten(content: str, files: Path, tmp_path: Path) -> None:
    plain = check([str(files)], each=Remembered(tmp_path, [str(files)]))
    (kept,) = (tmp_path / "validate").iterdir()
    kept.write_text(content)
    assert check([str(files)], each=Remembered(tmp_path, [str(files)])) == plain
    assert json.loads(kept.read_text())["outcomes"]


@pytest.mark.slow
def test_a_memory_that_cannot_be_written_is_done_without(files: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("no folder")
    assert check([str(files)], each=Remembered(tmp_path / "file", [str(files)])) == check([str(files)])


def test_a_memory_has_files_whose_names_are_no_utf_8(tmp_path: Path) -> None:
    (tmp_path / "caf\udce9.ttl").write_bytes((BAD / "bound-twice.ttl").read_bytes())
    counting = Counting()
    first = check([str(tmp_path)], each=Remembered(tmp_path / "memory", ["."], counting))
    assert check([str(tmp_path)], each=Remembered(tmp_path / "memory", ["."], counting)) == first
    assert counting.names == ["caf\udce9.ttl"]


def test_a_memory_of_other_code_is_forgotten(files: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before, after = Counting(), Counting()
    check([str(files)], each=Remembered(tmp_path, [str(files)], before))
    monkeypatch.setattr("selfconf.api.file_checks._own_version", lambda: "edited")
    check([str(files)], each=Remembered(tmp_path, [str(files)], after))
    assert sorted(before.names) == sorted(after.names) != []
