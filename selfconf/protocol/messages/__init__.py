"""The messages of the control plane, as values; the type of each field is what `selfconf.protocol.codec` reads it by.

Everything that can be stale carries a *life* (which incarnation of a component) or an *epoch* (which deployment of a
task). Of the calls of one task a component obeys the newest epoch that it knows of and refuses an older one.

* `calls`: a `Claim` is what every call says, a `Reserve`, `Apply` or `Release` is one, and `StateOf` a question; a
  `CallAnswer` has a `Verdict`. A `Wire` is an output that an input follows, `Wires` are those of each port.
* `component_reports`: `Fail`, for a `Cause`, `Free` and `Moved`.
* `sites`: `Known` and `Page` go with advertisements, `Wake` and `End` are about a process, `LogQuestion` and `LogPart`
  about a log.
* `access`: `Introduction`, `Access`, `RefusedAttempt`.
* `signals`: a `Stamp`, with a `SignalEncoding`.
* `tasks`: `Status` and `Notice` are said by a configurator; a `TaskRecord`, with each `RecordedLoss`, is kept by sites.
* `texts`: a `Label`, a `Remark` or an `Identity` is a text.

A `Message` is any of these that is sent by itself.
"""

from selfconf.protocol.messages.access import Access, Introduction, RefusedAttempt
from selfconf.protocol.messages.calls import Apply, CallAnswer, Claim, Release, Reserve, StateOf, Verdict, Wire, Wires
from selfconf.protocol.messages.component_reports import Cause, Fail, Free, Moved
from selfconf.protocol.messages.signals import SignalEncoding, Stamp
from selfconf.protocol.messages.sites import End, Known, LogPart, LogQuestion, Page, Wake
from selfconf.protocol.messages.tasks import Notice, RecordedLoss, Status, TaskRecord
from selfconf.protocol.messages.texts import Identity, Label, Remark

__all__ = [
    "Access",
    "Apply",
    "CallAnswer",
    "Cause",
    "Claim",
    "End",
    "Fail",
    "Free",
    "Identity",
    "Introduction",
    "Known",
    "Label",
    "LogPart",
    "LogQuestion",
    "Message",
    "Moved",
    "Notice",
    "Page",
    "RecordedLoss",
    "RefusedAttempt",
    "Release",
    "Remark",
    "Reserve",
    "SignalEncoding",
    "Stamp",
    "StateOf",
    "Status",
    "TaskRecord",
    "Verdict",
    "Wake",
    "Wire",
    "Wires",
]

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
