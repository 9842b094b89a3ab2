"""A collection of services and requests with judged relevance, as OWLS-TC4 is one, generated from a seed.

Someone *means* something by a service or a request: an object (a car) and a question about it (its price). A service is
relevant to a request iff both mean the same, and nobody looks at signatures to say so. Signatures are made of what is
meant with noise: a class above or below, a sibling, a port too many. Descriptions are made of synonyms, of which the
author of a request may know others. So the measure under test cannot have been used to judge.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from random import Random

PREFIXES = """\
@prefix sc: <https://w3id.org/selfconf#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix : <urn:retrieval:> .
"""
_SYLLABLES = ("ba", "co", "du", "fe", "gi", "ka", "lo", "mu", "ne", "pi", "ra", "so", "tu", "ve", "zo")
_FILLING = ("service", "returns", "information", "given", "provides", "user", "about", "requested", "data", "report")


@dataclass(frozen=True)
class Meaning:
    """What is meant: an object, and what is asked of it; both are classes of the ontology."""

    object: str
    question: str


@dataclass(frozen=True)
class Service:
    """A service or a request: what its author means by it, its signature, and how it is described."""

    name: str
    meaning: Meaning
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    description: str


class Collection:
    """An ontology, services and requests."""

    def __init__(self, seed: int, domains: int = 6, services: int = 240, requests: int = 12) -> None:
        self._random = random = Random(seed)
        self.parent: dict[str, str] = {}
        self._synonyms: dict[str, tuple[str, ...]] = {}
        objects = [one for number in range(domains) for one in self._tree(f"Thing{number}", 3, 3)]
        questions = [one for number in range(domains // 2) for one in self._tree(f"Quality{number}", 3, 3)]
        meanings = [Meaning(random.choice(objects), random.choice(questions)) for _ in range(requests * 2)]
        self.services = [self._service(number, random.choice(meanings)) for number in range(services)]
        self.requests = [self._service(number, meanings[number], "request") for number in range(requests)]

    def _tree(self, root: str, depth: int, width: int) -> list[str]:
        """The classes of a tree that are not near its root, each with a name of its own."""
        found: list[str] = []
        level = [root]
        for deep in range(depth):
            level = [self._child(parent) for parent in level for _ in range(self._random.randint(2, width))]
            found += level if deep else []
        return found

    def _child(self, parent: str) -> str:
        name = self._word().capitalize() + self._word().capitalize()
        self.parent[name] = parent
        self._synonyms[name] = (name, self._word(), self._word())
        return name

    def _word(self) -> str:
        return "".join(self._random.choices(_SYLLABLES, k=3))

    def _noisy(self, concept: str) -> str:
        """A class that an author may write for another: mostly itself, else one below, above or beside it."""
        below = [child for child, parent in self.parent.items() if parent == concept]
        above = self.parent[concept]
        beside = [child for child, parent in self.parent.items() if parent == above and child != concept]
        kind = self._random.random()
        if kind < 0.5:
            return concept
        if kind < 0.7:
            return self._random.choice(below or [concept])
        if kind < 0.85:
            return above if above in self.parent else concept
        return self._random.choice(beside or [concept])

    def _service(self, number: int, meaning: Meaning, prefix: str = "service") -> Service:
        random = self._random
        extra = [self._noisy(random.choice(list(self._synonyms)))] if random.random() < 0.25 else []
        inputs, outputs = [self._noisy(meaning.object)], [self._noisy(meaning.question)]
        if prefix == "service":
            (inputs if random.random() < 0.3 else outputs).extend(extra)
        words = [random.choice(self._synonyms[one]) for one in (meaning.object, meaning.question)]
        words += random.sample(_FILLING, 4)
        random.shuffle(words)
        return Service(f"{prefix}{number}", meaning, tuple(inputs), tuple(outputs), " ".join(words))

    def relevant(self, request: Service) -> set[str]:
        """The names of the services that mean what a request means."""
        return {service.name for service in self.services if service.meaning == request.meaning}

    def below(self) -> list[tuple[str, str]]:
        """Each class with the one right above it."""
        return list(self.parent.items())

    def ontology(self) -> str:
        """The classes as Turtle."""
        return PREFIXES + "".join(f":{child} rdfs:subClassOf :{parent} .\n" for child, parent in self.parent.items())

    def advertisements(self, described: bool) -> str:
        """The services as Turtle, with descriptions or without."""
        return PREFIXES + "".join(_component(one, ":Service", described) for one in self.services)


_KINDS = (
    "Price", "Hotel", "Film", "Book", "Route", "Weather", "Degree", "Ticket", "Person", "City", "Device", "Food",
    "Title", "Colour", "Funding", "Missile", "Surfing", "Camera", "Author", "Grant",
)  # fmt: skip
_MODIFIERS = (
    "Max", "Min", "TaxFree", "Recommended", "Academic", "Luxury", "Cheap", "Digital", "Used", "Local", "National",
    "Science", "Fiction", "Comedy", "Public", "Private", "Short", "Long", "Printed", "Compact", "Own", "Daily",
)  # fmt: skip


@dataclass(frozen=True)
class Topic:
    """What is meant by a service with several ports: what it is given, and what it gives."""

    given: tuple[str, ...]
    issued: tuple[str, ...]


class TangledCollection:
    """Another look-alike of OWLS-TC4, with what the first does not have.

    Names of classes are composed of words that occur all over, as `MaxPrice` below `Price`. The hierarchy is deep in
    places and wide in others, classes have several classes above them, and some are unions of classes of different
    domains. Services have up to three inputs and two outputs, and there are families of topics that differ in one of
    them: who means another topic of the family has nearly the same signature.
    """

    def __init__(self, seed: int, services: int = 1000, requests: int = 42, domains: int = 20) -> None:
        self._random = random = Random(seed)
        self.above: dict[str, list[str]] = {}
        for domain in range(domains):
            self._grow(
                _KINDS[domain % len(_KINDS)] + ("" if domain < len(_KINDS) else str(domain)), deep=domain % 2 == 0
            )
        names = [name for name, above in self.above.items() if above]
        for number in range(domains):
            self.above[f"Union{number}"] = []
            for member in random.sample(names, random.randint(2, 4)):
                self.above[member].append(f"Union{number}")
        for name in random.sample(names, len(names) // 7):
            other = random.choice(names)
            if name not in self._over(other):
                self.above[name].append(other)
        self._synonyms = {name: "".join(random.choices("abdefgiklmnoprstu", k=7)) for name in self.above}
        topics = self._topics(names, requests * 2)
        self.meant: dict[str, Topic] = {}
        self.services = [self._service(f"service{number}", random.choice(topics), True) for number in range(services)]
        self.requests = [self._service(f"request{number}", topics[number], False) for number in range(requests)]

    def _grow(self, root: str, deep: bool) -> None:
        """Add a domain: a few branches of ten classes below each other, or two levels of many."""
        self.above.setdefault(root, [])
        random = self._random
        if deep:
            for _ in range(3):
                parent = root
                for _ in range(10):
                    parent = self._below(parent, root)
        else:
            for child in [self._below(root, root) for _ in range(random.randint(6, 10))]:
                for _ in range(random.choice((0, 0, 12))):
                    self._below(child, root)

    def _below(self, parent: str, root: str) -> str:
        modifiers = self._random.sample(_MODIFIERS, self._random.choice((1, 1, 2)))
        name = "".join(modifiers) + root
        while name in self.above:
            name = self._random.choice(_MODIFIERS) + name
        self.above[name] = [parent]
        return name

    def _over(self, name: str) -> set[str]:
        """A class and all above it."""
        found, waiting = {name}, [name]
        while waiting:
            for one in self.above[waiting.pop()]:
                if one not in found:
                    found.add(one)
                    waiting.append(one)
        return found

    def _topics(self, names: Sequence[str], number: int) -> list[Topic]:
        """Topics, in families of three of which each two differ in one signal."""
        random, found = self._random, list[Topic]()
        while len(found) < number:
            one = Topic(
                tuple(random.sample(names, random.choice((1, 1, 2, 3)))),
                tuple(random.sample(names, random.choice((1, 1, 2)))),
            )
            found.append(one)
            found += [Topic(one.given, (*one.issued[:-1], random.choice(names))) for _ in range(2)]
        random.shuffle(found)
        return found

    def _noisy(self, concept: str) -> str:
        """A class that an author may write for another: mostly itself, else one below, above or beside it."""
        random = self._random
        kind = random.random()
        above = [one for one in self.above[concept] if self.above[one]]
        if kind < 0.55 or (kind >= 0.7 and not above):
            return concept
        if kind < 0.7:
            return random.choice([one for one, over in self.above.items() if concept in over] or [concept])
        parent = random.choice(above)
        return parent if kind < 0.85 else random.choice([one for one, over in self.above.items() if parent in over])

    def _service(self, name: str, topic: Topic, offered: bool) -> Service:
        random = self._random
        inputs, outputs = [*map(self._noisy, topic.given)], [*map(self._noisy, topic.issued)]
        if offered and random.random() < 0.25:
            random.choice((inputs, outputs)).append(self._noisy(random.choice(list(self._synonyms))))
        if offered and len(inputs) > 1 and random.random() < 0.15:
            inputs.pop(random.randrange(len(inputs)))
        said: list[str] = []
        for concept in (*topic.given, *topic.issued):
            words = re.findall("[A-Z][a-z]+", concept)
            said += [self._synonyms[concept]] if random.random() < 0.3 else [word.lower() for word in words]
        said += random.sample(_FILLING, 4)
        self.meant[name] = topic
        meaning = Meaning(" ".join(topic.given), " ".join(topic.issued))
        return Service(name, meaning, tuple(inputs), tuple(outputs), " ".join(said))

    def relevant(self, request: Service) -> set[str]:
        """The names of the services that mean what a request means."""
        return {service.name for service in self.services if service.meaning == request.meaning}

    def below(self) -> list[tuple[str, str]]:
        """Each class with each of those right above it."""
        return [(name, one) for name, above in self.above.items() for one in above]

    def advertisements(self, described: bool) -> str:
        """The services as Turtle, with descriptions or without."""
        return PREFIXES + "".join(_component(one, ":Service", described) for one in self.services)


def _ports(link: str, types: Iterable[str]) -> str:
    return "".join(f' ; sc:{link} [ sc:name "{number}" ; sc:signalType :{one} ]' for number, one in enumerate(types))


def _component(one: Service, kind: str, described: bool) -> str:
    said = f' ; rdfs:comment "{one.description}"' if described else ""
    ports = _ports("hasInput", one.inputs) + _ports("hasOutput", one.outputs)
    return f":{one.name} a sc:Component , {kind}{said}{ports} .\n"


def by_shape(request: Service, described: bool) -> tuple[str, str]:
    """A request as a template of one role whose shape asks for signal types; and no component besides."""
    wanted = [("hasOutput", one) for one in request.outputs] + [("hasInput", one) for one in request.inputs]
    shape = "".join(
        f" ; sh:property [ sh:path ( sc:{link} sc:signalType ) ; sh:hasValue :{one} ]" for link, one in wanted
    )
    said = f' ; rdfs:comment "{request.description}"' if described else ""
    # Nobody is called :Nobody, so that the services that conform are near misses as well.
    shape += " ; sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue :Nobody ]"
    return f"{PREFIXES} :t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :Service{said}{shape} .", PREFIXES


def by_interactions(request: Service, described: bool) -> tuple[str, str]:
    """A request as a template that connects a service between two components, which give and want the signals."""
    said = f' ; rdfs:comment "{request.description}"' if described else ""
    text = f"""{PREFIXES}
:t a sc:Template ; sc:roles ( :giver :r :taker ) .
:giver a sc:Role ; sh:class :Giver ; sc:feeds :r .
:r a sc:Role ; sh:class :Service{said} ; sc:feeds :taker .
:taker a sc:Role ; sh:class :Taker .
"""
    giver, taker = _ports("hasOutput", request.inputs), _ports("hasInput", (*request.outputs, "Nobody"))
    return text, f"{PREFIXES} :g a sc:Component , :Giver{giver} . :k a sc:Component , :Taker{taker} ."


def average_precision(ranking: Sequence[str], relevant: set[str]) -> float:
    """The mean, over the relevant, of the precision at the rank of each; one that is not ranked counts zero."""
    hits, total = 0, 0.0
    for rank, name in enumerate(ranking, 1):
        if name in relevant:
            hits += 1
            total += hits / rank
    return total / len(relevant)


def mean_average_precision(rankings: Mapping[str, Sequence[str]], relevant: Mapping[str, set[str]]) -> float:
    """The mean of the average precision over the requests for which anything is relevant."""
    judged = [name for name, some in relevant.items() if some]
    return sum(average_precision(rankings[name], relevant[name]) for name in judged) / len(judged)
