"""The text of the page of `serve`: what would turn a line around or steer anything is spelt out, as on a terminal."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from selfconf.model.wording import plain

NODE = shutil.which("node")
PAGE = Path(__file__).resolve().parents[2] / "selfconf" / "serve" / "page"
TEXTS = ["a\tb\nä 日本 ✓", "\x1b[2J\r\x07\x9b1m", "\u202egnp.exe\u2066", "\u061c\u200f\x7f\x00"]
PROGRAM = """
const { plain } = await import(process.argv[1]);
console.log(JSON.stringify(JSON.parse(process.argv[2]).map(plain)));
"""


@pytest.mark.process
@pytest.mark.skipif(NODE is None, reason="there is no node, which runs the scripts of the page outside of a browser")
def test_the_page_spells_out_what_a_terminal_does(tmp_path: Path) -> None:
    module = tmp_path / "dom.mjs"
    module.write_bytes((PAGE / "dom.js").read_bytes())
    command = [str(NODE), "--input-type=module", "--eval", PROGRAM, module.as_uri(), json.dumps(TEXTS)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert json.loads(done.stdout) == [plain(text) for text in TEXTS]


@pytest.mark.parametrize("script", sorted(PAGE.glob("*.js")), ids=lambda path: path.name)
def test_no_script_makes_markup_of_text_or_shows_any_but_by_its_one_door(script: Path) -> None:
    text = script.read_text("utf-8")
    assert not [word for word in ("innerHTML", "outerHTML", "insertAdjacentHTML", "document.write") if word in text]
    assigned = [line for line in text.splitlines() if ".textContent = " in line or ".title = `" in line]
    allowed = "plain(", '"asking"', "document.title"
    assert not [line for line in assigned if not any(one in line for one in allowed)]
