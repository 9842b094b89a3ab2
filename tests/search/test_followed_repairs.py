"""A repair works when an author follows it as it is worded: written as Turtle, and read by the reader."""

from __future__ import annotations

import random
import re
from pathlib import Path

import pytest

import selfconf
from selfconf.model.refusal import Refusal
from selfconf.model.relaxation import AcceptNearMiss, AddComponents, AddInteraction, AskForFewer, LetRecruit, Relaxation
from tests.harness.effort import examples, thorough

PREFIXES = """\
@prefix sc: <https://w3id.org/selfconf#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix unit: <http://qudt.org/vocab/unit/> .
@prefix : <urn:t:> .
"""
ADDED = re.compile(
    r"(one|\d+) more components? for the role (\w+)( to recruit)?(?: that issues? (.*?))?"
    r"(?:, with robot (\w+)|, with (no robot))?(?=$|(?:,| and) (?:one|\d+) more)"
)
SHARED = re.compile(r", with one robot for (?:both|all|those for the roles? ([\w, ]+))$")
ISSUED = re.compile(r"(\w+)(?: in (\w+))?( as the sc:accepts of its input asks)?(?: by the output '(\w+)')?(?:, |$)")
IN_METRES = "sc:accepts [ sh:property [ sh:path sc:unit ; sh:hasValue unit:M ] ]"
ANY_ROBOT = ("A", "B", "D")
"""Values that a component may state where a repair leaves the choice; A is the value of a parameter that is bound."""
PARAMETER_AS = {
    "may": "sh:in ( :robot )",
    "must": "sh:in ( :robot ) ; sh:minCount 1",
    "value": "sh:hasValue :robot",
}
ALTERNATIVES: dict[str, list[str | None]] = {
    " ; sh:not [ sh:property [ sh:path :on ; sh:minCount 1 ] ]": [None],
    " ; sh:or ( [ sh:property [ sh:path :on ; sh:hasValue :A ] ] [ sh:property [ sh:path :on ; sh:hasValue :B ] ] )": [
        "A",
        "B",
    ],
    " ; sh:xone ( [ sh:property [ sh:path :on ; sh:maxCount 0 ] ] [ sh:property [ sh:path :on ; sh:in ( :B ) ] ] )": [
        "B",
    ],
}
"""Alternatives of a role, and what a component may state where they are all that its shape says of the property."""


class Roles:
    """What a template says of its roles, and how its parameter stands in their shapes, if it has one."""

    def __init__(self, rng: random.Random, number: int) -> None:
        self.bound = rng.random() < 0.15
        self.parameter = self.bound or rng.random() < 0.4
        self.about: dict[str, str] = {}
        self.on: dict[str, tuple[str, list[str]]] = {}
        """How the parameter stands in the shape of a role, if it does, and which values the role lists besides."""
        self.alternatives: dict[str, list[str | None]] = {}
        """What a component may state for a role that has alternatives."""
        for role in [f"r{k}" for k in range(number)]:
            count = rng.choice(["", "", "", " ; sc:minCount 2", " ; sc:minCount 0"])
            recruits = rng.choice(["", "", "", " ; sc:recruits true", " ; sc:recruits [ sh:class :HELPER ]"])
            where = self._where(rng, role) if self.parameter and rng.random() < 0.7 else ""
            named = rng.choice([*[""] * 7, f" ; sh:in ( :c{role}0 :elsewhere )"])
            alternatives = rng.choice([*[""] * 7, *ALTERNATIVES])
            if alternatives:
                self.alternatives[role] = ALTERNATIVES[alternatives]
            self.about[role] = (
                f":{role} a sc:Role ; sh:class :{role.upper()}{count}{where}{named}{alternatives}{recruits} ."
            )

    def _where(self, rng: random.Random, role: str) -> str:
        kind, listed = rng.choice(["may", "may", "must", "value"]), rng.choice(["", "", "A", "A B", "B C"]).split()
        self.on[role] = kind, listed
        where = f" ; sh:property [ sh:path :on ; {PARAMETER_AS[kind]} ]"
        if listed:
            where += f" , [ sh:path :on ; sh:in ( {' '.join(f':{one}' for one in listed)} ) ]"
        return where

    def stated(self, rng: random.Random, role: str) -> str | None:
        """What a component states that is made for a role by its shape alone: any value that the shape permits."""
        kind, listed = self.on.get(role, ("may", []))
        may = [one for one in (ANY_ROBOT[:1] if self.bound else listed or ANY_ROBOT) if not listed or one in listed]
        permitted: list[str | None] = [*may, *([None] if kind == "may" else [])] or [None]
        passing = self.alternatives.get(role, permitted)
        return rng.choice([one for one in permitted if one in passing] or passing)


def ecology(rng: random.Random) -> tuple[str, Roles]:
    """A template, whose interactions name ports, and where a parameter may be free, and its roles.

    Some of these recruit.
    """
    roles = Roles(rng, rng.randint(2, 4))
    listed = " ".join(f":{role}" for role in roles.about)
    lines = [f":t a sc:Template ; sc:roles ( {listed} ) {'; sc:parameter :robot' * roles.parameter} ."]
    lines += [':robot a sc:Parameter ; sc:name "robot" ; sh:nodeKind sh:IRI .'] * roles.parameter
    for _ in range(rng.randint(1, 2 * len(roles.about))):
        source, sink = rng.sample(list(roles.about), 2)
        output = rng.choice(["", "", ' ; sc:output "p"', ' ; sc:output "q"'])
        wanted = rng.choice(["", "", ' ; sc:input "p"'])
        lines.append(f"[] a sc:Interaction ; sc:from :{source} ; sc:to :{sink}{output}{wanted} .")
    return "\n".join(lines), roles


