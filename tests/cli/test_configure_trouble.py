"""`configure`: a sentence for everything that is wrong, and an exit code whatever becomes of the streams."""

from __future__ import annotations

import io
import shlex
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest

from selfconf.bus.zenoh import client
from tests.cli.command import Outcome, each, run
from tests.cli.desk import BOUND, Desk, with_template
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES, iri, write_advertisements

# What is wrong with the input.


def test_an_advertisement_that_does_not_conform_is_named_and_left_out(desk: Desk) -> None:
    desk.advertise("bad", ':lamp a sc:Component, rob:PositionSensor ; sc:preference "high" .')
    outcome = desk.configure(*BOUND, "--format", "json")
    assert outcome.code == 0
    assert "bad.ttl" in outcome.err
    assert "sc:preference" in outcome.err
    assert outcome.body["eligible"][iri("position")] == 2


def test_a_component_whose_input_accepts_what_cannot_be_judged_is_named_once(desk: Desk) -> None:
    shape = '[ sh:property [ sh:path sc:name ; sh:pattern "(" ] ]'
    port = f'[ sc:name "i" ; sc:signalType rob:Text ; sc:accepts {shape} ]'
    desk.advertise("odd", f":odd a sc:Component, rob:PositionSensor ; sc:hasInput {port} .")
    outcome = desk.configure(*BOUND)
    assert outcome.code == 0
    assert outcome.err.count("what its input accepts cannot be judged") == 1


def test_a_component_that_is_advertised_twice_is_named(desk: Desk) -> None:
    desk.advertise("z", ADVERTISEMENTS["tracker"])
    outcome = desk.configure(*BOUND)
    assert outcome.code == 0
    assert "z.ttl" in outcome.err
    assert "tracker.ttl already" in outcome.err


def test_a_shape_in_one_advertisement_does_not_speak_about_another_component(desk: Desk) -> None:
    """Not even where pySHACL judges, over the advertisements of everybody."""
    (desk.ads / "drive.ttl").unlink()
    desk.advertise(
        "liar",
        ":liar a sc:Component, rob:Encoder ; :knows :pippi-drive . :pippi-drive rob:support :Astrid ; a :Approved .",
    )
    with_template(
        desk,
        ":t a sc:Template ; sc:roles ( :r ) ."
        " :r a sc:Role ; sh:class rob:MotorDrive ; sh:or ( [ sh:class :Approved ] ) .",
    )
    desk.refused()


def bad_templates() -> list[tuple[str, str]]:
    """Templates that cannot be read, each with words that the sentence must hold."""
    role = ":r a sc:Role ; sh:class rob:Encoder ."
    return [
        ("this is no turtle", "navigate.ttl:8"),
        ("", "no sc:Template"),
        (":t a sc:Template .", "sc:roles"),
        (":t a sc:Template ; sc:roles ( ) .", "empty"),
        (":t a sc:Template ; sc:roles ( :r ) .", "not described as a sc:Role"),
        (f":t a sc:Template ; sc:roles ( :r :r ) . {role}", "2 times"),
        (f":t a sc:Template ; sc:roles ( :r ) . {role} :r sc:feeds :nobody .", "which is no role"),
        (f":t a sc:Template ; sc:roles ( [ a sc:Role ] ) . {role}", "IRI"),
        (f"[] a sc:Template ; sc:roles ( :r ) . {role}", "IRI"),
        (f":t a sc:Template ; sc:roles ( :r ) . {role} :r sc:minCount 3 ; sc:maxCount 1 .", "at least 3 and at most 1"),
        (f':t a sc:Template ; sc:roles ( :r ) . {role} :r sc:minCount "two" .', "whole number"),
        (f":t a sc:Template ; sc:roles ( :r ) . {role} :r sc:minCount {'9' * 5000} .", "whole number"),
        (f":t a sc:Template ; sc:roles ( :r ) . {role} :i a sc:Interaction ; sc:from :r .", "sc:to"),
        (f":t a sc:Template ; sc:roles ( :r ) . {role} :i a sc:Interaction ; sc:from :r ; sc:to :x .", "no role"),
        (f":t a sc:Template ; sc:roles ( :r ) ; sc:parameter :p . {role} :p a sc:Parameter .", "sc:name"),
        (f":t a sc:Template ; sc:roles ( :r ) . {role} :r sc:sets [ sc:value 1 ] .", "sc:parameterType"),
        (f':t a sc:Template ; sc:roles ( :r ) . {role} :r sh:pattern "(" .', "not well-formed"),
        (
            f':t a sc:Template ; sc:roles ( :r ) . {role} :r sh:property [ sh:minCount "x" ; sh:path 3 ] .',
            "well-formed",
        ),
        (f":t a sc:Template ; sc:roles ( :r ) . {role} :r sh:property [ sh:minCount 1 ] .", "well-formed"),
        (":k a sc:Task ; sc:template :elsewhere .", "not in this file"),
    ]


