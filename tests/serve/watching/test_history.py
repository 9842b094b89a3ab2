"""The history of what was deployed, on disk."""

from __future__ import annotations

import resource
import shutil
from pathlib import Path

import pytest

from selfconf.errors import AuthorError
from selfconf.model.term import IRI
from selfconf.rdf.provenance import CONFIGURATION
from selfconf.rdf.turtle import ntriples, parse
from selfconf.rdf.vocabulary import PROV, SC, TYPE
from selfconf.serve.watching import history
from selfconf.serve.watching.history import History
from selfconf.serve.watching.task_watcher import DEPLOYED
from tests.lab import Lab, iri

GRAPH, OTHER_GRAPH = DEPLOYED + "lab/conf/c1/cfg", DEPLOYED + "lab/conf/c2/cfg"


def name(number: int) -> str:
    """What a configuration is called."""
    return f"{CONFIGURATION}{number}"


def told(number: int) -> bytes:
    """What a configurator tells of a configuration."""
    text = f"""<{name(number)}> a <https://w3id.org/selfconf#Configuration> ;
        <http://www.w3.org/ns/prov#generatedAtTime> "2026-01-01T00:00:{number:02}Z" ;
        <https://w3id.org/selfconf#assignment> [ <https://w3id.org/selfconf#role> <urn:role> ] ."""
    return ntriples(parse(text, "cfg").triples())


def test_a_configuration_ends_when_another_takes_its_place_or_its_configurator_goes(tmp_path: Path) -> None:
    kept = History(tmp_path, lambda: 86_400.0)
    assert kept.note({GRAPH: told(1)}) == {}
    (ended,) = kept.note({GRAPH: told(2)}).items()
    assert ended[0] == name(1)
    assert b'invalidatedAtTime> "1970-01-02T00:00:00' in ended[1]
    assert kept.note({GRAPH: told(2)}) == {}
    assert list(kept.note({GRAPH: b""})) == [name(2)]
    assert set(kept.past()) == {name(1), name(2)}


def test_what_is_called_as_a_component_may_be_is_no_configuration(tmp_path: Path) -> None:
    """Else its end would be told in the graph of the component, in place of what that advertises."""
    kept = History(tmp_path)
    kept.note({GRAPH: f"<urn:lamp> <{TYPE}> <{SC.Configuration}> .\n".encode()})
    assert kept.note({GRAPH: b""}) == {}
    assert kept.past() == {}


def test_a_configuration_that_is_told_after_its_end_has_ended_once(tmp_path: Path) -> None:
    kept = History(tmp_path)
    assert [list(kept.note({GRAPH: told(number)})) for number in (1, 2, 1, 3)] == [[], [name(1)], [], [name(2)]]
    ends = {name: triples.count(b"invalidatedAtTime") for name, triples in kept.past().items()}
    assert ends == {name(1): 1, name(2): 1, name(3): 0}


def test_a_configuration_that_is_deployed_again_after_its_end_runs(tmp_path: Path) -> None:
    kept = History(tmp_path)
    kept.note({GRAPH: told(1)})
    assert list(kept.note({GRAPH: b""})) == [name(1)]  # as where the server was cut off for a while
    assert kept.note({GRAPH: told(1)}) == {name(1): b""}, "it is none of the past any more"
    assert b"invalidatedAtTime" not in kept.past()[name(1)]
    assert b"invalidatedAtTime" in kept.note({GRAPH: told(2)})[name(1)]


@pytest.mark.parametrize("first", [OTHER_GRAPH, GRAPH], ids=["told before the end", "told after it"])
def test_a_configuration_with_which_another_configurator_goes_on_has_not_ended(tmp_path: Path, first: str) -> None:
    kept = History(tmp_path)
    kept.note({GRAPH: told(1)})
    for graph in (first, GRAPH if first is OTHER_GRAPH else OTHER_GRAPH):
        told_now = kept.note({graph: told(1) if graph is OTHER_GRAPH else b""})
    assert told_now == ({} if first is OTHER_GRAPH else {name(1): b""}), "it is none of the past"
    assert b"invalidatedAtTime" not in kept.past()[name(1)]
    assert kept.past()[name(1)].count(b"urn:role") == 1
    assert list(kept.note({OTHER_GRAPH: b""})) == [name(1)]