def component(name: str, role: str, inputs: dict[str, str], outputs: dict[str, str], on: str | None = None) -> str:
    """An advertisement."""
    ports = [f'sc:hasInput [ sc:name "{port}" ; sc:signalType :{signal} ]' for port, signal in inputs.items()]
    ports += [f'sc:hasOutput [ sc:name "{port}" ; sc:signalType :{signal} ]' for port, signal in outputs.items()]
    return " ; ".join([f":{name} a sc:Component, :{role.upper()}", *ports, *([f":on :{on}"] if on else [])]) + " ."


def components(rng: random.Random, roles: list[str]) -> list[str]:
    """Advertisements for the roles, one or two for each, sometimes none; in some, ports ask for units or have them."""
    found = []
    units = rng.random() < 0.4
    for role in roles:
        for number in range(rng.choice([0, 1, 1, 1, 2])):
            inputs, outputs = (
                {port: rng.choice("XYZ") for port in rng.sample("pqs", rng.choice([0, 0, 1, 2]))} for _ in range(2)
            )
            if units:
                asked = ["", "", " ; sc:unit unit:CentiM", f" ; {IN_METRES}"]
                inputs = {port: signal + rng.choice(asked) for port, signal in inputs.items()}
                outputs = {port: signal + rng.choice(["", " ; sc:unit unit:M"]) for port, signal in outputs.items()}
            # A name is one port, be it an input or an output.
            outputs = {port: signal for port, signal in outputs.items() if port not in inputs}
            found.append(component(f"c{role}{number}", role, inputs, outputs, rng.choice([None, "A", "B"])))
    return found


def issued(words: str) -> dict[str, str]:
    """The outputs, by name, of a component that issues what some words say, each with its unit."""
    outputs: dict[str, str] = {}
    for signal, unit, accepted, name in ISSUED.findall(words.replace(" and ", ", ")):
        stated = f" ; sc:unit unit:{unit}" if unit else " ; sc:unit unit:M" if accepted else ""
        outputs[name or f"any{len(outputs)}"] = signal + stated
    return outputs


def added(rng: random.Random, said: str, roles: Roles) -> list[str]:
    """The components that a sentence asks for; of what it leaves open they state what their roles permit."""
    said, found = said.removeprefix("add "), []
    shared = SHARED.search(said)
    sharing = re.findall(r"\b(r\d)\b", shared[1]) if shared and shared[1] else list(roles.about) if shared else []
    for number, role, recruited, issues, robot, no_robot in ADDED.findall(SHARED.sub("", said)):
        for k in range(1 if number == "one" else int(number)):
            kind = "helper" if recruited else role
            on = robot or (None if no_robot or recruited else "D" if role in sharing else roles.stated(rng, role))
            found.append(component(f"new{role}{len(found)}{k}", kind, {}, issued(issues) if issues else {}, on))
    return found


def followed(
    rng: random.Random, repair: Relaxation, template: str, roles: Roles
) -> tuple[str, dict[str, str], list[str]]:
    """What an author has who does what a repair says: the words are all that is looked at."""
    said, about, new = str(repair), dict(roles.about), []
    if isinstance(repair, AddComponents):
        new = added(rng, said, roles)
    elif isinstance(repair, AddInteraction):
        source, sink = re.findall(r"the role (\w+)", said)
        template += f"\n:{source} sc:feeds :{sink} ."
    elif isinstance(repair, LetRecruit):
        (role,) = re.findall(r"the role (\w+)", said)
        about[role] = about[role].removesuffix(" .") + " ; sc:recruits true ."
    elif isinstance(repair, AskForFewer):
        role, minimum = re.findall(r"the role (\w+).*sc:minCount (\d+)", said)[0]
        about[role] = re.sub(r" ; sc:minCount \d+", "", about[role]).removesuffix(" .") + f" ; sc:minCount {minimum} ."
    return template, about, new


@thorough
@pytest.mark.slow
def test_a_repair_that_is_followed_as_it_is_worded_works(tmp_path: Path) -> None:
    rng = random.Random(14)
    tried = refusals = 0
    for number in range(examples(300)):
        template, roles = ecology(rng)
        ads = components(rng, list(roles.about))
        refused = configured(tmp_path, template, roles.about, ads, roles.bound)
        if not isinstance(refused, Refusal):
            continue
        refusals += 1
        for repair in refused.repairs:
            if isinstance(repair, AcceptNearMiss):
                continue
            tried += 1
            changed, about, new = followed(rng, repair, template, roles)
            outcome = configured(tmp_path, changed, about, [*ads, *new], roles.bound)
            assert not isinstance(outcome, Refusal), (number, str(repair), changed, about, ads, new, outcome)
    assert refusals >= examples(100)  # at night 2,000 of them
    assert tried > refusals


def configured(folder: Path, template: str, about: dict[str, str], ads: list[str], bound: bool = False) -> object:
    """The answer to a template and advertisements, as files; the parameter is free, or bound to A."""
    (folder / "t.ttl").write_text(PREFIXES + template + "\n" + "\n".join(about.values()))
    (folder / "ads.ttl").write_text(PREFIXES + "\n".join(ads))
    read = selfconf.template(folder / "t.ttl")
    return selfconf.configure(read.bind(robot=":A") if bound else read, selfconf.read(folder / "ads.ttl"))
