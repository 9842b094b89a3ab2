"""Running a command in this process, and what came of it."""

from __future__ import annotations

import json
import signal
from dataclasses import dataclass
from typing import Any

import pytest

from selfconf.cli.main import main
from tests.harness.frozen import nothing_frozen


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a command has answered: its exit code, and what it said on stdout and stderr."""

    code: int
    out: str
    err: str

    @property
    def body(self) -> Any:
        """Its stdout as JSON."""
        assert self.out, self
        return json.loads(self.out)

    def is_one_sentence(self, *words: str) -> bool:
        """Whether it is misuse or unreadable input, said in one line on stderr that holds these words."""
        assert self.code == 2, self
        assert self.out == "", self
        assert self.err.count("\n") == 1, self
        assert "Traceback" not in self.err
        for word in words:
            assert word in self.err, self
        return True


def each(option: str, *values: object) -> list[str]:
    """An option with several values: it takes one, and is repeated."""
    return [word for value in values for word in (option, str(value))]


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> Outcome:
    """Run a command; what a program does about signals ends with it."""
    capsys.readouterr()
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)}
    try:
        with nothing_frozen():
            code = main(arguments)
    except SystemExit as error:
        code = int(error.code or 0)
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
    said = capsys.readouterr()
    return Outcome(code, said.out, said.err)