@pytest.mark.parametrize(("text", "words"), bad_templates())
def test_a_template_that_cannot_be_read_is_one_sentence(desk: Desk, text: str, words: str) -> None:
    with_template(desk, text)
    assert desk.configure().is_one_sentence(words, "navigate.ttl")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--bind", "robot=:Astrid"), "the parameter 'goal' needs a value"),
        ((*BOUND, "--bind", "colour=red"), "no parameter 'colour'"),
        ((*BOUND, "--bind", "robot=:Pippi"), "bound twice"),
        (("--bind", "robot"), "NAME=TERM"),
        (("--bind", "=x"), "NAME=TERM"),
        (("--bind", "robot=x:Astrid", "--bind", "goal=x"), "prefix x:"),
        (("--bind", "robot=<Astrid", "--bind", "goal=x"), "no Turtle term"),
        (("--bind", "robot=http://example.org/a", "--bind", "goal=x"), "angle brackets"),
        (("--bind", "robot=Astrid", "--bind", "goal=x"), "cannot stand for the parameter 'robot'"),
        (("--bind", "robot=:Astrid", "--bind", "goal=3"), "cannot stand for the parameter 'goal'"),
        ((*BOUND, "--ontology", "/no/such/file.ttl"), "no file or folder /no/such/file.ttl"),
        ((*BOUND, "--template", "navigate"), "CURIE"),
        ((*BOUND, "--template", ":radio"), "radio"),
    ],
)
def test_an_argument_that_does_not_fit_is_one_sentence(desk: Desk, arguments: tuple[str, ...], words: str) -> None:
    outcome = desk.configure(*arguments)
    assert outcome.is_one_sentence(words)
    assert "bound in" not in outcome.err, "no file says it"


def test_files_that_are_not_there_or_are_not_turtle_are_one_sentence(desk: Desk) -> None:
    missing = desk.folder / "nowhere"
    assert desk.configure(*BOUND, "--ads", str(missing), ads=False).is_one_sentence(f"no file or folder {missing}")
    assert run(desk.capsys, "configure", str(missing), "--ads", str(desk.ads)).is_one_sentence(str(missing))
    assert run(desk.capsys, "configure", str(desk.ads), "--ads", str(desk.ads)).is_one_sentence("is a folder")
    (desk.ads / "broken.ttl").write_bytes(b"@prefix : <x> .\n:a :b \xff .")
    assert desk.configure(*BOUND).is_one_sentence("broken.ttl:2:7", "not UTF-8")
    (desk.ads / "broken.ttl").write_bytes(b"# \xff in a comment\n")
    for answer in (
        desk.configure(*BOUND),
        run(desk.capsys, "partition", str(desk.template), *BOUND, "--ads", str(desk.ads)),
    ):
        assert answer.is_one_sentence("broken.ttl:1:3", "not UTF-8: the byte 0xFF cannot stand here")


