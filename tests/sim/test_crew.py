"""The processes of a demo: they do the same in whatever folder the demo is typed."""

from __future__ import annotations

from pathlib import Path

import pytest

from sim.crew import Crew

CLOCK = Path(__file__).parents[2] / "examples" / "clock"
PATIENCE = 60.0


@pytest.mark.process
def test_what_lies_in_the_folder_of_the_user_has_nothing_to_do_with_the_demo(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "json.py").write_text("raise SystemExit('this is another json')\n")
    (tmp_path / "selfconf.toml").write_text('ontology = "nowhere"\n')
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", "runtime")
    with Crew() as crew:
        crew.start("site", "-m", "selfconf", "site", str(CLOCK), "--ecology", "crew-of-a-demo")
        first = next(crew.lines(PATIENCE))
        there = list((tmp_path / "runtime").iterdir())
    assert "serves 2 advertisements" in (first.text or "")
    assert there
