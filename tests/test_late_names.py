"""Names of a package that are loaded when they are first used."""

from __future__ import annotations

import subprocess
import sys
import time
from importlib import import_module
from pathlib import Path

import pytest

from selfconf.__main__ import main as command_line
from selfconf.cli import main as program

ROOT = Path(__file__).resolve().parents[1]


@pytest.mark.parametrize(
    ("package", "name", "module"),
    [
        ("selfconf", "Refusal", "selfconf.model.refusal"),
        ("selfconf.query", "read_endpoint", "selfconf.query.endpoint"),
        ("selfconf.deployment", "TaskRunner", "selfconf.deployment.runner"),
    ],
)
def test_a_name_is_loaded_when_it_is_first_used_and_not_before(package: str, name: str, module: str) -> None:
    program = (
        f"import sys, {package}; assert {module!r} not in sys.modules;"
        f" found = {package}.{name}; assert {module!r} in sys.modules; assert vars({package})[{name!r}] is found"
    )
    subprocess.run([sys.executable, "-c", program], check=True)


@pytest.mark.parametrize("package", ["selfconf", "selfconf.query", "selfconf.deployment"])
def test_a_name_that_a_package_has_not_is_an_attribute_error(package: str) -> None:
    with pytest.raises(AttributeError, match=f"^module '{package}' has no attribute 'nothing'$"):
        _ = import_module(package).nothing


def test_a_command_is_there_to_be_interrupted_before_anything_large_is_loaded() -> None:
    look = "import sys; before = set(sys.modules); import selfconf.__main__; print(*sorted(set(sys.modules) - before))"
    loaded = subprocess.run([sys.executable, "-S", "-c", look], cwd=ROOT, capture_output=True, text=True, check=True)
    assert set(loaded.stdout.split()) <= {"__future__", "gc", "selfconf", "selfconf.__main__", "selfconf.late_names"}


def test_what_interrupts_python_as_it_makes_a_class_is_no_traceback(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupted() -> int:
        raise RuntimeError("Error calling __set_name__") from KeyboardInterrupt()

    monkeypatch.setattr(program, "main", interrupted)
    assert command_line() == 130
    assert capsys.readouterr().err == "selfconf: interrupted\n"


LOST = """
import signal, sys, time, weakref
from selfconf import __main__ as command
from selfconf.cli import main as program

class Referred:
    pass

def interrupted(_):
    signal.raise_signal(signal.SIGINT)

def run():
    referred = Referred()
    reference = weakref.ref(referred, interrupted)
    del referred
    print("goes on\\n", end="", flush=True)  # at once: the interrupt may come between a text and its end
    time.sleep(60)

signal.signal(signal.SIGINT, signal.default_int_handler)
program.main = run
sys.exit(command.main())
"""


def test_what_interrupts_python_where_it_ignores_exceptions_ends_a_command_all_the_same() -> None:
    began = time.monotonic()
    ended = subprocess.run([sys.executable, "-c", LOST], cwd=ROOT, capture_output=True, text=True)
    assert (ended.returncode, ended.stdout, ended.stderr) == (130, "goes on\n", "selfconf: interrupted\n")
    assert time.monotonic() - began < 30


def test_other_exceptions_that_python_ignores_are_shown() -> None:
    ignored = LOST.replace("signal.raise_signal(signal.SIGINT)", "1 / 0").replace("time.sleep(60)", "return 0")
    ended = subprocess.run([sys.executable, "-c", ignored], cwd=ROOT, capture_output=True, text=True)
    assert (ended.returncode, ended.stdout) == (0, "goes on\n")
    assert "ZeroDivisionError" in ended.stderr