def test_without_a_peer_there_is_a_sentence_that_says_what_to_start(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("selfconf.rendezvous.client", partial(client, seconds=0.1))
    assert desk.configure(*BOUND, ads=False).is_one_sentence("selfconf site")
    assert desk.configure(*BOUND, "--connect", "tcp/127.0.0.1:1", ads=False).is_one_sentence("no site answers")
    assert desk.configure(*BOUND, "--connect", "here", ads=False).is_one_sentence("no endpoint")


def test_an_empty_folder_is_an_honest_no(desk: Desk) -> None:
    empty = desk.folder / "empty"
    empty.mkdir()
    outcome = desk.configure(*BOUND, "--ads", str(empty), "--format", "json", ads=False)
    assert outcome.code == 1
    assert len(outcome.body["reasons"]) >= 1


# What the shell does with the streams.


@pytest.mark.parametrize(
    ("task", "redirected", "code"),
    [
        ("robot=:Pippi", "| true", 1),
        ("robot=:Pippi", "2>&1 | true", 1),
        ("nobody=:Pippi", "2>&1 | true", 2),
        ("robot=:Astrid", ">&-", 0),
        ("robot=:Pippi", ">&- 2>&-", 1),
    ],
)
def test_the_exit_code_does_not_depend_on_who_reads(desk: Desk, task: str, redirected: str, code: int) -> None:
    words = ("-m", "selfconf", "configure", desk.template, "--ads", desk.ads, "--bind", "goal=x", "--bind", task)
    command = shlex.join(map(str, (sys.executable, *words)))
    script = f"({command}; echo $? >code) {redirected}"
    done = subprocess.run(["bash", "-c", script], cwd=desk.folder, capture_output=True, text=True, check=False)
    assert "Traceback" not in done.stderr
    assert (desk.folder / "code").read_text() == f"{code}\n"


def test_template_or_advertisements_come_in_on_stdin_but_not_both(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    answer = desk.configured(*BOUND)["roles"]

    def piped(text: str, *arguments: str) -> Outcome:
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(text.encode())))
        return run(desk.capsys, "configure", *arguments, *BOUND, "--format", "json")

    assert piped(NAVIGATE, "-", "--ads", str(desk.ads)).body["roles"] == answer
    everything = "".join(path.read_text() for path in sorted(desk.ads.glob("*.ttl")))
    assert piped(everything, str(desk.template), "--ads", "-").body["roles"] == answer
    assert piped(NAVIGATE, "-", "--ads", "-").is_one_sentence("- is standard input")
    assert piped("garbage", "-", "--ads", str(desk.ads)).is_one_sentence("<stdin>:1:")


