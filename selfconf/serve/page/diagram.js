// The configuration of a task as a diagram that changes before one's eyes.

import { s, say, short } from "/page/dom.js";
import { layout } from "/page/layout.js";
import { did } from "/page/model.js";

const WIDE = { width: 196, height: 66, name: 21, caption: 46, edge: 16 };
const NARROW = { width: 150, height: 60, name: 20, caption: 26, edge: 12 };
const PORT = 20;
const MARGIN = 26;
const cut = (text, most) => (text.length > most ? `${text.slice(0, most - 1)}…` : text);

const because = (instead, task) => {
  const loss = task.lost[instead];
  return loss ? `instead of ${short(instead)}, which ${did(loss)}` : `instead of ${short(instead)}`;
};

/** A text as two lines of so many characters at most: broken before its reason, or between words. */
function twoLines(text, most) {
  if (text.length <= most) return [text, ""];
  const reason = text.indexOf(": ") + 1;
  const end = reason && reason <= most ? reason : text.lastIndexOf(" ", most);
  return end > 0 ? [text.slice(0, end), cut(text.slice(end + 1), most)] : [cut(text, most), ""];
}

/** The boxes and lines of a configuration: a box for each part in it, which stays when its player changes. */
function parts(configuration, box) {
  const nodes = [], of = new Map();
  const recruited = { role: "recruit", components: configuration.recruits ?? [] };
  for (const { role, components, passed_over: passed = [] } of [...configuration.roles, recruited]) {
    components.forEach((component, number) => {
      if (of.has(component)) {
        of.get(component).roles.push(role);
        return;
      }
      const node = { key: `${role} ${number}`, component, roles: [role], passed };
      of.set(component, node);
      nodes.push(node);
    });
  }
  const edges = configuration.connections
    .filter((one) => of.has(one.from.component) && of.has(one.to.component))
    .map((one) => {
      const [from, to] = [of.get(one.from.component).key, of.get(one.to.component).key];
      return { key: `${from} ${one.from.output} ${to} ${one.to.input}`, from, to, output: one.from.output, input: one.to.input };
    });
  for (const node of nodes) {
    const ports = Math.max(edges.filter((edge) => edge.to === node.key).length, edges.filter((edge) => edge.from === node.key).length);
    node.height = Math.max(box.height, (ports + 1) * PORT);
  }
  return { nodes, edges };
}

export class Diagram {
  #box = WIDE;
  #svg; #lines; #boxes; #known = new Map(); #drawn = new Map(); #task = null; #select;

