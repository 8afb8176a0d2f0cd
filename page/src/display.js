// Quads to be drawn: of the skin, of some of the hexes, and what a plane cuts of them.
import * as THREE from 'three';
import { edgeCorners, faceCycle } from './topology.js';

/** n quads: hex and side of each, its surface (0: none), face index, and four places in points. */
export class Quads {
  constructor(n, points) {
    this.n = n;
    this.points = points;
    this.corner = new Uint32Array(4 * n);
    this.hex = new Uint32Array(n);
    this.side = new Uint8Array(n);
    this.face = new Uint32Array(n);
    this.surface = new Uint32Array(n);
    this.offset = null;  // per quad: what it is moved by
  }
}

/** What is seen of the whole mesh; covered: also the surfaces between its parts. */
export function skinQuads(scene, covered = false) {
  const { skin } = scene, n = covered ? skin.quad_hex.length : scene.nOpen;
  const quads = new Quads(0, skin.point);
  quads.n = n;
  quads.corner = skin.quad.subarray(0, 4 * n);
  quads.hex = skin.quad_hex.subarray(0, n);
  quads.side = skin.quad_side.subarray(0, n);
  quads.face = skin.quad_face.subarray(0, n);
  quads.surface = skin.quad_surface.subarray(0, n);
  quads.node = skin.node;  // of a place in points
  return quads;
}

/** The skin of some hexes (shown[h] != 0). part: per hex a number; hexes of different ones have skins of their own. */
export function subsetQuads(inside, shown, part = null) {
  const { sides, n } = inside.faces;
  let count = 0;
  const each = (visit) => {
    for (let f = 0; f < n; ++f) {
      const a = sides[2 * f], b = sides[2 * f + 1], ha = (a / 6) | 0, hb = b < 0 ? -1 : (b / 6) | 0;
      const va = shown[ha] !== 0, vb = hb >= 0 && shown[hb] !== 0;
      if (!va && !vb) continue;
      if (va && vb && (!part || part[ha] === part[hb])) continue;
      if (va) visit(f, a, ha);
      if (vb) visit(f, b, hb);
    }
  };
  each(() => ++count);
  const quads = new Quads(count, inside.points), surface = inside.surfaceOfFace;
  let q = 0;
  each((f, side, hex) => {
    const s = side - 6 * hex, cycle = faceCycle[s];
    quads.hex[q] = hex;
    quads.side[q] = s;
    quads.face[q] = f;
    quads.surface[q] = surface[f];
    for (let k = 0; k < 4; ++k) quads.corner[4 * q + k] = inside.hexes[8 * hex + cycle[k]];
    ++q;
  });
  return quads;
}

/** All six faces of these hexes. */
export function hexQuads(inside, hexes) {
  const quads = new Quads(6 * [...hexes].length, inside.points);
  let q = 0;
  for (const hex of hexes)
    for (let s = 0; s < 6; ++s, ++q) {
      quads.hex[q] = hex;
      quads.side[q] = s;
      for (let k = 0; k < 4; ++k) quads.corner[4 * q + k] = inside.hexes[8 * hex + faceCycle[s][k]];
    }
  return quads;
}

/** Some of the quads, by their numbers. */
export function someQuads(quads, which) {
  const out = new Quads(which.length, quads.points);
  out.offset = quads.offset ? new Float32Array(3 * which.length) : null;
  which.forEach((q, i) => {
    out.hex[i] = quads.hex[q];
    for (let k = 0; k < 4; ++k) out.corner[4 * i + k] = quads.corner[4 * q + k];
    if (out.offset) out.offset.set(quads.offset.subarray(3 * q, 3 * q + 3), 3 * i);
  });
  return out;
}

/**
 * Fewer quads that look much the same from afar: corners are moved together in the cells of a grid, and quads that become
 * lines, or the same as others, are left out. source: per quad the one that it comes of.
 */
export function coarseQuads(quads, most) {
  const { n, corner, points, offset } = quads;
  let low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < 4 * n; ++i)
    for (let k = 0; k < 3; ++k) {
      const v = points[3 * corner[i] + k] + (offset ? offset[3 * (i >> 2) + k] : 0);
      if (v < low[k]) low[k] = v;
      if (v > high[k]) high[k] = v;
    }
  const size = Math.max(high[0] - low[0], high[1] - low[1], high[2] - low[2]) || 1;
  for (let cells = 128; cells >= 8; cells = Math.floor(cells * 0.7)) {
    const places = new Map(), sums = [], cellOf = new Uint32Array(4 * n);
    for (let i = 0; i < 4 * n; ++i) {
      const p = [0, 1, 2].map((k) => points[3 * corner[i] + k] + (offset ? offset[3 * (i >> 2) + k] : 0));
      const key = p.reduce((sum, v, k) => sum * 512 + Math.floor((cells * 0.9999 * (v - low[k])) / size), 0);
      let at = places.get(key);
      if (at === undefined) {
        places.set(key, (at = sums.length / 4));
        sums.push(0, 0, 0, 0);
      }
      for (let k = 0; k < 3; ++k) sums[4 * at + k] += p[k];
      ++sums[4 * at + 3];
      cellOf[i] = at;
    }
    const seen = new Set(), kept = [];
    for (let q = 0; q < n; ++q) {
      const c = [cellOf[4 * q], cellOf[4 * q + 1], cellOf[4 * q + 2], cellOf[4 * q + 3]], sorted = [...c].sort((a, b) => a - b);
      if (new Set(c).size < 3) continue;
      const key = sorted.join();
      if (seen.has(key)) continue;
      seen.add(key);
      kept.push(q);
    }
    if (kept.length > most) continue;
    const out = new Quads(kept.length, new Float32Array(places.size * 3));
    for (let i = 0; i < places.size; ++i) for (let k = 0; k < 3; ++k) out.points[3 * i + k] = sums[4 * i + k] / sums[4 * i + 3];
    kept.forEach((q, i) => { for (let k = 0; k < 4; ++k) out.corner[4 * i + k] = cellOf[4 * q + k]; });
    return { quads: out, source: kept };
  }
  return null;
}

