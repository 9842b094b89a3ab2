// What stands around the diagram: tasks, components by site and place, one component in detail, a refusal.

import { ago, by, h, keyed, plain, say, short } from "/page/dom.js";
import { did } from "/page/model.js";
import { coloured } from "/page/turtle.js";

const CALM = { running: "good", waiting: "warn", refused: "bad", gone: "bad", stopped: "plain", detached: "plain", kept: "warn" };

export function showTasks(tasks, chosen, choose) {
  const list = by("tasks");
  if (!tasks.length) {
    list.replaceChildren(h("li", { class: "none", text: "No task runs. Begin one with “selfconf run”." }));
    return;
  }
  list.querySelector(".none")?.remove();
  keyed(list, tasks, ([id]) => id,
    ([id]) => h("li", {}, h("button", { type: "button", class: "task", onclick: () => choose(id) },
      h("span", { class: "state" }), h("span", { class: "name" }), h("span", { class: "facts" }))),
    (item, [id, task]) => {
      const button = item.firstElementChild, [state, name, facts] = button.children;
      button.setAttribute("aria-current", String(id === chosen));
      button.classList.toggle("over", task.over);
      button.classList.toggle("within", Boolean(task.inside_of));
      state.className = `state ${CALM[task.phase] ?? "busy"}`;
      say(name, task.name);
      say(facts, `${task.inside_of ? `inside of ${short(task.inside_of)} · ` : ""}${task.phase}${task.priority ? ` · priority ${task.priority}` : ""}${task.detached ? " · in the sites" : ""}`);
    });
}

export function taskHead(task, live) {
  if (!task) return [];
  const facts = [task.template && short(task.template) !== task.name ? short(task.template) : "", task.priority ? `priority ${task.priority}` : ""];
  const bound = Object.entries(task.configuration?.bindings ?? {});
  const phase = `${task.phase}${live && task.since && !task.over ? ` for ${ago(task.since)}` : ""}`;
  const by = [task.configurator && `configurator ${task.configurator}`, task.host && `on ${task.host}`].filter(Boolean).join(" ");
  return [h("h2", { class: "title", text: task.name }),
    h("p", { class: "facts", title: by }, h("span", { class: `chip ${CALM[task.phase] ?? "busy"}`, text: phase }),
      ...bound.map(([name, value]) => h("span", {}, `${name} `, h("b", { text: worth(value), title: String(value) }))),
      ...facts.filter(Boolean).map((fact) => h("span", { text: fact })))];
}

/** What a parameter is bound to: of an IRI its last part. */
const worth = (value) => (/^(https?:|urn:)/.test(value) ? short(value) : String(value));

/** Why something is lost, and why there is no configuration. */
export function below(task, why, select) {
  if (!task) return [];
  const found = [];
  const lost = Object.entries(task.lost);
  if (lost.length) {
    const away = lost.every(([, loss]) => loss.cause === "refused" || loss.cause === "yield");
    found.push(h("section", { class: `card ${away ? "warn" : "bad"}` }, h("h3", { text: away ? "Not to be had" : lost.length === 1 ? "Lost" : `${lost.length} components lost` }),
      h("ul", {}, ...lost.slice(0, 12).map(([component, loss]) =>
        h("li", {}, link(component, select), h("span", { class: "soft", text: ` ${did(loss)}` }))))));
  }
  if (task.owed?.length) {
    found.push(h("section", { class: "card bad" }, h("h3", { text: "Out of control" }),
      h("ul", {}, ...task.owed.map((one) => h("li", {}, link(one, select), " was turned off and has not obeyed")))));
  }
  const slow = Object.entries(task.dropped ?? {});
  if (slow.length) {
    found.push(h("section", { class: "card warn" }, h("h3", { text: "Too slow" }),
      h("ul", {}, ...slow.map(([one, count]) => h("li", {}, link(one, select), ` has passed over ${count} signals`)))));
  }
  if (why) found.push(refusal(why, select));
  return found;
}

function refusal(body, select) {
  const parts = [h("h3", { text: "There is no configuration" }),
    h("ul", { class: "reasons" }, ...(body.reasons ?? []).map((one) => h("li", { text: one.message })))];
  if (body.message) parts.push(h("p", { text: body.message }));
  if (body.near_misses?.length) {
    parts.push(h("h4", { text: "Nearly" }), h("div", { class: "wide" }, h("table", {},
      h("thead", {}, h("tr", {}, ...["component", "role", "what keeps it out"].map((text) => h("th", { scope: "col", text })))),
      h("tbody", {}, ...body.near_misses.slice(0, 40).map((miss) => h("tr", {}, h("td", {}, link(miss.component, select)),
        h("td", { text: short(miss.role) }), h("td", { text: miss.obstacle })))))));
  }
  if (body.repairs?.length) {
    parts.push(h("h4", { text: "What would change that" }), h("ul", {}, ...body.repairs.map((one) => h("li", { text: one.message }))));
  }
  if (body.pending || body.detail) parts.push(h("p", { class: "soft", text: body.detail ?? "Looking for what would change that …" }));
  return h("section", { class: "card warn refusal" }, ...parts);
}

