// Faces, edges and sheets of hexes, numbered as mesh/topology.h and mesh/sheets.h number them.
//
// Corner c of a hex lies at (c & 1, c >> 1 & 1, c >> 2 & 1); edge 4 * axis + k runs along axis, face 2 * axis + side
// lies across it (mesh/corners.h).

const spread = (axis, k) => (axis === 0 ? k << 1 : axis === 1 ? (k & 1) | ((k & 2) << 1) : k);
const gather = (axis, c) => (axis === 0 ? c >> 1 : axis === 1 ? (c & 1) | ((c >> 1) & 2) : c & 3);

/** Per face its corners in a cycle, counter-clockwise from outside. */
export const faceCycle = [0, 1, 2, 3, 4, 5].map((face) => {
  const corner = (k) => spread(face >> 1, k) | ((face & 1) << (face >> 1));
  const outward = ((face & 1) === 1) === (face >> 1 !== 1);
  return outward ? [corner(0), corner(1), corner(3), corner(2)] : [corner(0), corner(2), corner(3), corner(1)];
});
export const edgeCorners = Array.from({ length: 12 }, (_, e) => [spread(e >> 2, e & 3), spread(e >> 2, e & 3) | (1 << (e >> 2))]);
export const edgeBetween = (c, d) => {
  const axis = (c ^ d) === 1 ? 0 : (c ^ d) === 2 ? 1 : 2;
  return 4 * axis + gather(axis, c);
};

/** Items 0 .. keys.length - 1 by their keys (0 .. n - 1), equal ones in their order. */
function buckets(keys, n) {
  const first = new Uint32Array(n + 1);
  for (let i = 0; i < keys.length; ++i) ++first[keys[i] + 1];
  for (let i = 0; i < n; ++i) first[i + 1] += first[i];
  const next = first.slice(0, n), order = new Uint32Array(keys.length);
  for (let i = 0; i < keys.length; ++i) order[next[keys[i]]++] = i;
  return { first, order };
}

/** hex: 8 nodes each. sides: per face two of 6 * hex + face of it, -1 for none. ofHex: per 6 * hex + face its face. */
export function faces(hex, nNodes) {
  const nHexes = hex.length / 8, n = 6 * nHexes;
  const low = new Uint32Array(n), diagonal = new Uint32Array(n), neighbour = new Uint32Array(n);
  for (let h = 0, i = 0; h < nHexes; ++h)
    for (let f = 0; f < 6; ++f, ++i) {
      const c = faceCycle[f], at = 8 * h;
      const a = hex[at + c[0]], b = hex[at + c[1]], d = hex[at + c[2]], e = hex[at + c[3]];
      let lowest = a, across = d, x = b, y = e;
      if (b < lowest) { lowest = b; across = e; x = a; y = d; }
      if (d < lowest) { lowest = d; across = a; x = b; y = e; }
      if (e < lowest) { lowest = e; across = b; x = a; y = d; }
      low[i] = lowest;
      diagonal[i] = across;
      neighbour[i] = x < y ? x : y;
    }
  const { first, order } = buckets(low, nNodes);
  const ofHex = new Uint32Array(n), sides = new Int32Array(n).fill(-1);
  let count = 0;
  for (let node = 0; node < nNodes; ++node) {
    const begin = first[node], end = first[node + 1];
    for (let i = begin + 1; i < end; ++i) {
      const item = order[i], d = diagonal[item], m = neighbour[item];
      let j = i - 1;
      for (; j >= begin; --j) {
        const other = order[j];
        if (diagonal[other] < d || (diagonal[other] === d && neighbour[other] <= m)) break;
        order[j + 1] = other;
      }
      order[j + 1] = item;
    }
    for (let i = begin; i < end; ++i) {
      const item = order[i], before = i > begin ? order[i - 1] : -1;
      if (before >= 0 && diagonal[before] === diagonal[item] && neighbour[before] === neighbour[item]) {
        sides[2 * (count - 1) + 1] = item;
      } else {
        sides[2 * count] = item;
        ++count;
      }
      ofHex[item] = count - 1;
    }
  }
  return { n: count, sides: sides.slice(0, 2 * count), ofHex };
}

/** nodes: per edge two, the lower one first. ofHex: per 12 * hex + edge of it its edge. */
export function edges(hex, nNodes) {
  const nHexes = hex.length / 8, n = 12 * nHexes;
  const low = new Uint32Array(n), high = new Uint32Array(n);
  for (let h = 0, i = 0; h < nHexes; ++h)
    for (let e = 0; e < 12; ++e, ++i) {
      const a = hex[8 * h + edgeCorners[e][0]], b = hex[8 * h + edgeCorners[e][1]];
      low[i] = a < b ? a : b;
      high[i] = a < b ? b : a;
    }
  const { first, order } = buckets(low, nNodes);
  const ofHex = new Uint32Array(n), nodes = new Uint32Array(2 * n);
  let count = 0;
  for (let node = 0; node < nNodes; ++node) {
    const begin = first[node], end = first[node + 1];
    for (let i = begin + 1; i < end; ++i) {
      const item = order[i], b = high[item];
      let j = i - 1;
      for (; j >= begin && high[order[j]] > b; --j) order[j + 1] = order[j];
      order[j + 1] = item;
    }
    for (let i = begin; i < end; ++i) {
      const item = order[i];
      if (i === begin || high[order[i - 1]] !== high[item]) {
        nodes[2 * count] = node;
        nodes[2 * count + 1] = high[item];
        ++count;
      }
      ofHex[item] = count - 1;
    }
  }
  return { n: count, nodes: nodes.slice(0, 2 * count), ofHex };
}

/** ofEdge: per edge its sheet, numbered by their lowest edges. */
export function sheets(edges) {
  const parent = new Uint32Array(edges.n);
  for (let i = 0; i < parent.length; ++i) parent[i] = i;
  const root = (i) => {
    while (parent[i] !== i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (let i = 0; i < edges.ofHex.length; i += 4) {
    let a = root(edges.ofHex[i]);
    for (let k = 1; k < 4; ++k) {
      const b = root(edges.ofHex[i + k]);
      if (a < b) parent[b] = a;
      else if (b < a) { parent[a] = b; a = b; }
    }
  }
  const ofEdge = new Uint32Array(edges.n);
  let n = 0;
  for (let i = 0; i < edges.n; ++i) ofEdge[i] = parent[i] === i ? n++ : ofEdge[root(i)];
  return { n, ofEdge };
}
