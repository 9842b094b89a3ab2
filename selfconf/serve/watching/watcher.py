"""A living ecology, followed from a bus: what is advertised, what lives, which tasks run, and what happens to them.

It only reads: it has no life of its own, answers no question, and makes no call to a component, so that no program
notices it. Changes come by push: lives by liveliness, files by `changed`, the events of a run by notices. Every
`LOOK_ANEW` seconds the configurators are asked once more, which heals what was lost and serves those that put no
notices.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from functools import partial

from selfconf.bus.port import Bus
from selfconf.bus.timer import Timer
from selfconf.discovery import Beliefs, Discovery, EcologyView, FoundAdvertisement
from selfconf.model.term import IRI
from selfconf.model.wording import one_line
from selfconf.protocol.keys import component_chunk, life_of, owner_of
from selfconf.rdf import turtle
from selfconf.rdf.provenance import CONFIGURATION
from selfconf.serve.watching.change import Body, EcologyChange
from selfconf.serve.watching.component_bodies import component_body
from selfconf.serve.watching.task_watcher import DEPLOYED, TOGETHER, TaskWatcher

LINK_CHECK = 0.5
"""Seconds between two looks whether the link is another one, over which everything is to be looked at anew."""
ASKED_AGAIN = 5.0
"""Seconds after which a site is asked again that has not answered in full."""


class EcologyWatcher:
    """Follows one ecology and hands on each change; runs on the thread of its bus."""

    def __init__(
        self,
        bus: Bus,
        ecology: str,
        tell: Callable[[EcologyChange], None],
        clock: Callable[[], float] = time.time,
        aside: Callable[[Callable[[], None]], object] = lambda work: work(),
        believed: Beliefs | None = None,
    ) -> None:
        """`aside` reads what the sites have answered on another thread than the bus's.

        With keys, `believed` says whose a component is that several sites advertise.
        """
        self.bus, self._tell, self._clock = bus, tell, clock
        self.view = EcologyView(bus, ecology, believed, aside=aside)
        self.keys = self.view.keys
        self._components: dict[IRI, Body] = {}
        self._chunks: dict[str, IRI] = {}
        self._sites: dict[str, Body] = {}
        self._flush_soon = Timer(bus, TOGETHER, self._flush)
        self._tasks = TaskWatcher(bus, self.keys, self._happened, self._flush_soon.set)
        self._shown: dict[str, Body] = {}
        """The tasks as they were sent last, by identity."""
        self._events: list[Body] = []
        self._touched: set[IRI] = set()
        self._link = self._told_link = ""
        """The link over which was last found what is advertised, and the one over which also what is deployed was."""
        self._ask_again = Timer(bus, ASKED_AGAIN, self._discover)
        self._discovering = self._discover_again = False

    def begin(self) -> None:
        """Look at what there is, and follow it from then on."""
        self._discover()
        self._check_link()

    # What is advertised, and what lives.

    def _discover(self) -> None:
        if self._discovering:
            self._discover_again = True
            return
        self._discovering, link = True, self.bus.link

        def discovered(discovery: Discovery) -> None:
            self._link = link if link == self.bus.link else ""
            self._discovered(discovery)

        self.view.discover(discovered)

    def _check_link(self) -> None:
        """Look at everything anew over another link: what was seen over the last one may have come or gone unseen."""
        if self.bus.link not in ("", self._link) and not self._discovering:
            self._discover()
        self.bus.later(LINK_CHECK, self._check_link)

    def _discovered(self, discovery: Discovery) -> None:
        self._discovering = False
        self._ask_again.stop()  # it leads to a discovery, which comes here again
        self._tell_left_out(discovery)
        before, self.view.discovery = self.view.discovery.found, discovery
        discovery.found.update(list(self._kept(before, discovery)))
        gone: dict[IRI, None] = {c: None for c in before if c not in discovery.found}
        new = {c: found for c, found in discovery.found.items() if before.get(c) != found}
        for component in gone:
            self._chunks.pop(component_chunk(component), None)
            self._components.pop(component, None)
        self._chunks.update({component_chunk(component): component for component in new})
        bodies = {component: component_body(found, self._state(component)) for component, found in new.items()}
        self._components.update(bodies)
        graphs = _graphs({**new, **gone})
        shown: dict[str, Body | None] = {str(component): body for component, body in bodies.items()}
        shown |= {str(component): None for component in gone}
        sites = self._changed_sites(discovery)
        self._hand_on(EcologyChange({**new, **gone}, shown, sites, graphs=graphs))
        if not self.view.followed:
            self._follow()
        if self._link not in ("", self._told_link):
            self._tasks.look(partial(self._looked, self._link))
        if self._discover_again:
            self._discover_again = False
            self._discover()
        elif discovery.missing:
            self._ask_again.set()

    def _looked(self, link: str) -> None:
        """Tell over which link everything was found, once it was handed on."""
        self._flush()
        if link == self.bus.link and link != self._told_link:
            self._told_link = link
            self._hand_on(EcologyChange(link=link))

    def _tell_left_out(self, discovery: Discovery) -> None:
        """Tell what was left out of what sites advertise, and why, unless it was the last time as well."""
        for complaint in discovery.complaints:
            if complaint not in self.view.discovery.complaints:
                self._happened({"act": "complaint", "detail": one_line(complaint)})

    def _kept(
        self, before: Mapping[IRI, FoundAdvertisement], discovery: Discovery
    ) -> Iterator[tuple[IRI, FoundAdvertisement]]:
        """What was advertised by sites that live and have not answered in full: they are busy, and it may act."""
        silent = discovery.site_tokens - discovery.answered
        for component, found in before.items():
            if component not in discovery.found and self.keys.site_life(found.site, found.site_life) in silent:
                yield component, found

    def _changed_sites(self, discovery: Discovery) -> dict[str, Body | None]:
        before, self._sites = self._sites, {site: {"missing": site in discovery.missing} for site in discovery.sites}
        gone: dict[str, Body | None] = {site: None for site in before if site not in self._sites}
        return {**gone, **{site: body for site, body in self._sites.items() if before.get(site) != body}}

    def _follow(self) -> None:
        """Follow everything, once; not before the first discovery has ended, as `EcologyView.follow` says."""
        self.view.follow(self._life_changed, self._site_changed)
        self.bus.subscribe(self.keys.changed(), lambda _: self._discover())
        self._tasks.follow()

    def _state(self, component: IRI) -> str:
        if self.view.life(component) is not None:
            return "alive"
        found = self.view.discovery.found.get(component)
        return "dormant" if found is not None and found.startable else "absent"

    def _life_changed(self, key: str, alive: bool) -> None:
        chunk, life = owner_of(key), life_of(key)
        known = life in self.view.lives.get(chunk, ())
        (self.view.began if alive else self.view.ended)(chunk, life)
        component = self._chunks.get(chunk)
        if component is None or known == alive:
            return
        self._touched.add(component)
        act, what = ("began", "lives") if alive else ("ended", "lives no more")
        self._happened({"act": act, "component": component, "message": f"{component.short} {what}"})

    def _site_changed(self, key: str, alive: bool) -> None:
        site = owner_of(key)
        if alive != (site in self._sites):
            act, what = ("site came", "is there") if alive else ("site left", "has gone")
            self._happened({"act": act, "site": site, "message": f"the site {site} {what}"})
        self._discover()

    # Handing on.

    def _happened(self, event: Body) -> None:
        self._events.append({"time": self._clock(), **event})
        self._flush_soon.set()

    def _flush(self) -> None:
        components: dict[str, Body | None] = {}
        for component in self._touched & self._components.keys():
            body = {**self._components[component], "state": self._state(component)}
            if body != self._components[component]:
                components[component] = self._components[component] = body
        self._touched.clear()
        shown = dict(self._tasks.bodies())
        tasks: dict[str, Body | None] = {one: body for one, body in shown.items() if self._shown.get(one) != body}
        tasks |= {one: None for one in self._shown if one not in shown}
        self._shown = shown
        # What was asked for at the beginning comes from several configurators, one after the other.
        events, self._events = tuple(sorted(self._events, key=_moment)), []
        *earlier, deployed = self._tasks.take_graphs()
        for before in earlier:
            self._hand_on(EcologyChange(deployed=before))
        records = self._tasks.take_records()
        self._hand_on(
            EcologyChange(components=components, tasks=tasks, events=events, deployed=deployed, records=records)
        )

    def _hand_on(self, change: EcologyChange) -> None:
        if not change.empty:
            self._tell(change)


def _graphs(advertised: Mapping[IRI, FoundAdvertisement | None]) -> dict[str, bytes]:
    """What components advertise now, as N-Triples by the name of the graph.

    A component may have any name; its graph is not to take the place of what configurators tell.
    """
    return {
        str(component): b"" if found is None else turtle.ntriples(found.advertisement.triples)
        for component, found in advertised.items()
        if not component.startswith((DEPLOYED, CONFIGURATION))
    }


def _moment(event: Body) -> float:
    """When an event was."""
    return float(event["time"])
