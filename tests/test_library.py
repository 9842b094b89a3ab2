"""The one door to the ontologies, shapes and schemas that ship with selfconf."""

from __future__ import annotations

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from selfconf import library
from selfconf.rdf.turtle import document as turtle

ROOT = Path(__file__).resolve().parent.parent


def test_the_ontologies_and_shapes_of_the_checkout_are_found() -> None:
    assert {path.name for path in library.ontologies()} >= {"selfconf.ttl", "robotics.ttl", "peis-home.ttl"}
    assert {path.name for path in library.shapes()} >= {"advertisement.ttl", "template.ttl", "task.ttl"}
    assert library.ontologies() == sorted((ROOT / "ontology").glob("*.ttl"))
    assert library.shapes() == sorted((ROOT / "shapes").glob("*.ttl"))


def test_the_schemas_of_the_checkout_are_found() -> None:
    assert {path.name for path in library.schemas()} >= {"configure.schema.json", "run.schema.json"}
    assert library.schemas() == sorted((ROOT / "docs" / "schemas").iterdir())


def test_ontologies_and_shapes_are_turtle() -> None:
    for path in (*library.ontologies(), *library.shapes()):
        assert turtle.parse(path.read_bytes(), str(path)).statements


def zipped(wheel: Path) -> Path:
    """The package zipped as a wheel has it: the code, and ontologies, shapes and schemas below `selfconf/_data`."""
    with zipfile.ZipFile(wheel, "w") as archive:
        for path in (ROOT / "selfconf").rglob("*.py"):
            archive.write(path, path.relative_to(ROOT))
        for folder in ("ontology", "shapes", "docs/schemas"):
            for path in (ROOT / folder).iterdir():
                archive.write(path, Path("selfconf", "_data", Path(folder).name, path.name))
    return wheel


@pytest.mark.process
def test_a_wheel_that_is_not_unpacked_has_all_of_them_and_leaves_nothing_behind(tmp_path: Path) -> None:
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    program = f"""if True:
        import sys
        sys.path.insert(0, {str(zipped(tmp_path / "selfconf.whl"))!r})
        from selfconf import library
        from selfconf.cli.main import main
        assert ".whl" in library.__file__, library.__file__
        for path in (*library.ontologies(), *library.shapes(), *library.shapes(), *library.schemas()):
            print(path.name, len(path.read_bytes()), sep=" ")
        raise SystemExit(main(["validate", {str(ROOT / "examples" / "navigate.ttl")!r}]))
    """
    environment = {**os.environ, "TMPDIR": str(temporary)}
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", program],
        env=environment,
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    shapes = sorted((ROOT / "shapes").glob("*.ttl"))
    files = [*sorted((ROOT / "ontology").glob("*.ttl")), *shapes, *shapes, *library.schemas()]
    assert done.stdout.splitlines()[: len(files)] == [f"{path.name} {path.stat().st_size}" for path in files]
    assert list(temporary.iterdir()) == []
    assert "Warning" not in done.stderr
