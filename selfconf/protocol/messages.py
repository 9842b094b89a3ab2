"""The messages of the control plane, as values; the type of each field is what `selfconf.protocol.codec` reads it by.

Everything that can be stale carries a *life* (which incarnation of a component) or an *epoch* (which deployment of a
task). Of the calls of one task a component obeys the newest epoch that it knows of and refuses an older one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from enum import Enum
from typing import Any

from selfconf.model.configuration import Wants
from selfconf.model.immutable import immutable
from selfconf.model.log_line import LogLine
from selfconf.model.term import IRI, Term
from selfconf.protocol.keys import task_name

Label = str
"""A text that names something: it stands in keys and in lines for people, so it steers nothing and ends no line."""
Remark = str
"""A text for people, of which nothing else depends: on one line, whatever was said."""
Identity = str
"""The identity of a task that sites keep: it becomes the name of a file there, and a chunk of keys."""


class Cause(str, Enum):
    """Why a component is lost. The paper has only the first."""

    FAIL = "fail"
    """The component raised FAIL itself."""
    CRASH = "crash"
    """The liveliness of the component has ended."""
    SILENCE = "silence"
    """An output that promised a rate has stopped."""
    REFUSED = "refused"
    """The component refused to be activated, or could not be."""
    HUNG = "hung"
    """Code of the component has not returned within its deadline."""
    MALFORMED = "malformed"
    """The component emitted what is not a signal of the type that its output promises."""
    YIELD = "yield"
    """A task of higher priority asks for it; it is not broken, and free for that task once it is released."""
    LET_GO = "let go"
    """It is not broken, but acts no more for a task whose configurator seemed gone, or has not yielded in time."""


@immutable
class Wire:
    """An output that an input shall follow; `period` is the longest pause in seconds that the output promises."""

    component: IRI
    output: str
    period: float | None = None


Wires = Mapping[str, tuple[Wire, ...]]
"""Some outputs for each port, by its name: those that an input follows, or that stand behind an output."""


@immutable
class Claim:
    """What every call says of the task that makes it, and of the component that it means."""

    epoch: int
    supervisor: Label
    """The liveliness key of the configurator that supervises the configuration now."""
    task: Label = ""
    """The identity of the task, which stays when another configurator goes on with it; empty from an older peer."""
    life: Label = ""
    """Which life of the component is meant; empty for whichever answers, as an older peer has it."""
    priority: int = 0
    beginning: float = 0.0
    """When the task began, in seconds of the Unix epoch by the clock of its configurator."""


@immutable
class Reserve(Claim):
    """Be held for a task, without acting for it: none of its components acts before it has reserved them all.

    A task that cannot begin now only waits: it is remembered, and told when the component is free.
    """

    inputs: Wires = field(default_factory=dict)
    values: Mapping[str, Term] = field(default_factory=dict)
    waits: bool = False


@immutable
class Apply(Claim):
    """Be active with these values of the operational parameters, and let each input follow exactly these outputs.

    Outputs that stand by are listened to as well, but what they issue is passed over, until a later call makes them
    inputs: then no time is lost with connecting. A component that is free is reserved by the same call.
    """

    inputs: Wires = field(default_factory=dict)
    standby: Wires = field(default_factory=dict)
    values: Mapping[str, Term] = field(default_factory=dict)
    callers: Mapping[str, tuple[IRI, ...]] = field(default_factory=dict)
    """For each operation of the component, by the name of its output, the components that may call it."""
    gently: bool = False
    """Whether an input is to follow the output before until the new one has issued a signal: make before break."""
    rests: bool = False
    """Whether an actuator is to rest: for a second already the configuration has lacked a part."""


@immutable
class Release(Claim):
    """Act for this task no more; the component is off when no task is left for which it acts."""


@immutable
class StateOf:
    """What goes with a question for a component's state: of which task it is."""

    task: Label


class Verdict(str, Enum):
    """How a component answers a call."""

    DONE = "done"
    STALE = "stale"
    """The epoch is older than the newest one the component has obeyed."""
    BUSY = "busy"
    """Another task holds the component; the task that asked is remembered, and hears when the component is free."""
    REFUSED = "refused"
    """The component itself refuses, or its code broke; `detail` says why."""
    NOT_HELD = "not held"
    """The component has no outputs, and the task that applies to it has not reserved it, or not since it was let go."""
    OTHER_LIFE = "another life"
    """The call means another life of the component than the one that answers, or that life is ending."""


