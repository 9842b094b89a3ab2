"""Every key of the ecology is built and taken apart here.

    selfconf/{ecology}/site/{site}/live/{life}              a site is alive (liveliness token)
    selfconf/{ecology}/site/{site}/ads/{component}          an advertisement (queryable, one reply each)
    selfconf/{ecology}/site/{site}/changed                  its advertisements have changed (put)
    selfconf/{ecology}/site/{site}/reopens                  its hub is about to be opened anew (put)
    selfconf/{ecology}/site/{site}/@ctl/wake                start a dormant component (call)
    selfconf/{ecology}/site/{site}/@ctl/end                 end a component that does not obey (call)
    selfconf/{ecology}/site/{site}/@ctl/keep                keep a task, or hear that it has ended (call)
    selfconf/{ecology}/site/{site}/@ctl/introduce           show a certificate, be shown that of the site (call)
    selfconf/{ecology}/site/{site}/@ctl/access              who may do what, and what was refused (call)
    selfconf/{ecology}/site/{site}/@ctl/log                 what its components have printed (call)
    selfconf/{ecology}/site/{site}/tasks/{task}             a task that the site keeps (queryable, one reply each)
    selfconf/{ecology}/task/{task}                          what has become of a task that the sites keep (put)
    selfconf/{ecology}/c/{shard}/{component}/live/{life}    a component is alive (liveliness token)
    selfconf/{ecology}/c/{shard}/{component}/out/{port}     what an output issues (put)
    selfconf/{ecology}/c/{shard}/{component}/fail           FAIL (put)
    selfconf/{ecology}/c/{shard}/{component}/free           it is free, and for which task (put)
    selfconf/{ecology}/c/{shard}/{component}/moved          what issues the outputs of a composite (put)
    selfconf/{ecology}/c/{shard}/{component}/@op/{name}/{caller}  an operation that it offers (call)
    selfconf/{ecology}/c/{shard}/{component}/@ctl/{call}    reserve, apply, release, state (call)
    selfconf/{ecology}/conf/{name}/live/{life}              a configurator is alive (liveliness token)
    selfconf/{ecology}/conf/{name}/cfg                      what it has deployed, as Turtle (put; queryable)
    selfconf/{ecology}/conf/{name}/events                   what it does and notices (put; queryable: the latest)
    selfconf/{ecology}/conf/{name}/@ctl/{call}              status, task, stop (call)

`{component}` is the base-32 of the ten-byte BLAKE2s of the component's IRI, `{shard}` the first byte of the same hash
in hexadecimal: the cost of siblings under one chunk grows with the square of their number, so no chunk has thousands.
`{caller}` is the same of the component that calls: so a rule about keys can hold each component to its own name.
`{life}` is a random text, new for each incarnation. A chunk that starts with `@` is matched by no wildcard, so that a
broad query can never activate anything.
"""

from __future__ import annotations

import base64
import hashlib
import re
from functools import lru_cache
from urllib.parse import quote, unquote

from selfconf.errors import AuthorError, PeerError
from selfconf.model.immutable import immutable
from selfconf.model.term import IRI

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}")


def checked_name(name: str, what: str) -> str:
    """A name that can be a chunk of a key: up to 64 ASCII letters, digits, '.', '-', '_'. Raises AuthorError."""
    if not _NAME.fullmatch(name):
        permitted = (
            "begin with an ASCII letter or a digit; after it '.', '-' and '_' may stand as well, at most 64 in all"
        )
        raise AuthorError(f"{name!r} cannot name {what}: {permitted}")
    return name


@lru_cache(maxsize=1 << 14)
def component_chunk(component: IRI) -> str:
    """The chunk that stands for a component; remembered, as every life that begins or ends is looked up by it."""
    return base64.b32encode(_digest(component)).decode().lower()


@lru_cache(maxsize=1 << 12)
def _place(component: IRI) -> str:
    """The shard and the chunk of a component, as they stand in its keys."""
    return f"{_digest(component)[0]:02x}/{component_chunk(component)}"


def _digest(component: IRI) -> bytes:
    return hashlib.blake2s(component.encode(), digest_size=10).digest()


