"""`main`: a component class as a program; what it says when it cannot join."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import pytest

from selfconf.bus.zenoh_bus import client
from selfconf.sdk import Component, main
from tests.lab import write_advertisements


class Lamp(Component):
    """A lamp."""


@pytest.fixture(autouse=True)
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    """No endpoint is waited for."""
    for module in ("selfconf.sdk.program", "selfconf.rendezvous"):
        monkeypatch.setattr(f"{module}.client", partial(client, seconds=0.1))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "selfconf site"),
        (("--ecology", "home"), "of the ecology 'home'"),
        (("--ecology", "home", "--connect", "tcp/127.0.0.1:1"), "nobody answers at tcp/127.0.0.1:1"),
        (("--ecology", "home", "--connect", "somewhere"), "no endpoint"),
    ],
)
def test_a_program_that_finds_no_ecology_says_so_in_one_sentence(
    arguments: tuple[str, ...], words: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    kind = type("Tracker", (Lamp,), {"advertisement": write_advertisements(tmp_path, "tracker") / "tracker.ttl"})
    with pytest.raises(SystemExit, match="2"):
        main(kind, arguments=arguments)
    said = capsys.readouterr().err
    assert words in said
    assert said.count("\n") == 1


def test_the_environment_that_a_site_gives_names_the_ecology(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("SELFCONF_ECOLOGY", "home")
    monkeypatch.setenv("SELFCONF_CONNECT", "tcp/127.0.0.1:1")
    with pytest.raises(SystemExit, match="2"):
        main(Lamp, arguments=())
    assert "nobody answers at tcp/127.0.0.1:1" in capsys.readouterr().err


def test_help_tells_what_the_component_is(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(Lamp, arguments=("--help",))
    assert "A lamp." in capsys.readouterr().out
