// Where the boxes of a diagram stand: layers from sources to sinks, ordered so that few lines cross (Sugiyama).

/** The layer of each node: one more than that of the farthest that feeds it; a circle is cut where it closes. */
function layers(nodes, edges) {
  const feeds = new Map(nodes.map((node) => [node.key, []]));
  for (const edge of edges) if (edge.from !== edge.to) feeds.get(edge.to)?.push(edge.from);
  const layer = new Map(), open = new Set();
  const deep = (key) => {
    if (layer.has(key)) return layer.get(key);
    if (open.has(key)) return -1;
    open.add(key);
    const found = Math.max(-1, ...feeds.get(key).map(deep)) + 1;
    open.delete(key);
    layer.set(key, found);
    return found;
  };
  nodes.forEach((node) => deep(node.key));
  return layer;
}

function ordered(rows, edges) {
  const places = () => new Map(rows.flatMap((row) => row.map((key, number) => [key, number - (row.length - 1) / 2])));
  for (let sweep = 0; sweep < 6; sweep++) {
    const at = places();
    const near = sweep % 2 ? (edge) => [edge.from, edge.to] : (edge) => [edge.to, edge.from];
    const pull = new Map();
    for (const edge of edges) {
      const [key, other] = near(edge);
      pull.set(key, [...(pull.get(key) ?? []), at.get(other)]);
    }
    const middle = (key) => {
      const values = pull.get(key);
      return values ? values.reduce((sum, value) => sum + value, 0) / values.length : at.get(key);
    };
    rows = rows.map((row) => row.map((key) => [middle(key), key]).sort((a, b) => a[0] - b[0]).map(([, key]) => key));
  }
  return rows;
}

/** The corner of each box, and the size of the whole; `down` stacks the layers, for a narrow screen.

Boxes are as wide as `width`, and as high as each says. */
export function layout(nodes, edges, { width, down }) {
  const high = new Map(nodes.map((node) => [node.key, node.height]));
  const layer = layers(nodes, edges);
  let rows = [];
  for (const node of nodes) (rows[layer.get(node.key)] ??= []).push(node.key);
  rows = ordered(rows, edges);
  const gap = down ? { along: 74, across: 16 } : { along: 104, across: 44 };
  const across = (key) => (down ? width : high.get(key));
  const along = (row) => (down ? Math.max(...row.map((key) => high.get(key))) : width);
  const breadth = (row) => row.reduce((sum, key) => sum + across(key), 0) + (row.length - 1) * gap.across;
  const size = Math.max(0, ...rows.map(breadth));
  const at = new Map();
  let start = 0;
  for (const row of rows) {
    let place = (size - breadth(row)) / 2;
    for (const key of row) {
      at.set(key, down ? { x: place, y: start } : { x: start, y: place });
      place += across(key) + gap.across;
    }
    start += along(row) + gap.along;
  }
  const length = Math.max(0, start - gap.along);
  return { at, width: down ? size : length, height: down ? length : size };
}