const link = (component, select) =>
  h("button", { type: "button", class: "link", title: component, text: short(component), onclick: () => select(component) });

// Components by site and place.

const MANY = 40, ALL = 200;
const byName = new Intl.Collator("en", { numeric: true });
const opened = new Map();

export function showComponents(model, selected, select, filter) {
  const { held, lost } = model.claims(), then = model.statesThen();
  const words = filter.toLowerCase().split(/\s+/).filter(Boolean);
  const groups = new Map([...model.sites.keys()].sort().map((site) => [site, new Map()]));
  let count = 0;
  for (const [iri, one] of [...model.components].sort(([, a], [, b]) => byName.compare(a.name, b.name))) {
    const text = `${one.name} ${one.label} ${one.types.join(" ")} ${one.places.join(" ")} ${one.site}`.toLowerCase();
    if (!words.every((word) => text.includes(word))) continue;
    count += 1;
    const places = groups.get(one.site) ?? groups.set(one.site, new Map()).get(one.site);
    const place = one.places[0] ?? "";
    places.set(place, [...(places.get(place) ?? []), { iri, ...one }]);
  }
  const shown = [...groups].filter(([, places]) => places.size || !words.length);
  keyed(by("components"), shown, ([site]) => site, ([site]) => group("site", site),
    (element, [site, places]) => {
      const all = [...places.values()].flat();
      headed(element, site, all, model.sites.get(site)?.missing ? "does not answer" : "");
      unfold(element, `site ${site}`, words.length > 0 || shown.length < 9, () =>
        keyed(element.lastElementChild, [...places].sort(([a], [b]) => byName.compare(a, b)), ([place]) => place, ([place]) => group("place", place),
          (inner, [place, members]) => {
            headed(inner, place || "no place", members, "");
            inner.classList.toggle("alone", places.size === 1 && !place);
            const few = members.length <= MANY && (count <= ALL || members.some((one) => held.has(one.iri)));
            unfold(inner, `place ${site} ${place}`, few || words.length > 0 || members.some((one) => one.iri === selected), () =>
              keyed(inner.lastElementChild, members, (one) => one.iri, (one) => row(one, select),
                (button, one) => fill(button, one, selected, held, lost, then)));
          }));
    });
  return count;
}

const group = (kind, name) => h("details", { class: kind, "data-name": name }, h("summary", {}, h("span", { class: "what" }), h("span", { class: "count" })), h("div", { class: "inside" }));

function headed(element, name, members, note) {
  const [what, count] = element.firstElementChild.children;
  say(what, name);
  const alive = members.filter((one) => one.state === "alive").length;
  say(count, note || (alive === members.length ? String(alive) : `${alive} of ${members.length}`));
  count.classList.toggle("bad", Boolean(note));
}

/** Open or close a group as its user has left it, else as is best; its content is made when it is seen. */
function unfold(element, name, usual, content) {
  if (!element.dataset.heeded) {
    element.dataset.heeded = "yes";
    element.firstElementChild.addEventListener("click", () => opened.set(name, !element.open));
    element.addEventListener("toggle", () => element.open && element.content?.());
  }
  element.content = content;
  element.open = opened.get(name) ?? usual;
  if (element.open) content();
}

const row = (one, select) => h("button", { type: "button", class: "component", onclick: () => select(one.iri) },
  h("span", { class: "state" }), h("span", { class: "name" }), h("span", { class: "holder" }));

function fill(button, one, selected, held, lost, then) {
  const [state, name, holder] = button.children, now = lost.has(one.iri) ? "lost" : then.get(one.iri) ?? one.state;
  state.className = `state ${now.replaceAll(" ", "-")}`;
  button.title = plain(`${one.iri}\n${one.types.join(", ")}\n${now}`);
  button.setAttribute("aria-current", String(one.iri === selected));
  say(name, one.name);
  say(holder, (held.get(one.iri) ?? []).map((task) => task.name).join(", "));
  state.setAttribute("role", "img");
  state.setAttribute("aria-label", now);
}

// One component, and what the page shows where none is chosen.

const STATES = [["alive", "alive: its program runs"], ["dormant", "dormant: its site starts it when a task needs it"],
  ["absent", "absent: no program of it runs"], ["lost", "lost: it failed while a task held it"]];

