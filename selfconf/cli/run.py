"""`run`: configures, deploys, monitors and configures again, until Ctrl-C, which takes everything down cleanly."""

from __future__ import annotations

import argparse
import json
import os
import secrets
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import cache, partial
from typing import Any

from selfconf import rendezvous
from selfconf.bus.zenoh_bus import client
from selfconf.cli import budget, words
from selfconf.cli.inputs import (
    STDIN,
    add_task_arguments,
    complain,
    composer_of,
    existing,
    read_advertisements,
    read_task,
)
from selfconf.cli.live import add_connection_arguments
from selfconf.cli.places import Places
from selfconf.cli.terminal import silence
from selfconf.cli.why import explained
from selfconf.configurator.machine import Policy
from selfconf.deployment import Account, RunRequest, TaskRunner
from selfconf.errors import AuthorError, NetworkError
from selfconf.model.configuration import Configuration
from selfconf.model.optimum import Optimum
from selfconf.model.refusal import Outcome, Refusal, Undecided
from selfconf.model.template import Template
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement
from selfconf.termination import PARENT_CHECK, Termination, end_as_by_ctrl_c, parent_environment

NAME = "run"
HELP = "configure, deploy, monitor and configure again, until Ctrl-C takes everything down"
EXAMPLE = """  selfconf run examples/clock/tell-the-time.ttl --ads examples/clock"""
SITE_STARTS = 20.0
"""How long, in seconds, a site that `run` starts may take to listen."""
MISUSE = 2
"""The exit code of a command that has said in one sentence why it cannot be run."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    add_task_arguments(parser)
    parser.add_argument(
        "--policy",
        choices=[policy.value for policy in Policy],
        default=Policy.REPAIR.value,
        help="what to do with the rest when a component is lost (default: %(default)s)",
    )
    parser.add_argument(
        "--wait", action="store_true", help="when there is no configuration, wait for the ecology to change"
    )
    parser.add_argument("--format", choices=["text", "json"], default="text", help="default: %(default)s")
    budget.add_budget_arguments(parser)
    add_connection_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """0 when it was taken down as wanted; 1 when there is no configuration (any more); 2 when that was not decided.

    Raises NetworkError when its own site has ended, once everything is taken down.
    """
    end_as_by_ctrl_c()
    task = read_task(given)
    composer = composer_of(given, task)
    names = words.Names(task.document.prefixes)
    where = _places(given, task.task.template)
    tell = partial(_tell_json, where) if given.format == "json" else Teller(names, where)
    with _ecology(given) as (ecology, endpoints, site):
        bus = client(endpoints)
        ended: list[Refusal | Undecided | None] = []
        alive: dict[IRI, Advertisement] = {}

        def told(account: Account) -> None:
            try:
                tell(account)
            except OSError:  # whoever read the accounts is gone, or the disk is full: end rather than run unseen
                for stream in (sys.stdout, sys.stderr):
                    silence(stream)
                bus.wake_up(agent.stop)

        def compose(found: Mapping[IRI, Advertisement], lost: frozenset[IRI], running: Configuration | None) -> Outcome:
            answer = budget.composed(composer, found, lost, running, budget.Clock(given.seconds))
            if isinstance(answer, Refusal):
                alive.clear()
                alive.update((component, one) for component, one in found.items() if component not in lost)
            return answer.configuration if isinstance(answer, Optimum) else answer

        order = RunRequest(
            task=task.task,
            compose=compose,
            standby=composer.standby,
            passed_over=composer.passed_over,
            policy=Policy(given.policy),
            patient=given.wait,
            tell=told,
            settle=ended.append,
        )
        agent = TaskRunner(bus, ecology, order)
        Termination(bus, agent.stop)

        def look() -> None:
            """Without its own site nothing of what was given is there, and nobody starts it again."""
            if site is not None and site.poll() is not None:
                agent.stop()
            else:
                bus.later(PARENT_CHECK, look)

        try:
            agent.start()
            look()
            bus.run(lambda: bool(ended))
        finally:
            bus.close()
        if site is not None and site.poll() is not None:
            raise NetworkError(f"its own site has ended with code {site.returncode}; everything is taken down")
    if agent.trouble is not None:
        raise agent.trouble
    refusal = ended[0] if ended else None
    if isinstance(refusal, Undecided):
        complain(words.undecided_text(refusal, task.task.template.iri, names))
        return 2
    if refusal is not None and given.format == "text":
        # Everything is down, so there is time to find out what else can be told.
        refusal = explained(composer, alive, refusal, given, budget.Clock(given.seconds))
        complain(words.refusal_text(refusal, names, where))
        lost = agent.state.lost.values()
        for sentence in _lost_sentences(agent.losses, names):
            complain(sentence)
        if any(loss.busy for loss in lost):
            complain(
                "run again when it is free, or run with --wait, which goes on then; `selfconf status` shows who has it"
            )
        if any(not loss.busy for loss in lost):
            complain("start it again and run again, or run with --wait, which goes on when it is back")
    return 1 if refusal is not None else 0


def _places(given: argparse.Namespace, template: Template) -> words.Where:
    """Where the roles are described, and the components if their files are given; read at the first refusal."""

    @cache
    def places() -> Places:
        try:
            return Places(template, {} if given.ads is None else read_advertisements(given.ads))
        except AuthorError:
            return Places(template, {})  # the files have gone since

    return lambda named: places()(named)


@contextmanager
def _ecology(given: argparse.Namespace) -> Iterator[tuple[str, list[str], subprocess.Popen[bytes] | None]]:
    """The ecology to run in: the one there is, or one with a site of our own for the advertisements given."""
    if given.ads is None:
        yield *rendezvous.find(given.ecology, given.connect), None
        return
    if STDIN in given.ads:
        raise AuthorError("a site watches the files of its advertisements, so give files to --ads, not -")
    for path in given.ads:
        existing(path)
    name = given.ecology or f"run-{secrets.token_hex(3)}"
    site = f"s{secrets.token_hex(3)}"
    command = [
        sys.executable,
        "-m",
        "selfconf",
        "site",
        *map(str, given.ads),
        "--ecology",
        name,
        "--name",
        site,
    ]
    for endpoint in given.connect:
        command += ["--connect", endpoint]
    # What the site and the components that it starts print is for people: stdout holds the account alone.
    process = subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=sys.stderr,
        start_new_session=True,
        env={**os.environ, **parent_environment()},
    )
    try:
        yield name, [_listening(process, name, site), *given.connect], process
    finally:
        process.terminate()
        process.wait()


def _listening(process: subprocess.Popen[bytes], ecology: str, site: str) -> str:
    deadline = time.monotonic() + SITE_STARTS
    while time.monotonic() < deadline:
        for meeting in rendezvous.local_sites(ecology):
            if meeting.site == site:
                return meeting.endpoint
        try:
            process.wait(0.02)
        except subprocess.TimeoutExpired:
            continue
        if process.returncode == MISUSE:
            raise SystemExit(MISUSE)  # it has said why, to the same reader
        raise NetworkError(f"the site for the advertisements ended with code {process.returncode}")
    raise NetworkError(f"the site for the advertisements does not listen after {SITE_STARTS:.0f} s")


class Teller:
    """Tells people what the configurator does, one line at a time, on stderr."""

    SENTENCES: Mapping[str, str] = {
        "query": "act 1  asking the ecology what it has",
        "discovered": "act 2  {components} components at {sites}",
        "watching": "act 4  listening to FAIL of {component}",
        "waking": "act 4  {component} is dormant; site {site} starts it",
        "connecting": "act 4  {source} {output} -> {sink} {input}",
        "activated": "act 4  {component} is active",
        "set": "act 4  {component} has its parameters",
        "declined": "       {component} declines: {detail}",
        "unreachable": "       {component} cannot be reached: {detail}",
        "lost": "LOST   {component}: {cause}, {detail}",
        "released": "       {component} is off",
        "running": "       running",
        "stopped": "       taken down",
        "cut off": "       cut off from the ecology; waiting to be connected again",
        "connected": "       connected again; looking at what has become of it",
        "complaint": "       {detail}",
    }

    def __init__(self, names: words.Names, where: words.Where) -> None:
        self._names, self._where = names, where
        self._began: float | None = None

    def __call__(self, account: Account) -> None:
        self._began = self._began or account.time
        sentence = self.SENTENCES.get(account.act)
        if account.act == "waiting":
            refusal = account.facts["refusal"]
            undecided = isinstance(refusal, Undecided)
            _say(f"  {refusal}" if undecided else words.refusal_text(refusal, self._names, self._where))
            for lost in _lost_sentences(account.facts["lost"], self._names):
                _say(lost)
            sentence = "       waiting for the ecology to change"
        if account.act == "composed":
            sentence = "act 3  {roles} in {milliseconds:.1f} ms"
        if sentence is None:
            return
        facts = {key: self._word(value) for key, value in account.facts.items()}
        if account.act == "composed":
            outcome = account.facts["outcome"]
            nothing = "no answer" if isinstance(outcome, Undecided) else "no configuration"
            found = isinstance(outcome, Configuration)
            facts["roles"] = f"{len(outcome.components)} components" if found else nothing
            facts["milliseconds"] = account.facts["seconds"] * 1000
        _say(f"{account.time - self._began:9.3f} s  {sentence.format(**facts)}")

    def _word(self, value: Any) -> Any:
        if isinstance(value, IRI):
            return self._names(value)
        if isinstance(value, tuple):
            return ", ".join(map(str, value)) or "no site"
        return value


def _lost_sentences(losses: Mapping[IRI, str], names: words.Names) -> list[str]:
    return [f"  {names(component)} was lost: {why}" for component, why in losses.items()]


def _say(sentence: str) -> None:
    """A line of the account on stderr. Raises OSError if nobody reads it, which ends the run."""
    print(sentence, file=sys.stderr, flush=True)


def _tell_json(where: words.Where, account: Account) -> None:
    """One JSON object per line on stdout: act, time, facts. Places are looked up when nobody waits for act 4."""
    facts: dict[str, Any] = {}
    for key, value in account.facts.items():
        if isinstance(value, Configuration):
            facts[key] = words.configuration_body(value)
        elif isinstance(value, Refusal):
            facts[key] = words.refusal_body(value, words.nowhere if account.act == "composed" else where)
        elif isinstance(value, Undecided):
            facts[key] = words.undecided_body(value)
        else:
            facts[key] = value
    print(json.dumps({"act": account.act, "time": account.time, **facts, "process": os.getpid()}), flush=True)