@immutable
class Keys:
    """The keys of one ecology."""

    ecology: str

    def __post_init__(self) -> None:
        checked_name(self.ecology, "an ecology")

    def _site(self, site: str, rest: str) -> str:
        return f"selfconf/{self.ecology}/site/{site}/{rest}"

    def site_life(self, site: str, life: str) -> str:
        return self._site(site, f"live/{life}")

    def any_site_life(self) -> str:
        return self._site("*", "live/*")

    def advertisement(self, site: str, component: IRI) -> str:
        return self._site(site, f"ads/{component_chunk(component)}")

    def advertisements(self, site: str = "*") -> str:
        return self._site(site, "ads/**")

    def no_advertisements(self, site: str) -> str:
        """The key under which a site replies that it has none to tell, which is that of no component."""
        return self._site(site, "ads/none")

    def changed(self, site: str = "*") -> str:
        return self._site(site, "changed")

    def reopens(self, site: str = "*") -> str:
        return self._site(site, "reopens")

    def wake(self, site: str) -> str:
        return self._site(site, "@ctl/wake")

    def end(self, site: str) -> str:
        return self._site(site, "@ctl/end")

    def introduce(self, site: str) -> str:
        return self._site(site, "@ctl/introduce")

    def access(self, site: str = "*") -> str:
        return self._site(site, "@ctl/access")

    def log(self, site: str) -> str:
        return self._site(site, "@ctl/log")

    def all_of_site(self, site: str) -> tuple[str, ...]:
        """What a site says, under whatever key."""
        return self._site(site, "**"), self._site(site, "@ctl/*")

    def keep(self, site: str = "*") -> str:
        return self._site(site, "@ctl/keep")

    def kept_task(self, site: str, task: str) -> str:
        return self._site(site, f"tasks/{task}")

    def kept_tasks(self, site: str = "*") -> str:
        return self._site(site, "tasks/*")

    def task(self, task: str = "*") -> str:
        return f"selfconf/{self.ecology}/task/{task}"

    def _component(self, component: IRI, rest: str) -> str:
        return f"selfconf/{self.ecology}/c/{_place(component)}/{rest}"

    def life(self, component: IRI, life: str) -> str:
        return self._component(component, f"live/{life}")

    def lives(self, component: IRI) -> str:
        return self._component(component, "live/*")

    def parts_of_lives(self) -> tuple[str, ...]:
        """Sixteen key expressions that together mean `any_life`, and each about as many lives as another."""
        return tuple(self.any_life().replace("/c/*/", f"/c/{digit}$*/", 1) for digit in "0123456789abcdef")

    def any_life(self) -> str:
        return f"selfconf/{self.ecology}/c/*/*/live/*"

    def output(self, component: IRI, port: str) -> str:
        return self._component(component, f"out/{quote(port, safe='')}")

    def outputs(self, component: IRI) -> str:
        return self._component(component, "out/*")

    def any_output(self) -> str:
        return f"selfconf/{self.ecology}/c/*/*/out/*"

    def all_of_component(self, chunk: str) -> tuple[str, ...]:
        """What a component says, given by its chunk, under whatever key."""
        place = f"selfconf/{self.ecology}/c/{base64.b32decode(chunk.upper())[0]:02x}/{chunk}"
        return f"{place}/**", f"{place}/@ctl/*", f"{place}/@op/*/*"

    def operation(self, component: IRI, name: str, caller: IRI) -> str:
        return self._component(component, f"@op/{quote(name, safe='')}/{component_chunk(caller)}")

    def operations(self, component: IRI) -> str:
        return self._component(component, "@op/*/*")

    def any_operation(self, caller: str) -> str:
        """Every operation of the ecology, as a component calls it that is given by its chunk."""
        return f"selfconf/{self.ecology}/c/*/*/@op/*/{caller}"

    def fail(self, component: IRI) -> str:
        return self._component(component, "fail")

    def any_fail(self) -> str:
        return f"selfconf/{self.ecology}/c/*/*/fail"

    def free(self, component: IRI) -> str:
        return self._component(component, "free")

    def any_free(self) -> str:
        return f"selfconf/{self.ecology}/c/*/*/free"

    def moved(self, component: IRI) -> str:
        return self._component(component, "moved")

    def any_moved(self) -> str:
        return f"selfconf/{self.ecology}/c/*/*/moved"

    def call(self, component: IRI, call: str = "*") -> str:
        return self._component(component, f"@ctl/{call}")

    def any_call(self, call: str = "*") -> str:
        return f"selfconf/{self.ecology}/c/*/*/@ctl/{call}"

    def everything(self) -> tuple[str, ...]:
        """Every key of the ecology."""
        return *self.all_but_operations(), f"selfconf/{self.ecology}/**/@op/**"

    def all_but_operations(self) -> tuple[str, ...]:
        """Every key of the ecology by which no operation of a component is called."""
        whole = f"selfconf/{self.ecology}/**"
        return whole, f"{whole}/@ctl/**"

    def _configurator(self, name: str, rest: str) -> str:
        return f"selfconf/{self.ecology}/conf/{name}/{rest}"

    def configurator_life(self, name: str, life: str) -> str:
        return self._configurator(name, f"live/{life}")

    def is_configurator_life(self, key: str) -> bool:
        """Whether a key is the life of one configurator of this ecology; a wildcard, for one, would never end."""
        chunks = key.split("/")
        return (
            len(chunks) == 6
            and all(map(_NAME.fullmatch, (chunks[3], chunks[5])))
            and key == self.configurator_life(chunks[3], chunks[5])
        )

    def any_configurator_life(self) -> str:
        return self._configurator("*", "live/*")

    def configuration(self, name: str = "*") -> str:
        return self._configurator(name, "cfg")

    def notices(self, name: str = "*") -> str:
        return self._configurator(name, "events")

    def all_of_configurators(self, prefix: str) -> tuple[str, ...]:
        """What configurators say whose names begin with a prefix and a hyphen, under whatever key; `*`: all of them."""
        names = "*" if prefix == "*" else f"{prefix}-$*"
        return self._configurator(names, "**"), self._configurator(names, "@ctl/*")

    def configurator_call(self, name: str, call: str = "*") -> str:
        return self._configurator(name, f"@ctl/{call}")


