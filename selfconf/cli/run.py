"""`run`: configures, deploys, monitors and configures again, until Ctrl-C, which takes everything down cleanly."""

from __future__ import annotations

import argparse
import shlex
import sys
import time
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from selfconf.cli.options import (
    add_budget_arguments,
    add_ecology_arguments,
    add_endpoint_argument,
    add_format_argument,
    add_task_arguments,
    complain_of_left_out,
    complain_of_strategy,
    delay_option,
    files_named,
    joined,
    method_of,
    one_ecology,
    task_of,
    whole_number,
)
from selfconf.cli.progress import ProgressLine
from selfconf.cli.run_lines import LinePrinter, TextLines, json_lines
from selfconf.cli.terminal import complain, silence
from selfconf.errors import AuthorError, NetworkError, reason

if TYPE_CHECKING:
    from selfconf.api.method import Method
    from selfconf.api.sites.local_site import SiteProcess
    from selfconf.api.task import TaskSpecification
    from selfconf.api.tasks.run import Run
    from selfconf.model.term import IRI
    from selfconf.rdf.advertisements import Advertisement

EXAMPLE = """  selfconf run examples/clock/tell-the-time.ttl --ads examples/clock"""
MAY_TAKE_LONG = {"query": "asking the ecology", "discovered": "searching for a configuration"}
"""What a run does after an event, by its act, where that may take long."""
SETTLE = 5.0
"""Seconds that a component has to be there before a task is changed for it, unless it is said."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    add_task_arguments(parser)
    add_endpoint_argument(parser)
    parser.add_argument(
        "--policy",
        choices=["repair", "dismantle"],
        default="repair",
        help="what to do with the rest when a component is lost (default: %(default)s)",
    )
    parser.add_argument(
        "--wait", action="store_true", help="when there is no configuration, wait for the ecology to change"
    )
    parser.add_argument(
        "--name",
        metavar="NAME",
        type=_name,
        help="the name of the task (default: that of its template; without --detach with a number if it is taken)",
    )
    parser.add_argument(
        "--priority",
        metavar="N",
        type=_priority,
        help="a task gets components that one of lower priority holds (default: its sc:priority, or 0)",
    )
    parser.add_argument(
        "--upgrade",
        action="store_true",
        help="change to components that the strategy prefers, when they appear or recover",
    )
    parser.add_argument(
        "--settle",
        metavar="SECONDS",
        type=delay_option,
        help=f"with --upgrade, how long such components have to be there first (default: {SETTLE})",
    )
    parser.add_argument(
        "--detach",
        action="store_true",
        help="hand the task to the sites, which go on with it, and return; `selfconf stop NAME` ends it",
    )
    add_format_argument(parser)
    add_budget_arguments(parser)
    add_ecology_arguments(parser)


def _upgrade(given: argparse.Namespace) -> float | None:
    """After how many seconds the task is changed to what is rather had; None: never. Raises AuthorError."""
    if given.settle is not None and not given.upgrade:
        raise AuthorError("--settle says when to change to better components, which --upgrade asks for; give both")
    return (SETTLE if given.settle is None else given.settle) if given.upgrade else None


def _name(text: str) -> str:
    """The name of a task, as the option takes it; what is no name for another reason is found out later."""
    if not text:
        raise argparse.ArgumentTypeError("'' is no name of a task; leave the option out for that of its template")
    return text


def _priority(text: str) -> int:
    """A priority, as the option takes it."""
    from selfconf.model.template import MOST_PRIORITY

    priority = whole_number(text)
    if priority is None or abs(priority) > MOST_PRIORITY:
        raise argparse.ArgumentTypeError(
            f"{text!r} is no priority; it takes a whole number from {-MOST_PRIORITY} to {MOST_PRIORITY}"
        )
    return priority


def run(given: argparse.Namespace) -> int:
    """0 when it was taken down as wanted; 1 when there is no configuration (any more); 2 when that was not decided.

    Raises NetworkError when its own site has ended, once everything is taken down.
    """
    from selfconf.model.refusal import Undecided
    from selfconf.render import undecided_text
    from selfconf.termination import end_as_by_ctrl_c, ignore_from_now_on

    end_as_by_ctrl_c()
    _begin_none_for_the_project(given)
    task = task_of(given)
    if given.detach:
        return _detach(given, task)
    _tell_of_others(given)
    with _begun(given, task) as (running, site), ExitStack() as at_end:
        at_end.callback(ignore_from_now_on)  # also while a site of its own ends
        running.stop_on_signals()
        if running.task_name != running.wanted_name:
            complain(f"a task {running.wanted_name!r} lives already, so this one is {running.task_name!r}")
        lines = TextLines(task, _log_options(given, site))
        report, stream = (json_lines, sys.stdout) if given.format == "json" else (lines, sys.stderr)
        printer = LinePrinter(report, stream, running.stop)
        with ProgressLine() as shown:
            for event in running.events():
                shown.end()
                printer.put(event)
                if event.act in MAY_TAKE_LONG:
                    shown.begin(MAY_TAKE_LONG[event.act])
        printer.end()
    if site is not None and site.exit_code_before_end is not None:
        raise NetworkError(f"its own site has ended with code {site.exit_code_before_end}; everything is taken down")
    if printer.trouble is not None:
        raise NetworkError(f"its lines cannot be written ({reason(printer.trouble)}); everything is taken down")
    if isinstance(running.refusal, Undecided):
        complain(undecided_text(running.refusal, task.iri, task.names))
        return 2
    if running.refusal is not None and given.format == "text":
        _explain(running, task, lines.told)
    return 1 if running.refusal is not None else 0


def _begin_none_for_the_project(given: argparse.Namespace) -> None:
    """Pass over what the project file says an ecology is begun from, where the task is to run in one that is there."""
    if "ads" in given.from_project and _lives(given):
        given.ads = None  # what is missing is started, and this is there
    if "endpoint" in given.from_project and given.detach:
        given.endpoint = None


def _lives(given: argparse.Namespace) -> bool:
    """Whether there are sites to run in, so that none has to be started for the advertisements of the project file."""
    from selfconf import rendezvous, this_machine

    ecology, endpoints = rendezvous.asked_for(given.ecology, given.connect)
    return bool(given.detach or endpoints or (ecology is not None and this_machine.local_sites(ecology)))


def _tell_of_others(given: argparse.Namespace) -> None:
    """Tell a user that gives advertisements, and so begins an ecology, of one that runs on this machine already."""
    from selfconf import rendezvous, this_machine

    others = sorted({site.ecology for site in this_machine.local_sites()})
    if given.ads is not None and rendezvous.asked_for(given.ecology, given.connect)[0] is None and others:
        complain(
            f"this run begins an ecology of its own, and {others[0]} runs here already; to run there,"
            f" give --ecology {others[0]} in place of --ads"
        )


@contextmanager
def _begun(given: argparse.Namespace, task: TaskSpecification) -> Iterator[tuple[Run, SiteProcess | None]]:
    """The run in the ecology that there is, or in one with a site of its own for the advertisements given."""
    from selfconf import rendezvous
    from selfconf.api.membership import MEMBERS, Membership
    from selfconf.api.sites.local_site import SiteProcess
    from selfconf.api.tasks.run import Run
    from selfconf.api.tasks.task_options import TaskOptions

    method = method_of(given, task)
    options = TaskOptions.of(given.policy, given.name or "", given.priority, _upgrade(given))
    shown = rendezvous.credentials(given.keys, *MEMBERS)
    with ExitStack() as stack:
        paths = given.ads if given.endpoint is None else [stack.enter_context(_fetched(given, task, method))]
        if paths is None:
            with files_named(given):
                ecology, endpoints = rendezvous.find(given.ecology, given.connect, shown)
            running = Run(task, method, Membership(ecology, tuple(endpoints), shown), options, given.wait)
            yield stack.enter_context(running), None
            return
        site = stack.enter_context(
            SiteProcess(paths, given.ecology, given.connect, given.keys, method.reasoning.value, given.ontology)
        )
        described = partial(_described, given.ads or ())
        membership = Membership(site.ecology, tuple(site.endpoints), shown)
        running = Run(task, method, membership, options, given.wait, rests_on=site.running, described=described)
        yield stack.enter_context(running), site


def _log_options(given: argparse.Namespace, site: SiteProcess | None) -> str:
    """The options by which `selfconf log` finds the ecology: as they were typed, or the name of one of its own."""
    if site is not None:
        return f"--ecology {site.ecology}"
    named = [("ecology", given.ecology), *(("connect", one) for one in given.connect), ("keys", given.keys)]
    typed = [(name, value) for name, value in named if value is not None and name not in given.from_project]
    return shlex.join(word for name, value in typed for word in (f"--{name}", str(value)))


def _detach(given: argparse.Namespace, task: TaskSpecification) -> int:
    """Hand the task to the sites of the living ecology."""
    if given.ads is not None or given.endpoint is not None:
        raise AuthorError(
            "a detached task lives in the sites that there are: start them with `selfconf site`, without --ads"
            " and --endpoint"
        )
    from selfconf.model.run_event import TaskDetached

    upgrade = _upgrade(given)
    complain_of_strategy(given, task)
    with joined(given) as ecology:
        name = ecology.detach(
            task,
            policy=given.policy,
            strategy=given.strategy,
            reasoning=given.reasoning,
            ontologies=given.ontology,
            steps=given.steps,
            seconds=given.seconds,
            name=given.name or "",
            priority=given.priority,
            upgrade=upgrade,
        )
    report, stream = (json_lines, sys.stdout) if given.format == "json" else (TextLines(task), sys.stderr)
    try:
        report(TaskDetached(name, time=time.time()))
    except OSError as error:  # the task lives all the same
        silence(stream)
        if stream is sys.stdout and not isinstance(error, BrokenPipeError):
            said = f"the task {name!r} lives in the sites now, but that cannot be written ({reason(error)})"
            raise NetworkError(said) from None
    return 0


@contextmanager
def _fetched(given: argparse.Namespace, task: TaskSpecification, method: Method) -> Iterator[Path]:
    """A folder with what the endpoint has for the task; what was left out is named on stderr."""
    from selfconf.api.ecology import EndpointEcology
    from selfconf.api.sites.endpoint_files import endpoint_files

    one_ecology(given)
    ecology = EndpointEcology(given.endpoint)
    with endpoint_files(ecology, task, method) as (folder, left_out):
        complain_of_left_out(left_out)
        yield folder


def _described(paths: Sequence[Path]) -> Mapping[IRI, Advertisement]:
    """The advertisements in the files given, read for their places at the first refusal; the files may have gone."""
    from selfconf.api.reading import read

    try:
        return read(*paths).advertisements()
    except AuthorError:
        return {}


def _explain(running: Run, task: TaskSpecification, told: Collection[IRI]) -> None:
    """Print what else can be found out about a refusal: everything is down, so there is time."""
    from selfconf.model.refusal import Refusal
    from selfconf.render import refusal_text
    from selfconf.render.run_events import lost_sentences

    refusal = running.explained()
    if isinstance(refusal, Refusal):
        complain(refusal_text(refusal, task.names))
    for sentence in lost_sentences(running.lost, task.names, told):
        complain(sentence)
    losses = running.losses.values()
    if any(loss.busy for loss in losses):
        complain(
            "run again when it is free, or run with --wait, which goes on then; `selfconf status` shows who has it"
        )
    if any(not loss.busy for loss in losses):
        complain("run again when what is lost can act (start it if it ended), or run with --wait, which goes on then")
