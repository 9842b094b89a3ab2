"""The ecologies in which histories happen: who lives where, what it says of itself, and which tasks there are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES


@dataclass(frozen=True, slots=True)
class FaultyEcology:
    """Sites with their components, and two templates for their tasks."""

    name: str
    sites: Mapping[str, tuple[str, ...]]
    """The sites, each with what it advertises."""
    advertisements: Mapping[str, str]
    composites: tuple[str, ...]
    """The components that are no process of their own, but tasks of their site."""
    whole: str
    """The template of most tasks."""
    part: str
    """Another template, without the actuator."""
    bindings: tuple[tuple[str, str], ...] = ()
    """Values for parameters of either template; `{task}` stands for the name of the task."""
    preferred: tuple[str, ...] = ()
    """The processes in whose place another one may stand, but that tasks would rather have."""
    tasks: tuple[str, ...] = ("task-1", "task-2", "task-3")
    """The tasks there may be."""
    latched: bool = False
    """Whether outputs issue one signal as their components start, and nothing else for as long as they act."""
    crowd: bool = False
    """Whether most of its tasks begin at once, and each is of either template."""

    @property
    def processes(self) -> tuple[str, ...]:
        """The components that are processes."""
        return tuple(sorted({name for names in self.sites.values() for name in names} - {*self.composites}))


PAPER = FaultyEcology(
    "paper",
    {
        "living-room": ("tracker",),
        "astrid": ("sonar", "encoder", "odometry", "control", "drive", "pippi"),
    },
    ADVERTISEMENTS,
    (),
    NAVIGATE,
    NAVIGATE.replace(" :drive )", " )").replace("sc:feeds :drive ;", "").partition(":drive a sc:Role")[0],
    (("robot", ":Astrid"), ("goal", "(AT {task})")),
    ("tracker",),
)
"""The paper's six components and Pippi's drive; the other template is the paper's task without the drive."""

_POSITIONS = (
    'sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ] ; sc:hasOperation [ sc:name "where" ; sc:response :Pose ]'
)
_TRACKER = (
    'a sc:Component, :Tracker ; sc:hasInput [ sc:name "image" ; sc:signalType :Image ] ;'
    ' sc:hasOutput [ sc:name "track" ; sc:signalType :Pose ] ;'
    ' sc:hasOperation [ sc:name "locate" ; sc:response :Pose ] ;'
    ' sc:needsOperation [ sc:name "lamp" ; sc:response :Light ] .'
)
_CAMERA = 'a sc:Component, :Camera ; sc:hasOutput [ sc:name "image" ; sc:signalType :Image ] .'
_LAMP = 'a sc:Component, :Lamp ; sc:hasOperation [ sc:name "shine" ; sc:response :Light ] .'
_ROLES = """
:light a sc:Role ; sh:class :Lamp ; sc:feeds :position .
:position a sc:Role ; sh:class :Positions ; sc:feeds FED .
"""
COMPOSED = FaultyEcology(
    "composed",
    {
        "living-room": ("camera-1", "camera-2", "tracker-1", "tracker-2", "service"),
        "astrid": ("lamp-1", "lamp-2", "odometry", "drive", "screen"),
    },
    {
        "camera-1": f":camera-1 {_CAMERA}",
        "camera-2": f":camera-2 {_CAMERA}",
        "tracker-1": f":tracker-1 {_TRACKER}",
        "tracker-2": f":tracker-2 {_TRACKER}",
        "lamp-1": f":lamp-1 {_LAMP}",
        "lamp-2": f":lamp-2 {_LAMP}",
        "odometry": f":odometry a sc:Component, :Positions ; {_POSITIONS} .",
        "drive": ':drive a sc:Component, :Drive ; sc:hasInput [ sc:name "position" ; sc:signalType :Pose ] ;'
        ' sc:needsOperation [ sc:name "start" ; sc:response :Pose ] .',
        "screen": ':screen a sc:Component, :Screen ; sc:needsOperation [ sc:name "place" ; sc:response :Pose ] .',
        "service": f""":service a sc:Component, :Positions ; sc:preference 5 ; {_POSITIONS} ;
    sc:needsOperation [ sc:name "light" ; sc:response :Light ] ; sc:grounding [ sc:template :localise ] .
:localise a sc:Template ; sc:roles ( :eye :tracker ) ;
    sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ; sc:of :tracker ] ;
    sc:hasOperation [ sc:name "where" ; sc:response :Pose ; sc:of :tracker ] ;
    sc:needsOperation [ sc:name "light" ; sc:response :Light ; sc:of :tracker ] .
:eye a sc:Role ; sh:class :Camera ; sc:feeds :tracker .
:tracker a sc:Role ; sh:class :Tracker .""",
    },
    ("service",),
    f"{PREFIXES}:go a sc:Template ; sc:roles ( :light :position :motor ) .{_ROLES.replace('FED', ':motor')}"
    ":motor a sc:Role ; sh:class :Drive .",
    f"{PREFIXES}:show a sc:Template ; sc:roles ( :light :position :wall ) .{_ROLES.replace('FED', ':wall')}"
    ":wall a sc:Role ; sh:class :Screen .",
    preferred=("lamp-1",),
)
"""A composite that has an output, offers an operation and needs one; and a component that can stand for it."""