@immutable
class CallAnswer:
    """The answer to a call: the verdict, the component's life, and the newest epoch obeyed for the task of the call."""

    verdict: Verdict
    component: IRI
    life: Label
    epoch: int = 0
    active: bool = False
    detail: Remark = ""
    supervisor: Label = ""
    """The liveliness key of the configurator that holds the component; empty if none does, or if it is left out."""
    task: Label = ""
    """The identity of the task that holds the component, of the highest priority if there are several."""
    priority: int = 0
    beginning: float = 0.0
    place: Remark = ""
    """The process and the host of the component, for people."""
    dropped: int = 0
    """How many signals the component has passed over since it lives, because its code was too slow."""
    age: float = 0.0
    """For how long the component has lived, in seconds; this and what follows stand in the answer to `state` alone."""
    memory: int = 0
    """The resident memory of its process in bytes; zero where the system does not say."""
    issued: Mapping[str, int] = field(default_factory=dict)
    """How many signals each output has issued since the component lives."""
    outputs: Wires = field(default_factory=dict)
    """Of a composite that acts: by which outputs inside of it each of its own is issued."""
    callers: Mapping[str, tuple[IRI, ...]] = field(default_factory=dict)
    """Of a composite that acts: which components inside of it call by each operation that it needs."""
    patience: float = 0.0
    """Of a composite whose inside is being started, or a component of which an input is being handed over gently: for
    how many seconds the caller may wait for that."""
    stopping: bool = False
    """Whether the code of the component was asked to stop, and is not at rest yet: it may still act."""
    shared: bool = False
    """Whether a component that is busy acts for the task that calls as well, as it has before.

    In the answer to `state`: whether it acts for that task and for others as well."""


@immutable
class Moved:
    """The outputs of a composite are issued by others inside of it than before, or others call what it needs."""

    component: IRI
    life: Label
    outputs: Wires = field(default_factory=dict)
    callers: Mapping[str, tuple[IRI, ...]] = field(default_factory=dict)


@immutable
class Fail:
    """FAIL, the special output that every component has."""

    component: IRI
    life: Label
    epoch: int
    cause: Cause = Cause.FAIL
    detail: Remark = ""
    task: Label = ""
    """The identity of the task that it is put for; empty: every task that the component acts for."""
    sequence: int = 0
    """The number of the last signal that this life has issued: what comes of it later, up to that, is no news.

    0 where there was none, or where it is not known, as to a site.
    """


@immutable
class Free:
    """To those that wait for a component: it is free, and kept for a moment for the task that goes first.

    Without a task: it begins to act for the one that holds it, so waiting for it may last.
    """

    component: IRI
    life: Label
    task: Label = ""


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
class Introduction:
    """A certificate that is shown to a site, which lets its holder in if the authority issued it, and shows its own."""

    certificate: str
    """The certificate, as PEM. It is no secret: it is of no use without its key."""
    known: bool = False
    """In an answer: whether the site knew the one that asks, so that its rules stay as they are."""
    beside: tuple[Label, ...] = ()
    """In an answer: the sites of its host. One that does not answer has lost its hub for a moment, or hangs."""


@immutable
class Access:
    """What a holder may do at the hubs of a site, as keys, and as a sentence that says it."""

    principal: Remark
    """A common name; empty for every holder of a certificate of the authority."""
    sentence: Remark
    says: tuple[Label, ...] = ()
    """Under which keys it may say something."""
    asked: tuple[Label, ...] = ()
    """As which keys, besides, others may ask for that or listen to it: they know it by wider ones."""
    hears: tuple[Label, ...] = ()
    """Under which keys it may ask and listen."""
    about: tuple[Label, ...] = ()
    """The components that it speaks for, by their chunks."""
    told: tuple[Label, ...] = ()
    """What reaches it of what it hears; empty: all of it. Another site hears from each host what is said there."""


@immutable
class RefusedAttempt:
    """What a client has tried, and may not."""

    principal: Remark
    """A common name; empty for a client that has shown no trusted certificate."""
    attempt: Remark
    """What was tried, such as `Query`, or why the certificate is not believed."""
    key: Remark
    """Under which key; empty where there was no link."""
    number: int
    """How often."""
    latest: float
    """When it was last tried, in seconds of the Unix epoch."""


@immutable
class Known:
    """What goes with the question for advertisements: which revision of which site the asker knows already.

    A site of which that is the present one replies one page without a component, that says the revision and how many
    there are.
    """

    revisions: Mapping[str, int] = field(default_factory=dict)
    """By the name and the life of the site, with a slash between."""


