"""What a site is asked and answers: advertisements, processes that are started and ended, its log."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from selfconf.model.immutable import immutable
from selfconf.model.log_line import LogLine
from selfconf.model.term import IRI
from selfconf.protocol.messages.texts import Label, Remark


@immutable
class Known:
    """What goes with the question for advertisements: which revision of which site the asker knows already.

    A site of which that is the present one replies one page without a component, that says the revision and how many
    there are.
    """

    revisions: Mapping[str, int] = field(default_factory=dict)
    """By the name and the life of the site, with a slash between."""


@immutable
class Page:
    """What goes with each advertisement that a site replies: which of how many, of which revision, from which file."""

    index: int
    total: int
    revision: int
    component: IRI | None = None
    source: Remark = ""
    startable: bool = False
    life: Label = ""
    """Which life of the site replies: another one may have its name."""
    insecure: bool = False
    """Whether the site listens beyond its host without keys."""
    unable: Remark = ""
    """Why the component, a composite, cannot act now, in a sentence; empty if it can, or if that is not known yet."""


@immutable
class Wake:
    """Start the process of a dormant component."""

    component: IRI
    after: Label = ""
    """The life that has ended while the task held it; empty: none has, as far as the task knows."""


@immutable
class End:
    """End the process of a component that does not obey."""

    component: IRI
    life: Label = ""
    """The life that is meant; empty: whichever the site has started, as a person has it ended: that is no crash."""
    task: Label = ""
    """The identity of the task whose release it has not obeyed; empty if it is to end whatever it does."""


@immutable
class LogQuestion:
    """What goes with the question for the log of a site: whose lines, how many of before, and from where on."""

    component: Label = ""
    """An IRI or a local name: only the lines of the processes of this component; empty: all."""
    lines: int = 0
    """How many of the latest lines, where there is no position."""
    position: Label = ""
    """The position that an earlier answer has named: only what was added since is asked for."""


@immutable
class LogPart:
    """The answer to a question for the log of a site, in the order in which the lines were printed."""

    lines: tuple[LogLine, ...] = ()
    position: Label = ""
    """Where the answer ends; only its site can read it."""
    more: bool = False
    """Whether more has been added already than one answer holds."""
