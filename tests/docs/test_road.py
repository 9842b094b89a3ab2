"""The architecture page says how many files and rooms a task goes through; so it is, within a tenth."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from docs.road import ROADS, Road

ROOT = Path(__file__).resolve().parents[2]
MEASURES = re.compile(r"(\d+) files in (\d+) rooms, (\d+) functions; (\d+) files are handed an advertisement")


@pytest.mark.slow
@pytest.mark.skipif(sys.version_info >= (3, 12), reason="what the page counts has a function for each comprehension")
@pytest.mark.parametrize("road", ROADS)
def test_the_page_says_how_long_the_road_is(road: str) -> None:
    command = [sys.executable, "-m", "docs.road", road]
    said = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    measured = MEASURES.search(said)
    assert measured
    page = (ROOT / "docs" / "architecture.md").read_text("utf-8")
    row = re.search(rf"^\| `{road}`.*\| (\d+) \| (\d+) \| (\d+) \| (\d+) \|$", page, re.M)
    assert row
    for stated, found in zip(map(int, row.groups()), map(int, measured.groups()), strict=True):
        assert abs(stated - found) <= max(1, found // 10), f"{said}\nwrite it into the table of docs/architecture.md"


def test_what_runs_only_while_a_module_loads_is_no_part_of_the_road() -> None:
    from selfconf.model.literal_values import number_of

    def load_and_ask() -> None:
        module = compile("number_of('1', 'urn:none')", "a module", "exec")
        exec(module, {"number_of": number_of})

    assert Road().travel(load_and_ask).functions == {}
    asked = Road().travel(lambda: number_of("1", "urn:none"))
    assert set(asked.functions) == {"model/literal_values.py"}
    assert asked.rooms == {"model": 1}


def test_a_file_is_handed_an_advertisement_where_a_function_is_given_one_or_a_part_of_it() -> None:
    from selfconf.model.profile import Profile
    from selfconf.model.term import IRI

    profile = Profile(IRI("urn:c"))
    assert Road().travel(lambda: profile.inputs).handed == {"model/profile.py"}
