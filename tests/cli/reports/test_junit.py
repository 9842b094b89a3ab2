"""Reports as JUnit's XML."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

from selfconf.api.validation import check
from selfconf.cli.reports import RENDERERS
from tests.cli.diagnosed import NASTY


def test_junit_has_a_case_for_each_file(folder: Path) -> None:
    suites = ElementTree.fromstring(RENDERERS["junit"](check(["."])).encode())
    assert (suites.get("tests"), suites.get("failures"), suites.get("errors")) == ("4", "1", "1")
    cases = {case.get("name"): [part.tag for part in case] for case in suites.iter("testcase")}
    assert cases == {"broken.ttl": ["error"], "good.ttl": [], "strange.ttl": ["system-out"], "wrong.ttl": ["failure"]}


def test_junit_holds_no_character_that_xml_forbids() -> None:
    assert "[31m" in (ElementTree.fromstring(RENDERERS["junit"](NASTY).encode()).findtext(".//failure") or "")
