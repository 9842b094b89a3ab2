"""Where the options of a command have their values from: typed, the environment, the project file, in this order."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf import rendezvous
from selfconf.cli.main import parser
from selfconf.cli.settings import VARIABLES, found_settings
from selfconf.serve.watching.history import History
from tests.cli.command import Outcome, run
from tests.cli.processes import Home, dormant
from tests.lab import ADVERTISEMENTS, NAVIGATE, write_advertisements

PROJECT = """\
ads = "home"
[bind.navigate]
robot = ":Astrid"
goal = "(AT BEDROOM)"
"""


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A project with the paper's template and advertisements; the current folder is one below it."""
    write_advertisements(tmp_path / "home", *ADVERTISEMENTS)
    (tmp_path / "navigate.ttl").write_text(NAVIGATE)
    (tmp_path / "sub").mkdir()
    (tmp_path / "selfconf.toml").write_text(PROJECT)
    monkeypatch.chdir(tmp_path / "sub")
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(tmp_path / "runtime"))
    for variable in VARIABLES.values():
        monkeypatch.delenv(variable, raising=False)
    return tmp_path


def configure(capsys: pytest.CaptureFixture[str], *arguments: str) -> Outcome:
    return run(capsys, "configure", "../navigate.ttl", "--format", "json", *arguments)


def test_the_variables_are_those_of_the_programs() -> None:
    assert set(VARIABLES.values()) == {
        rendezvous.ECOLOGY_VARIABLE,
        rendezvous.CONNECT_VARIABLE,
        rendezvous.KEYS_VARIABLE,
    }


@pytest.mark.usefixtures("project")
def test_a_command_needs_no_options_where_the_project_has_them(capsys: pytest.CaptureFixture[str]) -> None:
    body = configure(capsys).body
    assert body["status"] == "configured"
    assert body["bindings"]["robot"].endswith("#Astrid")


