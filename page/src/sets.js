// Colours of sets and owners: rows of the legend, and which faces, hexes and nodes have them.

export const setKeys = { owner: 'owner of nodes', nodeset: 'nodeset', sideset: 'sideset', group: 'group' };

/** { rows: [{ text, count, colour, kind, id, position }], hex, side, node: maps from numbers to rows }; the first row counts. */
export async function setRows(scene, key) {
  const rows = [], hex = new Map(), side = new Map(), node = new Map();
  const put = (map, list, row) => { for (const i of list ?? []) if (!map.has(i)) map.set(i, row); };
  if (key === 'owner') {
    const { owner_dim, node: nodes } = scene.skin;
    for (const [dim, text] of ['nodes of vertices', 'nodes of curves', 'nodes of surfaces'].entries()) {
      const some = nodes.filter((n, i) => owner_dim[i] === dim);
      put(node, some, rows.length);
      rows.push({ text, count: some.length, colour: dim + 1, kind: 'node', nodes: some });
    }
    return { rows, hex, side, node };
  }
  const sets = await scene.sets();
  scene.meta[key].forEach(([id, name, count], position) => {
    const row = rows.length;
    rows.push({ text: `${key} ${id}${name ? ` ${name}` : ''}`, count, colour: row, kind: key, id, position });
    if (key === 'nodeset') put(node, sets[`nodeset ${id}`], row);
    if (key === 'sideset') put(side, sets[`sideset ${id}`], row);
    if (key === 'group') {
      put(hex, sets[`group ${id} hexes`], row);
      put(side, sets[`group ${id} sides`], row);
      put(node, sets[`group ${id} nodes`], row);
    }
  });
  return { rows, hex, side, node };
}

/** The row of a face that is drawn, undefined where it has none: a side is seen from either hex. */
export function rowOf(scene, sets, hex, side) {
  const here = sets.side.get(6 * hex + side);
  if (here !== undefined) return here;
  if (sets.side.size && scene.insideNow) {
    const { ofHex, sides } = scene.insideNow.faces, face = ofHex[6 * hex + side];
    const there = sets.side.get(sides[2 * face] === 6 * hex + side ? sides[2 * face + 1] : sides[2 * face]);
    if (there !== undefined) return there;
  }
  return sets.hex.get(hex);
}
