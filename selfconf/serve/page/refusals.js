// Near misses and relaxations of a task that waits or was refused, which the server finds while the refusal is shown.

export class ExplainedRefusals {
  #asked = "";
  #asking = null;
  #told = null;
  /** Called when the server has said it. */
  changed = null;

  /** The refusal of a task with all that is known of it; asks the server once for each refusal. */
  refusal(id, task, live) {
    const body = task?.refusal;
    if (!body || !live || body.repairs?.length) return body;  // with repairs, its configurator has found out the rest
    const about = JSON.stringify([id, body.reasons, body.message, Object.keys(task.lost)]);
    if (about !== this.#asked) {
      this.#asked = about;
      this.#told = { pending: true };
      this.#asking?.abort();  // the server makes one search at a time
      this.#asking = new AbortController();
      this.#ask(id, this.#asking);
    }
    return { ...body, ...this.#told };
  }

  async #ask(id, asking) {
    let told = {};
    try {
      const answer = await fetch(`/mend?task=${encodeURIComponent(id)}`, { signal: asking.signal });
      if (answer.ok) told = await answer.json();
    } catch { /* the server has ended; the page tries to reach it by itself */ }
    if (asking === this.#asking) {
      this.#told = told.reasons ? told : { detail: told.detail };
      this.changed?.();
    }
  }
}