_SECOND = {
    "sonar": ":second-sonar a sc:Component, rob:SonarArray ; sc:preference -1 ;",
    "control": ":second-cap a sc:Component, rob:NavigationControl ; sc:preference -1 ;",
    "drive": ":second-drive a sc:Component, rob:MotorDrive ; sc:preference -1 ;",
}
CHOICE = FaultyEcology(
    "choice",
    {
        "living-room": ("tracker", "odometry"),
        "astrid": ("sonar", "second-sonar", "encoder", "control", "second-control", "drive", "second-drive"),
    },
    {
        **{name: text for name, text in ADVERTISEMENTS.items() if name != "pippi"},
        **{f"second-{name}": f"{begin} {ADVERTISEMENTS[name].partition(';')[2]}" for name, begin in _SECOND.items()},
    },
    (),
    PAPER.whole,
    PAPER.part,
    PAPER.bindings,
    ("tracker", "sonar", "control", "drive"),
)
"""The paper's task, with a second component for most of its roles that is not preferred."""

_SENSORS = ("sensor0a", "sensor0b", "sensor1a", "sensor2a", "sensor2b", "sensor3a")
_DRIVES = ("drive0", "drive1", "drive2")


def _sensing(numbers: tuple[int, ...], name: str) -> str:
    """A task that needs some sensors and a drive, in the order given."""
    roles = " ".join(f":role{number}" for number in numbers)
    sensors = (
        f":role{number} a sc:Role ; sh:class :Sensor{number} ; sc:feeds :drive-role ;"
        " sc:sets [ sc:parameterType :Mode ; sc:value :goal ] ."
        for number in numbers
    )
    return "\n".join(
        [
            f"{PREFIXES}:{name} a sc:Template ; sc:parameter :goal ; sc:roles ( {roles} :drive-role ) .",
            ':goal a sc:Parameter ; sc:name "goal" ; sh:datatype xsd:string .',
            *sensors,
            ":drive-role a sc:Role ; sh:class :Drive .",
        ]
    )


CROWDED = FaultyEcology(
    "crowded",
    {
        "x": tuple(name for name in _SENSORS if name.endswith("a")),
        "y": (*(name for name in _SENSORS if name.endswith("b")), *_DRIVES),
    },
    {
        name: f":{name} a sc:Component, :S{name[1:-1]} ; sc:preference {-1 if name.endswith('b') else 0} ;"
        ' sc:hasOutput [ sc:name "out" ; sc:signalType :Signal ] ;'
        ' sc:hasParameter [ sc:name "mode" ; sc:parameterType :Mode ] .'
        for name in _SENSORS
    }
    | {
        name: f':{name} a sc:Component, :Drive ; sc:hasInput [ sc:name "in" ; sc:signalType :Signal ] .'
        for name in _DRIVES
    },
    (),
    _sensing((0, 1, 2), "whole"),
    _sensing((3, 2, 1, 0), "part"),
    (("goal", "(AT {task})"),),
    ("sensor0a", "sensor2a"),
    tuple(f"task-{number}" for number in range(1, 6)),
    crowd=True,
)
"""Five tasks that want the same few sensors and drives, in opposite order of their needs, and can share none."""

