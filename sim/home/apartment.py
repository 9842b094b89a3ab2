"""The apartment as its Turtle describes it: the reader turns the RDF graph into the values of `floor_plan`.

Everything in the file that has a spatial type belongs to the apartment, and its shape is known nowhere
else.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from rdflib import RDF, RDFS, SKOS, Graph, Literal, Namespace, URIRef
from rdflib.term import Node

from sim.geometry import Pose
from sim.home.floor_plan import Block, CameraMount, Colour, Door, Furniture, Place, Robot, Room, Wall

__all__ = [
    "PEIS_HOME",
    "Apartment",
    "ApartmentError",
    "Block",
    "CameraMount",
    "Door",
    "Furniture",
    "Place",
    "Robot",
    "Room",
    "Wall",
    "read_apartment",
]

HOME = Namespace("https://w3id.org/selfconf/peis-home#")
ROB = Namespace("https://w3id.org/selfconf/robotics#")
PEIS_HOME = Path(__file__).parents[2] / "ontology" / "peis-home.ttl"


class ApartmentError(Exception):
    """The apartment's description is incomplete or contradicts itself: the author of the Turtle can mend it.

    `subject` and `property` are the names in question, `reason` says what is wrong with them.
    """

    def __init__(self, subject: str, property: str, reason: str) -> None:
        super().__init__(subject, property, reason)
        self.subject, self.property, self.reason = subject, property, reason

    def __str__(self) -> str:
        return f"{self.subject}: {self.property} {self.reason}"


@dataclass(frozen=True)
class Apartment:
    """The whole apartment, every list sorted by name; its IRI names the frame of all its coordinates."""

    iri: str
    rooms: tuple[Room, ...]
    walls: tuple[Wall, ...]
    furniture: tuple[Furniture, ...]
    places: tuple[Place, ...]
    cameras: tuple[CameraMount, ...]
    robots: tuple[Robot, ...]

    @property
    def doors(self) -> tuple[Door, ...]:
        """All doors of all walls."""
        return tuple(door for wall in self.walls for door in wall.doors)

    def robot(self, name: str) -> Robot:
        """Return a robot by name; raises ApartmentError if it is not described."""
        return _named(self.robots, name, "rob:Robot")

    def camera(self, name: str) -> CameraMount:
        """Return a camera by name; raises ApartmentError if it is not described."""
        return _named(self.cameras, name, "home:Camera")

    def place(self, name: str) -> Place:
        """Return a room or spot by name; raises ApartmentError if it is not described."""
        return _named(self.places, name, "rob:Place")

    def room_at(self, x: float, y: float) -> Room | None:
        """Return the room that a point of the plane lies in, None on a threshold or outside."""
        return next((room for room in self.rooms if room.contains(x, y)), None)


def read_apartment(source: Path | Graph = PEIS_HOME) -> Apartment:
    """Read the apartment from a Turtle file or a graph that holds exactly one home:Apartment.

    Raises ApartmentError, which names the subject and the property, if the geometry is incomplete; a file that cannot
    be read is a subject, too.
    """
    return _Reader(source if isinstance(source, Graph) else _parsed(source)).apartment()


def _parsed(path: Path) -> Graph:
    try:
        return Graph().parse(data=path.read_bytes(), format="turtle")
    except (OSError, SyntaxError, ValueError, AssertionError) as error:  # what rdflib raises for what is no Turtle
        raise ApartmentError(str(path), "the file", f"cannot be read: {' '.join(str(error).split())}") from None


class _Reader:
    def __init__(self, graph: Graph) -> None:
        self.graph = graph

    def apartment(self) -> Apartment:
        homes = self.of_class(HOME.Apartment)
        if len(homes) != 1:
            raise ApartmentError("the graph", "home:Apartment", f"must have one instance, not {len(homes)}")
        rooms = tuple(self.room(s) for s in self.of_class(HOME.Room))
        names = {room.name: room for room in rooms}
        return Apartment(
            iri=str(homes[0]),
            rooms=rooms,
            walls=tuple(self.wall(s, names) for s in self.of_class(HOME.Wall)),
            furniture=tuple(self.piece(s, names) for s in self.of_class(HOME.Furniture)),
            places=tuple(self.place(s, names) for s in self.of_class(HOME.Room) + self.of_class(HOME.Spot)),
            cameras=tuple(self.camera(s) for s in self.of_class(HOME.Camera)),
            robots=tuple(self.robot(s) for s in self.of_class(ROB.Robot)),
        )

    def of_class(self, wanted: URIRef) -> list[URIRef]:
        classes = set(self.graph.transitive_subjects(RDFS.subClassOf, wanted))
        return sorted({s for c in classes for s in self.graph.subjects(RDF.type, c) if isinstance(s, URIRef)})

    def room(self, s: URIRef) -> Room:
        width, depth = self.size(s, HOME.width), self.size(s, HOME.depth)
        x, y = self.number(s, HOME.x), self.number(s, HOME.y)
        return Room(str(s), _name(s), self.label(s), x, y, width, depth, self.colour(s))

    def wall(self, s: URIRef, rooms: dict[str, Room]) -> Wall:
        block = self.block(s)
        openings = sorted(d for d in self.graph.objects(s, HOME.hasDoor) if isinstance(d, URIRef))
        doors = tuple(self.door(d, block.theta, rooms) for d in openings)
        wall = Wall(**vars(block), iri=str(s), doors=doors)
        for door in wall.doors:
            offset = Pose(wall.x, wall.y, wall.theta).relative(Pose(door.x, door.y))
            if abs(offset.y) > wall.depth / 2 or abs(offset.x) + door.width / 2 > wall.width / 2:
                raise ApartmentError(f"home:{door.name}", "home:x and home:y", f"lie outside {_curie(s)}")
        return wall

    def door(self, s: URIRef, theta: float, rooms: dict[str, Room]) -> Door:
        joined = sorted(_name(r) for r in self.graph.objects(s, HOME.connects))
        if len(joined) != 2 or not rooms.keys() >= set(joined):
            raise ApartmentError(_curie(s), "home:connects", f"must name two rooms, and names {joined}")
        x, y = self.number(s, HOME.x), self.number(s, HOME.y)
        width, height = self.size(s, HOME.width), self.size(s, HOME.height)
        return Door(str(s), _name(s), x, y, theta, width, height, (joined[0], joined[1]))

    def piece(self, s: URIRef, rooms: dict[str, Room]) -> Furniture:
        block = self.block(s)
        kind = min(_name(c) for c in self.graph.objects(s, RDF.type))
        solid = s not in self.of_class(HOME.FloorCovering)
        room = self.room_of(s, block.x, block.y, rooms)
        return Furniture(**vars(block), iri=str(s), kind=kind, room=room, solid=solid)

    def place(self, s: URIRef, rooms: dict[str, Room]) -> Place:
        x, y, z = self.number(s, HOME.x), self.number(s, HOME.y), self.number(s, HOME.z, 0.0)
        notation = self.graph.value(s, SKOS.notation)
        standing = self.pose(s, HOME.standingPoint) if (s, HOME.standingPoint, None) in self.graph else None
        if notation is not None and standing is None:
            raise ApartmentError(_curie(s), "home:standingPoint", "is missing, but goals may name the place")
        room = _name(s) if _name(s) in rooms else self.room_of(s, x, y, rooms)
        goal_name = None if notation is None else str(notation)
        return Place(str(s), _name(s), self.label(s), x, y, z, room, goal_name, standing)

    def camera(self, s: URIRef) -> CameraMount:
        width, height = round(self.size(s, HOME.imageWidth)), round(self.size(s, HOME.imageHeight))
        angle, rate = self.size(s, HOME.fieldOfView), self.size(s, HOME.frameRate)
        target = self.node(s, HOME.lookAt)
        return CameraMount(str(s), _name(s), self.point(s), self.point(target), angle, width, height, rate)

    def robot(self, s: URIRef) -> Robot:
        return Robot(str(s), _name(s), self.pose(s, HOME.startPose))

    def block(self, s: URIRef) -> Block:
        x, y, z = self.number(s, HOME.x), self.number(s, HOME.y), self.number(s, HOME.z, 0.0)
        is_round = (s, HOME.radius, None) in self.graph
        width = 2 * self.size(s, HOME.radius) if is_round else self.size(s, HOME.width)
        depth = width if is_round else self.size(s, HOME.depth)
        theta, height = self.number(s, HOME.theta, 0.0), self.size(s, HOME.height)
        return Block(_name(s), x, y, z, theta, width, depth, height, self.colour(s), is_round)

    def room_of(self, s: URIRef, x: float, y: float, rooms: dict[str, Room]) -> str:
        name = _name(self.node(s, HOME.isIn))
        if name not in rooms:
            raise ApartmentError(_curie(s), "home:isIn", f"names {name}, which is no room")
        if not rooms[name].contains(x, y):
            raise ApartmentError(_curie(s), "home:isIn", f"says {name}, but the centre lies outside it")
        return name

    def pose(self, s: URIRef, property: URIRef) -> Pose:
        node = self.node(s, property)
        return Pose(self.number(node, HOME.x), self.number(node, HOME.y), self.number(node, HOME.theta, 0.0))

    def point(self, s: Node) -> tuple[float, float, float]:
        return self.number(s, HOME.x), self.number(s, HOME.y), self.number(s, HOME.z)

    def node(self, s: Node, property: URIRef) -> Node:
        nodes = list(self.graph.objects(s, property))
        if len(nodes) != 1:
            reason = "is given more than once" if nodes else "is missing"
            raise ApartmentError(self.called(s), _curie(property), reason)
        return nodes[0]

    def number(self, s: Node, property: URIRef, default: float | None = None) -> float:
        if default is not None and (s, property, None) not in self.graph:
            return default
        node = self.node(s, property)
        try:
            value = float(node) if isinstance(node, Literal) else math.nan
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise ApartmentError(self.called(s), _curie(property), f"must be a number, not {node.n3()}")
        return value

    def size(self, s: Node, property: URIRef) -> float:
        value = self.number(s, property)
        if value <= 0.0:
            raise ApartmentError(self.called(s), _curie(property), f"must be greater than 0, not {value}")
        return value

    def called(self, s: Node) -> str:
        """Name a subject; one without a name of its own by what points at it."""
        if isinstance(s, URIRef):
            return _curie(s)
        return next((f"{_curie(o)} {_curie(p)}" for o, p in self.graph.subject_predicates(s)), "a blank node")

    def label(self, s: URIRef) -> str:
        return str(self.graph.value(s, RDFS.label, default=Literal(_name(s))))

    def colour(self, s: URIRef) -> Colour:
        text = str(self.graph.value(s, HOME.colour, default=Literal("#c8c8c8")))
        if not re.fullmatch(r"#[0-9a-fA-F]{6}", text):
            raise ApartmentError(_curie(s), "home:colour", f'must be like "#3f67a6", not "{text}"')
        red, green, blue = (int(text[i : i + 2], 16) / 255 for i in (1, 3, 5))
        return red, green, blue


_Named = TypeVar("_Named", CameraMount, Place, Robot)


def _named(things: tuple[_Named, ...], name: str, kind: str) -> _Named:
    for thing in things:
        if thing.name == name:
            return thing
    raise ApartmentError(f"home:{name}", "rdf:type", f"{kind} is missing")


def _name(node: Node) -> str:
    return re.split("[#/]", str(node))[-1]


def _curie(node: Node) -> str:
    return f"home:{_name(node)}" if str(node).startswith(str(HOME)) else str(node)
