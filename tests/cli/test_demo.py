"""`demo`: what it needs before there is a world, and a sentence for what it lacks. The world has tests of its own."""

from __future__ import annotations

import argparse
import importlib.util
import socket
from pathlib import Path

import pytest

from selfconf.access import Authority, Principal, PrincipalKind
from selfconf.cli import demo
from tests.cli.command import run


@pytest.mark.parametrize(
    ("text", "speed"), [("1", 1.0), ("0.5", 0.5), ("0.001", 0.001), ("2e1", 20.0), ("max", float("inf"))]
)
def test_a_speed_is_a_number_or_max(text: str, speed: float) -> None:
    parser = argparse.ArgumentParser()
    demo.add_arguments(parser)
    assert parser.parse_args(["--speed", text]).speed == speed


@pytest.mark.parametrize("text", ["0", "-1", "1e-9", "fast", "nan", ""])
def test_what_is_no_speed_is_one_sentence(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(capsys, "demo", f"--speed={text}").is_one_sentence(f"{text!r} is no speed", "or max")


@pytest.mark.parametrize("text", ["-4", "1.5", "x", ""])
def test_what_is_no_seed_is_one_sentence(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(capsys, "demo", f"--seed={text}").is_one_sentence(f"{text!r} is no seed", "from zero on")


@pytest.mark.parametrize(("option", "value"), [("--scene", "opera"), ("--pictures", "oil"), ("--policy", "weep")])
def test_a_choice_that_there_is_not_is_one_sentence(
    option: str, value: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(capsys, "demo", option, value).is_one_sentence(f"{option}: invalid choice: {value!r}")


def test_outside_of_a_checkout_it_is_said_what_to_type(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(demo, "__file__", str(tmp_path / "selfconf" / "cli" / "demo.py"))
    assert run(capsys, "demo").is_one_sentence("clone the repository and type `make demo`")


def test_without_pybullet_it_is_said_what_to_install(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    find = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == "pybullet" else find(name))
    assert run(capsys, "demo").is_one_sentence("PyBullet is missing", "pip install '.[sim]'")


def test_the_radio_needs_neither_a_world_nor_what_draws_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    find, lacking = importlib.util.find_spec, ("pybullet", "mitsuba")
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name in lacking else find(name))
    monkeypatch.setattr("sim.demo.run", lambda options: 0)
    assert run(capsys, "demo", "--scene", "radio", "--out", str(tmp_path)).code == 0


def test_without_a_server_it_is_said_what_to_install(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    present = object()
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == "uvicorn" else present)
    assert run(capsys, "demo", "--serve").is_one_sentence("the server is missing", "pip install '.[sim,serve]'")


@pytest.mark.sim
def test_a_window_needs_a_display_that_answers(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("pybullet", reason="there is no PyBullet here")
    with socket.create_server(("127.0.0.1", 0)) as taken:
        closed = taken.getsockname()[1] - 6000
    for display in ("", "nonsense", "127.0.0.1:x", f"127.0.0.1:{closed}"):
        monkeypatch.setenv("DISPLAY", display)
        assert run(capsys, "demo", "--gui").is_one_sentence("there is no display")


@pytest.mark.sim
def test_the_keys_of_a_demo_are_those_of_an_authority(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("pybullet", reason="there is no PyBullet here")
    authority = Authority.init(tmp_path / "keys")
    authority.issue(Principal(PrincipalKind.READER, "alice"), tmp_path / "alice")
    out = str(tmp_path / "out")
    assert run(capsys, "demo", "--out", out, "--keys", str(tmp_path / "alice")).is_one_sentence(
        "alice is not the folder of an authority"
    )
    (tmp_path / "out/keys").write_text("no folder")
    assert run(capsys, "demo", "--out", out, "--keys").is_one_sentence("exists and is not empty")


@pytest.mark.sim
def test_a_folder_that_cannot_be_written_is_one_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("pybullet", reason="there is no PyBullet here")
    (tmp_path / "file").write_text("no folder")
    assert run(capsys, "demo", "--out", str(tmp_path / "file" / "out")).is_one_sentence(
        "choose another folder by --out"
    )
