// The page: it hears of each change of the ecology, and shows it.

import { by, plain, say } from "/page/dom.js";
import { Diagram } from "/page/diagram.js";
import { Model, worded } from "/page/model.js";
import { Fits } from "/page/fits.js";
import { Look } from "/page/look.js";
import { ExplainedRefusals } from "/page/refusals.js";
import { below, forget, showComponents, showDetail, showTasks, taskHead } from "/page/panels.js";
import { lend, prepareQuery } from "/page/query.js";
import { Timeline } from "/page/timeline.js";

const model = new Model();
let chosen = null, selected = "", drawing = false, belowSays = "";
const diagram = new Diagram(by("canvas"), select);
const look = new Look(), fits = new Fits(), refusals = new ExplainedRefusals();
fits.changed = refusals.changed = draw;
const timeline = new Timeline(model, draw);

function draw() {
  if (!drawing) {
    drawing = true;
    requestAnimationFrame(() => { drawing = false; render(); });
  }
}

function select(iri) {
  selected = selected === iri ? "" : iri;
  draw();
  // On a narrow screen it is shown above the list in which it was chosen.
  if (selected) requestAnimationFrame(() => by("detail").scrollIntoView({ block: "nearest" }));
}

function choose(id) {
  chosen = id;
  draw();
}

function render() {
  const tasks = model.tasksSeen();
  if (!tasks.some(([id]) => id === chosen)) chosen = tasks[0]?.[0] ?? null;
  const task = tasks.find(([id]) => id === chosen)?.[1] ?? null;
  showTasks(tasks, chosen, choose);
  by("task-head").replaceChildren(...taskHead(task, model.at === null));
  const then = model.statesThen();
  const states = new Map([...model.components].map(([iri, one]) => [iri, then.get(iri) ?? one.state]));
  const canvas = by("canvas");
  const last = task?.over && !task.refusal ? model.ranLast(chosen) : null;
  const configuration = task?.configuration ?? last;
  if (configuration) diagram.show(chosen, { ...task, configuration }, selected, model.components, states, canvas.clientWidth);
  else diagram.clear();
  canvas.classList.toggle("last", Boolean(last));
  by("legend").hidden = !configuration;
  say(by("legend"), last ? `The task is over: ${task.phase}. This ran last; the line below leads back to what ran before.` : LEGEND);
  canvas.hidden = Boolean(task && !task.configuration && task.refusal);
  canvas.dataset.says = configuration ? "" : task ? nothing(task) : "No task runs. What lives is listed beside.";
  const refusal = refusals.refusal(chosen, task, model.at === null);
  const facts = JSON.stringify([chosen, task?.lost, task?.owed, task?.dropped, refusal]);
  if (facts !== belowSays) {
    belowSays = facts;
    by("below").replaceChildren(...below(task, refusal, select));
  }
  showComponents(model, selected, select, by("filter").value);
  showDetail(model, selected, select, choose, look, fits);
  timeline.show();
  const alive = [...model.components.values()].filter((one) => one.state === "alive").length;
  say(by("tally"), `${alive} of ${model.components.size} components alive · ${model.sites.size} ${model.sites.size === 1 ? "site" : "sites"}`);
  say(by("ecology"), model.ecology || "selfconf");
  document.title = `${model.ecology || "ecology"} · selfconf`;
}

const nothing = (task) => (task.over ? `This task is over: ${task.phase}.` : task.refusal ? "" : `No configuration yet: ${task.phase}.`);
const LEGEND = "Each box is a role and, in bold, the component that plays it. Arrows are signals, named after the inputs that they feed.";

// Hearing of changes.

async function begin() {
  const answer = await fetch("/state");
  const state = await answer.json();
  model.begin(state);
  forget(selected);
  lend(state.prefixes);
  draw();
  const stream = new EventSource(`/changes?last=${encodeURIComponent(state.last)}`);
  stream.addEventListener("change", (event) => {
    const change = JSON.parse(event.data);
    const newest = change.events?.length ?? 0;
    model.apply(change);
    for (const iri of Object.keys(change.components ?? {})) forget(iri);
    if (newest) announce(change.events);
    draw();
  });
  stream.addEventListener("reset", () => { stream.close(); again(); });
  stream.addEventListener("open", () => linked(true));
  stream.addEventListener("error", () => {
    linked(false);
    if (stream.readyState === EventSource.CLOSED) again();
  });
}

let waiting = 0;

function again() {
  clearTimeout(waiting);
  waiting = setTimeout(() => begin().catch(() => { linked(false); again(); }), 1000);
}

function linked(yes) {
  const line = by("link");
  line.classList.toggle("live", yes);
  say(line, yes ? "live" : "not connected");
}

function announce(events) {
  const said = events.map((event) => worded(event, null)).filter((one) => one && one.kind !== "plain").at(-1);
  if (said) by("said").textContent = plain(said.text);  // also what was said before is said anew
}

// Views and themes.

function view(name) {
  by("main").hidden = name !== "ecology";
  by("query").hidden = name !== "query";
  by("show-ecology").setAttribute("aria-pressed", String(name === "ecology"));
  by("show-query").setAttribute("aria-pressed", String(name === "query"));
  history.replaceState(null, "", name === "query" ? "#query" : "#");
  if (name === "query") by("sparql").focus();
  draw();
}

function theme(name) {
  if (name) document.documentElement.dataset.theme = name;
  try { if (name) localStorage.setItem("theme", name); } catch { /* a browser may keep nothing */ }
}

try { theme(localStorage.getItem("theme")); } catch { /* a browser may keep nothing */ }
by("theme").addEventListener("click", () => {
  const now = document.documentElement.dataset.theme ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
  theme(now === "dark" ? "light" : "dark");
});
by("show-ecology").addEventListener("click", () => view("ecology"));
by("show-query").addEventListener("click", () => view("query"));
by("filter").addEventListener("input", draw);
addEventListener("resize", draw);
addEventListener("keydown", (event) => {
  const writing = event.target.matches("input[type=search], textarea");
  if (event.key === "Escape" && selected) select(selected);
  if (event.key === "/" && !writing) { event.preventDefault(); view("ecology"); by("filter").focus(); }
});
setInterval(() => { if (model.at === null) draw(); }, 10000);
prepareQuery((iri) => model.components.has(iri), (iri) => {
  selected = iri;
  view("ecology");
});
if (location.hash === "#query") view("query");
begin().catch(() => { linked(false); again(); });
