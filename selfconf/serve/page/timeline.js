// What has happened, as a line that can be moved back along, and as sentences.

import { by, clock, h, keyed, say } from "/page/dom.js";
import { worded } from "/page/model.js";

const SENTENCES = 60, TICKS = 300;

/** The events that are worth a line, each with its number and its sentence; of what a task that waits finds again and
again, the first. */
export function sentences(events) {
  const before = new Map(), told = new Map(), found = [];
  events.forEach((event, number) => {
    const said = worded(event, before.get(event.task));
    if (event.act === "running") {
      before.set(event.task, event.configuration);
      told.delete(event.task);
    }
    if (!said) return;
    if (event.act === "waiting" || event.cause === "refused") {
      const known = told.get(event.task) ?? told.set(event.task, new Set()).get(event.task);
      if (known.has(said.text)) return;
      known.add(said.text);
    }
    found.push({ number: number + 1, event, ...said });
  });
  return found;
}

export class Timeline {
  #model; #changed; #numbers = [];

  constructor(model, changed) {
    this.#model = model;
    this.#changed = changed;
    by("moment").addEventListener("input", () => {
      const place = Number(by("moment").value);
      this.go(place >= this.#numbers.length ? null : this.#numbers[place]);
    });
    by("now").addEventListener("click", () => this.go(null));
  }

  go(number) {
    this.#model.at = number;
    this.#changed();
  }

  show() {
    const model = this.#model, all = sentences(model.events);
    this.#numbers = all.map((one) => one.number);
    const range = by("moment"), live = model.at === null;
    range.max = String(all.length);
    const place = live ? all.length : Math.max(0, this.#numbers.findLastIndex((number) => number <= model.at));
    range.value = String(place);
    const moment = live ? null : model.events[Math.max(0, model.at - 1)]?.time;
    const text = live ? "now" : clock(moment ?? 0);
    say(by("moment-says"), text);
    range.setAttribute("aria-valuetext", live ? "now" : `${text}: ${all[place]?.text ?? ""}`);
    by("now").hidden = live;
    document.body.classList.toggle("then", !live);
    const step = Math.max(1, Math.ceil(all.length / TICKS));
    const ticks = all.filter((one, number) => one.kind !== "plain" || number % step === 0).slice(-TICKS);
    keyed(by("ticks"), ticks, (one) => `${one.number} ${one.event.time}`, () => h("i", {}),
      (tick, one) => {
        tick.className = one.kind;
        tick.style.left = `${(100 * (this.#numbers.indexOf(one.number))) / Math.max(1, all.length)}%`;
      });
    const lines = all.slice(-SENTENCES).reverse();
    keyed(by("events"), lines, (one) => `${one.event.time} ${one.number}`, (one) => this.#line(one),
      (line, one) => line.firstElementChild.setAttribute("aria-current", String(!live && model.at === one.number)));
    if (!all.length) by("events").replaceChildren(h("li", { class: "none", "data-key": "none", text: "Nothing has happened since this server came." }));
  }

  #line({ number, event, kind, text }) {
    const task = event.task ? event.task.split("~")[0] : "";
    return h("li", {}, h("button", { type: "button", class: `event ${kind}`, onclick: () => this.go(number) },
      h("time", { datetime: new Date(event.time * 1000).toISOString(), text: clock(event.time) }), h("i", {}),
      h("span", { class: "what", text }), h("span", { class: "whose", text: task })));
  }
}
