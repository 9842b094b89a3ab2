// What the chosen component issues and prints, as it comes; the server hears of it only while this is looked at.

import { clock, h, keyed, plain, say, short } from "/page/dom.js";

const MOST_LINES = 300, AGAIN = 2000;

/** A value for the eye: numbers of four digits, names in place of IRIs; all of it is in the title. */
function seen(value) {
  if (typeof value === "number") {
    return Number.isInteger(value) ? String(value) : Math.abs(value) < 1000 ? String(Number(value.toPrecision(4))) : value.toFixed(1);
  }
  if (Array.isArray(value)) return `[${value.map(seen).join(", ")}]`;
  if (typeof value === "string") return /^(https?:|urn:)/.test(value) ? short(value) : value;
  return JSON.stringify(value);
}

/** The fields of a signal, each with its name; of what is no JSON object its text. */
function fields(text) {
  let value = null;
  try { value = JSON.parse(text); } catch { /* it was shortened, or is described */ }
  if (value === null || typeof value !== "object" || Array.isArray(value)) return [h("span", { text })];
  return Object.entries(value).map(([name, one]) => h("span", {}, h("i", { text: name }), ` ${seen(one)}`));
}

export class Look {
  #stream = null; #iri = ""; #about = ""; #signals = new Map(); #lines = []; #trouble = ""; #number = 0;
  /** The elements, which stay, so that neither focus nor scrolling is lost. */
  signals = h("ul", { class: "signals" });
  log = h("ol", { class: "log", tabindex: 0, "aria-label": "What it has printed" });

  constructor() {
    document.addEventListener("visibilitychange", () => this.#follow());
    setInterval(() => this.#iri && this.#showSignals(), 1000);  // so that their ages grow
  }

  /** Look at a component, anew where it is advertised with other outputs or by another site; an empty IRI: at none. */
  show(iri, body) {
    const about = JSON.stringify(iri && [iri, body.site, body.outputs]);
    if (about === this.#about) return;
    [this.#iri, this.#about] = [iri, about];
    this.#signals = new Map(iri ? body.outputs.map((port) => [port.name, null]) : []);
    [this.#lines, this.#trouble] = [[], ""];
    this.#stream?.close();
    this.#stream = null;
    this.#showSignals();
    this.#showLog("…");
    this.#follow();
  }

  #follow() {
    if (!this.#iri || document.hidden) {
      this.#stream?.close();
      this.#stream = null;
    } else if (!this.#stream) {
      this.#stream = new EventSource(`/look?component=${encodeURIComponent(this.#iri)}`);
      this.#stream.addEventListener("signals", (event) => this.#heard(JSON.parse(event.data)));
      this.#stream.addEventListener("log", (event) => this.#printed(JSON.parse(event.data)));
      this.#stream.addEventListener("error", (event) => this.#refused(event.target));
    }
  }

  /** Ask again where a stream was refused, as by a server that has just begun: a browser itself does not. */
  #refused(stream) {
    if (stream !== this.#stream || stream.readyState !== EventSource.CLOSED) return;
    this.#stream = null;
    setTimeout(() => this.#follow(), AGAIN);
  }

  #heard(signals) {
    const now = Date.now();
    for (const [port, signal] of Object.entries(signals)) {
      const before = this.#signals.get(port);
      // A glance that has just begun knows no rate yet: that of the last one holds.
      this.#signals.set(port, { ...signal, rate: signal.rate ?? before?.rate ?? null, at: now });
    }
    this.#showSignals();
  }

  #showSignals() {
    keyed(this.signals, [...this.#signals], ([port]) => port,
      ([port]) => h("li", {}, h("b", { text: port }), h("span", { class: "rate" }), h("code", {})),
      (item, [, signal]) => {
        const [, rate, text] = item.children, passed = signal ? Math.floor((Date.now() - signal.at) / 1000) : 0;
        const stale = passed > Math.max(3, 3 / (signal?.rate || 1));
        item.classList.toggle("stale", !signal || stale);
        say(rate, !signal ? "nothing yet" : stale ? `${passed} s ago` : signal.rate ? `${signal.rate.toFixed(1)}/s` : "");
        const says = signal?.trouble ?? signal?.text ?? "";
        if (text.title !== plain(says)) {
          text.title = plain(says);
          text.replaceChildren(...(signal?.trouble ? [says] : says ? fields(says) : []));
        }
        text.classList.toggle("bad", Boolean(signal?.trouble));
      });
  }

  #printed({ lines, anew, trouble }) {
    this.#trouble = trouble ?? "";
    if (anew) this.#lines = [];
    for (const line of lines ?? []) this.#lines.push({ ...line, number: String((this.#number += 1)) });
    this.#lines.splice(0, this.#lines.length - MOST_LINES);
    this.#showLog("It has printed nothing that its site has kept.");
  }

  #showLog(nothing) {
    const atEnd = this.log.scrollTop + this.log.clientHeight >= this.log.scrollHeight - 8;
    const shown = this.#lines.length ? this.#lines : [{ number: "none", text: this.#trouble || nothing, stream: "none" }];
    keyed(this.log, shown, (line) => line.number, () => h("li", {}, h("time", {}), h("span", {})),
      (item, line) => {
        item.className = line.stream;
        say(item.firstElementChild, line.time ? clock(Date.parse(line.time) / 1000) : "");
        say(item.lastElementChild, line.text);
      });
    if (atEnd) this.log.scrollTop = this.log.scrollHeight;
  }
}
