"""A forked program is as one that was begun by itself: what it is given, what it says, and how it ends."""

from __future__ import annotations

import os
import signal
import subprocess
from pathlib import Path

import pytest

from tests.harness.fork_server import ForkedProgram

pytestmark = pytest.mark.process
ENVIRONMENT = {"ABOVE": "yes", "PATH": os.defpath}


class Begun:
    """A forked program that was written by a test."""

    def __init__(self, folder: Path, text: str, *words: str) -> None:
        (folder / "some_program.py").write_text(text)
        self.read_end, write_end = os.pipe()
        self.process = ForkedProgram(["some_program.py", *words], ENVIRONMENT, folder, write_end)
        os.close(write_end)

    def said(self) -> tuple[str, str, int]:
        """What it has written on each stream by its end, and its exit code."""
        with os.fdopen(self.read_end) as out, self.process.stderr as error:
            return out.read(), error.read(), self.process.wait(60)


def test_it_has_its_arguments_environment_folder_and_streams(tmp_path: Path) -> None:
    text = (
        "import os, sys\nprint(__name__, sys.argv, dict(os.environ), os.getcwd(), sys.stdin.read())\n"
        "print('no', file=sys.stderr)\nassert sys.stdout.fileno() == 1 and not sys.stdout.isatty()\n"
    )
    out, error, code = Begun(tmp_path, text, "a", "b c").said()
    assert out == f"__main__ ['some_program.py', 'a', 'b c'] {ENVIRONMENT} {tmp_path} \n"
    assert (error, code) == ("no\n", 0)


@pytest.mark.parametrize(
    ("text", "code", "error"),
    [
        ("raise SystemExit(3)", 3, ""),
        ("raise SystemExit", 0, ""),
        ("raise SystemExit('so it is')", 1, "so it is"),
        ("raise ValueError('so it is')", 1, "ValueError: so it is"),
        ("raise KeyboardInterrupt", -signal.SIGINT, ""),
        ("import os; os._exit(5)", 5, ""),
    ],
)
def test_it_ends_as_python_does(tmp_path: Path, text: str, code: int, error: str) -> None:
    _, complaints, ended = Begun(tmp_path, text).said()
    assert ended == code
    assert error in complaints


def test_it_waits_for_its_threads_and_then_does_what_is_left_for_its_end(tmp_path: Path) -> None:
    text = (
        "import atexit, threading\natexit.register(print, 'last')\n"
        "main = threading.main_thread()\nthreading.Thread(target=lambda: (main.join(), print('before'))).start()\n"
    )
    assert Begun(tmp_path, text).said()[0] == "before\nlast\n"


def test_it_can_be_waited_for_and_ended(tmp_path: Path) -> None:
    begun = Begun(tmp_path, "import os, signal\nos.write(1, b'!')\nsignal.pause()\n")
    assert os.read(begun.read_end, 1) == b"!"
    assert begun.process.poll() is None
    with pytest.raises(subprocess.TimeoutExpired):
        begun.process.wait(0.01)
    begun.process.send_signal(signal.SIGTERM)
    assert begun.process.wait(60) == -signal.SIGTERM == begun.process.poll()
    begun.process.send_signal(signal.SIGTERM)  # it has ended
    assert begun.said() == ("", "", -signal.SIGTERM)


def test_one_that_has_ended_unheard_of_is_sent_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    begun = Begun(tmp_path, "")
    assert begun.said() == ("", "", 0)
    monkeypatch.setattr(ForkedProgram, "poll", lambda _: None)
    begun.process.send_signal(signal.SIGTERM)
