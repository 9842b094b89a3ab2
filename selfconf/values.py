"""The types of the values that the library answers with, for annotations, `isinstance` and `match`.

    from selfconf.values import TaskRunning, TaskWaiting

    for event in run.events():
        match event:
            case TaskRunning(configuration=configuration):
                print(configuration["screen"])
            case TaskWaiting(refusal=refusal):
                print(refusal)

`Reason`, `Obstacle`, `Relaxation`, `Requirement` and `Fault` are unions, whose members are here too. `selfconf` itself
has the functions, and the types that most programs name. A value is made by the function that answers with it, so a
program that names no types needs nothing of this module but `event_body`, which makes of an event of a run the JSON
that `run --format json` prints for it.
"""

from selfconf.api.answer import Answer
from selfconf.api.ecology import Components, Solutions
from selfconf.api.living.component_states import ComponentState
from selfconf.api.living.echo import HeardSignal
from selfconf.api.living.site_access import SiteAccess
from selfconf.api.partition_table import PartitionTable, RolePartition
from selfconf.api.tasks.living_task import LivingTask
from selfconf.api.tasks.run_outcomes import AnsweredEvent as AnyRunEvent
from selfconf.api.tasks.run_outcomes import AnsweredRunning as TaskRunning
from selfconf.api.tasks.run_outcomes import AnsweredSearch as SearchEnded
from selfconf.api.validation import ValidationReport
from selfconf.configurator import Loss, Revival
from selfconf.discovery import Discovery, FoundAdvertisement
from selfconf.model.configuration import Assignment, Connection, ParameterSetting, Wants
from selfconf.model.consequence import Consequence
from selfconf.model.diagnostic import Diagnostic, Severity
from selfconf.model.holder import Holder
from selfconf.model.left_out import LeftOut
from selfconf.model.obstacle import (
    Excluded,
    NoAlternative,
    NoCommonValue,
    NotFedItself,
    NotJudged,
    Obstacle,
    ParameterForbids,
    ParameterUndeclared,
    PropertyUnmet,
    ShapeViolated,
    TypeRelation,
    UnfitOutput,
    UnlikePorts,
    WrongComponent,
    WrongType,
)
from selfconf.model.optimum import Optimum
from selfconf.model.partition import Candidate, NearMiss
from selfconf.model.profile import Input, OperationalParameter, Output, Place, Profile
from selfconf.model.property_fault import (
    Ambiguous,
    ConstraintFailed,
    Fault,
    Missing,
    NotAmong,
    WrongCount,
    WrongShareOfValues,
)
from selfconf.model.refusal import (
    Conflict,
    Contradiction,
    DerivationStep,
    InputUnfed,
    MisnamedPort,
    Reason,
    TooFewDistinct,
    TooFewEligible,
    ValueUnknown,
)
from selfconf.model.relaxation import (
    AcceptNearMiss,
    AddComponents,
    AddInteraction,
    Addition,
    AddRecruits,
    AskForFewer,
    LetRecruit,
    Relaxation,
)
from selfconf.model.requirement import InputFed, OneRoleEach, OneValue, Requirement, RolePlayed
from selfconf.model.run_event import (
    ActivationSent,
    AnswerRejected,
    CallDeclined,
    ComponentActivated,
    ComponentAwaited,
    ComponentLeftOut,
    ComponentLost,
    ComponentReleased,
    ComponentUnreachable,
    ComponentWoken,
    EcologyAsked,
    EcologyDiscovered,
    EcologyReachable,
    EcologyUnreachable,
    FailWatched,
    InputConnected,
    ParametersSet,
    RunEvent,
    TaskDetached,
    TaskRefused,
    TaskStopped,
    TaskWaiting,
)
from selfconf.model.signal_likeness import Degree, SignalMatch
from selfconf.model.template import Interaction, Parameter, Role, Setting
from selfconf.model.term import BlankNode, Term
from selfconf.protocol.messages import Access, Cause, RefusedAttempt, SignalEncoding, Stamp, Status
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.eligibility import Exclusion
from selfconf.render import Names
from selfconf.render.run_events import event_body
from selfconf.this_machine import LocalSite

__all__ = [
    "AcceptNearMiss",
    "Access",
    "ActivationSent",
    "AddComponents",
    "AddInteraction",
    "AddRecruits",
    "Addition",
    "Advertisement",
    "Ambiguous",
    "Answer",
    "AnswerRejected",
    "AnyRunEvent",
    "AskForFewer",
    "Assignment",
    "BlankNode",
    "CallDeclined",
    "Candidate",
    "Cause",
    "ComponentActivated",
    "ComponentAwaited",
    "ComponentLeftOut",
    "ComponentLost",
    "ComponentReleased",
    "ComponentState",
    "ComponentUnreachable",
    "ComponentWoken",
    "Components",
    "Conflict",
    "Connection",
    "Consequence",
    "ConstraintFailed",
    "Contradiction",
    "Degree",
    "DerivationStep",
    "Diagnostic",
    "Discovery",
    "EcologyAsked",
    "EcologyDiscovered",
    "EcologyReachable",
    "EcologyUnreachable",
    "Excluded",
    "Exclusion",
    "FailWatched",
    "Fault",
    "FoundAdvertisement",
    "HeardSignal",
    "Holder",
    "Input",
    "InputConnected",
    "InputFed",
    "InputUnfed",
    "Interaction",
    "LeftOut",
    "LetRecruit",
    "LivingTask",
    "LocalSite",
    "Loss",
    "MisnamedPort",
    "Missing",
    "Names",
    "NearMiss",
    "NoAlternative",
    "NoCommonValue",
    "NotAmong",
    "NotFedItself",
    "NotJudged",
    "Obstacle",
    "OneRoleEach",
    "OneValue",
    "OperationalParameter",
    "Optimum",
    "Output",
    "Parameter",
    "ParameterForbids",
    "ParameterSetting",
    "ParameterUndeclared",
    "ParametersSet",
    "PartitionTable",
    "Place",
    "Profile",
    "PropertyUnmet",
    "Reason",
    "RefusedAttempt",
    "Relaxation",
    "Requirement",
    "Revival",
    "Role",
    "RolePartition",
    "RolePlayed",
    "RunEvent",
    "SearchEnded",
    "Setting",
    "Severity",
    "ShapeViolated",
    "SignalEncoding",
    "SignalMatch",
    "SiteAccess",
    "Solutions",
    "Stamp",
    "Status",
    "TaskDetached",
    "TaskRefused",
    "TaskRunning",
    "TaskStopped",
    "TaskWaiting",
    "Term",
    "TooFewDistinct",
    "TooFewEligible",
    "TypeRelation",
    "UnfitOutput",
    "UnlikePorts",
    "ValidationReport",
    "ValueUnknown",
    "Wants",
    "WrongComponent",
    "WrongCount",
    "WrongShareOfValues",
    "WrongType",
    "event_body",
]
