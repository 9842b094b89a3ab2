"""A repair works when an author follows it as it is worded: written as Turtle, and read by the reader."""

from __future__ import annotations

import random
import re
from pathlib import Path

import pytest

import selfconf
from selfconf.model.refusal import Refusal
from selfconf.model.relaxation import AcceptNearMiss, AddComponents, AddInteraction, AskForFewer, LetRecruit, Relaxation
from tests.effort import examples

PREFIXES = """\
@prefix sc: <https://w3id.org/selfconf#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix : <urn:t:> .
"""
ADDED = re.compile(
    r"(one|\d+) more components? for the role (\w+)( to recruit)?(?: that issues? (.*?))?"
    r"(?:, with robot (\w+)|, with no robot)?(?=$|(?:,| and) (?:one|\d+) more)"
)
ISSUED = re.compile(r"(\w+)(?: by the output '(\w+)')?")


def ecology(rng: random.Random) -> tuple[str, dict[str, str]]:
    """A template, whose interactions name ports, and where a parameter may be free, and statements of its roles.

    Some of these recruit.
    """
    roles = [f"r{k}" for k in range(rng.randint(2, 4))]
    free = rng.random() < 0.3
    about = {}
    for role in roles:
        count = rng.choice(["", "", "", " ; sc:minCount 2", " ; sc:minCount 0"])
        recruits = rng.choice(["", "", "", " ; sc:recruits true", " ; sc:recruits [ sh:class :HELPER ]"])
        where = " ; sh:property [ sh:path :on ; sh:in ( :robot ) ]" if free and rng.random() < 0.7 else ""
        about[role] = f":{role} a sc:Role ; sh:class :{role.upper()}{count}{where}{recruits} ."
    listed = " ".join(f":{role}" for role in roles)
    lines = [f":t a sc:Template ; sc:roles ( {listed} ) {'; sc:parameter :robot' * free} ."]
    lines += [':robot a sc:Parameter ; sc:name "robot" ; sh:nodeKind sh:IRI .'] * free
    for _ in range(rng.randint(1, 2 * len(roles))):
        source, sink = rng.sample(roles, 2)
        output = rng.choice(["", "", ' ; sc:output "p"', ' ; sc:output "q"'])
        wanted = rng.choice(["", "", ' ; sc:input "p"'])
        lines.append(f"[] a sc:Interaction ; sc:from :{source} ; sc:to :{sink}{output}{wanted} .")
    return "\n".join(lines), about


def component(name: str, role: str, inputs: dict[str, str], outputs: dict[str, str], on: str | None = None) -> str:
    """An advertisement."""
    ports = [f'sc:hasInput [ sc:name "{port}" ; sc:signalType :{signal} ]' for port, signal in inputs.items()]
    ports += [f'sc:hasOutput [ sc:name "{port}" ; sc:signalType :{signal} ]' for port, signal in outputs.items()]
    return " ; ".join([f":{name} a sc:Component, :{role.upper()}", *ports, *([f":on :{on}"] if on else [])]) + " ."


def components(rng: random.Random, roles: list[str]) -> list[str]:
    """Advertisements for the roles, one or two for each, sometimes none."""
    found = []
    for role in roles:
        for number in range(rng.choice([0, 1, 1, 1, 2])):
            inputs, outputs = (
                {port: rng.choice("XYZ") for port in rng.sample("pqs", rng.choice([0, 0, 1, 2]))} for _ in range(2)
            )
            # A name is one port, be it an input or an output.
            outputs = {port: signal for port, signal in outputs.items() if port not in inputs}
            found.append(component(f"c{role}{number}", role, inputs, outputs, rng.choice([None, "A", "B"])))
    return found


def followed(repair: Relaxation, template: str, about: dict[str, str]) -> tuple[str, dict[str, str], list[str]]:
    """What an author has who does what a repair says: the words are all that is looked at."""
    said, about, new = str(repair), dict(about), []
    if isinstance(repair, AddComponents):
        parts, *shared = re.split(r", with one robot for (?:both|all)$", said.removeprefix("add "))
        for number, role, recruited, issues, robot in ADDED.findall(parts):
            outputs = {}
            for signal, name in ISSUED.findall(issues.replace(" and ", ", ")) if issues else ():
                outputs[name or f"any{len(outputs)}"] = signal
            for k in range(1 if number == "one" else int(number)):
                kind = "helper" if recruited else role
                new.append(component(f"new{role}{len(new)}{k}", kind, {}, outputs, robot or ("C" if shared else None)))
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


@pytest.mark.slow
def test_a_repair_that_is_followed_as_it_is_worded_works(tmp_path: Path) -> None:
    rng = random.Random(14)
    tried = refusals = 0
    for number in range(examples(300)):
        template, about = ecology(rng)
        ads = components(rng, list(about))
        refused = configured(tmp_path, template, about, ads)
        if not isinstance(refused, Refusal):
            continue
        refusals += 1
        for repair in refused.repairs:
            if isinstance(repair, AcceptNearMiss):
                continue
            tried += 1
            changed, roles, new = followed(repair, template, about)
            outcome = configured(tmp_path, changed, roles, [*ads, *new])
            assert not isinstance(outcome, Refusal), (number, str(repair), changed, roles, ads, new, outcome)
    assert refusals >= examples(100)  # at night 2,000 of them
    assert tried > refusals


def configured(folder: Path, template: str, about: dict[str, str], ads: list[str]) -> object:
    """The answer to a template and advertisements, as files."""
    (folder / "t.ttl").write_text(PREFIXES + template + "\n" + "\n".join(about.values()))
    (folder / "ads.ttl").write_text(PREFIXES + "\n".join(ads))
    answer = selfconf.configure(selfconf.template(folder / "t.ttl"), selfconf.read(folder / "ads.ttl"))
    return answer
