// One mesh on its model, as far as it has been loaded. Positions are 0-based; ids are what users know.
import * as topology from './topology.js';
import { text } from './unpack.js';

export const kinds = ['vertex', 'curve', 'surface', 'volume', 'node', 'edge', 'face', 'hex', 'block', 'nodeset', 'sideset', 'sheet'];
const measures = { curve: 'length', surface: 'area', volume: 'volume' };
export const pluralOf = (kind) => (kind === 'vertex' ? 'vertices' : kind === 'hex' ? 'hexes' : kind + 's');
/** The kind that a word names, in one or many. */
export const kindNamed = (word) => [...kinds, 'group'].find((kind) => word === kind || word === pluralOf(kind));

export class Scene {
  /** load(name): arrays of a block, null where there is none. */
  static async open(load) {
    const skin = await load('skin');
    return skin && new Scene(JSON.parse(text(skin.meta)), skin, load);
  }

  constructor(meta, skin, load) {
    this.meta = meta;
    this.skin = skin;
    this.load = load;
    this.loading = {};
    this.insideNow = null;
    this.nOpen = skin.n_open[0];  // faces that nothing covers: they come first
    this.radius = Math.max(meta.size / 2, 1e-12);
  }

  block(name) {
    this.loading[name] ??= this.load(name);
    return this.loading[name];
  }
  cad() { return this.block('cad'); }
  sets() { return this.block('sets'); }

  /** No mesh: the CAD alone. */
  get isCad() { return this.meta.n_hexes === 0; }
  get hasInside() { return !this.meta.left_out.includes('inside'); }
  async inside() {
    if (this.insideNow) return this.insideNow;
    const arrays = await this.block('inside');
    if (!arrays) throw new Error('the inside of this mesh is not in the page: it is too large');
    this.insideNow ??= new Inside(arrays, this);
    return this.insideNow;
  }

  channel(i) { return this.block('c' + i).then((arrays) => arrays?.value ?? null); }

  hexId(hex) {
    const inside = this.insideNow;
    if (inside?.hexIds) return inside.hexIds[hex];
    if (!this.skin.quad_hex_id) return hex + 1;
    this.hexIdOnSkin ??= new Map(Array.from(this.skin.quad_hex, (h, q) => [h, this.skin.quad_hex_id[q]]));
    return this.hexIdOnSkin.get(hex);
  }
  nodeId(node) {
    if (this.insideNow?.nodeIds) return this.insideNow.nodeIds[node];
    if (!this.skin.node_id) return node + 1;
    this.nodeIdOnSkin ??= new Map(Array.from(this.skin.node, (n, i) => [n, this.skin.node_id[i]]));
    return this.nodeIdOnSkin.get(node);
  }

  /** How many entities of a kind there are; null where that takes loading the inside. */
  count(kind) {
    if (this.meta[kind]) return this.meta[kind].length;
    if (kind === 'hex') return this.meta.n_hexes;
    if (kind === 'node') return this.meta.n_nodes;
    const inside = this.insideNow;
    return inside ? inside.count(kind) : null;
  }
  /** Id and name of the i-th. */
  row(kind, i) {
    const rows = this.meta[kind];
    if (!rows) return { id: kind === 'hex' ? this.hexId(i) : kind === 'node' ? this.nodeId(i) : i + 1, name: '', note: '' };
    const row = rows[i];
    if (kind === 'block' || kind === 'nodeset' || kind === 'sideset' || kind === 'group')
      return { id: row[0], name: row[1], note: `${row[2].toLocaleString('en')} ${kind === 'block' ? 'hexes' : kind === 'nodeset' ? 'nodes' : kind === 'sideset' ? 'sides' : 'members'}` };
    const measure = row[2] === null || kind === 'vertex' ? '' : `, ${measures[kind]} ${short(row[2])}`;
    return { id: i + 1, name: row[0], note: kind === 'vertex' ? '' : `${row[1]}${measure}` };
  }
  /** Position of an id, -1 where there is none. */
  find(kind, id) {
    const rows = this.meta[kind];
    if (kind === 'block' || kind === 'nodeset' || kind === 'sideset' || kind === 'group') return rows.findIndex((row) => row[0] === id);
    const ids = kind === 'hex' ? this.insideNow?.hexIds : kind === 'node' ? this.insideNow?.nodeIds : null;
    if (ids) return indexIn(ids, id);
    if (kind === 'hex' && this.skin.quad_hex_id) return this.skin.quad_hex[this.skin.quad_hex_id.indexOf(id)] ?? -1;
    if (kind === 'node' && this.skin.node_id) return this.skin.node[this.skin.node_id.indexOf(id)] ?? -1;
    const n = this.count(kind);
    return id >= 1 && (n === null || id <= n) ? id - 1 : -1;
  }
}

