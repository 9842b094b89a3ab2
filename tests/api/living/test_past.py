"""What a server has kept, read from its folder while it writes, and told as `why` tells the present."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.api.living.deployed import passed_over
from selfconf.api.living.past import past_configurations, past_graphs, past_why
from selfconf.errors import AuthorError
from selfconf.rdf.provenance import CONFIGURATION
from selfconf.rdf.turtle import ntriples, parse
from selfconf.rdf.vocabulary import SC
from selfconf.serve.watching.change import EcologyChange
from selfconf.serve.watching.history import History
from selfconf.serve.watching.task_watcher import DEPLOYED
from selfconf.serve.watching.watcher import EcologyWatcher
from tests.lab import ADVERTISEMENTS, Lab, iri

GRAPH = DEPLOYED + "lab/conf/c1/cfg"


class Clock:
    """A clock turned by hand."""

    now = 1_000_000.0

    def __call__(self) -> float:
        return self.now


def told(number: int, position: str, before: str = "", at: float = 0.0) -> bytes:
    """What a configurator tells of a configuration, which the loss of another position has led to."""
    failure = (
        f"prov:wasRevisionOf <{CONFIGURATION}{number - 1}> ;"
        f' prov:wasInfluencedBy [ sc:component :{before} ; sc:cause "fail" ; sc:detail "out of view" ;'
        f' prov:atTime "1970-01-12T13:46:{int(at - 1_000_000 + 40):02}.000+00:00"^^xsd:dateTime ] ;'
        if before
        else ""
    )
    over = f"; sc:passedOver :{before}" if before else ""
    text = f"""@prefix : <https://example.org/peis-home#> . @prefix sc: <https://w3id.org/selfconf#> .
        @prefix prov: <http://www.w3.org/ns/prov#> . @prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
        <{CONFIGURATION}{number}> a sc:Configuration ; sc:template :navigate ; sc:task [ sc:template :navigate ] ;
            prov:wasAttributedTo <urn:selfconf:configurator:c1> ; {failure}
            prov:generatedAtTime "1970-01-12T13:46:{int(at - 1_000_000 + 40):02}.500+00:00"^^xsd:dateTime ;
            sc:assignment [ sc:role :position ; sc:component :{position} {over} ] ."""
    return ntriples(parse(text, "cfg").triples())


@pytest.fixture
def kept(tmp_path: Path) -> Path:
    """The history of a task whose tracker failed, that then had nothing for a while, and was taken down in the end."""
    clock = Clock()
    history = History(tmp_path, clock)
    history.note({GRAPH: told(1, "tracker", at=clock.now)})
    clock.now += 5
    history.note({GRAPH: told(2, "odometry", "tracker", clock.now)})
    clock.now += 3
    history.note({GRAPH: b""})
    clock.now += 2
    history.note({GRAPH: told(3, "tracker", at=clock.now)})
    clock.now += 5
    history.note({GRAPH: b""})
    history.close()
    return tmp_path


def test_every_configuration_is_read_with_its_time_its_end_and_what_had_failed(kept: Path) -> None:
    first, second, third = past_configurations(past_graphs(kept))
    assert (first.configurator, first.task, first.failures) == ("c1", "navigate", ())
    assert (first.generated, first.ended) == (1_000_000.5, 1_000_005.0)
    assert (second.failures[0]["cause"], second.failures[0]["time"]) == ("fail", 1_000_005.0)
    assert passed_over(second.body) == {iri("position"): [iri("tracker")]}
    assert third.ended == 1_000_015.0


@pytest.mark.parametrize(
    ("at", "words"),
    [
        (999_999.0, []),
        (1_000_003.0, ["position in navigate: tracker, since", "no other candidate"]),
        (1_000_006.0, ["navigate: odometry", "it took over from tracker: lost at", "passed over", "what would change"]),
        (1_000_009.0, ["odometry, since", "took over", "passed over", "would change"]),
        (1_000_012.0, ["position in navigate: tracker, since", "was lost", "no other candidate"]),
        (None, ["position in navigate: tracker, since", "was lost", "no other candidate"]),
    ],
)
def test_the_answer_is_that_of_the_moment(at: float | None, words: list[str], kept: Path) -> None:
    said = past_why(kept, ":position", at)
    assert [word in one for word, one in zip(words, said, strict=True)] == [True] * len(words)
    assert [", until " in one for one in said[:1]] == ([at in (None, 1_000_009.0)] if said else [])


def test_what_took_over_after_a_time_without_a_configuration_is_told_with_the_failure_before(tmp_path: Path) -> None:
    clock = Clock()
    history = History(tmp_path, clock)
    history.note({GRAPH: told(1, "tracker", at=clock.now)})
    clock.now += 2
    loss = {"act": "lost", "configurator": "c1", "component": iri("tracker"), "cause": "crash", "time": clock.now}
    history.note({GRAPH: b""}, [loss])
    clock.now += 5
    history.note({GRAPH: told(2, "odometry", "tracker", clock.now)})
    history.close()
    assert ["(crash)" in one for one in past_why(tmp_path, "position", 1_000_004.0)] == [False, True, False]
    assert "it took over from tracker: lost at" in past_why(tmp_path, "position", None)[1]


def test_tasks_that_were_over_by_then_are_passed_over_but_for_the_last_where_no_other_answers(tmp_path: Path) -> None:
    clock = Clock()
    history = History(tmp_path, clock)
    for number in range(3):  # three runs, each over before the next one
        graph, moment = GRAPH.replace("c1", f"c{number}"), clock.now
        history.note({graph: told(10 * number, "tracker", at=moment).replace(b"tor:c1>", b"tor:c%d>" % number)})
        clock.now += 4
        history.note({graph: b""})
        clock.now += 4
    history.close()
    at_each = [past_why(tmp_path, "position", 1_000_000.0 + seconds) for seconds in (2, 6, 10, 14, 18, 22)]
    assert [len([one for one in said if one.startswith("position in navigate")]) for said in at_each] == [1] * 6
    assert [", until " in said[0] for said in at_each] == [False, True] * 3
    assert past_why(tmp_path, "position", None) == at_each[-1]
    assert len({said[0].partition(",")[2] for said in at_each}) == 6, "each is told of its own run"


def test_it_is_read_while_a_server_writes(tmp_path: Path) -> None:
    history = History(tmp_path, Clock())
    for number in range(5):
        history.note({GRAPH: told(number, "tracker", at=1_000_000.0 + number)})
        assert len(past_graphs(tmp_path)) == number + 1
    history.close()


def test_a_real_configuration_is_told(tmp_path: Path) -> None:
    lab = Lab(tmp_path / "lab")
    lab.navigation()
    agent = lab.agent()
    lab.running(agent)
    history = History(tmp_path / "history")
    history.note({GRAPH: ntriples(parse(agent._record.turtle(), "cfg").triples())})
    history.close()
    sentence, why = past_why(tmp_path / "history", "position", None)
    assert sentence.startswith("position in navigate: person-tracker, since ")
    assert why == "  no other candidate went before it in the latest search"
    assert past_why(tmp_path / "history", "Astrid", None)


def test_a_task_goes_by_the_name_that_it_ran_by(tmp_path: Path) -> None:
    history = History(tmp_path, Clock())
    lines = told(1, "tracker", at=Clock.now).decode().splitlines()
    (task,) = (line.split()[2] for line in lines if line.split()[1].endswith("#task>"))
    history.note({GRAPH: "\n".join((*lines, f'{task} <{SC.name}> "patrol" .', "")).encode()})
    history.close()
    (found,) = past_configurations(past_graphs(tmp_path))
    assert found.task == "patrol"
    assert past_why(tmp_path, "patrol", None)


@pytest.mark.parametrize("named", ["tracker", "x:tracker", iri("tracker"), f"<{iri('tracker')}>"])
def test_what_was_passed_over_is_told_by_its_name_however_it_was_typed(tmp_path: Path, named: str) -> None:
    history = History(tmp_path, Clock())
    never_lost = told(1, "odometry", "tracker", Clock.now).replace(b"wasInfluencedBy", b"wasDerivedFrom")
    history.note({GRAPH: never_lost})
    history.close()
    sentence = "tracker goes before odometry for the role position, and was passed over"
    assert past_why(tmp_path, named, None) == [sentence]
    assert past_why(tmp_path, "home:tracker", None) == []  # another namespace than that of the test


def test_a_folder_in_it_is_passed_over(kept: Path) -> None:
    known = past_graphs(kept)
    (kept / "lost+found").mkdir()
    assert past_graphs(kept) == known


def test_a_folder_without_a_history_and_one_that_is_broken_are_sentences(tmp_path: Path, kept: Path) -> None:
    with pytest.raises(AuthorError, match="holds no history; `selfconf serve --history"):
        past_graphs(tmp_path / "nowhere")
    (kept / "CURRENT").write_text("nothing")
    with pytest.raises(AuthorError, match="cannot read the history in"):
        past_graphs(kept)


def test_what_is_no_configuration_is_passed_over() -> None:
    assert past_configurations({"urn:x": b"<urn:x> <urn:y> <urn:z> .\n"}) == []


def test_after_three_failures_the_history_tells_at_each_moment_what_the_run_has_told(tmp_path: Path) -> None:
    spare = ADVERTISEMENTS["odometry"].replace("absolute-odometry", "spare")
    lab = Lab(tmp_path / "lab", advertised={**ADVERTISEMENTS, "spare": spare})
    lab.navigation()
    lab.site("attic", "spare")
    lab.component("spare")
    history = History(tmp_path / "history", lambda: lab.network.time)

    def note(change: EcologyChange) -> None:
        history.note(change.deployed, change.events)

    EcologyWatcher(lab.network.node(), "lab", note, lambda: lab.network.time).begin()
    assert lab.running(lab.agent(patient=True))
    for name in ("tracker", "odometry", "spare"):
        lab.let_pass(20.0)
        lab.components[name].fail(f"{name} is told to")
        lab.let_pass(5.0)
    history.close()
    lost = [(event.time, event.component.short) for event in lab.acts("lost")]
    players = [
        (event.time, next(one.components[0].short for one in event.configuration.assignments if "position" in one.role))
        for event in lab.acts("running")
    ]
    assert [who for _, who in players] == ["person-tracker", "absolute-odometry", "spare"]
    assert [who for _, who in lost] == [who for _, who in players]
    begun, *replaced = (when for when, _ in players)
    for moment in (begun + 1, replaced[0] - 1, replaced[0] + 1, replaced[1] + 1, lost[2][0] - 1):
        said = past_why(tmp_path / "history", "position", moment)
        number = sum(when <= moment for when, _ in players) - 1
        assert f": {players[number][1]}, since " in said[0], moment
        causes = [line for line in said if "took over from" in line]
        failed = lost[number - 1][1] if number else ""
        assert [f"{failed}: lost at " in line and "(fail, " in line for line in causes] == [True] * bool(number), said
    over = past_why(tmp_path / "history", "position", lost[2][0] + 4)
    assert ", until " in over[0]
    assert "(fail, spare is told to)" in over[2]