def test_the_help_says_for_which_templates_the_project_has_values(
    project: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    assert run(capsys, "configure", "--help").code == 0
    (project / "selfconf.toml").write_text(f'{PROJECT}[bind.patrol]\nrobot = ":Pippi"\n')
    assert "(now those for navigate and patrol, from ../selfconf.toml)" in run(capsys, "configure", "--help").out


@pytest.mark.usefixtures("project")
def test_what_is_typed_goes_before_the_file_value_by_value(capsys: pytest.CaptureFixture[str]) -> None:
    assert configure(capsys, "--bind", "robot=:Nobody").code == 1
    assert configure(capsys, "--bind", "goal=x").body["bindings"]["robot"].endswith("#Astrid")


def test_a_list_that_is_typed_takes_the_place_of_that_in_the_file(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (project / "empty").mkdir()
    assert configure(capsys, "--ads", "../empty").code == 1


@pytest.mark.slow
@pytest.mark.usefixtures("project")
@pytest.mark.parametrize("option", ["--ecology=other", "--connect=tcp/127.0.0.1:9"])
def test_an_ecology_that_is_typed_goes_before_the_files_of_the_project(
    option: str, capsys: pytest.CaptureFixture[str]
) -> None:
    outcome = configure(capsys, option)
    assert outcome.code == 2
    assert "no site" in outcome.err or "9" in outcome.err


@pytest.mark.usefixtures("project")
def test_the_environment_goes_before_the_file(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("SELFCONF_ECOLOGY", "elsewhere")
    assert configure(capsys).is_one_sentence("no site of the ecology 'elsewhere'")


@pytest.mark.parametrize(
    ("typed", "variable", "ecology", "from_project"),
    [
        ("", "", "mine", {"ads", "ecology", "strategy"}),
        ("", "theirs", None, {"strategy"}),
        ("other", "theirs", "other", {"strategy"}),
        ("other", "", "other", {"strategy"}),
    ],
)
def test_each_option_has_its_value_from_the_first_that_says_one(
    project: Path,
    monkeypatch: pytest.MonkeyPatch,
    typed: str,
    variable: str,
    ecology: str | None,
    from_project: set[str],
) -> None:
    (project / "selfconf.toml").write_text('ads = "home"\necology = "mine"\nstrategy = "best"\n')
    monkeypatch.setenv("SELFCONF_ECOLOGY", variable)
    settings, broken = found_settings(print)
    assert broken is None
    words = ["configure", "../navigate.ttl", *(["--ecology", typed] if typed else [])]
    given = parser(words[:1], settings).parse_args(words)
    settings.fill(given)
    assert (given.ecology, given.strategy, given.from_project) == (ecology, "best", from_project)


def test_the_ecology_of_the_file_is_that_of_every_command(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (project / "selfconf.toml").write_text('ecology = "ours"')
    for command in ("discover", "status", "tasks", "stop"):
        assert run(capsys, command).is_one_sentence("no site of the ecology 'ours'")


def test_reasoning_strategy_and_budgets_come_from_the_file(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (project / "selfconf.toml").write_text(PROJECT.replace("[bind", 'strategy = "best"\nsteps = 1\n[bind'))
    outcome = configure(capsys)
    assert "states no sc:cost" in outcome.err
    assert outcome.body["status"] == "undecided"


def test_help_says_where_a_value_comes_from(
    project: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    (project / "selfconf.toml").write_text('reasoning = "subclass"\necology = "100%"\n'.replace("100%", "ours"))
    said = run(capsys, "configure", "--help").out
    assert "(now subclass, from ../selfconf.toml:1)" in said
    assert "(now ours, from ../selfconf.toml:2)" in said
    assert "how to search (default: first)" in said
    monkeypatch.setenv("SELFCONF_ECOLOGY", "theirs")
    assert "(now theirs, from $SELFCONF_ECOLOGY)" in run(capsys, "status", "--help").out


def test_a_bad_file_stops_the_commands_that_it_concerns_but_no_help(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (project / "selfconf.toml").write_text("ecologie = 3")
    assert configure(capsys).is_one_sentence("selfconf configure: ../selfconf.toml:1:1: There is no key 'ecologie'")
    assert run(capsys, "configure", "--help").code == 0
    assert run(capsys, "new", "ontology", "mine").code == 0


def test_a_binding_for_a_parameter_that_there_is_not_is_named_with_the_file(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (project / "selfconf.toml").write_text(PROJECT + "speed = 3\n")
    assert configure(capsys).is_one_sentence("no parameter 'speed'", "(bound in ../selfconf.toml:5)")
    (project / "selfconf.toml").write_text(PROJECT.replace('":Astrid"', "3"))
    assert configure(capsys).is_one_sentence(
        "3 cannot stand for the parameter 'robot'", "(bound in ../selfconf.toml:3)"
    )


def test_a_parameter_that_is_bound_for_another_template_is_named_with_that(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (project / "selfconf.toml").write_text(PROJECT.replace("[bind.navigate]", "[bind.navigte]"))
    outcome = configure(capsys)
    assert outcome.is_one_sentence("'goal' needs a value", "(bound in ../selfconf.toml:4 for 'navigte' alone)")
    assert outcome.code == 2


def test_validate_in_a_project_checks_its_file_and_its_advertisements(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    outcome = run(capsys, "validate")
    assert outcome.code == 0
    assert f"{len(ADVERTISEMENTS) + 1} files conform" in outcome.err
    (project / "selfconf.toml").write_text('ads = "home"\nstep = 3')
    outcome = run(capsys, "validate")
    assert outcome.code == 1
    assert outcome.out.startswith("../selfconf.toml:2:1: error[SC-P02]")
    (project / "selfconf.toml").write_text("ads = ")
    outcome = run(capsys, "validate", "..")
    assert outcome.code == 2
    assert "../selfconf.toml:1:7: error[SC-P01]" in outcome.out


def test_without_a_project_nothing_is_validated_and_nothing_served(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(capsys, "validate").is_one_sentence("there is nothing to validate")
    assert run(capsys, "site", "--ecology", "x").is_one_sentence("there is nothing to serve")


@pytest.mark.process
def test_in_a_project_site_and_run_need_no_options_and_run_starts_a_site_only_where_there_is_none(home: Home) -> None:
    for name in ADVERTISEMENTS:
        dormant(home, name)
    text = f'ecology = "{home.ecology}"\n' + PROJECT.replace('"home"', '"ads"')
    (home.folder / "selfconf.toml").write_text(text)
    alone = home.selfconf("run", "navigate.ttl", "--format", "json")
    assert alone.act("running")["configuration"]["roles"]
    assert len(alone.children()) == 1  # the site of its own
    assert alone.end() == 0
    site = home.selfconf("site", "--name", "ours")
    assert home.until(lambda: (home.runtime / f"{home.ecology}@ours.json").exists() or site.over), site.complaints
    joined = home.selfconf("run", "navigate.ttl", "--format", "json")
    assert joined.act("running")["configuration"]["roles"]
    assert joined.children() == []
    assert joined.end() == 0


@pytest.mark.process
def test_the_keys_of_a_project_are_those_of_its_commands(tmp_path: Path) -> None:
    home = Home(tmp_path, keys=True)
    try:
        given = home.environment.pop("SELFCONF_KEYS")
        (tmp_path / "selfconf.toml").write_text(f'ecology = "{home.ecology}"\nkeys = "{Path(given).name}"\n')
        home.site("a", "ads/tracker.ttl")
        assert home.endpoint().startswith("tls/")
        found = home.selfconf("discover", "--format", "json")
        assert found.ended() == 0, found.complaints
        home.environment["SELFCONF_KEYS"] = str(tmp_path / "nowhere")
        refused = home.selfconf("discover")
        assert refused.ended() == 2
        assert "there is no folder" in refused.complaints
    finally:
        home.close()


def test_keys_in_a_project_file_are_one_folder_that_is_there(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for text, code, words in (
        ('keys = ["a", "b"]', "SC-P03", "takes a text in quotes"),
        ("keys = 3", "SC-P03", "takes a text in quotes"),
        ('keys = "nowhere"', "SC-P05", "no file or folder nowhere"),
    ):
        (tmp_path / "selfconf.toml").write_text(text)
        outcome = run(capsys, "validate", "selfconf.toml")
        assert outcome.code == 1
        assert f"selfconf.toml:1:1: error[{code}]" in outcome.out
        assert words in outcome.out


def test_advertisements_that_are_not_there_are_one_mistake_of_the_project_file(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (project / "selfconf.toml").write_text('ads = ["home", "nowhere"]')
    outcome = run(capsys, "validate")
    assert outcome.code == 1
    assert "selfconf.toml:1:1: error[SC-P05]: There is no file or folder nowhere." in outcome.out
    assert f"1 error in 1 of {len(ADVERTISEMENTS) + 1} files." in outcome.err


@pytest.mark.parametrize("named", ["", "..", "../selfconf.toml"])
def test_an_ontology_that_is_not_there_is_a_mistake_of_the_project_file_where_that_is_checked(
    project: Path, capsys: pytest.CaptureFixture[str], named: str
) -> None:
    (project / "selfconf.toml").write_text('ontology = "nowhere.ttl"')
    outcome = run(capsys, "validate", *filter(None, [named]))
    assert outcome.code == 1
    assert "selfconf.toml:1:1: error[SC-P05]: There is no file or folder nowhere.ttl." in outcome.out
    assert run(capsys, "validate", "../home").code == 2


def test_the_endpoint_of_the_file_does_not_keep_a_query_from_the_past(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (project / "selfconf.toml").write_text('endpoint = "http://127.0.0.1:1/sparql"\n')
    History(project / "past").close()
    words = ("query", "ASK {}", "--history", str(project / "past"))
    assert run(capsys, *words).code == 0
    typed = run(capsys, *words, "--endpoint", "http://127.0.0.1:1/sparql")
    assert typed.is_one_sentence("--history is for the past of a living ecology, and for files")


def test_the_file_counts_for_the_commands_below_a_command_too(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (project / "selfconf.toml").write_text('ecology = "house"\n')
    assert "(now house, from" in run(capsys, "bridge", "wot", "--help").out


def test_the_router_of_ros_2_is_none_of_the_endpoints_of_the_file(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (project / "selfconf.toml").write_text('connect = ["tcp/127.0.0.1:7450"]\n')
    help_ = run(capsys, "bridge", "ros2", "--help").out
    assert "7450" not in help_
    assert "tcp/127.0.0.1:7447" in help_


def test_where_sites_listen_is_not_where_the_router_of_ros_2_does(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (project / "selfconf.toml").write_text('connect = ["tcp/127.0.0.1:7447"]\n')
    lamp = project / "lamp.td.json"
    lamp.write_text('{"@context": "https://www.w3.org/2022/wot/td/v1.1", "id": "urn:lamp", "title": "lamp"}')
    outcome = run(capsys, "import", "wot", str(lamp), "--out", str(project / "ads"))
    assert "--connect" not in outcome.err