_CHART = 'a sc:Component, :Chart ; sc:hasOutput [ sc:name "map" ; sc:signalType :Map ]'
_BEACON = 'a sc:Component, :Beacon ; sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ]'
_PLANNER = (
    'a sc:Component, :Planner ; sc:hasInput [ sc:name "map" ; sc:signalType :Map ] ,'
    ' [ sc:name "pose" ; sc:signalType :Pose ] ; sc:hasOutput [ sc:name "path" ; sc:signalType :Path ] ;'
    ' sc:hasParameter [ sc:name "mode" ; sc:parameterType :Mode ]'
)
_MOWER = 'a sc:Component, :Mower ; sc:hasInput [ sc:name "path" ; sc:signalType :Path ]'
LATCHED = FaultyEcology(
    "latched",
    {
        "house": ("chart", "second-chart", "beacon", "second-beacon", "wall"),
        "garden": ("planner", "second-planner", "mower", "second-mower"),
    },
    {
        "chart": f":chart {_CHART} .",
        "second-chart": f":second-chart {_CHART} ; sc:preference -1 .",
        "beacon": f":beacon {_BEACON} .",
        "second-beacon": f":second-beacon {_BEACON} ; sc:preference -1 .",
        "planner": f":planner {_PLANNER} .",
        "second-planner": f":second-planner {_PLANNER} ; sc:preference -1 .",
        "mower": f":mower {_MOWER} ; sc:tolerates [ sc:value 0.3 ; sc:unit unit:SEC ] .",
        "second-mower": f":second-mower {_MOWER} ; sc:preference -1 ; sc:tolerates [ sc:value 4 ; sc:unit unit:SEC ] .",
        "wall": ':wall a sc:Component, :Wall ; sc:hasInput [ sc:name "map" ; sc:signalType :Map ] .',
    },
    (),
    f"""{PREFIXES}:mow a sc:Template ; sc:parameter :goal ; sc:roles ( :where :fix :way :blades ) .
:goal a sc:Parameter ; sc:name "goal" ; sh:datatype xsd:string .
:where a sc:Role ; sh:class :Chart ; sc:feeds :way .
:fix a sc:Role ; sh:class :Beacon ; sc:feeds :way .
:way a sc:Role ; sh:class :Planner ; sc:feeds :blades ; sc:sets [ sc:parameterType :Mode ; sc:value :goal ] .
:blades a sc:Role ; sh:class :Mower .""",
    f"""{PREFIXES}:show a sc:Template ; sc:parameter :goal ; sc:roles ( :where :wall ) .
:goal a sc:Parameter ; sc:name "goal" ; sh:datatype xsd:string .
:where a sc:Role ; sh:class :Chart ; sc:feeds :wall .
:wall a sc:Role ; sh:class :Wall .""",
    (("goal", "(AT {task})"),),
    ("chart", "beacon"),
    latched=True,
)
"""Two tasks share charts and beacons of which each has one thing to say, and can be replaced by another."""

_SHARED_ROLES = """
:eye a sc:Role ; sh:class :Camera ; sc:feeds :position .
:position a sc:Role ; sh:class :Tracker ; sc:feeds FED .
"""
_SINKS = {"drive": ("Drive", 2), "screen": ("Screen", 2)}
SHARED = FaultyEcology(
    "shared",
    {
        "living-room": ("camera-1", "camera-2", "tracker-1", "screen-1"),
        "astrid": ("camera-3", "tracker-2", "drive-1", "drive-2", "screen-2"),
    },
    {f"camera-{number}": f":camera-{number} {_CAMERA}" for number in (1, 2, 3)}
    | {
        f"tracker-{number}": f":tracker-{number} a sc:Component, :Tracker ; sc:shareable true ;"
        f' sc:preference {-number} ; sc:hasInput [ sc:name "image" ; sc:signalType :Image ] ;'
        ' sc:hasOutput [ sc:name "track" ; sc:signalType :Pose ] .'
        for number in (1, 2)
    }
    | {
        f"{name}-{number}": f":{name}-{number} a sc:Component, :{kind} ;"
        ' sc:hasInput [ sc:name "pose" ; sc:signalType :Pose ] .'
        for name, (kind, count) in _SINKS.items()
        for number in range(1, count + 1)
    },
    (),
    f"{PREFIXES}:go a sc:Template ; sc:roles ( :eye :position :motor ) .{_SHARED_ROLES.replace('FED', ':motor')}"
    ":motor a sc:Role ; sh:class :Drive .",
    f"{PREFIXES}:show a sc:Template ; sc:roles ( :eye :position :wall ) .{_SHARED_ROLES.replace('FED', ':wall')}"
    ":wall a sc:Role ; sh:class :Screen .",
    preferred=("camera-1", "tracker-1"),
    tasks=tuple(f"task-{number}" for number in range(1, 5)),
    crowd=True,
)
"""Four tasks that share cameras, and trackers as long as they want the same camera, and lose these while they do."""

ECOLOGIES = {one.name: one for one in (PAPER, COMPOSED, CHOICE, CROWDED, LATCHED, SHARED)}