function indexIn(ids, id) {
  let low = 0, high = ids.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (ids[middle] < id) low = middle + 1;
    else high = middle;
  }
  return ids[low] === id ? low : -1;
}

/** All nodes and hexes, and what is derived of them when first asked for. */
export class Inside {
  constructor(arrays, scene) {
    this.points = arrays.point;
    this.hexes = arrays.hex;
    this.volume = arrays.volume;
    this.hexIds = arrays.hex_id ?? null;
    this.nodeIds = arrays.node_id ?? null;
    this.ownerDim = arrays.owner_dim;
    this.ownerId = arrays.owner_id;
    this.nHexes = this.hexes.length / 8;
    this.nNodes = this.points.length / 3;
    this.scene = scene;
  }
  get faces() { return (this.faces_ ??= topology.faces(this.hexes, this.nNodes)); }
  get edges() { return (this.edges_ ??= topology.edges(this.hexes, this.nNodes)); }
  get sheets() { return (this.sheets_ ??= topology.sheets(this.edges)); }
  count(kind) {
    return kind === 'face' ? this.faces.n : kind === 'edge' ? this.edges.n : kind === 'sheet' ? this.sheets.n : null;
  }
  /** Three coordinates per hex. */
  get centres() {
    if (this.centres_) return this.centres_;
    const { points, hexes, nHexes } = this, out = new Float32Array(3 * nHexes);
    for (let h = 0; h < nHexes; ++h) {
      let x = 0, y = 0, z = 0;
      for (let c = 0; c < 8; ++c) {
        const p = 3 * hexes[8 * h + c];
        x += points[p]; y += points[p + 1]; z += points[p + 2];
      }
      out[3 * h] = x / 8; out[3 * h + 1] = y / 8; out[3 * h + 2] = z / 8;
    }
    return (this.centres_ = out);
  }
  /** Per face the surface that it lies on, 0 for none. */
  get surfaceOfFace() {
    if (this.surfaceOfFace_) return this.surfaceOfFace_;
    const out = new Uint32Array(this.faces.n), { quad_face, quad_surface } = this.scene.skin;
    for (let q = 0; q < quad_face.length; ++q) out[quad_face[q]] = quad_surface[q];
    return (this.surfaceOfFace_ = out);
  }
  /** Sheets through a hex, one for each direction. */
  sheetsOfHex(h) { return [0, 1, 2].map((axis) => this.sheets.ofEdge[this.edges.ofHex[12 * h + 4 * axis]]); }
  hexesOfSheet(sheet) {
    const out = [], { ofEdge } = this.sheets, { ofHex } = this.edges;
    for (let h = 0; h < this.nHexes; ++h)
      for (let axis = 0; axis < 3; ++axis)
        if (ofEdge[ofHex[12 * h + 4 * axis]] === sheet) { out.push(h); break; }
    return out;
  }
  /** Hexes in a row through a face of a hex (2 * axis + side), both ways. */
  column(hex, face) {
    const seen = new Set([hex]);
    for (const start of [face, face ^ 1])
      for (let h = hex, f = start; ;) {
        const { sides, ofHex } = this.faces, at = ofHex[6 * h + f];
        const other = sides[2 * at] === 6 * h + f ? sides[2 * at + 1] : sides[2 * at];
        if (other < 0) break;
        h = Math.floor(other / 6);
        f = (other % 6) ^ 1;
        if (seen.has(h)) break;
        seen.add(h);
      }
    return [...seen];
  }
}

/** A number in at most four digits. */
export function short(value) {
  if (value === null || value === undefined || Number.isNaN(value)) return '';
  if (value !== 0 && (Math.abs(value) >= 1e7 || Math.abs(value) < 1e-4)) return value.toExponential(3).replace(/\.?0+e/, 'e');
  return String(Number(value.toPrecision(4)));
}
