"""`discover`: what is out there, and that what dies is not."""

from __future__ import annotations

import signal

import pytest

from tests.cli.command import run
from tests.cli.processes import Home
from tests.lab import ADVERTISEMENTS, PREFIXES, iri

pytestmark = pytest.mark.process


def test_everything_that_is_advertised_is_shown_with_its_site_and_whether_it_lives(
    inhabited: Home, capsys: pytest.CaptureFixture[str]
) -> None:
    body = run(capsys, "discover", "--format", "json", *inhabited.arguments()).body
    assert (body["sites"], body["missing"]) == (["peis-home"], [])
    assert len(body["components"]) == len(ADVERTISEMENTS)
    assert {row["state"] for row in body["components"]} == {"alive"}
    (tracker,) = [row for row in body["components"] if row["component"] == iri("person-tracker")]
    assert tracker["types"] == ["https://w3id.org/selfconf/robotics#PositionSensor"]
    assert tracker["site"] == "peis-home"


def test_the_table_ends_with_a_count(inhabited: Home, capsys: pytest.CaptureFixture[str]) -> None:
    outcome = run(capsys, "discover", *inhabited.arguments())
    assert outcome.code == 0
    assert outcome.out.splitlines()[-1] == f"7 components at 1 site of ecology {inhabited.ecology}"
    assert "rob:PositionSensor" in outcome.out


def test_the_advertisements_of_a_site_that_is_killed_vanish(home: Home, capsys: pytest.CaptureFixture[str]) -> None:
    (home.folder / "ads" / "pippi.ttl").write_text(
        PREFIXES + ADVERTISEMENTS["pippi"].rstrip(" .") + ' ; sc:grounding [ sc:command "true" ] .\n'
    )
    home.site("a", "ads/tracker.ttl")
    second = home.site("b", "ads/drive.ttl", "ads/pippi.ttl", connect=(home.endpoint("a"),))
    arguments = "--ecology", home.ecology, "--connect", home.endpoint("a")

    def states() -> dict[str, str]:
        body = run(capsys, "discover", "--format", "json", *arguments).body
        return {row["component"]: row["state"] for row in body["components"]}

    assert states() == {
        iri("person-tracker"): "absent",
        iri("astrid-drive"): "absent",
        iri("pippi-drive"): "dormant",
    }
    second.end(signal.SIGKILL)
    assert home.until(lambda: states() == {iri("person-tracker"): "absent"}, 5.0)


def test_a_site_that_is_suspended_is_named_also_when_it_seems_to_be_gone(
    home: Home, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(home.runtime))  # as on one machine
    home.site("a", "ads/tracker.ttl")
    second = home.site("b", "ads/drive.ttl", connect=(home.endpoint("a"),))
    arguments = "--ecology", home.ecology, "--connect", home.endpoint("a")
    second.send(signal.SIGSTOP)

    def asked() -> tuple[list[str], list[str]]:
        body = run(capsys, "discover", "--format", "json", *arguments).body
        return body["sites"], body["missing"]

    assert home.until(lambda: asked() == (["a"], ["b"]))
    said = "site b is suspended; what it advertises may be missing"
    assert said in run(capsys, "discover", *arguments).err
    assert said in run(capsys, "log", "astrid-drive", *arguments).err
    wanted = home.run()
    assert "site b did not answer in full" in wanted.act("discovered")["message"]
    assert wanted.ended() == 1
    second.send(signal.SIGCONT)
    assert home.until(lambda: asked() == (["a", "b"], []))


def test_the_ecology_behind_an_endpoint_need_not_be_named(inhabited: Home, capsys: pytest.CaptureFixture[str]) -> None:
    body = run(capsys, "discover", "--format", "json", "--connect", inhabited.endpoint()).body
    assert body["ecology"] == inhabited.ecology


def test_an_ecology_of_another_name_is_one_sentence(inhabited: Home, capsys: pytest.CaptureFixture[str]) -> None:
    outcome = run(capsys, "discover", "--ecology", "nobody-here", "--connect", inhabited.endpoint())
    assert outcome.is_one_sentence("no site of the ecology 'nobody-here' answers")


def test_a_name_that_is_none_is_one_sentence(inhabited: Home, capsys: pytest.CaptureFixture[str]) -> None:
    outcome = run(capsys, "discover", "--ecology", "a/b", "--connect", inhabited.endpoint())
    assert outcome.is_one_sentence("cannot name an ecology")


def test_without_any_site_there_is_a_sentence_that_says_what_to_start(capsys: pytest.CaptureFixture[str]) -> None:
    for command in ("discover", "status", "stop"):
        assert run(capsys, command).is_one_sentence("selfconf site")


def test_the_ecology_may_be_named_by_the_environment(
    inhabited: Home, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SELFCONF_CONNECT", inhabited.endpoint())
    assert run(capsys, "discover", "--format", "json").body["ecology"] == inhabited.ecology
    monkeypatch.setenv("SELFCONF_ECOLOGY", inhabited.ecology)
    assert run(capsys, "discover", "--format", "json").body["ecology"] == inhabited.ecology
