"""What operators are given is true: the units, the dashboard, the alerts, and every command of their page."""

from __future__ import annotations

import json
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from selfconf.cli.main import parser
from selfconf.configurator.losing import GOES_ON
from selfconf.project import project_problems
from selfconf.serve.metrics import HELP
from selfconf.site.log_file import MOST_BYTES, PUT_ASIDE
from tests.cli.processes import Home

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "examples" / "operating"
UNITS = sorted(FOLDER.glob("*.service"))
PAGE = (ROOT / "docs" / "operating.md").read_text()
DASHBOARD: dict[str, Any] = json.loads((FOLDER / "grafana-dashboard.json").read_text())
INSTALLED = "/opt/selfconf/bin/selfconf"
LABELS = {"status", "cause", "state", "phase"}
"""The labels of the metrics."""


@pytest.fixture
def home(tmp_path: Path) -> Any:
    """An ecology of a test's own, without any process yet."""
    home = Home(tmp_path)
    yield home
    home.close()


def command_of(unit: Path) -> list[str]:
    """The words of what a unit starts."""
    (line,) = re.findall(r"^ExecStart=(.*)$", unit.read_text(), re.MULTILINE)
    words = shlex.split(line)
    assert words[0] == INSTALLED
    return words[1:]


# Units.


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="systemd is not installed")
def test_systemd_finds_nothing_wrong_with_the_units(tmp_path: Path) -> None:
    units = []
    for unit in UNITS:
        units.append(tmp_path / unit.name)
        units[-1].write_text(unit.read_text().replace(INSTALLED, shutil.which("true") or ""))
    done = subprocess.run(
        ["systemd-analyze", "verify", "--man=no", *units], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize("unit", UNITS, ids=lambda unit: unit.stem)
def test_a_unit_is_made_of_sections_with_settings_and_starts_a_command_that_there_is(unit: Path) -> None:
    lines = [line for line in unit.read_text().splitlines() if line and not line.startswith("#")]
    assert all(re.fullmatch(r"\[\w+\]|[A-Z]\w+=.+", line) for line in lines)
    assert [line for line in lines if line.startswith("[")] == ["[Unit]", "[Service]", "[Install]"]
    assert parser().parse_args(command_of(unit)).run


def test_the_site_may_write_into_its_folder_of_keys_which_lies_where_all_else_is_read_only() -> None:
    (unit,) = (unit for unit in UNITS if unit.stem == "selfconf-site")
    settings = unit.read_text().splitlines()
    command = command_of(unit)
    assert "ProtectSystem=strict" in settings
    assert f"ReadWritePaths={command[command.index('--keys') + 1]}" in settings


@pytest.mark.process
def test_the_site_of_the_unit_starts_in_a_folder_with_a_project_file(home: Home, tmp_path: Path) -> None:
    (home.folder / "selfconf.toml").write_text(f'ecology = "{home.ecology}"\nads = "ads"\n')
    (site,) = (command_of(unit) for unit in UNITS if unit.stem == "selfconf-site")
    at = site.index("--keys")  # those of a test's own would take the authority that `tests/access` tries
    del site[at : at + 2]
    moved = {
        "/var/lib": f"{tmp_path}/lib",
        "/var/log": f"{tmp_path}/log",
        "tls/0.0.0.0:7447": "tcp/127.0.0.1:0",
        "%l": "host",
    }
    for before, after in moved.items():
        site = [word.replace(before, after) for word in site]
    program = home.program(sys.executable, "-m", "selfconf", *site)
    assert home.until(lambda: (home.runtime / f"{home.ecology}@host.json").exists() or program.over)
    assert not program.over, program.complaints
    told = json.loads((home.runtime / f"{home.ecology}@host.json").read_text())
    assert told["log"].startswith(f"{tmp_path}/log/selfconf/")
    assert program.end() == 0


# Dashboard and alerts.


def expressions() -> list[str]:
    """What the dashboard and the alerts ask Prometheus."""
    asked = [target["expr"] for panel in DASHBOARD["panels"] for target in panel["targets"]]
    return asked + re.findall(r"^ *expr: (.*)$", (FOLDER / "selfconf-alerts.yml").read_text(), re.MULTILINE)


def test_every_metric_that_is_asked_for_is_one_that_the_server_has() -> None:
    named = {name for expression in expressions() for name in re.findall(r"\bselfconf_\w+", expression)}
    assert named == HELP.keys()


def test_every_label_is_one_of_a_metric_and_every_counter_is_asked_for_its_growth() -> None:
    for expression in expressions():
        labels = re.findall(r"by \((\w+)\)|\{(\w+)(?:=|!~)", expression)
        assert {label for pair in labels for label in pair if label} <= LABELS
        for counter in re.findall(r"selfconf_\w+_total", expression):
            assert re.search(rf"(rate|increase)\({counter}({{[^}}]*}})?\[", expression), expression


def test_no_alert_counts_what_is_lost_and_not_broken() -> None:
    (expression,) = (one for one in expressions() if "losses" in one and ">" in one)
    (left_out,) = re.findall(r'cause!~"([^"]*)"', expression)
    assert left_out.split("|") == [cause.value for cause in GOES_ON]


def test_both_sides_of_a_division_have_the_same_labels_without_which_nothing_is_shown() -> None:
    divisions = [expression.split(" / ") for expression in expressions() if " / " in expression]
    assert divisions
    for sides in divisions:
        assert all(re.match(r"(clamp_min\()?sum\(", side) for side in sides), sides


def test_the_panels_have_a_place_each_and_a_sentence() -> None:
    taken: set[tuple[int, int]] = set()
    for panel in DASHBOARD["panels"]:
        place = panel["gridPos"]
        cells = {(place["x"] + x, place["y"] + y) for x in range(place["w"]) for y in range(place["h"])}
        assert not cells & taken, panel["title"]
        assert place["x"] + place["w"] <= 24
        assert panel["description"].endswith(".")
        taken |= cells
    assert len({panel["id"] for panel in DASHBOARD["panels"]}) == len(DASHBOARD["panels"])


def test_the_files_for_prometheus_are_yaml_and_name_each_other() -> None:
    yaml = pytest.importorskip("yaml", reason="PyYAML is not installed")
    scraped = yaml.safe_load((FOLDER / "prometheus.yml").read_text())
    assert all((FOLDER / name).is_file() for name in scraped["rule_files"])
    ((target,),) = ([one["targets"] for one in job["static_configs"]] for job in scraped["scrape_configs"])
    (served,) = (command_of(unit) for unit in UNITS if unit.stem == "selfconf-serve")
    assert target == [f"127.0.0.1:{served[served.index('--port') + 1]}"]
    rules = yaml.safe_load((FOLDER / "selfconf-alerts.yml").read_text())["groups"][0]["rules"]
    assert all(rule.keys() - {"for"} == {"alert", "expr", "annotations"} for rule in rules)


# The page.


def test_every_command_of_the_page_is_one_that_there_is() -> None:
    today = PAGE.replace("--at 14:02", "--at 00:00")  # which has come, whenever this is run
    said = re.findall(r"`selfconf ([a-z][^`]*)`", today)
    assert len(said) > 20
    for words in said:
        assert parser().parse_args(shlex.split(words if " " in words else NEEDS.get(words, words))).run


NEEDS = {"site": "site ads", "echo": "echo NAME PORT", "why": "why NAME", "query": "query SPARQL"}
"""What commands take that the page names without it."""


def test_the_project_file_of_the_page_is_one(tmp_path: Path) -> None:
    (text,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    (tmp_path / "ads").mkdir()
    assert project_problems("selfconf.toml", text.encode(), tmp_path) == []


def test_the_page_has_every_metric_in_the_words_of_the_server_and_the_size_of_the_logs() -> None:
    kinds = {name: "counter" if name.endswith("_total") else "gauge" for name in HELP}
    assert all(f"| `{name}` | {kinds[name]} | {means} |" in PAGE for name, means in HELP.items())
    assert f"{MOST_BYTES * (1 + PUT_ASIDE) >> 20} MiB for each site" in PAGE