export function quadGeometry(quads) {
  const { n, corner, points, offset } = quads;
  const position = new Float32Array(12 * n), index = new Uint32Array(6 * n);
  for (let i = 0; i < 4 * n; ++i) {
    const p = 3 * corner[i], o = 3 * (i >> 2);
    position[3 * i] = points[p] + (offset ? offset[o] : 0);
    position[3 * i + 1] = points[p + 1] + (offset ? offset[o + 1] : 0);
    position[3 * i + 2] = points[p + 2] + (offset ? offset[o + 2] : 0);
  }
  for (let q = 0; q < n; ++q) {
    const v = 4 * q, at = 6 * q;
    index[at] = v; index[at + 1] = v + 1; index[at + 2] = v + 2;
    index[at + 3] = v; index[at + 4] = v + 2; index[at + 5] = v + 3;
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(position, 3));
  geometry.setAttribute('tint', new THREE.BufferAttribute(new Uint8Array(16 * n).fill(255), 4, true));
  geometry.setIndex(new THREE.BufferAttribute(index, 1));
  return geometry;
}

/** What the plane normal . x = distance cuts of the hexes that are shown: triangles, their hexes, and outlines. */
export function section(inside, shown, normal, distance) {
  const { points, hexes, nHexes, nNodes } = inside, [a, b, c] = normal;
  const height = new Float32Array(nNodes);
  for (let i = 0; i < nNodes; ++i) height[i] = a * points[3 * i] + b * points[3 * i + 1] + c * points[3 * i + 2] - distance;
  const u = Math.abs(a) < 0.9 ? [0, c, -b] : [-c, 0, a], v = [b * u[2] - c * u[1], c * u[0] - a * u[2], a * u[1] - b * u[0]];
  const triangles = [], hexOf = [], lines = [];
  for (let h = 0; h < nHexes; ++h) {
    if (shown && !shown[h]) continue;
    let low = Infinity, high = -Infinity;
    for (let k = 0; k < 8; ++k) {
      const z = height[hexes[8 * h + k]];
      if (z < low) low = z;
      if (z > high) high = z;
    }
    if (!(low < 0 && high >= 0)) continue;
    const cut = [];
    for (const [e, f] of edgeCorners) {
      const i = hexes[8 * h + e], j = hexes[8 * h + f], s = height[i], t = height[j];
      if (s < 0 === t < 0) continue;
      const w = s / (s - t), p = [0, 1, 2].map((k) => points[3 * i + k] + w * (points[3 * j + k] - points[3 * i + k]));
      cut.push(p);
    }
    if (cut.length < 3) continue;
    const middle = [0, 1, 2].map((k) => cut.reduce((sum, p) => sum + p[k], 0) / cut.length);
    const angle = (p) => {
      const d = [p[0] - middle[0], p[1] - middle[1], p[2] - middle[2]];
      return Math.atan2(d[0] * v[0] + d[1] * v[1] + d[2] * v[2], d[0] * u[0] + d[1] * u[1] + d[2] * u[2]);
    };
    const ring = cut.map((p) => [angle(p), p]).sort((x, y) => x[0] - y[0]).map((x) => x[1]);
    for (let k = 0; k < ring.length; ++k) {
      const next = ring[(k + 1) % ring.length];
      lines.push(...ring[k], ...next);
      if (k > 0 && k + 1 < ring.length) {
        triangles.push(...ring[0], ...ring[k], ...next);
        hexOf.push(h);
      }
    }
  }
  return { triangles: new Float32Array(triangles), hexOf: Uint32Array.from(hexOf), lines: new Float32Array(lines) };
}

/** The twist plane of a sheet: in every hex that it runs through, the quad between the middles of the four edges. */
export function twistPlane(inside, sheet) {
  const { ofEdge } = inside.sheets, { ofHex, nodes } = inside.edges, { points } = inside, position = [];
  for (let h = 0; h < inside.nHexes; ++h)
    for (let axis = 0; axis < 3; ++axis) {
      const first = 12 * h + 4 * axis;
      if (ofEdge[ofHex[first]] !== sheet) continue;
      const p = [0, 1, 3, 2].map((k) => {
        const e = ofHex[first + k], i = 3 * nodes[2 * e], j = 3 * nodes[2 * e + 1];
        return [0, 1, 2].map((x) => (points[i + x] + points[j + x]) / 2);
      });
      position.push(...p[0], ...p[1], ...p[2], ...p[3]);
    }
  const n = position.length / 12, quads = new Quads(n, new Float32Array(position));
  for (let i = 0; i < 4 * n; ++i) quads.corner[i] = i;
  return quads;
}
