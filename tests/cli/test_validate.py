"""`selfconf validate`, as it is called: what it prints where, and with which exit code it ends."""

from __future__ import annotations

import io
import json
import os
import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

from selfconf.api.validation import check
from selfconf.cli.main import main
from selfconf.cli.reports import RENDERERS
from selfconf.cli.reports.text import illustrate
from selfconf.cli.validate import reference
from selfconf.model.codes import CODES, PREAMBLE
from selfconf.model.diagnostic import Diagnostic, Severity, report

BAD = Path(__file__).parents[1] / "bad"
GOOD = PREAMBLE + ":tuner a sc:Component, rob:Tuner .\n"
WRONG = PREAMBLE + ':radio a sc:Component ; sc:preference "high" .\n'
STRANGE = PREAMBLE + ":lamp a sc:Component, rob:Lmap .\n"
BROKEN = PREAMBLE + ":speaker a .\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name, text in (("good", GOOD), ("wrong", WRONG), ("strange", STRANGE), ("broken", BROKEN)):
        (tmp_path / f"{name}.ttl").write_text(text)
    return tmp_path


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["good.ttl"], 0),
        (["strange.ttl"], 0),
        (["wrong.ttl"], 1),
        (["good.ttl", "wrong.ttl"], 1),
        (["broken.ttl"], 2),
        (["broken.ttl", "wrong.ttl"], 2),
        (["nowhere.ttl"], 2),
        (["nowhere.ttl", "wrong.ttl"], 2),
        (["."], 2),
        ([], 2),
        (["--explain", "SC-A01"], 0),
        (["--explain", "SC-X99"], 2),
        (["good.ttl", "--ontology", "nowhere.ttl"], 2),
        (["good.ttl", "--ontology", "broken.ttl"], 2),
        (["good.ttl", "--ontology", "strange.ttl"], 0),
    ],
)
def test_exit_codes(folder: Path, arguments: list[str], code: int) -> None:
    assert main(["validate", *arguments]) == code


def test_every_problem_is_one_line_with_file_line_and_column(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["validate", "good.ttl", "wrong.ttl", "strange.ttl", "broken.ttl", "nowhere.ttl"])
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 5
    for line in lines:
        assert re.fullmatch(r"\w+\.ttl:\d+:\d+: (error|warning)\[SC-[A-Z]\d\d\]: \S.*[.?]", line), line
    assert lines[2].startswith("strange.ttl:10:23: warning[SC-L02]: ")


def test_a_summary_goes_to_stderr_and_a_clean_run_prints_nothing_else(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main(["validate", "good.ttl"])
    assert capsys.readouterr() == ("", "1 file conforms.\n")


def test_a_file_that_cannot_be_read_is_named_on_stderr(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["validate", "nowhere.ttl"])
    assert "nowhere.ttl" in capsys.readouterr().err


def test_a_folder_stands_for_all_turtle_below_it(folder: Path) -> None:
    (folder / "deep" / "er").mkdir(parents=True)
    (folder / "deep" / "er" / "x.ttl").write_text(GOOD.replace(":tuner", ":deep"))
    (folder / "deep" / "notes.txt").write_text("no Turtle")
    assert check(["deep"]).files == ("deep/er/x.ttl",)
    assert len(check([".", "good.ttl"]).files) == 5


def test_a_file_that_is_named_twice_is_read_once(folder: Path) -> None:
    assert not check(["good.ttl", "./good.ttl", str(folder / "good.ttl")]).diagnostics


def test_an_empty_folder_is_said_to_be_empty(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "empty").mkdir()
    assert main(["validate", "empty"]) == 0
    assert "no Turtle file" in capsys.readouterr().out


def test_a_file_with_nothing_to_validate_is_said_to_hold_nothing(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "kitchen.ttl").write_text("<urn:kitchen> <urn:is> <urn:warm> .")
    assert main(["validate", "kitchen.ttl"]) == 0
    assert "warning[SC-S04]" in capsys.readouterr().out


def test_standard_input_can_be_validated(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(WRONG.encode())))
    assert main(["validate", "-"]) == 1
    assert capsys.readouterr().out.startswith("<stdin>:10:1: error[SC-A03]: ")


def test_json_holds_every_problem(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["validate", "wrong.ttl", "broken.ttl", "--format", "json"])
    content = json.loads(capsys.readouterr().out)
    assert content["conforms"] is False
    assert (content["files"], content["errors"], content["warnings"]) == (2, 3, 0)
    assert content["unreadable"] == ["broken.ttl"]
    assert content["diagnostics"][1] == {
        "file": "wrong.ttl",
        "line": 10,
        "column": 1,
        "end_column": 7,
        "severity": "error",
        "code": "SC-A03",
        "message": "A component has a type besides sc:Component, which says what kind of component it is.",
        "hint": None,
        "shape": "https://w3id.org/selfconf/shapes#ComponentKind",
    }


NASTY = report(
    ["a,b:c%.ttl"],
    [Diagnostic("a,b:c%.ttl", 3, 7, "SC-A01", "100 %\r\nof <this> & \x1b[31m that,: so", width=2, hint="Try.")],
)


def test_workflow_commands_are_escaped() -> None:
    assert RENDERERS["github"](NASTY) == (
        "::error file=a%2Cb%3Ac%25.ttl,line=3,endLine=3,col=7,endColumn=9,title=SC-A01::"
        "100 %25%0D%0Aof <this> & \x1b[31m that,: so Try.\n"
    )


def test_warnings_are_workflow_warnings(folder: Path) -> None:
    assert RENDERERS["github"](check(["strange.ttl"])).startswith(
        "::warning file=strange.ttl,line=10,endLine=10,col=23,"
    )