def any_ecology() -> str:
    """The liveliness key of every site of every ecology."""
    return "selfconf/*/site/*/live/*"


def ecology_of(key: str) -> str:
    """The ecology that a key belongs to."""
    chunks = key.split("/")
    if len(chunks) < 3 or chunks[0] != "selfconf":
        raise PeerError(f"{key!r} is no key of an ecology")
    return chunks[1]


def life_of(key: str) -> str:
    """The incarnation that a liveliness key ends in."""
    return key.rsplit("/", 1)[-1]


def owner_of(key: str) -> str:
    """The site or configurator name, or the component chunk, that a liveliness key speaks of."""
    chunks = key.split("/")
    if len(chunks) < 3 or chunks[-2] != "live":
        raise PeerError(f"{key!r} is no liveliness key")
    return chunks[-3]


def task_identity(name: str, token: str) -> str:
    """The identity of a task: its name, and a text that no other task of that name has."""
    return f"{checked_name(name, 'a task')}~{token}"


def is_task_identity(text: str) -> bool:
    """Whether a text can be the identity of a task: two names with a tilde between."""
    name, _, token = text.partition("~")
    return _NAME.fullmatch(name) is not None and _NAME.fullmatch(token) is not None


def safe_name(text: str) -> str:
    """A text as a name that a key can hold: what cannot stand in one becomes a hyphen."""
    name = re.sub(r"[^A-Za-z0-9._-]+", "-", text).lstrip("._-")[:64]
    return name or "task"


def task_name(identity: str) -> str:
    """The name of a task, as its user knows it, by its identity."""
    return identity.partition("~")[0]


def owner_of_fail(key: str) -> str:
    """The component chunk of a FAIL key."""
    chunks = key.split("/")
    if len(chunks) != 6 or chunks[-1] != "fail":
        raise PeerError(f"{key!r} is no FAIL key")
    return chunks[-2]


def site_of(key: str) -> str:
    """The site that a site's key belongs to."""
    chunks = key.split("/")
    if len(chunks) < 5 or chunks[2] != "site":
        raise PeerError(f"{key!r} is no key of a site")
    return chunks[3]


def configurator_of(key: str) -> str:
    """The name of the configurator that a configurator's key belongs to; a wildcard, for one, names none."""
    chunks = key.split("/")
    if len(chunks) < 5 or chunks[2] != "conf" or not _NAME.fullmatch(chunks[3]):
        raise PeerError(f"{key!r} is no key of a configurator")
    return chunks[3]


def operation_of(key: str) -> tuple[str, str]:
    """The name of the operation that is called by a key, and the chunk of the component that calls it."""
    *_, name, caller = key.split("/")
    return unquote(name), caller


def call_of(key: str) -> str:
    """The name of the call at the end of a control key."""
    return key.rsplit("/", 1)[-1]
