"""The logs of several sites read as one: those of this machine as files, those of others by asking their sites."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager
from pathlib import Path

import pytest

from selfconf.api.living.log_reader import LogReader, log_reader
from selfconf.api.living.site_logs import LogSource, local_log
from selfconf.errors import AuthorError
from selfconf.model.log_line import LogLine
from selfconf.protocol.messages import LogPart, LogQuestion
from tests.cli.processes import Home


def said(second: int, text: str) -> str:
    return f"2026-11-22T06:30:{second:02}.000Z stdout https://example.org/x#clock {text}\n"


def test_lines_of_several_logs_come_in_the_order_of_their_times(tmp_path: Path) -> None:
    one, other = tmp_path / "a.log", tmp_path / "b.log"
    one.write_text(said(1, "first") + said(3, "third"))
    other.write_text(said(2, "second") + said(4, "fourth"))
    reader = LogReader(map(local_log, (one, other)), "clock")
    assert [line.text for line in reader.latest(3)] == ["second", "third", "fourth"]
    assert LogReader([local_log(one)]).latest(0) == []
    assert reader.added() == []
    for path, second in ((other, 5), (one, 6)):
        with path.open("a") as file:
            file.write(said(second, f"added {second}"))
    assert [line.text for line in reader.added()] == ["added 5", "added 6"]
    assert reader.added() == []


def test_what_a_site_tells_in_parts_is_asked_for_until_there_is_no_more() -> None:
    def source(question: LogQuestion) -> LogPart:
        place = int(question.position or "0")
        return LogPart((LogLine(str(place), "stdout", (), ""),) if question.position else (), str(place + 1), place < 3)

    reader = LogReader([source])
    assert reader.latest(9) == []
    assert [line.time for line in reader.added()] == ["1", "2", "3"]
    assert [line.time for line in reader.added()] == ["4"]


def test_a_log_that_begins_later_is_followed_from_its_beginning(tmp_path: Path) -> None:
    first, later = tmp_path / "e@first.log", tmp_path / "e@later.log"
    first.write_text(said(1, "known"))
    found: list[list[LogSource]] = [[], [local_log(later)], []]
    reader = LogReader([local_log(first)], further=lambda: found.pop(0))
    assert [line.text for line in reader.latest(9)] == ["known"]
    assert reader.added() == []
    later.write_text(said(2, "of a former site").replace("2026", "2006") + said(3, "new").replace("2026", "2126"))
    assert [line.text for line in reader.added()] == ["new"]
    with later.open("a") as file:
        file.write(said(4, "newer"))
    assert [line.text for line in reader.added()] == ["newer"]


def test_where_nothing_is_kept_that_is_said_or_that_there_is_no_such_component() -> None:
    def look_up(component: str) -> None:
        raise AuthorError(f"no component {component} is advertised")

    assert LogReader([]).why_nothing() == "nothing that a component has printed is kept in the log"
    assert LogReader([], "clock").why_nothing() == "nothing that clock has printed is kept in the log"
    with pytest.raises(AuthorError, match="no component clock is advertised"):
        LogReader([], "clock", look_up=look_up).why_nothing()


@pytest.mark.parametrize("named", ["clock", ":clock", "x:clock", "<https://example.org/x#clock>"])
def test_a_component_is_named_as_tables_and_templates_name_it(tmp_path: Path, named: str) -> None:
    (tmp_path / "a.log").write_text(said(1, "mine") + said(2, "another's").replace("#clock", "#radio"))
    assert [line.text for line in LogReader([local_log(tmp_path / "a.log")], named).latest(9)] == ["mine"]


@pytest.fixture
def far(tmp_path: Path) -> Iterator[Home]:
    """An ecology on another machine, which is one with another runtime folder: nothing is known but its endpoint."""
    (tmp_path / "far").mkdir()
    far = Home(tmp_path / "far")
    yield far
    far.close()


@pytest.mark.process
def test_the_site_of_another_machine_is_asked_and_a_silent_one_named(
    far: Home, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept = far.folder / "kept" / f"{far.ecology}@far.log"
    kept.parent.mkdir()
    kept.write_text(said(1, "far away"))
    site = far.site("far", "ads", options=("--log", "kept"))
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(tmp_path / "here"))
    keys = None if far.authority is None else far.authority.path
    complaints: list[str] = []

    def reader(component: str = "") -> AbstractContextManager[LogReader]:
        return log_reader(far.ecology, [far.endpoint()], keys, None, component, complaints.append)

    with reader("clock") as lines:
        assert [line.text for line in lines.latest(9)] == ["far away"]
        with kept.open("a") as file:
            file.write(said(2, "later"))
        assert [line.text for line in lines.added()] == ["later"]
        where = far.endpoint()
        site.end()
        assert lines.added() == lines.added() == []
    assert [one.partition(":")[0] for one in complaints] == [
        "the site far does not tell what its components have printed"
    ]
    near = tmp_path / "here" / "log" / f"{far.ecology}@near.log"
    near.parent.mkdir(parents=True)
    near.write_text(said(1, "near"))
    with log_reader(far.ecology, [where], keys, None, "", complaints.append) as lines:
        assert [line.text for line in lines.latest(9)] == ["near"]
    assert complaints[-1].startswith("only the logs of this machine are shown: ")


@pytest.mark.process
def test_sites_that_begin_later_are_followed_on_this_machine_and_on_others(
    far: Home, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("selfconf.api.living.log_reader.ASK_AGAIN", 0.0)
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(tmp_path / "here"))
    far.site("far", "ads", options=("--log", "kept"))
    keys = None if far.authority is None else far.authority.path
    near = tmp_path / "here" / "log" / f"{far.ecology}@near.log"
    near.parent.mkdir(parents=True)
    added: list[str] = []
    with log_reader(far.ecology, [far.endpoint()], keys, None, "", pytest.fail) as lines:
        assert lines.latest(9) == []
        far.site("further", "ads", options=("--log", "kept"))
        (far.folder / "kept").mkdir(exist_ok=True)
        later = said(1, "further away").replace("2026", "2126")
        (far.folder / "kept" / f"{far.ecology}@further.log").write_text(later)
        near.write_text(later.replace("further away", "near"))
        far.until(lambda: bool(added.extend(line.text for line in lines.added())) or len(added) > 1)
    assert sorted(added) == ["further away", "near"]


@pytest.mark.process
def test_the_ecology_is_that_of_the_endpoint_where_logs_of_others_are_kept_here(
    far: Home, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept = far.folder / "kept" / f"{far.ecology}@far.log"
    kept.parent.mkdir()
    kept.write_text(said(1, "far away"))
    far.site("far", "ads", options=("--log", "kept"))
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(tmp_path / "here"))
    keys = None if far.authority is None else far.authority.path
    (tmp_path / "here" / "log").mkdir(parents=True)
    complaints: list[str] = []
    for other in ("of-yesterday", "of-the-day-before"):
        (tmp_path / "here" / "log" / f"{other}@near.log").write_text(said(1, "near"))
        with log_reader(None, [far.endpoint()], keys, None, "", complaints.append) as lines:
            assert [line.text for line in lines.latest(9)] == ["far away"]
    assert complaints == []


@pytest.mark.process
def test_a_site_that_lives_elsewhere_is_asked_though_a_former_one_of_its_name_has_kept_a_log_here(
    far: Home, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for folder, text in ((far.folder / "kept", said(2, "far away")), (tmp_path / "here" / "log", said(1, "once here"))):
        folder.mkdir(parents=True)
        (folder / f"{far.ecology}@far.log").write_text(text)
    far.site("far", "ads", options=("--log", "kept"))
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(tmp_path / "here"))
    keys = None if far.authority is None else far.authority.path
    with log_reader(far.ecology, [far.endpoint()], keys, None, "", lambda _: None) as lines:
        assert [line.text for line in lines.latest(9)] == ["once here", "far away"]
    with log_reader(far.ecology, [far.endpoint()], keys, far.folder / "kept", "", lambda _: None) as lines:
        assert [line.text for line in lines.latest(9)] == ["far away"]
