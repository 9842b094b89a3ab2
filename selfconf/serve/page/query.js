// Questions in SPARQL, and answers as a table, a truth value, or Turtle.

import { by, h, say, short } from "/page/dom.js";
import { coloured } from "/page/turtle.js";

const EXAMPLES = {
  "Who is there": `SELECT ?component ?type ?place WHERE {
  ?component a sc:Component, ?type .
  OPTIONAL { ?component rob:place ?place }
  FILTER (?type != sc:Component)
} ORDER BY ?type ?component`,
  "Who feeds whom": `SELECT ?source ?output ?sink ?input WHERE {
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
  "Outputs nobody could follow": `SELECT ?component ?output ?signal WHERE {
  ?component sc:hasOutput [ sc:name ?output ; sc:signalType ?signal ] .
  FILTER NOT EXISTS { [] sc:hasInput [ sc:signalType ?signal ] }
}`,
  "One component, as a graph": `DESCRIBE ?component WHERE { ?component a sc:Component } LIMIT 1`,
};
const ROWS = 1000;

export function prepareQuery() {
  const text = by("sparql");
  by("examples").append(...Object.entries(EXAMPLES).map(([name, query]) =>
    h("button", { type: "button", class: "chip", text: name, onclick: () => { text.value = query; ask(); } })));
  text.value = Object.values(EXAMPLES)[0];
  text.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) ask();
  });
  by("ask").addEventListener("click", ask);
}

let running = null;

async function ask() {
  running?.abort();
  const mine = (running = new AbortController()), began = performance.now();
  by("asked").textContent = "asking";
  try {
    const answer = await fetch("/sparql", {
      method: "POST", body: by("sparql").value, signal: mine.signal,
      headers: { "Content-Type": "application/sparql-query", Accept: "application/sparql-results+json, text/turtle" },
    });
    const kind = answer.headers.get("Content-Type") ?? "", took = `${Math.round(performance.now() - began)} ms`;
    if (!answer.ok) show(`${answer.status}`, h("p", { class: "card bad", text: (await answer.json()).detail }));
    else if (kind.startsWith("text/turtle")) show(took, coloured(await answer.text()));
    else results(await answer.json(), took);
  } catch (error) {
    if (error.name !== "AbortError") show("", h("p", { class: "card bad", text: "The server does not answer." }));
  }
}

function show(said, ...content) {
  say(by("asked"), said);
  by("answer").replaceChildren(...content);
}

function results(body, took) {
  if ("boolean" in body) {
    show(took, h("p", { class: "truth", text: body.boolean ? "yes" : "no" }));
    return;
  }
  const names = body.head.vars, rows = body.results.bindings;
  const cell = (one) => (one === undefined ? h("td", {})
    : one.type === "uri" ? h("td", { title: one.value }, h("span", { class: "t-name", text: short(one.value) }))
    : h("td", { text: one.value ?? "" }));
  show(`${rows.length} ${rows.length === 1 ? "row" : "rows"} in ${took}${rows.length > ROWS ? `; the first ${ROWS} are shown` : ""}`,
    h("div", { class: "wide" }, h("table", {}, h("thead", {}, h("tr", {}, ...names.map((text) => h("th", { scope: "col", text })))),
      h("tbody", {}, ...rows.slice(0, ROWS).map((row) => h("tr", {}, ...names.map((name) => cell(row[name]))))))));
}
