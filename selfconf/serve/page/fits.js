// Which roles of the tasks that run the chosen component plays or could play, and what keeps it out of the others.

import { h, short } from "/page/dom.js";

export class Fits {
  #asked = "";
  #asking = null;
  /** What the server has said, by task; null as long as it has not. */
  told = null;
  /** Called when it has said it. */
  changed = null;
  element = h("ul", { class: "fits" });

  /** Ask what the roles of these tasks say of a component, unless that has been asked. */
  show(iri, body, tasks) {
    const running = tasks.filter(([, task]) => !task.over);
    const about = iri && JSON.stringify([iri, body, running.map(([id]) => id)]);
    if (about !== this.#asked) {
      this.#asked = about;
      this.told = null;
      this.#asking?.abort();  // the server judges one component at a time
      this.#asking = new AbortController();
      if (iri) this.#ask(iri, this.#asking);
    }
    this.#show(iri, running);
  }

  async #ask(iri, asking) {
    let told = { trouble: "The server does not say." };
    try {
      const answer = await fetch(`/fit?component=${encodeURIComponent(iri)}`, { signal: asking.signal });
      if (answer.ok) told = (await answer.json()).tasks;
    } catch { /* it has ended; the page tries to reach it by itself */ }
    if (asking === this.#asking) {
      this.told = told;
      this.changed?.();
    }
  }

  #show(iri, running) {
    const lines = running.flatMap(([id, task]) => this.#lines(iri, task, this.told?.[id]));
    const nothing = this.told?.trouble ?? (!running.length ? "No task runs." : this.told ? "It fits no role of a task that runs, not even nearly." : "…");
    this.element.replaceChildren(...(lines.length ? lines : [h("li", { class: "soft", text: nothing })]));
  }

  #lines(iri, task, told) {
    const plays = new Set((task.configuration?.roles ?? []).filter((one) => one.components.includes(iri)).map((one) => one.role));
    const line = (kind, role, text) => h("li", { class: kind }, h("b", { text: short(role) }), h("span", { class: "soft", text: ` of ${task.name}` }), h("span", { class: "says", text }));
    if (told?.detail) return [h("li", { class: "soft", text: `${task.name}: ${told.detail}` })];
    const roles = told?.roles ?? [...plays].map((role) => ({ role, eligible: true, near: true, obstacles: [] }));
    return roles.filter((one) => one.near || plays.has(one.role)).map((one) =>
      plays.has(one.role) ? line("plays", one.role, "plays it")
        : one.eligible ? line("could", one.role, task.lost[iri] ? "could, were it not lost" : "could play it")
        : line("nearly", one.role, `nearly: ${one.obstacles.join("; ")}`));
  }
}