  constructor(canvas, select) {
    this.#select = select;
    this.#lines = s("g", { class: "lines" });
    this.#boxes = s("g", { class: "boxes" });
    const arrow = s("marker", { id: "arrow", viewBox: "0 0 8 8", refX: 7, refY: 4, markerWidth: 7, markerHeight: 7, orient: "auto" },
      s("path", { d: "M0 0.800 7.500 4 0 7.200z", class: "arrow" }));
    this.#svg = s("svg", { class: "diagram", role: "group" }, s("defs", {}, arrow), this.#lines, this.#boxes);
    canvas.append(this.#svg);
  }

  clear() {
    this.#known.clear();
    this.#drawn.clear();
    this.#lines.replaceChildren();
    this.#boxes.replaceChildren();
    this.#svg.classList.add("empty");
    this.#task = null;
  }

  /** Show a configuration; of another task than before at once, of the same task by a movement. */
  show(id, task, selected, components, states, room) {
    const down = room < 620;
    if (id !== this.#task || (down ? NARROW : WIDE) !== this.#box) this.clear();
    this.#box = down ? NARROW : WIDE;
    this.#task = id;
    this.#svg.classList.remove("empty");
    const { nodes, edges } = parts(task.configuration, this.#box);
    const placed = layout(nodes, edges, { width: this.#box.width, down });
    const margin = down ? 6 : MARGIN, top = down ? 32 : MARGIN;
    this.#svg.classList.toggle("narrow", down);
    const [width, height] = [placed.width + 2 * margin, placed.height + top + margin + 14];
    this.#svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.#svg.style.setProperty("--natural", `${width}px`);
    this.#svg.setAttribute("aria-label", `Configuration of ${task.name}: ${nodes.length} components`);
    const high = new Map(nodes.map((node) => [node.key, node.height]));
    const at = new Map([...placed.at].map(([key, { x, y }]) => [key, { x: x + margin, y: y + top, height: high.get(key) }]));
    this.#boxesOf(nodes, at, task, selected, components, states);
    this.#linesOf(edges, at, down);
  }

  #boxesOf(nodes, at, task, selected, components, states) {
    const here = new Set(nodes.map((node) => node.key));
    for (const [key, known] of this.#known) {
      if (here.has(key)) continue;
      known.group.classList.add("gone");
      const group = known.group;
      setTimeout(() => group.remove(), 700);
      this.#known.delete(key);
    }
    for (const node of nodes) {
      const { x, y, height } = at.get(node.key), place = `translate(${x}px, ${y}px)`;
      let known = this.#known.get(node.key);
      if (!known) {
        known = this.#made(node, place);
        this.#known.set(node.key, known);
      }
      const middle = (height - this.#box.height) / 2;
      known.face.firstElementChild.setAttribute("height", height);
      known.inner.setAttribute("transform", `translate(0 ${middle})`);
      known.height = height;
      known.group.style.transform = place;
      if (known.component !== node.component) this.#swap(known, node, task);
      known.component = node.component;
      const lost = task.lost[node.component], instead = task.configuration.replaced?.[node.component];
      const note = lost ? did(lost) : instead ? because(instead, task) : "";
      const state = lost ? "lost" : states.get(node.component) ?? "";
      known.face.setAttribute("class", `face ${state}${selected === node.component ? " selected" : ""}${note && !lost ? " new" : ""}`);
      const told = twoLines(note, this.#box.caption), above = told[1] ? -19 : -6;
      told.forEach((line, number) => say(known.lines[number], line));
      known.caption.setAttribute("y", this.#box === NARROW ? above : height + 16);
      known.group.classList.toggle("composite", Boolean(components.get(node.component)?.inside));
      say(known.role, cut(node.roles.map(short).join(", "), 28));
      say(known.title, [node.component, `plays ${node.roles.map(short).join(", ")}`, note,
        node.passed.length ? `passed over: ${node.passed.map(short).join(", ")}` : ""].filter(Boolean).join("\n"));
    }
  }

  #made(node, place) {
    const known = { component: node.component };
    known.role = s("text", { class: "role", x: this.#box.edge, y: 24 });
    known.name = s("text", { class: "name", x: this.#box.edge, y: 47 });
    known.lines = [s("tspan", { x: 2 }), s("tspan", { x: 2, dy: 14 })];
    known.caption = s("text", { class: "caption", x: 2, y: this.#box.height + 16 }, ...known.lines);
    known.title = s("title", {});
    known.old = s("g", { class: "old" });
    known.face = s("g", { class: "face" }, s("rect", { width: this.#box.width, height: node.height, rx: 11 }),
      s("path", { class: "behind", d: `M8 ${node.height + 4}H${this.#box.width - 7}a11 11 0 0 0 11-11V9` }),
      known.inner = s("g", {}, s("circle", { class: "dot", cx: this.#box.width - 18, cy: 20, r: 4 }), known.role, known.name));
    const choose = () => this.#select(known.component);
    known.group = s("g", { class: "box", tabindex: 0, role: "button", onclick: choose,
      onkeydown: (event) => { if (event.key === "Enter" || event.key === " ") { event.preventDefault(); choose(); } } },
      known.title, known.face, known.old, known.caption);
    known.group.style.transform = place;  // before it is seen, or it would move there from the corner
    this.#boxes.append(known.group);  // a text has no length before it is part of the page
    this.#nameOf(known, node.component);
    return known;
  }

  /** Write the name of a component into its box, closer where it would not fit. */
  #nameOf(known, component) {
    say(known.name, cut(short(component), this.#box.name));
    known.name.removeAttribute("textLength");
    const room = this.#box.width - 2 * this.#box.edge;
    if (known.name.getComputedTextLength() > room) {
      known.name.setAttribute("lengthAdjust", "spacingAndGlyphs");
      known.name.setAttribute("textLength", room);
    }
  }

  /** One component takes over from another: the old name leaves, struck through, and the new one comes in. */
  #swap(known, node, task) {
    const loss = task.lost[known.component];
    const leaving = s("g", { class: `leaving${loss ? " failed" : ""}` }, s("rect", { width: this.#box.width, height: known.height, rx: 11 }),
      s("text", { class: "name", x: this.#box.edge, y: 47 + (known.height - this.#box.height) / 2, text: cut(short(known.component), this.#box.name) }));
    known.old.replaceChildren(leaving);
    leaving.addEventListener("animationend", () => leaving.remove());
    this.#nameOf(known, node.component);
    known.name.classList.remove("arriving");
    known.group.getBoundingClientRect();  // so that the movement begins anew
    known.name.classList.add("arriving");
    for (const line of this.#drawn.values()) {
      if (line.from === node.key || line.to === node.key) {
        line.path.classList.remove("fresh");
        line.path.getBoundingClientRect();
        line.path.classList.add("fresh");
      }
    }
  }

  #linesOf(edges, at, down) {
    const here = new Set(edges.map((edge) => edge.key));
    for (const [key, line] of this.#drawn) {
      if (here.has(key)) continue;
      line.group.remove();
      this.#drawn.delete(key);
    }
    const ins = new Map(), outs = new Map();
    for (const edge of edges) {
      ins.set(edge.to, [...(ins.get(edge.to) ?? []), edge]);
      outs.set(edge.from, [...(outs.get(edge.from) ?? []), edge]);
    }
    const side = down ? "x" : "y";
    for (const list of ins.values()) list.sort((a, b) => at.get(a.from)[side] - at.get(b.from)[side]);
    for (const list of outs.values()) list.sort((a, b) => at.get(a.to)[side] - at.get(b.to)[side]);
    const port = (list, edge, length) => ((list.indexOf(edge) + 1) * length) / (list.length + 1);
    for (const edge of edges) {
      const a = at.get(edge.from), b = at.get(edge.to), length = (one) => (down ? this.#box.width : one.height);
      const [p, q] = [port(outs.get(edge.from), edge, length(a)), port(ins.get(edge.to), edge, length(b))];
      const from = down ? { x: a.x + p, y: a.y + a.height } : { x: a.x + this.#box.width, y: a.y + p };
      const to = down ? { x: b.x + q, y: b.y - 2 } : { x: b.x - 2, y: b.y + q };
      const last = down ? to.y - 24 : to.x - 62;  // it ends straight, so that there is room for the name of the input
      const bend = Math.max(34, Math.abs(last - (down ? from.y : from.x)) / 2);
      const path = down
        ? `M${from.x} ${from.y}C${from.x} ${from.y + bend} ${to.x} ${last - bend} ${to.x} ${last}L${to.x} ${to.y}`
        : `M${from.x} ${from.y}C${from.x + bend} ${from.y} ${last - bend} ${to.y} ${last} ${to.y}L${to.x} ${to.y}`;
      let line = this.#drawn.get(edge.key);
      if (!line) {
        line = { from: edge.from, to: edge.to, path: s("path", { class: "line fresh", "marker-end": "url(#arrow)", pathLength: 1 }),
          label: s("text", { class: "port" }), title: s("title", { text: `${edge.output} → ${edge.input}` }) };
        line.group = s("g", { class: "wire" }, line.title, line.path, line.label);
        this.#drawn.set(edge.key, line);
        this.#lines.append(line.group);
      }
      line.path.setAttribute("d", path);
      say(line.label, cut(edge.input, 14));
      line.label.setAttribute("x", down ? to.x + 6 : to.x - 11);
      line.label.setAttribute("y", down ? to.y - 9 : to.y - 5);
      line.label.setAttribute("text-anchor", down ? "start" : "end");
    }
  }
}