def test_standard_input_that_is_closed_is_one_sentence(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", None)
    for given in (("-", "--ads", str(desk.ads)), (str(desk.template), "--ads", "-")):
        assert run(desk.capsys, "configure", *given, *BOUND).is_one_sentence("standard input is closed")


def test_of_two_descriptions_the_first_by_path_counts_in_whatever_order_they_are_given(desk: Desk) -> None:
    for name, text in (("a", ":lamp a sc:Component, :A ."), ("b", ":lamp a sc:Component, :B .")):
        (desk.folder / f"{name}.ttl").write_text(PREFIXES + text)
    desk.template.write_text(PREFIXES + ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :A .")
    files = [str(desk.folder / f"{name}.ttl") for name in "ab"]
    for order in (files, files[::-1]):
        outcome = desk.configure(*each("--ads", *order), ads=False)
        assert outcome.code == 0
        line = (PREFIXES + "x").count("\n") + 1
        assert outcome.err == f"{files[1]}:{line}: left out {iri('lamp')}: it is advertised in {files[0]} already\n"


# What cannot be composed.


SUPPLIED = ":t a sc:Template ; sc:roles ( :source :user ) . :source a sc:Role ; sh:class :Source ; sc:feeds :user ."
USER = ":user a sc:Role ; sh:class :User ."
RECRUITING = ":t a sc:Template ; sc:roles ( :user ) . :user a sc:Role ; sh:class :User ; sc:recruits true ."
COMPOSITE = """:NAME a sc:Component, :User, :NAME-type ; sc:hasOutput [ sc:name "o" ; sc:signalType :S ] ;
    sc:grounding [ sc:template :NAME-inside ] .
:NAME-inside a sc:Template ; sc:roles ( :NAME-role ) ;
    sc:hasOutput [ sc:name "o" ; sc:signalType :S ; sc:of :NAME-role ] .
:NAME-role a sc:Role ; sh:class :WANTED ."""


def source(name: str, wanted: str, issued: str) -> str:
    """A component that makes one signal of another."""
    issues = f'sc:hasOutput [ sc:name "o" ; sc:signalType :{issued} ]'
    return f':{name} a sc:Component, :Source ; sc:hasInput [ sc:name "i" ; sc:signalType :{wanted} ] ; {issues} .'


@pytest.mark.parametrize(
    ("task", "ads", "code", "sentence"),
    [
        (
            RECRUITING,
            {
                "user": ':u a sc:Component, :User ; sc:hasInput [ sc:name "i" ; sc:signalType :S ] .',
                "both": source("a", "T", "S") + source("b", "S", "T"),
            },
            1,
            "the nearest is a, which is fed only in a circle: its input 'i' by b by a",
        ),
        (
            SUPPLIED + USER,
            {
                "u": ':u a sc:Component, :User ; sc:hasInput [ sc:name "i" ; sc:accepts _:s ] . _:s sh:node _:s .',
                "s": ':s a sc:Component, :Source ; sc:hasOutput [ sc:name "o" ; sc:signalType :S ] .',
            },
            1,
            "left out https://example.org/peis-home#u: the sc:accepts of input 'i' is no shape",
        ),
        (
            SUPPLIED.replace("sc:feeds :user", "") .replace(":source :user", ":user") + USER,
            {
                "one": COMPOSITE.replace("NAME", "one").replace("WANTED", "two-type"),
                "two": COMPOSITE.replace("NAME", "two").replace("WANTED", "one-type"),
            },
            0,
            ":one: it could be inside of itself (one of two of one); a composite of itself has no end",
        ),
        (
            SUPPLIED + USER,
            {
                "u": ':u a sc:Component, :User ; sc:needsOperation [ sc:name "look" ; sc:response :S ] .',
                "s": ':s a sc:Component, :Source ; sc:hasOperation [ sc:name "see" ; sc:response :T ] .',
            },
            1,
            "the operation 'look' (-> S) that u needs cannot be called: no candidate of source offers an operation",
        ),
        (
            SUPPLIED + USER,
            {
                "u": ':u a sc:Component, :User ; sc:hasInput [ sc:name "i" ; sc:signalType :S ; sc:unit "metre" ] .',
                "s": ':s a sc:Component, :Source ; sc:hasOutput [ sc:name "o" ; sc:signalType :S ] .',
            },
            1,
            "left out https://example.org/peis-home#u: 'i' has at most one sc:unit, an IRI",
        ),
        (
            SUPPLIED.replace("sc:feeds :user", "").replace(":source :user", ":user") + USER,
            {
                "one": COMPOSITE.replace("NAME", "one").replace("WANTED", "Part"),
                "part": ':part a sc:Component, :Part ; sc:hasOutput [ sc:name "o" ; sc:signalType :T ] .',
            },
            0,
            "its inside cannot be configured now: the input 'o' (S) of one cannot be fed: no candidate of one-role",
        ),
        (
            SUPPLIED.replace("sc:feeds :user", "").replace(":source :user", ":user") + USER,
            {"one": COMPOSITE.replace("NAME", "one").replace("sc:of :one-role", "sc:of :nobody")},
            1,
            "peis-home#nobody>, which is no role of the template",
        ),
    ],
    ids=["cycle", "endless", "itself", "unanswered", "unit", "unserved", "roleless"],
)  # fmt: skip
def test_what_cannot_be_composed_is_one_sentence(
    task: str, ads: dict[str, str], code: int, sentence: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "task.ttl").write_text(PREFIXES + task)
    write_advertisements(tmp_path / "ads", advertisements=ads)
    outcome = run(capsys, "configure", str(tmp_path / "task.ttl"), "--ads", str(tmp_path / "ads"))
    assert outcome.code == code
    assert sentence in outcome.out + outcome.err
    assert "Traceback" not in outcome.err
