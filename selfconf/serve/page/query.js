// Questions in SPARQL, and answers as a table, a truth value, or Turtle.

import { by, h, say, short } from "/page/dom.js";
import { coloured, tokens } from "/page/turtle.js";

const EXAMPLES = {
  "Who is there": `SELECT ?component ?type ?place WHERE {
  ?component a sc:Component, ?type .
  OPTIONAL { ?component rob:place ?place }
  FILTER (?type != sc:Component)
} ORDER BY ?type ?component`,
  "Which component feeds which": `SELECT ?source ?output ?sink ?input WHERE {
  [] sc:connection [ sc:from ?source ; sc:output ?output ; sc:to ?sink ; sc:input ?input ]
}`,
  "What replaced what, and why": `SELECT ?role ?component ?instead ?cause ?detail WHERE {
  ?configuration sc:assignment [ sc:role ?role ; sc:component ?component ; sc:replaces ?instead ] .
  OPTIONAL {
    ?configuration prov:wasInfluencedBy [ sc:component ?instead ; sc:cause ?cause ; sc:detail ?detail ]
  }
}`,
  "Who could deliver a pose": `SELECT ?component ?output WHERE {
  ?component sc:hasOutput [ sc:name ?output ; sc:signalType rob:PlanarPose2D ]
}`,
  "Outputs that no input could follow": `SELECT ?component ?output ?signal WHERE {
  ?component sc:hasOutput [ sc:name ?output ; sc:signalType ?signal ] .
  FILTER NOT EXISTS { [] sc:hasInput [ sc:signalType ?signal ] }
}`,
  "One component, as a graph": `DESCRIBE ?component WHERE { ?component a sc:Component } LIMIT 1`,
};
const ROWS = 1000;

let prefixes = {}, reveal, knows;

/** Prepare the view in which questions are asked; `known` tells whether an IRI is a component's, `see` shows that. */
export function prepareQuery(known, see) {
  const text = by("sparql");
  [knows, reveal] = [known, see];
  by("examples").append(...Object.entries(EXAMPLES).map(([name, query]) =>
    h("button", { type: "button", class: "chip", text: name, onclick: () => { text.value = query; paint(); ask(); } })));
  text.value = Object.values(EXAMPLES)[0];
  text.addEventListener("input", () => paint());
  text.addEventListener("scroll", follow);
  text.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) ask();
  });
  by("ask").addEventListener("click", ask);
  paint();
}

/** What the server lends to every query. */
export function lend(known) {
  prefixes = known;
  by("prefixes").replaceChildren(...Object.entries(known).flatMap(([prefix, iri]) => [h("dt", { text: `${prefix}:` }), h("dd", { text: iri })]));
}

// The editor: what is typed is transparent, and lies on the same text with colours.

function paint(wrong = null) {
  const text = by("sparql").value, [start, end] = wrong ?? [text.length, text.length];
  by("painted").replaceChildren(...tokens(text.slice(0, start)),
    ...(wrong ? [h("mark", {}, ...tokens(text.slice(start, end) || " "))] : []), ...tokens(text.slice(end)), "\n");
  by("sparql").setAttribute("aria-invalid", String(Boolean(wrong)));
  follow();
}

function follow() {
  by("painted").scrollTop = by("sparql").scrollTop;
  by("painted").scrollLeft = by("sparql").scrollLeft;
}

/** Where in a query a complaint finds fault, from which to which character; null where it does not say. */
export function faultIn(query, complaint) {
  const place = /at (\d+):(\d+)/.exec(complaint), named = /prefix ([^\s:]*:)|begins with '([^']+)'/.exec(complaint);
  let start = -1;
  if (place) {
    const before = query.split("\n").slice(0, Number(place[1]) - 1).reduce((sum, line) => sum + line.length + 1, 0);
    start = Math.min(before + Number(place[2]) - 1, query.trimEnd().length - 1);  // what is missing has no place: the end
  } else if (named) start = query.indexOf(named[1] ?? named[2]);
  else start = /\bSERVICE\b/i.exec(/^SERVICE /.test(complaint) ? query : "")?.index ?? -1;
  if (start < 0) return null;
  const token = /^[\p{L}\p{N}_?:.$-]+|^\S?/u.exec(query.slice(start))[0];
  return [start, start + token.length];
}

let running = null;

async function ask() {
  running?.abort();
  const mine = (running = new AbortController()), began = performance.now(), query = by("sparql").value;
  by("asked").textContent = "asking";
  paint();
  try {
    const answer = await fetch("/sparql", {
      method: "POST", body: query, signal: mine.signal,
      headers: { "Content-Type": "application/sparql-query", Accept: "application/sparql-results+json, text/turtle" },
    });
    const kind = answer.headers.get("Content-Type") ?? "", took = `${Math.round(performance.now() - began)} ms`;
    if (!answer.ok) refused(query, (await answer.json()).detail);
    else if (kind.startsWith("text/turtle")) show(took, coloured(await answer.text()));
    else results(await answer.json(), took);
  } catch (error) {
    if (error.name !== "AbortError") show("", h("p", { class: "card bad", text: "The server does not answer." }));
  }
}

/** Say what is wrong with a query, and put the cursor there. */
function refused(query, complaint) {
  const wrong = faultIn(query, complaint), text = by("sparql");
  show("", h("p", { class: "card bad", role: "alert", text: complaint }));
  if (!wrong || text.value !== query) return;
  paint(wrong);
  text.focus();
  text.setSelectionRange(...wrong);
}

function show(said, ...content) {
  say(by("asked"), said);
  by("answer").replaceChildren(...content);
}

/** An IRI by a prefix that every query may use; else in full. */
function named(iri) {
  const known = Object.entries(prefixes).find(([, namespace]) => iri.startsWith(namespace) && /^[\p{L}\p{N}_-]+$/u.test(iri.slice(namespace.length)));
  return known ? `${known[0]}:${iri.slice(known[1].length)}` : iri;
}

function cell(one) {
  if (one === undefined) return h("td", {});
  if (one.type !== "uri") return h("td", {}, one.value ?? "", one["xml:lang"] ? h("span", { class: "soft", text: ` @${one["xml:lang"]}` }) : null);
  if (knows(one.value)) return h("td", {}, h("button", { type: "button", class: "link", title: one.value, text: short(one.value), onclick: () => reveal(one.value) }));
  return h("td", { title: one.value }, h("span", { class: "t-name", text: named(one.value) }));
}

function results(body, took) {
  if ("boolean" in body) {
    show(took, h("p", { class: "truth", text: body.boolean ? "yes" : "no" }));
    return;
  }
  const names = body.head.vars, rows = body.results.bindings;
  show(`${rows.length} ${rows.length === 1 ? "row" : "rows"} in ${took}${rows.length > ROWS ? `; the first ${ROWS} are shown` : ""}`,
    h("div", { class: "wide", tabindex: 0, role: "region", "aria-label": "Rows" }, h("table", {}, h("thead", {}, h("tr", {}, ...names.map((text) => h("th", { scope: "col", text })))),
      h("tbody", {}, ...rows.slice(0, ROWS).map((row) => h("tr", {}, ...names.map((name) => cell(row[name]))))))));
}
