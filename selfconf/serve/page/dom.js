// Elements, made of text and never of markup: whatever a stranger wrote stays text, and turns no line around.

const SVG = "http://www.w3.org/2000/svg";

/** A text with control characters, and those that change the direction of writing, spelt out as the terminal has them. */
export const plain = (text) =>
  String(text).replace(/[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]/g, (found) => {
    if (found === "\r") return "\\r";
    const code = found.charCodeAt(0).toString(16);
    return code.length < 3 ? `\\x${code.padStart(2, "0")}` : `\\u${code.padStart(4, "0")}`;
  });

function filled(element, facts, children) {
  for (const [name, value] of Object.entries(facts ?? {})) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name === "text") element.textContent = plain(value);
    else element.setAttribute(name, value === true ? "" : name === "title" || name.startsWith("aria-") ? plain(value) : value);
  }
  const shown = children.flat().filter((child) => child !== null && child !== undefined && child !== false);
  element.append(...shown.map((child) => (child instanceof Node ? child : plain(child))));
  return element;
}

export const h = (tag, facts, ...children) => filled(document.createElement(tag), facts, children);
export const s = (tag, facts, ...children) => filled(document.createElementNS(SVG, tag), facts, children);
export const by = (id) => document.getElementById(id);

/** Let a parent hold one child for each item, in order; a child stays as long as its key does, and so does the focus. */
export function keyed(parent, items, key, make, update) {
  const old = new Map([...parent.children].map((child) => [child.dataset.key, child]));
  let before = parent.firstElementChild;
  for (const item of items) {
    const name = key(item);
    let child = old.get(name);
    if (child) old.delete(name);
    else {
      child = make(item);
      child.dataset.key = name;
    }
    update?.(child, item);
    if (child === before) before = before.nextElementSibling;
    else parent.insertBefore(child, before);
  }
  for (const child of old.values()) child.remove();
}

/** Change a text only if it is another, so that nothing is selected or read anew in vain. */
export function say(element, text) {
  if (element.textContent !== plain(text)) element.textContent = plain(text);
}

export const short = (iri) => String(iri ?? "").replace(/[#/]+$/, "").split(/[#/]/).pop();

export const clock = (seconds) =>
  new Date(seconds * 1000).toLocaleTimeString([], { hour: "2-digit", minute: "2-digit", second: "2-digit", hour12: false });

export function ago(seconds) {
  const passed = Math.max(0, Date.now() / 1000 - seconds);
  if (passed < 60) return `${Math.floor(passed)} s`;
  if (passed < 3600) return `${Math.floor(passed / 60)} min`;
  if (passed < 86400) return `${Math.floor(passed / 3600)} h`;
  return `${Math.floor(passed / 86400)} d`;
}
