// Turtle with colours: tokens become spans of text.

import { h } from "/page/dom.js";

const TOKEN = /(#[^\n]*)|("""[\s\S]*?"""|"(?:[^"\\\n]|\\.)*")|(<[^<>\s]*>)|(@?\b(?:prefix|base)\b|\ba\b(?=\s))|([\p{L}_][\p{L}\p{N}_.-]*)?:([\p{L}\p{N}_](?:[\p{L}\p{N}_.-]*[\p{L}\p{N}_-])?)?|([+-]?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?)|(\b(?:true|false)\b)/gu;

export function coloured(text) {
  const parts = [];
  let end = 0;
  for (const found of text.matchAll(TOKEN)) {
    if (found.index > end) parts.push(text.slice(end, found.index));
    const [all, comment, string, iri, word, prefix, local, number, truth] = found;
    const kind = comment ? "comment" : string ? "string" : iri ? "iri" : word ? "word" : number || truth ? "number" : "name";
    parts.push(kind === "name" && (prefix || local)
      ? h("span", { class: "t-name" }, h("span", { class: "t-prefix", text: `${prefix ?? ""}:` }), local ?? "")
      : h("span", { class: `t-${kind}`, text: all }));
    end = found.index + all.length;
  }
  parts.push(text.slice(end));
  return h("pre", { class: "turtle", tabindex: 0 }, h("code", {}, ...parts));
}