@immutable
class SignalEncoding:
    """What the bytes of a signal are; empty for JSON, and for bytes of which nothing is said."""

    media: str = ""
    """The media type."""
    datatype: str = ""
    """The datatype of the elements of an array, such as `uint8`; empty for what is no array."""
    shape: tuple[int, ...] = ()
    """How many elements an array has in each of its dimensions."""


@immutable
class Stamp:
    """What goes with each signal: its source, in which life, its number there, its time in seconds, its encoding."""

    component: IRI
    life: Label
    sequence: int
    time: float
    encoding: SignalEncoding = SignalEncoding()


@immutable
class Status:
    """What a configurator has deployed, and for which task."""

    configurator: Label
    phase: Remark
    template: IRI
    epoch: int
    since: float
    host: Remark = ""
    process: int = 0
    components: tuple[IRI, ...] = ()
    lost: Mapping[str, Any] = field(default_factory=dict)
    task: Label = ""
    """The identity of the task."""
    priority: int = 0
    beginning: float = 0.0
    owed: tuple[IRI, ...] = ()
    """The components that were turned off and have not obeyed yet."""
    dropped: Mapping[str, Any] = field(default_factory=dict)
    """How many signals those components have passed over that are too slow."""
    outside: IRI | None = None
    """The composite of which the task is the inside, if it is one."""
    wants: Mapping[IRI, Wants] = field(default_factory=dict)
    """What the task wants of those components that can be shared, where it wants anything of them."""

    @property
    def name(self) -> str:
        """The name of the task, as its user knows it."""
        return task_name(self.task)


@immutable
class Notice:
    """An event of a run, for observers: nothing depends on its arrival."""

    configurator: Label
    sequence: int
    """Grows by one with each event of the configurator; a gap tells that one was lost."""
    task: Label
    event: Mapping[str, Any]
    """The event as `selfconf run --format json` prints it."""


@immutable
class RecordedLoss:
    """A component that a task has lost and that lives on: in which life, and why."""

    component: IRI
    life: Label
    cause: Cause
    detail: Remark = ""


@immutable
class TaskRecord:
    """A task that lives in the ecology: what the sites keep of it, and by which one of them goes on with it."""

    task: Identity
    """The identity of the task."""
    revision: int
    """Of two records of a task that has not ended, the one with the higher revision counts."""
    ended: bool = False
    """Whether it is to run no more; kept so that a site that was away hears of it."""
    priority: int = 0
    beginning: float = 0.0
    document: str = ""
    """The Turtle document that holds its template."""
    source: Remark = ""
    """Where the document was read from, for people."""
    wanted: Label = ""
    """The IRI of the template or task, in case the document holds several."""
    bindings: Mapping[str, Term] = field(default_factory=dict)
    ontologies: tuple[str, ...] = ()
    """Turtle documents of further ontologies, in which no IRI is relative to where they come from."""
    options: Mapping[str, Any] = field(default_factory=dict)
    """`policy`, `strategy`, `reasoning`, `steps`, `seconds`, `upgrade`, as the command `run` has them."""
    epoch: int = 0
    """The newest epoch in which it was deployed; zero: never yet."""
    configuration: Mapping[str, Any] = field(default_factory=dict)
    """What is deployed, as `selfconf configure --format json` prints it; empty if nothing is."""
    lost: tuple[RecordedLoss, ...] = ()
    """What has failed and lives on: a site that goes on with the task does without it, until it lives anew."""
    keeper: Label = ""
    """The site that begins to run the task, by which the one that runs it may let go; empty: none does now."""

    @property
    def version(self) -> tuple[bool, int, int]:
        """Of two records of one task the one of the greater version counts: the end of a task is final.

        Two sites may make one revision, where one of them was frozen or cut off: what runs is of the newer epoch.
        """
        return self.ended, self.revision, self.epoch

    def supersedes(self, known: TaskRecord | None) -> bool:
        """Whether this record counts, and not the one that is known of the same task."""
        return known is None or self.version > known.version


Message = (
    Reserve
    | Apply
    | Release
    | StateOf
    | CallAnswer
    | Fail
    | Free
    | Moved
    | Wake
    | Introduction
    | Access
    | RefusedAttempt
    | End
    | Known
    | LogQuestion
    | LogPart
    | Notice
    | Page
    | Stamp
    | Status
    | TaskRecord
)
