// What is known of the ecology, now and at each moment that is remembered.

import { short } from "/page/dom.js";

const SETTLED = new Set(["running", "waiting", "refused", "stopped", "detached"]);
const OVER = new Set(["refused", "stopped", "detached"]);

export class Model {
  components = new Map();
  sites = new Map();
  tasks = new Map();
  events = [];
  /** The number of events that are seen; null: all, and what is live. */
  at = null;
  ecology = "";

  begin(state) {
    this.ecology = state.ecology;
    this.components = new Map(Object.entries(state.components));
    this.sites = new Map(Object.entries(state.sites));
    this.tasks = new Map(Object.entries(state.tasks));
    this.events = state.events;
    this.at = null;
  }

  apply(change) {
    for (const kind of ["components", "sites", "tasks"]) {
      for (const [name, body] of Object.entries(change[kind] ?? {})) {
        if (body === null) this[kind].delete(name);
        else this[kind].set(name, body);
      }
    }
    this.events.push(...(change.events ?? []));
    const over = this.events.length - 4000;
    if (over > 0) {
      this.events.splice(0, over);
      if (this.at !== null) this.at = Math.max(0, this.at - over);
    }
  }

  get seen() {
    return this.at === null ? this.events : this.events.slice(0, this.at);
  }

  /** The tasks as they are, or were: running ones first, then by priority; those inside of composites after their own. */
  tasksSeen() {
    const found = [...(this.at === null ? this.tasks : this.#tasksThen())];
    found.sort(([, a], [, b]) => a.over - b.over || b.priority - a.priority || a.beginning - b.beginning);
    const holders = new Map(found.map(([id, task]) => [id, holderOf(task, found)]));
    const after = (id) => found.filter(([one]) => holders.get(one) === id).flatMap((one) => [one, ...after(one[0])]);
    return after("");
  }

  #tasksThen() {
    const found = new Map();
    for (const event of this.seen) {
      if (!event.task) continue;
      const now = this.tasks.get(event.task);
      const task = found.get(event.task) ?? {
        ...(now ?? { name: event.task.split("~")[0], priority: 0, beginning: event.time, template: "" }),
        phase: "composing", over: false, configuration: null, refusal: null, lost: {}, since: event.time, owed: [],
        dropped: {}, components: [],
      };
      const next = { ...task };
      if (event.act === "lost") next.lost = { ...task.lost, [event.component]: event };
      if (event.act === "running" && event.configuration) {
        const replaced = replacements(task.configuration ?? task.before, event.configuration);
        const configuration = { ...event.configuration, replaced: Object.fromEntries(replaced.map((one) => [one.component, one.instead])) };
        Object.assign(next, { configuration, before: configuration, refusal: null, epoch: event.epoch });
        next.components = [
          ...event.configuration.roles.flatMap((role) => role.components), ...(event.configuration.recruits ?? [])];
      }
      if (event.act === "waiting" || event.act === "refused") {
        Object.assign(next, { configuration: null, refusal: event.refusal, components: [] });
      }
      if (SETTLED.has(event.act)) Object.assign(next, { phase: event.act, since: event.time });
      if (OVER.has(event.act)) Object.assign(next, { over: true, configuration: null, components: [] });
      found.set(event.task, next);
    }
    return found;
  }

  /** The configuration that a task had last; null if it never had one. */
  ranLast(id) {
    return this.#tasksThen().get(id)?.before ?? null;
  }

  /** The state of each component whose state was another then. */
  statesThen() {
    const then = new Map();
    if (this.at === null) return then;
    for (const event of this.events.slice(this.at)) {
      if (then.has(event.component)) continue;
      if (event.act === "ended") then.set(event.component, "alive");
      if (event.act === "began") {
        const now = this.components.get(event.component);
        then.set(event.component, now?.state === "alive" ? "not there yet" : now?.state);
      }
    }
    return then;
  }

  /** Which task holds which component, and which have lost one. */
  claims() {
    const held = new Map(), lost = new Map();
    for (const [id, task] of this.tasksSeen()) {
      if (task.over) continue;
      for (const component of task.components) held.set(component, [...(held.get(component) ?? []), { id, ...task }]);
      for (const [component, why] of Object.entries(task.lost)) lost.set(component, why);
    }
    for (const component of held.keys()) lost.delete(component);  // the task that has it now can use it
    return { held, lost };
  }
}

/** The task that holds the composite of which another one is the inside; empty for what stands by itself. */
function holderOf(inside, tasks) {
  const found = inside.inside_of && tasks.find(([, task]) => task !== inside && task.components.includes(inside.inside_of));
  return found ? found[0] : "";
}

/** What has changed from one configuration to the next: which component took over which role from which other. */
export function replacements(before, after) {
  const found = [];
  for (const { role, components } of after?.roles ?? []) {
    const old = before?.roles.find((one) => one.role === role)?.components ?? [];
    const gone = old.filter((one) => !components.includes(one));
    for (const [number, one] of components.filter((each) => !old.includes(each)).entries()) {
      if (gone[number]) found.push({ role, component: one, instead: gone[number] });
    }
  }
  return found;
}

const DID = { fail: "failed", crash: "crashed", silence: "fell silent", refused: "refused", hung: "hangs",
  malformed: "sent malformed signals", yield: "went to another task", "let go": "let go of the task" };

/** What a component that is lost did, as the end of a sentence that begins with its name. */
export const did = (loss) => [DID[loss.cause] ?? `was lost (${loss.cause})`, loss.detail].filter(Boolean).join(": ");

/** Who plays in a configuration, in a few words. */
function players(configuration) {
  const names = (configuration?.roles ?? []).flatMap((one) => one.components).map(short);
  const more = names.length > 6 ? ` and ${names.length - 5} more` : "";
  return names.length ? `: ${names.slice(0, more ? 5 : 6).join(", ")}${more}` : "";
}

/** An event in a sentence, its kind for the eye, and whether it is worth a line. */
export function worded(event, before) {
  const component = short(event.component);
  switch (event.act) {
    case "lost": return { kind: event.cause === "refused" || event.cause === "yield" ? "warn" : "bad", text: `${component} ${did(event)}` };
    case "running": {
      const changes = replacements(before, event.configuration);
      const text = changes.map((one) => `${short(one.component)} takes over ${short(one.role)} from ${short(one.instead)}`);
      return { kind: "good", text: text.length ? text.join("; ") : `the configuration runs${players(event.configuration)}` };
    }
    case "waiting": return { kind: "warn", text: "there is no configuration; the task waits" };
    case "refused": return { kind: "bad", text: "there is no configuration; the task has ended" };
    case "stopped": return { kind: "plain", text: "the task was taken down" };
    case "detached": return { kind: "plain", text: "handed to the sites" };
    case "waking": return { kind: "plain", text: `${component} is started by its site` };
    case "awaiting": return { kind: "warn", text: `${component} is held by another task; waiting for it` };
    case "declined": return { kind: "warn", text: `${component} declines: ${event.detail}` };
    case "unreachable": return { kind: "bad", text: `${component} cannot be reached: ${event.detail}` };
    case "left out": return { kind: "warn", text: `${component} is left out: ${event.reason}` };
    case "complaint": return { kind: "warn", text: String(event.detail) };
    case "cut off": return { kind: "bad", text: "the configurator is cut off from the ecology" };
    case "connected": return { kind: "good", text: "the configurator is connected again" };
    case "began": return { kind: "plain", text: `${component} lives` };
    case "ended": return { kind: "warn", text: `${component} lives no more` };
    case "site came": return { kind: "plain", text: `the site ${event.site} is there` };
    case "site left": return { kind: "bad", text: `the site ${event.site} has gone` };
    default: return null;
  }
}
