"""`selfconf new`: what it writes is valid as it stands, runs as it stands, and overwrites nothing."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest

from selfconf.api.validation import check
from selfconf.cli.main import main
from selfconf.cli.scaffolds import SCAFFOLDS
from tests.cli.command import run


@pytest.mark.parametrize("namespace", ["https://example.org/else/", "urn:home:", "https://example.org/%C3%A4#"])
@pytest.mark.parametrize("kind", SCAFFOLDS)
def test_a_namespace_of_ones_own_is_used(kind: str, namespace: str, tmp_path: Path) -> None:
    assert main(["new", kind, "x", "--dir", str(tmp_path), "--namespace", namespace]) == 0
    assert f"<{namespace}>" in (tmp_path / "x.ttl").read_text()
    assert not check([str(tmp_path)]).diagnostics


@pytest.mark.parametrize("kind", SCAFFOLDS)
def test_nothing_is_overwritten(kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    last = [*SCAFFOLDS[kind]][-1]
    (tmp_path / f"x{last}").write_text("mine")
    assert main(["new", kind, "x", "--dir", str(tmp_path)]) == 2
    assert "not overwritten" in capsys.readouterr().err
    assert [path.read_text() for path in tmp_path.iterdir()] == ["mine"]


@pytest.mark.parametrize("name", ["", "../x", "2x", "a b", "-x", "x-", "ä", "x.ttl"])
def test_a_name_that_could_not_be_a_file_and_a_term_is_refused(name: str, tmp_path: Path) -> None:
    assert main(["new", "--dir", str(tmp_path), "component", "--", name]) == 2
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["queue", "selfconf", "none"])
def test_a_component_whose_file_would_hide_a_module_or_be_no_python_is_refused(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    outcome = run(capsys, "new", "component", name, "--dir", str(tmp_path))
    assert outcome.is_one_sentence(repr(name), f"choose another name, such as my-{name}")
    assert not list(tmp_path.iterdir())
    assert main(["new", "template", name, "--dir", str(tmp_path)]) == 0


@pytest.mark.parametrize(
    "namespace",
    ["home", "https://example.org/home", "", "https://a b#", "https://a>#", "https://a/%zz#", "urn:\udcff:"],
)
def test_a_namespace_that_is_no_iri_is_refused(
    namespace: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    outcome = run(capsys, "new", "component", "x", "--dir", str(tmp_path), "--namespace", namespace)
    assert outcome.is_one_sentence(repr(namespace), "it is an absolute IRI that ends with #, / or :")


@pytest.mark.parametrize("folder", ["my home", "-home", "it's"])
def test_what_to_type_next_can_be_typed(
    folder: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    said = run(capsys, "new", "component", "x", f"--dir={folder}").err
    command, *arguments = shlex.split(said.split("`")[1])
    assert (command, run(capsys, *arguments).code) == ("selfconf", 0)


def test_a_folder_that_is_not_there_is_made(tmp_path: Path) -> None:
    assert main(["new", "ontology", "x", "--dir", str(tmp_path / "deep" / "er")]) == 0
    assert (tmp_path / "deep" / "er" / "x.ttl").is_file()


def test_a_name_with_hyphens_and_underscores_is_one_and_the_sentence_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["new", "component", "kitchen_door-bell", "--dir", str(tmp_path)]) == 0
    assert not check([str(tmp_path)]).diagnostics
    capsys.readouterr()
    outcome = run(capsys, "new", "component", "a__b", "--dir", str(tmp_path))
    assert outcome.is_one_sentence(
        "'a__b' cannot be a name", "begin with an ASCII letter, go on with these and digits, a - or _"
    )