def test_sarif_refers_to_rules_and_places(folder: Path) -> None:
    content = json.loads(RENDERERS["sarif"](check(["wrong.ttl", "strange.ttl"])))
    assert content["version"] == "2.1.0"
    (run,) = content["runs"]
    rules = [rule["id"] for rule in run["tool"]["driver"]["rules"]]
    assert rules == ["SC-A03", "SC-A04", "SC-L02"]
    for result in run["results"]:
        assert rules[result["ruleIndex"]] == result["ruleId"]
        assert result["level"] in ("error", "warning")
        assert result["message"]["text"]
        (location,) = result["locations"]
        assert location["physicalLocation"]["artifactLocation"]["uri"] in ("wrong.ttl", "strange.ttl")
        region = location["physicalLocation"]["region"]
        assert 1 <= region["startColumn"] < region["endColumn"]


def test_sarif_writes_paths_as_uris() -> None:
    content = json.loads(RENDERERS["sarif"](report(["/a b.ttl"], [Diagnostic("/a b.ttl", 1, 1, "SC-A01", "x")])))
    location = content["runs"][0]["results"][0]["locations"][0]["physicalLocation"]
    assert location["artifactLocation"]["uri"] == "file:///a%20b.ttl"
    relative = json.loads(RENDERERS["sarif"](NASTY))["runs"][0]["results"][0]["locations"][0]["physicalLocation"]
    assert relative["artifactLocation"]["uri"] == "a%2Cb%3Ac%25.ttl"


def test_junit_has_a_case_for_each_file(folder: Path) -> None:
    suites = ElementTree.fromstring(RENDERERS["junit"](check(["."])).encode())
    assert (suites.get("tests"), suites.get("failures"), suites.get("errors")) == ("4", "1", "1")
    cases = {case.get("name"): [part.tag for part in case] for case in suites.iter("testcase")}
    assert cases == {"broken.ttl": ["error"], "good.ttl": [], "strange.ttl": ["system-out"], "wrong.ttl": ["failure"]}


def test_junit_holds_no_character_that_xml_forbids() -> None:
    assert "[31m" in (ElementTree.fromstring(RENDERERS["junit"](NASTY).encode()).findtext(".//failure") or "")


@pytest.mark.parametrize("name", RENDERERS)
def test_every_form_can_say_that_all_is_well(name: str) -> None:
    assert RENDERERS[name](report(["a.ttl"], [])).endswith("\n" if name in ("json", "sarif", "junit") else "")


def test_on_a_terminal_the_place_is_underlined() -> None:
    found = Diagnostic("a.ttl", 12, 3, "SC-A01", "No.", width=3, source="\tx:abc .\x1b[2J")
    plain = re.sub(r"\x1b\[[\d;]*m", "", illustrate(report(["a.ttl"], [found])))
    assert plain.splitlines()[1:] == ["   12 | \tx:abc .�[2J", "      | \t ^^^"]


def test_a_file_cannot_steer_the_terminal() -> None:
    assert "\x1b" not in RENDERERS["text"](NASTY)


@pytest.mark.parametrize("code", [code.code for code in CODES])
def test_every_code_is_explained(code: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["validate", "--explain", code.lower()]) == 0
    assert capsys.readouterr().out.startswith(code)


def test_an_unknown_code_is_answered_with_the_known_ones(capsys: pytest.CaptureFixture[str]) -> None:
    main(["validate", "--explain", "SC-X99"])
    assert "SC-A01" in capsys.readouterr().err


def test_the_manual_lists_every_code() -> None:
    assert all(f"## {code.code}: " in reference(CODES) for code in CODES)


def test_help_has_an_example(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["validate", "--help"])
    assert ended.value.code == 0
    assert "\n  selfconf validate examples/" in capsys.readouterr().out


def test_an_unknown_format_is_misuse(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["validate", "--format", "xml", "."])
    assert ended.value.code == 2


def test_good_advertisements_pass_without_rdflib(folder: Path) -> None:
    program = (
        "import sys\nfrom selfconf.api.validation import check\n"
        "assert check(['good.ttl']).conforms\nassert 'rdflib' not in sys.modules"
    )
    environment = {"PYTHONPATH": str(Path(__file__).parents[2])}
    subprocess.run([sys.executable, "-c", program], check=True, env=environment)


def test_severities_are_words() -> None:
    assert [severity.value for severity in Severity] == ["error", "warning"]


@pytest.mark.parametrize("form", RENDERERS)
def test_a_file_name_that_is_not_utf8_is_escaped(folder: Path, form: str) -> None:
    (folder / "latin").mkdir()
    (folder / "latin" / os.fsdecode(b"\xff.ttl")).write_text("bad")
    for locale in ("C", "C.UTF-8"):
        command = (sys.executable, "-m", "selfconf", "validate", "latin", "--format", form)
        done = subprocess.run(command, capture_output=True, env={**os.environ, "LC_ALL": locale}, check=False)
        assert (done.returncode, b"Traceback" in done.stderr) == (2, False)
        shown = {"sarif": "%FF.ttl", "junit": "\N{REPLACEMENT CHARACTER}.ttl"}.get(form, "\\udcff.ttl")
        assert shown in done.stdout.decode("utf-8")


def test_a_warning_about_an_empty_folder_counts_no_file(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "empty").mkdir()
    main(["validate", "empty"])
    assert capsys.readouterr().err == "1 warning; 0 files conform.\n"
    main(["validate", "empty", "good.ttl"])
    assert capsys.readouterr().err == "1 warning; 1 file conforms.\n"
