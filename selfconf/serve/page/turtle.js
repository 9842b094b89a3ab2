// Turtle and SPARQL with colours: tokens become spans of text.

import { h } from "/page/dom.js";

const TOKEN = /(#[^\n]*)|("""[\s\S]*?"""|"(?:[^"\\\n]|\\.)*")|(<[^<>\s]*>)|([?$][\p{L}\p{N}_]+)|([\p{L}_][\p{L}\p{N}_.-]*)?:([\p{L}\p{N}_](?:[\p{L}\p{N}_.-]*[\p{L}\p{N}_-])?)?|([+-]?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?)|(\b(?:true|false)\b)|(@?\b[A-Za-z]+\b)/gu;

/** The tokens of a text as spans with colours, and what lies between them. */
export function tokens(text) {
  const parts = [];
  let end = 0;
  for (const found of text.matchAll(TOKEN)) {
    if (found.index > end) parts.push(text.slice(end, found.index));
    const [all, comment, string, iri, variable, prefix, local, number, truth, word] = found;
    const kind = comment ? "comment" : string ? "string" : iri ? "iri" : variable ? "variable" : number || truth ? "number" : word ? "word" : "name";
    parts.push(kind === "name" && (prefix || local)
      ? h("span", { class: "t-name" }, h("span", { class: "t-prefix", text: `${prefix ?? ""}:` }), local ?? "")
      : h("span", { class: `t-${kind}`, text: all }));
    end = found.index + all.length;
  }
  return [...parts, text.slice(end)];
}

export const coloured = (text) => h("pre", { class: "turtle", tabindex: 0, role: "region", "aria-label": "Turtle" }, h("code", {}, ...tokens(text)));
