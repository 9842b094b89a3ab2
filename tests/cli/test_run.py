"""`run` with real processes: the experiment, crashes, kills, and that nothing is left behind."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

from selfconf.access import believe
from selfconf.sdk.runtime.supervision import GRACE
from tests.cli import command
from tests.cli.endpoints import oxigraph
from tests.cli.processes import NO_NOHUP, Home, component_of, dormant
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES

pytestmark = pytest.mark.process

REST = ("sonar", "encoder", "odometry", "control", "drive")
EVERYBODY = ("tracker", *REST)
TASK = {"sonar", "encoder", "control", "drive"}


def test_the_experiment_and_a_component_that_is_killed(home: Home) -> None:
    """FAIL of the tracker, then kill -9 of odometry: each is replaced, the second one by a new tracker."""
    home.site("peis-home", "ads")
    home.components("sonar", "encoder", "control", "drive")
    tracker = home.components("tracker")
    odometry = home.components("odometry")
    run = home.run()
    running = run.act("running")["configuration"]
    assert [role["components"] for role in running["roles"]] == [
        [component_of(name)] for name in ("sonar", "encoder", "tracker", "control", "drive")
    ]
    assert home.active(*EVERYBODY) == TASK | {"tracker"}
    assert home.until(lambda: (home.folder / "control.goal").exists())
    assert (home.folder / "control.goal").read_text() == "(AT BEDROOM)"
    (home.folder / "tracker.fail").touch()
    lost = run.act("lost")
    assert (lost["component"], lost["cause"], lost["detail"]) == (component_of("tracker"), "fail", "told to")
    run.act("running")
    assert home.active(*EVERYBODY) == TASK | {"odometry"}
    tracker.end()
    home.components("tracker")
    odometry.end(signal.SIGKILL)
    assert run.act("lost")["cause"] == "crash"
    run.act("running")
    assert home.active(*EVERYBODY) == TASK | {"tracker"}
    (home.folder / "tracker.fail").touch()
    assert run.act("refused")["refusal"]["reasons"]
    assert run.ended() == 1
    assert home.active(*EVERYBODY) == set()


@pytest.mark.parametrize("advertised", [pytest.param(True, id="advertised"), pytest.param(False, id="new")])
def test_a_run_that_upgrades_changes_to_what_is_rather_had_and_back_when_that_is_lost(
    home: Home, advertised: bool
) -> None:
    advertisement, elsewhere = home.folder / "ads" / "tracker.ttl", home.folder / "tracker.ttl"
    if not advertised:
        advertisement.rename(elsewhere)
    home.site("peis-home", "ads")
    home.components(*REST)
    run = home.run("--upgrade", "--settle", "0.2")
    run.act("running")
    assert home.active(*EVERYBODY) == TASK | {"odometry"}
    if not advertised:
        elsewhere.rename(advertisement)
    tracker = home.components("tracker")
    # What is advertised before it lives is tried in vain, and what ran runs on; it is tried again once it lives.
    runs = (run.act("running")["configuration"]["roles"][2]["components"] for _ in range(3))
    assert [component_of("tracker")] in runs
    # What ran is released once what is rather had runs.
    assert home.until(lambda: home.active(*EVERYBODY) == TASK | {"tracker"})
    tracker.end(signal.SIGKILL)
    assert run.act("lost")["component"] == component_of("tracker")
    run.act("running")
    assert home.active(*EVERYBODY) == TASK | {"odometry"}
    assert run.end(signal.SIGINT) == 0


@pytest.mark.parametrize("seconds", ["-1", "inf", "2e6", "soon"])
def test_a_time_for_upgrades_is_zero_or_more(seconds: str, capsys: pytest.CaptureFixture[str]) -> None:
    outcome = command.run(capsys, "run", "navigate.ttl", "--upgrade", f"--settle={seconds}")
    assert outcome.is_one_sentence("--settle", repr(seconds), "from 0 to 1,000,000")


@pytest.mark.parametrize("detach", [(), ("--detach",)])
def test_a_time_for_upgrades_takes_upgrades(
    home: Home, detach: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    bound = ("--bind", "robot=:Astrid", "--bind", "goal=x")
    outcome = command.run(capsys, "run", str(home.folder / "navigate.ttl"), *bound, "--settle", "0", *detach)
    assert outcome.is_one_sentence("--settle says when", "--upgrade")


@pytest.mark.parametrize("number", [signal.SIGINT, pytest.param(signal.SIGHUP, marks=NO_NOHUP)])
def test_ctrl_c_or_the_end_of_its_terminal_takes_everything_down(inhabited: Home, number: signal.Signals) -> None:
    run = inhabited.run()
    run.act("running")
    assert run.end(number) == 0
    assert run.complaints == ""
    assert inhabited.active(*EVERYBODY) == set()


def test_ctrl_c_before_anything_is_deployed_ends_it_all_the_same(inhabited: Home) -> None:
    run = inhabited.run()
    run.act("query")
    assert run.end(signal.SIGINT) == 0
    assert inhabited.active(*EVERYBODY) == set()


def test_when_the_configurator_is_killed_components_turn_off_and_a_new_run_recovers(inhabited: Home) -> None:
    run = inhabited.run()
    run.act("running")
    run.end(signal.SIGKILL)
    assert inhabited.until(lambda: inhabited.active(*EVERYBODY) == set(), 5.0 + GRACE)
    again = inhabited.run()
    again.act("running")
    assert inhabited.active(*EVERYBODY) == TASK | {"tracker"}
    again.end(signal.SIGKILL)
    at_once = inhabited.run()  # within the grace period of the one before
    at_once.act("running")
    assert inhabited.active(*EVERYBODY) == TASK | {"tracker"}
    assert at_once.end(signal.SIGTERM) == 0
    assert inhabited.active(*EVERYBODY) == set()


def test_two_sites_on_two_ports_are_as_two_hosts(home: Home) -> None:
    (home.folder / "living-room").mkdir()
    (home.folder / "ads" / "tracker.ttl").rename(home.folder / "living-room" / "tracker.ttl")
    (home.folder / "ads" / "tracker.ttl").symlink_to(home.folder / "living-room" / "tracker.ttl")
    astrid = [f"ads/{name}.ttl" for name in REST]
    home.site("living-room", "living-room")
    home.site("astrid", *astrid, connect=(home.endpoint("living-room"),))
    home.components("tracker", connect=(home.endpoint("living-room"),))
    home.components(*REST, connect=(home.endpoint("astrid"),))
    run = home.run("--connect", home.endpoint("astrid"))
    discovered = run.act("discovered")
    assert (discovered["sites"], discovered["missing"]) == (["astrid", "living-room"], [])
    run.act("running")
    assert home.active(*EVERYBODY) == TASK | {"tracker"}
    (home.folder / "tracker.fail").touch()
    run.act("running")
    assert home.active(*EVERYBODY) == TASK | {"odometry"}
    assert run.end(signal.SIGINT) == 0


def test_a_dormant_component_is_started_by_its_site_and_ends_with_it(home: Home) -> None:
    dormant(home, "tracker")
    site = home.site("peis-home", "ads")
    home.components(*REST)
    assert home.state(component_of("tracker")) is None
    run = home.run()
    run.act("waking")
    run.act("running")
    assert home.active(*EVERYBODY) == TASK | {"tracker"}
    assert run.end(signal.SIGINT) == 0
    answer = home.state(component_of("tracker"))
    assert answer is not None
    assert not answer.active
    assert site.end() == 0


def test_a_dormant_component_behind_a_shell_is_started_too(home: Home) -> None:
    (home.folder / "start.sh").write_text("python components.py tracker\ntrue\n")
    (home.folder / "ads" / "tracker.ttl").write_text(
        PREFIXES + ADVERTISEMENTS["tracker"].rstrip(" .") + ' ; sc:grounding [ sc:command "sh ../start.sh" ] .\n'
    )
    (home.folder / "start.sh").write_text("cd ..\npython components.py tracker\ntrue\n")
    site = home.site("peis-home", "ads")
    home.components(*REST)
    run = home.run()
    run.act("running")
    assert home.active("tracker") == {"tracker"}
    assert run.end(signal.SIGINT) == 0
    site.end(signal.SIGKILL)


def test_a_run_with_advertisements_brings_a_site_of_its_own_and_takes_it_away_again(home: Home) -> None:
    (home.folder / "start.sh").write_text('echo "here is $1"\nexec python "$(dirname "$0")/components.py" "$1"\n')
    for name in ("sonar", "encoder", "tracker", "control", "drive"):
        path = home.folder / "ads" / f"{name}.ttl"
        command = f"sh {home.folder}/start.sh {name}"
        text = PREFIXES + ADVERTISEMENTS[name].rstrip(" .") + f' ; sc:grounding [ sc:command "{command}" ] .\n'
        path.write_text(text)
    run = home.run("--ads", "ads")
    run.act("running")  # every line until then is JSON
    assert home.active("tracker", "control", "drive") == {"tracker", "control", "drive"}
    assert run.end(signal.SIGINT) == 0
    assert list(home.runtime.glob("*.json")) == []
    assert all(f"here is {name}\n" in run.complaints for name in ("sonar", "encoder", "tracker", "control", "drive"))


def test_a_run_takes_its_advertisements_from_an_endpoint(home: Home) -> None:
    for name in EVERYBODY:
        dormant(home, name)
    held = {f"urn:{name}": (home.folder / "ads" / f"{name}.ttl").read_text() for name in EVERYBODY}
    with oxigraph("", held) as url:
        run = home.run("--endpoint", f"{url}?union-default-graph")
        run.act("running")
        assert home.active(*EVERYBODY) == TASK | {"tracker"}
        assert run.end(signal.SIGINT) == 0
    assert list(home.runtime.glob("*.json")) == []


def test_a_run_starts_no_commands_that_somebody_on_the_way_could_have_written(home: Home) -> None:
    run = home.run("--endpoint", "http://192.0.2.7/query")
    assert run.ended() == 2
    assert run.complaints.count("\n") == 1
    assert "give an https:// URL" in run.complaints


def test_a_run_has_one_ecology(home: Home) -> None:
    run = home.run("--endpoint", "http://127.0.0.1:9/query", "--ads", "ads")
    assert run.ended() == 2
    assert "--ads and --endpoint are two ecologies" in run.complaints


def test_an_empty_name_is_no_name_of_a_task(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    (tmp_path / "navigate.ttl").write_text(NAVIGATE)
    for more in ([], ["--detach"]):
        outcome = command.run(capsys, "run", str(tmp_path / "navigate.ttl"), "--name", "", *more)
        assert outcome.is_one_sentence("'' is no name of a task", "leave the option out")


def test_no_peer_is_one_sentence_and_exit_code_2(home: Home) -> None:
    run = home.run()
    assert run.ended() == 2
    assert run.complaints.count("\n") == 1
    assert "no site of the ecology" in run.complaints


def test_a_refused_task_is_exit_code_1_with_the_reasons_and_their_places(home: Home) -> None:
    home.site("peis-home", "ads/tracker.ttl")
    run = home.selfconf("run", "navigate.ttl", "--bind", "robot=:Astrid", "--bind", "goal=x")
    assert run.ended() == 1
    line = NAVIGATE.splitlines().index(next(one for one in NAVIGATE.splitlines() if one.startswith(":sonar a"))) + 1
    assert f"no component is eligible for the role sonar  [navigate.ttl:{line}]" in run.complaints


def test_a_refusal_points_to_the_advertisements_that_were_given_and_says_what_would_mend_it(home: Home) -> None:
    control = home.folder / "ads" / "control.ttl"
    control.write_text(control.read_text().replace("rob:NavigationControl", "rob:NavigationContro"))
    arguments = ("run", "navigate.ttl", "--bind", "robot=:Astrid", "--bind", "goal=x", "--ads", "ads")
    spoken = home.selfconf(*arguments)
    assert spoken.ended() == 1
    place = f"[ads/control.ttl:{PREFIXES.count(chr(10)) + 1}]"
    near = "it is no NavigationControl but a NavigationContro (is one of them misspelt?)"
    assert f"but {near}  {place}" in spoken.complaints
    assert "what would mend it" in spoken.complaints
    assert "an ecology of its own" not in spoken.complaints
    home.site("peis-home", "ads/tracker.ttl")
    written = home.selfconf(*arguments, "--format", "json")
    (reason,) = written.act("refused")["refusal"]["reasons"]
    assert reason["place"].startswith("navigate.ttl:")
    assert written.ended() == 1
    assert f"an ecology of its own, and {home.ecology} runs here already" in written.complaints
    home.environment["SELFCONF_ECOLOGY"] = home.ecology
    there = home.selfconf(*arguments)
    assert there.ended() == 1
    assert "an ecology of its own" not in there.complaints


def test_a_shape_that_cannot_be_judged_is_one_sentence_and_exit_code_2(inhabited: Home, tmp_path: Path) -> None:
    template = tmp_path / "broken.ttl"
    template.write_text(NAVIGATE + ':drive sh:pattern "(" .\n')
    run = inhabited.selfconf(
        "run", str(template), "--bind", "robot=:Astrid", "--bind", "goal=x", "--ecology", inhabited.ecology
    )
    assert run.ended() == 2
    assert "Traceback" not in run.complaints
    assert "broken.ttl" in run.complaints.splitlines()[-1]


def test_a_reader_that_has_seen_enough_ends_the_run(inhabited: Home) -> None:
    """As in `selfconf run ... --format json | head -1`."""
    run = inhabited.run()
    run.act("running")
    run.hang_up()
    (inhabited.folder / "tracker.fail").touch()
    assert run.ended() == 0
    assert "Traceback" not in run.complaints
    assert inhabited.active(*EVERYBODY) == set()


def test_a_site_that_is_killed_and_comes_back_finds_its_ecology_running_again(home: Home) -> None:
    site = home.site("peis-home", "ads")
    home.components("tracker", *REST)
    run = home.run()
    run.act("running")
    for end in (signal.SIGKILL, signal.SIGTERM):
        site.end(end)
        run.act("cut off")
        site = home.site("peis-home", "ads")
        run.act("running")
    assert home.active(*EVERYBODY) == TASK | {"tracker"}
    assert run.end(signal.SIGINT) == 0
    assert home.active(*EVERYBODY) == set()


def test_when_one_of_two_sites_is_killed_the_task_goes_on_through_the_other(home: Home) -> None:
    first = home.site("a", "ads")
    home.site("b", "ads", connect=(home.endpoint("a"),))
    both = home.endpoint("a"), home.endpoint("b")
    if home.authority is not None:  # with keys, what two sites advertise is nobody's until somebody says whose it is
        for name in ("tracker", *REST):
            believe(home.authority.path, component_of(name), "a")
    home.components("tracker", *REST, connect=both)
    run = home.run("--connect", both[0], "--connect", both[1])
    run.act("running")
    first.end(signal.SIGKILL)
    run.act("running")
    assert home.active(*EVERYBODY) == TASK | {"tracker"}
    assert run.end(signal.SIGINT) == 0


def test_a_run_that_is_not_decided_deploys_nothing_and_says_so(inhabited: Home) -> None:
    run = inhabited.run("--steps", "1")
    assert run.act("composed")["outcome"]["code"] == "undecided"
    assert run.ended() == 2
    assert "not decided within 1 step" in run.complaints
    assert inhabited.active("sonar", "control", "drive") == set()