def test_where_nothing_takes_its_place_a_configuration_says_which_of_its_components_failed(tmp_path: Path) -> None:
    kept = History(tmp_path, lambda: 90.0)
    part = {"act": "lost", "configurator": "c1", "component": "urn:lamp", "cause": "crash", "detail": "", "time": 80.0}
    others = ({**part, "component": "urn:other"}, {**part, "configurator": "c2", "cause": "fail"}, {"act": "lost"})
    heater = {**part, "component": "urn:heater"}
    for number, event in ((1, heater), (1, part), (2, {**part, "cause": "fail", "detail": "dark", "time": 1e11})):
        recruits = " , ".join(("<urn:lamp>", "<urn:heater>")[: 3 - number])
        kept.note(
            {GRAPH: told(number) + ntriples(parse(f"<{name(number)}> <{SC.recruited}> {recruits} .", "r").triples())}
        )
        kept.note({}, (event, *others))
    first, second = kept.past()[name(1)], kept.note({GRAPH: b""})[name(2)]
    assert b"Failure" not in first  # the second one says what has led to it
    document = parse(second, "second")
    (failure,) = document.values(IRI(name(2)), PROV.qualifiedInvalidation)
    assert {(p, getattr(o, "lexical", o)) for p, o in document.about(failure)} == {
        (TYPE, SC.Failure), (SC.component, "urn:lamp"), (SC.cause, "fail"), (SC.detail, "dark"),
        (PROV.atTime, "1970-01-01T00:01:30Z"),
    }  # fmt: skip


def test_it_is_there_for_the_next_server(tmp_path: Path) -> None:
    first = History(tmp_path)
    for number in (1, 2, 3):
        first.note({GRAPH: told(number)})
    first.note({GRAPH + "2": told(4)})
    first.close()
    second = History(tmp_path)
    assert set(second.past()) == {name(1), name(2)}
    second.note({GRAPH: told(3)})
    assert set(second.settle()) == {name(4)}
    assert set(second.note({GRAPH: b""})) == {name(3)}


def test_what_runs_on_is_none_of_the_past_however_late_the_next_server_hears_of_it(tmp_path: Path) -> None:
    first = History(tmp_path)
    first.note({GRAPH: told(1)})
    first.close()
    second = History(tmp_path)
    assert set(second.settle()) == {name(1)}
    assert second.note({GRAPH: told(1)}) == {name(1): b""}


def test_the_oldest_go_when_there_are_too_many(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(history, "MOST_KEPT", 3)
    kept = History(tmp_path)
    forgotten = [one for number in range(6) for one, text in kept.note({GRAPH: told(number)}).items() if not text]
    assert forgotten == [name(0), name(1), name(2)]
    assert set(kept.past()) == {name(3), name(4), name(5)}


def test_a_configuration_that_two_have_told_counts_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(history, "MOST_KEPT", 2)
    kept = History(tmp_path)
    for graph, text in ((GRAPH, told(1)), (OTHER_GRAPH, told(1)), (GRAPH, b""), (OTHER_GRAPH, told(2))):
        kept.note({graph: text})
    assert set(kept.past()) == {name(1), name(2)}


def test_what_a_change_takes_does_not_grow_with_what_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kept, asked, generated = History(tmp_path), list[str](), History._generated
    for number in range(40):
        kept.note({GRAPH: told(number)})
    monkeypatch.setattr(History, "_generated", lambda self, name: asked.append(name) or generated(self, name))
    kept.note({GRAPH: told(40)})
    assert asked == [name(40)]
    kept.close()


def test_the_oldest_go_first_for_the_next_server_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = History(tmp_path)
    for number in (2, 3, 1):
        first.note({GRAPH: told(number)})
    first.close()
    monkeypatch.setattr(history, "MOST_KEPT", 3)
    assert set(History(tmp_path).note({GRAPH: told(4)})) == {name(1)}


def test_what_a_full_disk_did_not_take_is_noted_once_there_is_room(tmp_path: Path) -> None:
    kept, room = History(tmp_path), resource.getrlimit(resource.RLIMIT_FSIZE)
    kept.note({GRAPH: told(1)})
    resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 10, room[1]))  # no file may grow beyond that
    try:
        for number in (2, 3):
            with pytest.raises(history.CANNOT_WRITE):
                kept.note(
                    {GRAPH: told(number) + told(number).replace(b"urn:role", b"urn:" + bytes(1 << 10).hex().encode())}
                )
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, room)
    assert list(kept.note({GRAPH + "2": told(4)})) == [name(1)]
    assert list(kept.note({GRAPH: b""})) == [name(3)]
    kept.close()
    later = History(tmp_path)
    ends = {name: triples.count(b"invalidatedAtTime") for name, triples in later.past().items()}
    assert ends == {name(1): 1, name(3): 1}
    assert set(later.settle()) == {name(4)}


