"""The files that `new` writes: they conform as they stand, and run as they stand."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from selfconf.api.validation import check
from selfconf.cli.main import main
from selfconf.cli.scaffolds import SCAFFOLDS

PATIENCE = 40.0


@pytest.mark.parametrize("kind", SCAFFOLDS)
@pytest.mark.parametrize("name", ["kitchen-thermometer", "x", "Radio2", "a_b-c"])
def test_what_is_scaffolded_conforms_without_a_warning(kind: str, name: str, tmp_path: Path) -> None:
    assert main(["new", kind, name, "--dir", str(tmp_path)]) == 0
    assert not check([str(tmp_path)]).diagnostics


def test_no_name_is_given_an_article_that_does_not_fit_it(tmp_path: Path) -> None:
    assert main(["new", "ontology", "orchard", "--dir", str(tmp_path)]) == 0
    text = (tmp_path / "orchard.ttl").read_text()
    assert " a orchard" not in text
    assert " the orchard" not in text


@pytest.fixture
def home(tmp_path: Path) -> Path:
    """A folder with a scaffolded component and a scaffolded template."""
    for kind, name in (("component", "thermometer"), ("template", "watch")):
        assert main(["new", kind, name, "--dir", str(tmp_path)]) == 0
    return tmp_path


@pytest.mark.parametrize(("place", "code"), [("kitchen", 0), ("cellar", 1)])
def test_a_scaffolded_template_finds_the_scaffolded_component(home: Path, place: str, code: int) -> None:
    arguments = ["configure", str(home / "watch.ttl"), "--ads", str(home), "--bind", f"place=:{place}"]
    assert main(arguments) == code


@pytest.mark.process
def test_a_scaffolded_component_runs_until_it_is_interrupted(home: Path) -> None:
    process = subprocess.Popen(
        [sys.executable, "-m", "selfconf", "run", "watch.ttl", "--ads", "."],
        cwd=home,
        env={**os.environ, "SELFCONF_RUNTIME_DIR": str(home / "runtime")},
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    assert process.stdout is not None
    said = []
    for line in process.stdout:
        said.append(line)
        if line.rstrip().endswith(" running"):
            process.send_signal(signal.SIGINT)
            break
    rest, _ = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0, "".join(said) + rest
    assert ":thermometer is active" in "".join(said)
    assert "taken down" in rest
