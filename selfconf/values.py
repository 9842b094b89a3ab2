"""The types of the values that the library answers with, for annotations, `isinstance` and `match`.

    from selfconf.values import TaskRunning, TaskWaiting

    for event in run.events():
        match event:
            case TaskRunning(configuration=configuration):
                print(configuration["screen"])
            case TaskWaiting(refusal=refusal):
                print(refusal)

`selfconf` itself has the functions, and the types that most programs name. A value is made by the function that answers
with it, so a program that names no types needs nothing of this module.
"""

from selfconf.api.answer import Answer
from selfconf.api.ecology import Components, Solutions
from selfconf.api.living.component_states import ComponentState
from selfconf.api.living.echo import HeardSignal
from selfconf.api.partition_table import PartitionTable, RolePartition
from selfconf.api.tasks.living_task import LivingTask
from selfconf.api.tasks.run_outcomes import AnsweredEvent as AnyRunEvent
from selfconf.api.tasks.run_outcomes import AnsweredRunning as TaskRunning
from selfconf.api.tasks.run_outcomes import AnsweredSearch as SearchEnded
from selfconf.api.validation import ValidationReport
from selfconf.model.configuration import Assignment, Connection, ParameterSetting
from selfconf.model.consequence import Consequence
from selfconf.model.diagnostic import Diagnostic
from selfconf.model.holder import Holder
from selfconf.model.left_out import LeftOut
from selfconf.model.optimum import Optimum
from selfconf.model.partition import Candidate, NearMiss
from selfconf.model.profile import Place, Profile
from selfconf.model.refusal import (
    Conflict,
    Contradiction,
    InputUnfed,
    Reason,
    TooFewDistinct,
    TooFewEligible,
    ValueUnknown,
)
from selfconf.model.relaxation import Relaxation
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
from selfconf.model.template import Parameter, Role
from selfconf.protocol.messages import Status
from selfconf.rdf.eligibility import Exclusion

__all__ = [
    "ActivationSent",
    "Answer",
    "AnswerRejected",
    "AnyRunEvent",
    "Assignment",
    "CallDeclined",
    "Candidate",
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
    "Contradiction",
    "Diagnostic",
    "EcologyAsked",
    "EcologyDiscovered",
    "EcologyReachable",
    "EcologyUnreachable",
    "Exclusion",
    "FailWatched",
    "HeardSignal",
    "Holder",
    "InputConnected",
    "InputUnfed",
    "LeftOut",
    "LivingTask",
    "NearMiss",
    "Optimum",
    "Parameter",
    "ParameterSetting",
    "ParametersSet",
    "PartitionTable",
    "Place",
    "Profile",
    "Reason",
    "Relaxation",
    "Role",
    "RolePartition",
    "RunEvent",
    "SearchEnded",
    "Solutions",
    "Status",
    "TaskDetached",
    "TaskRefused",
    "TaskRunning",
    "TaskStopped",
    "TaskWaiting",
    "TooFewDistinct",
    "TooFewEligible",
    "ValidationReport",
    "ValueUnknown",
]