const guide = () => [h("h2", { text: "How to read this" }),
  h("p", { class: "hint", text: "Components say what they are; a task says which roles it needs. The middle shows who plays which role now, and the line below what has happened: drag its handle to look back." }),
  h("ul", { class: "guide" }, ...STATES.map(([state, text]) => h("li", {}, h("span", { class: `state ${state}` }), text))),
  h("p", { class: "hint", text: "Choose a component, in the list or in the diagram, to see what it says of itself, its last signals and its log." })];

let asked = "", detailSays = "";

export function showDetail(model, iri, select, chooseTask, look, fits) {
  const place = by("detail"), one = model.components.get(iri), live = model.at === null;
  place.classList.toggle("open", Boolean(iri));
  look.show(one && live ? iri : "", one);
  fits.show(one && live ? iri : "", one, model.tasksSeen());
  if (!iri) {
    asked = detailSays = "";
    place.replaceChildren(...guide());
    return;
  }
  const { held, lost } = model.claims(), holders = held.get(iri) ?? [], loss = lost.get(iri);
  const within = one?.inside ? model.tasksSeen().filter(([, task]) => task.inside_of === iri && !task.over) : [];
  const state = loss ? "lost" : model.statesThen().get(iri) ?? one?.state ?? "not advertised";
  const says = JSON.stringify([iri, one, state, loss, holders.map((task) => task.id), within.map(([id]) => id), live]);
  if (says === detailSays && asked === iri) return;
  detailSays = says;
  const dt = (name, ...values) => (values.flat().filter(Boolean).length ? [h("dt", { text: name }), h("dd", {}, ...values.flat())] : []);
  const ports = (list) => list.map((port) => h("div", {}, h("b", { text: port.name }), h("span", { class: "soft", text: ` ${[port.signals.join(", "), port.unit, port.rate && `${port.rate} Hz`, port.optional && "optional"].filter(Boolean).join(" · ")}` })));
  const calls = (list) => list.map((each) => h("div", {}, h("b", { text: `${each.name}()` }), h("span", { class: "soft", text: ` ${[each.request, each.response && `→ ${each.response}`, each.optional && "optional"].filter(Boolean).join(" · ")}` })));
  const facts = one ? [
    ...dt("state", h("span", { class: "with-state" }, h("span", { class: `state ${state.replaceAll(" ", "-")}` }), loss ? `lost: it ${did(loss)}` : state)),
    ...dt("held by", holders.map((task) => h("button", { type: "button", class: "link", text: task.name, onclick: () => chooseTask(task.id) }))),
    ...dt("inside", !one.inside ? "" : within.length
      ? within.map(([id, task]) => h("button", { type: "button", class: "link", text: task.name, onclick: () => chooseTask(id) }))
      : one.inside),
    ...dt("site", `${one.site}`), ...dt("place", one.places.join(", ")),
    ...dt("inputs", ports(one.inputs)), ...dt("outputs", ports(one.outputs)),
    ...dt("operations", calls(one.operations)), ...dt("needs", calls(one.needed_operations)),
    ...dt("parameters", one.parameters.map((each) => h("div", {}, h("b", { text: each.name }), h("span", { class: "soft", text: ` ${each.type}` })))),
    ...dt("preference", one.preference ? String(one.preference) : ""),
  ] : [h("dd", { text: "No site advertises it now." })];
  const turtle = asked === iri ? place.querySelector(".turtle") : null;
  const kept = turtle ?? h("pre", { class: "turtle waiting", text: "…" });
  place.replaceChildren(
    h("button", { type: "button", class: "quiet close", "aria-label": "Close", text: "×", onclick: () => select("") }),
    h("h2", { class: "title", text: one?.name ?? short(iri) }),
    ...(one?.label ? [h("p", { class: "lead", text: one.label })] : []),
    h("p", { class: "types" }, ...(one?.types ?? []).map((type) => h("span", { class: "chip", text: type }))),
    h("dl", {}, ...facts),
    ...(one && live ? [h("h3", { text: "Roles" }), fits.element] : []),
    ...(one?.outputs.length && live ? [h("h3", { text: "Last signals" }), look.signals] : []),
    ...(one && live ? [h("h3", { text: "Log" }), look.log] : []),
    h("h3", { text: "Advertisement" }), kept, h("p", { class: "iri", text: iri }));
  if (one && !turtle) {
    asked = iri;
    fetch(`/things/${encodeURIComponent(iri)}`, { headers: { Accept: "text/turtle" } })
      .then((answer) => (answer.ok ? answer.text() : Promise.reject(new Error(answer.statusText))))
      .then((text) => { if (asked === iri) place.querySelector(".turtle")?.replaceWith(coloured(text.replace(/^@prefix .*\n/gm, "").trim())); })
      .catch(() => { asked = ""; });
  }
}

/** Forget the advertisement that is shown, as it may have changed. */
export const forget = (iri) => { if (asked === iri) asked = ""; };