@pytest.mark.parametrize("renamed", [False, True])
def test_a_history_that_was_removed_begins_anew_with_what_is_deployed(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, renamed: bool
) -> None:
    place, renamed_to = tmp_path / "history", tmp_path / "last-year"
    kept = History(place)
    for number, graph in ((1, GRAPH), (2, GRAPH), (3, GRAPH + "2")):
        kept.note({graph: told(number)})
    place.rename(renamed_to)
    if not renamed:
        shutil.rmtree(renamed_to, ignore_errors=True)  # the store may be writing into it
    assert list(kept.note({GRAPH: told(4)})) == [name(2)]
    assert [record.getMessage() for record in caplog.records] == [
        f"the history in {place} is not there any more; a new one begins there"
    ]
    kept.close()
    later = History(place)
    assert set(later.past()) == {name(2)}
    assert set(later.settle()) == {name(3), name(4)}
    if renamed:
        assert set(History(renamed_to).past()) == {name(1)}


def test_what_cannot_be_written_at_the_end_is_a_sentence(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    kept = History(tmp_path / "history")
    kept.note({GRAPH: told(1)})
    (tmp_path / "history").rename(tmp_path / "last-year")
    kept.close()
    assert [(record.levelname, record.exc_info) for record in caplog.records] == [("ERROR", None)]


def test_what_is_older_than_a_year_goes_unless_it_runs_still(tmp_path: Path) -> None:
    now = [1.77e9]  # in February 2026
    kept = History(tmp_path, lambda: now[0])
    for number, graph in ((1, GRAPH), (2, GRAPH), (3, GRAPH + "2")):
        kept.note({graph: told(number)})
    now[0] += history.KEPT_FOR
    assert kept.note({GRAPH: told(4)}) == {name(1): b"", name(2): b""}
    assert set(kept.past()) == {name(3), name(4)}


def test_a_folder_that_another_server_uses_is_a_sentence(tmp_path: Path) -> None:
    kept = History(tmp_path)
    with pytest.raises(AuthorError, match="does another server use it"):
        History(tmp_path)
    kept.close()


def test_a_real_configuration_keeps_its_provenance(tmp_path: Path) -> None:
    lab = Lab(tmp_path / "lab")
    lab.navigation()
    agent = lab.agent()
    lab.running(agent)
    kept = History(tmp_path / "history")
    kept.note({GRAPH: ntriples(parse(agent._record.turtle(), "cfg").triples())})
    lab.components["tracker"].fail("lost Astrid")
    lab.let_pass(1.0)
    (before,) = kept.note({GRAPH: ntriples(parse(agent._record.turtle(), "cfg").triples())})
    (after,) = kept.note({GRAPH: b""}).values()
    document = parse(after, "after")
    (revision,) = [str(o) for _, p, o in document.triples() if p == PROV.wasRevisionOf]
    assert revision == before
    assert iri("person-tracker") in after.decode()


def test_a_folder_with_a_broken_store_is_a_sentence(tmp_path: Path) -> None:
    History(tmp_path).close()
    (tmp_path / "CURRENT").write_text("nothing")
    with pytest.raises(AuthorError, match=r"cannot keep a history in .* \(Corruption: .*\)$"):
        History(tmp_path)


def test_a_file_is_no_folder_for_a_history(tmp_path: Path) -> None:
    (tmp_path / "notes").write_text("mine")
    with pytest.raises(AuthorError, match=r"cannot keep a history in .*notes \(File exists\)$"):
        History(tmp_path / "notes")
