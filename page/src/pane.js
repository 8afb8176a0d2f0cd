// One mesh in the picture: its quads, what the plane cuts, the CAD, and what is picked.
import * as THREE from 'three';
import { MeshBVH } from 'three-mesh-bvh';
import { coarseQuads, hexQuads, quadGeometry, Quads, section, skinQuads, someQuads, subsetQuads, twistPlane } from './display.js';
import { lineMesh } from './lines.js';
import { cadMaterial, noClip, quadMaterial } from './materials.js';

THREE.ColorManagement.enabled = false;  // colours are those of the screen throughout

const thinLines = 20000;  // segments: beyond that lines are one pixel wide
const mostMarked = 60000; // quads
const mostMoving = 9000;  // quads, where there is no graphics card
const mostDots = 200000;  // nodes that are looked at
const mostParts = 1000;   // that are compared with each other when they are taken apart

const dotVertexShader = `
uniform float size;
varying vec3 own;
#ifdef TINTED
attribute vec3 tint;
#endif
void main() {
#ifdef TINTED
  own = tint;
#endif
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_Position.z -= 0.0015 * gl_Position.w;  // before the faces that it lies on
  gl_PointSize = size;
}`;
const dotFragmentShader = `
uniform vec3 colour;
varying vec3 own;
void main() {
  float d = length(gl_PointCoord - 0.5);
  if (d > 0.5) discard;
#ifdef TINTED
  gl_FragColor = vec4(d > 0.4 ? 0.4 * own : own, 1.0);
#else
  gl_FragColor = vec4(d > 0.36 ? vec3(1.0) : colour, 1.0);
#endif
}`;

export class Pane {
  constructor(scene, theme) {
    this.scene = scene;
    this.theme = theme;
    this.root = new THREE.Scene();
    this.faces = new THREE.Mesh(new THREE.BufferGeometry(), quadMaterial());
    this.section = new THREE.Mesh(new THREE.BufferGeometry(), quadMaterial({ lines: 0, offset: 0.5 }));
    this.sectionLines = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial());
    this.cad = new THREE.Mesh(new THREE.BufferGeometry(), cadMaterial());
    this.curves = new THREE.Group();
    this.marks = new THREE.Group();
    this.hints = new THREE.Group();
    this.planes = new THREE.Group();
    this.nodeDots = new THREE.Group();
    for (const object of [this.cad, this.faces, this.section, this.sectionLines, this.curves, this.nodeDots, this.planes, this.marks, this.hints]) {
      object.frustumCulled = false;
      this.root.add(object);
    }
    this.cad.visible = false;
    this.coarse = null;       // what is drawn while the eye moves, where drawing is slow
    this.shown = null;        // per hex, null: all
    this.values = null;
    this.setQuads(skinQuads(scene));
  }

  setQuads(quads) {
    this.quads = quads;
    this.faces.geometry.dispose();
    this.faces.geometry = quadGeometry(quads);
    this.bvh = null;
    this.dropCoarse();
  }

  dropCoarse() {
    if (this.coarse) {
      this.root.remove(this.coarse);
      this.coarse.geometry.dispose();
      this.coarse.material.dispose();
    }
    this.coarse = this.coarseSource = null;
  }
  makeCoarse() {
    if (this.coarse || this.quads.n <= mostMoving) return;
    const made = coarseQuads(this.quads, mostMoving);
    if (!made) return;
    this.coarse = new THREE.Mesh(quadGeometry(made.quads), quadMaterial({ lines: 0, isPlain: true }));
    this.coarse.frustumCulled = false;
    this.coarse.visible = false;
    this.coarseSource = made.source;
    this.root.add(this.coarse);
    this.tintCoarse();
  }
  tintCoarse() {
    if (!this.coarse) return;
    const from = this.faces.geometry.getAttribute('tint').array, tint = this.coarse.geometry.getAttribute('tint');
    this.coarseSource.forEach((q, i) => tint.array.set(from.subarray(16 * q, 16 * q + 16), 16 * i));
    tint.needsUpdate = true;
    this.coarse.material.uniforms.clip.value.copy(this.faces.material.uniforms.clip.value);
  }
  /** Before a frame: is it one of many? */
  prepare(isMoving) {
    if (!this.coarse) return;
    this.coarse.visible = isMoving && this.faces.visible;
    this.faces.layers.set(this.coarse.visible ? 1 : 0);
  }

  tree() {
    if (!this.bvh && this.quads.n) this.bvh = new MeshBVH(this.faces.geometry, { indirect: true, targetLeafSize: 8 });
    return this.bvh;
  }

  /** The same for the surfaces of the CAD, where there is no mesh. */
  cadTree() {
    if (!this.cadTree_ && this.cadArrays?.quad.length) this.cadTree_ = new MeshBVH(this.cad.geometry, { indirect: true });
    return this.cadTree_;
  }
  /** Those surfaces as quads. */
  cadQuads(test) {
    const { quad, quad_surface, point } = this.cadArrays, quads = new Quads(quad_surface.length, point), which = [];
    quads.corner.set(quad);
    quad_surface.forEach((surface, q) => { if (test(surface - 1)) which.push(q); });
    return someQuads(quads, which);
  }

  /** clip: { mode: 'off' | 'crinkle' | 'plane', normal, distance }; hidden: per hex, null: none; explode: 0..1. */
  async rebuild({ clip, shown, explode }) {
    const { scene } = this, cuts = clip.mode !== 'off';
    const material = this.faces.material.uniforms, plane = noClip();
    if (clip.mode === 'plane') plane.set(...clip.normal, clip.distance);
    for (const each of [material, this.cad.material.uniforms]) each.clip.value.copy(plane);
    if (scene.isCad) return;
    if (!cuts && !shown && !explode) {
      this.shown = null;
      this.setQuads(skinQuads(scene));
      this.setSection(null);
      return;
    }
    const inside = await scene.inside();
    let visible = shown;
    if (clip.mode === 'crinkle') {
      visible = new Uint8Array(inside.nHexes);
      const { centres } = inside, [a, b, c] = clip.normal, d = clip.distance;
      for (let h = 0; h < visible.length; ++h)
        visible[h] = (!shown || shown[h]) && a * centres[3 * h] + b * centres[3 * h + 1] + c * centres[3 * h + 2] <= d ? 1 : 0;
    }
    this.shown = visible;
    const parts = explode ? await this.parts(inside) : null, part = parts?.n > 1 ? parts : null;
    if (!visible && !part) this.setQuads(skinQuads(scene));
    else {
      const quads = subsetQuads(inside, visible ?? new Uint8Array(inside.nHexes).fill(1), part?.of ?? null);
      if (part) {
        quads.offset = new Float32Array(3 * quads.n);
        for (let q = 0; q < quads.n; ++q) {
          const p = part.of[quads.hex[q]];
          for (let k = 0; k < 3; ++k) quads.offset[3 * q + k] = 1.2 * explode * part.middle[3 * p + k];
        }
      }
      this.setQuads(quads);
    }
    this.setSection(clip.mode === 'plane' ? section(inside, visible, clip.normal, clip.distance) : null);
  }

  /** What is taken apart: blocks, or volumes where there is but one. */
  async parts(inside) {
    if (this.parts_) return this.parts_;
    const { channels } = this.scene.meta, block = channels.findIndex((c) => c.name === 'block' && c.is_class);
    const byBlock = this.scene.meta.block.length > 1 && block >= 0;
    const values = byBlock ? await this.scene.channel(block) : inside.volume;
    const numbers = new Map(), of = new Uint32Array(inside.nHexes);
    for (let h = 0; h < of.length; ++h) {
      const v = values[h];
      if (!numbers.has(v)) numbers.set(v, numbers.size);
      of[h] = numbers.get(v);
    }
    const middle = new Float32Array(3 * numbers.size), n = new Float32Array(numbers.size);
    for (let h = 0; h < of.length; ++h) {
      ++n[of[h]];
      for (let k = 0; k < 3; ++k) middle[3 * of[h] + k] += inside.centres[3 * h + k];
    }
    for (let i = 0; i < middle.length; ++i) middle[i] /= n[(i / 3) | 0];
    // What has its middle where a larger part has it, as a ball in a cube, goes up.
    const order = Array.from(n.keys()).sort((a, b) => n[b] - n[a]), before = middle.slice(), near = 0.05 * this.scene.radius;
    const isNear = (p, q) => [0, 1, 2].every((k) => Math.abs(before[3 * p + k] - before[3 * q + k]) < near);
    order.slice(0, mostParts).forEach((p, i) => { middle[3 * p + 2] += 1.4 * this.scene.radius * order.slice(0, i).filter((q) => isNear(p, q)).length; });
    return (this.parts_ = { of, middle, n: numbers.size });
  }

  setSection(cut) {
    this.cut = cut;
    this.section.geometry.dispose();
    this.sectionLines.geometry.dispose();
    this.section.visible = this.sectionLines.visible = cut !== null;
    if (!cut) return;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(cut.triangles, 3));
    geometry.setAttribute('tint', new THREE.BufferAttribute(new Uint8Array((4 * cut.triangles.length) / 3).fill(255), 4, true));
    this.section.geometry = geometry;
    this.sectionLines.geometry = new THREE.BufferGeometry();
    this.sectionLines.geometry.setAttribute('position', new THREE.BufferAttribute(cut.lines, 3));
  }

  /** colourOf(hex, surface, node): [r, g, b]; onNodes: asked per node, with nothing else. */
  paint(colourOf, onNodes) {
    const { quads } = this, tint = this.faces.geometry.getAttribute('tint'), to = tint.array;
    for (let q = 0; q < quads.n; ++q) {
      const c = onNodes ? null : colourOf(quads.hex[q], quads.surface[q], quads.side[q]);
      for (let k = 0; k < 4; ++k) {
        const at = 16 * q + 4 * k, place = quads.corner[4 * q + k];
        const [r, g, b] = c ?? colourOf(quads.node ? quads.node[place] : place);
        to[at] = r; to[at + 1] = g; to[at + 2] = b;
      }
    }
    tint.needsUpdate = true;
    this.tintCoarse();
    if (!this.cut) return;
    const cut = this.section.geometry.getAttribute('tint'), { hexOf } = this.cut, inside = this.scene.insideNow;
    for (let i = 0; i < hexOf.length; ++i) {
      let c;
      if (onNodes) {
        // One colour per hex: the average of its corners.
        c = [0, 0, 0];
        for (let k = 0; k < 8; ++k) colourOf(inside.hexes[8 * hexOf[i] + k]).forEach((v, j) => { c[j] += v / 8; });
      } else c = colourOf(hexOf[i], 0, -1);
      for (let k = 0; k < 3; ++k) cut.array.set([...c, 255], 12 * i + 4 * k);
    }
    cut.needsUpdate = true;
  }

  /** colourOf(surface): [r, g, b]; null: all alike. */
  paintCad(colourOf) {
    this.cad.material.uniforms.tinted.value = colourOf && this.cadArrays ? 1 : 0;
    if (!colourOf || !this.cadArrays) return;
    const tint = this.cad.geometry.getAttribute('tint'), { quad, quad_surface } = this.cadArrays;
    for (let q = 0; q < quad_surface.length; ++q) {
      const colour = [...colourOf(quad_surface[q]), 255];
      for (let k = 0; k < 4; ++k) tint.array.set(colour, 4 * quad[4 * q + k]);
    }
    tint.needsUpdate = true;
  }
  /** Nodes that are drawn, as dots. colourOf(node): [r, g, b], null for none; or null: no dots at all. */
  showDots(colourOf) {
    this.clear(this.nodeDots);
    if (!colourOf) return;
    const { quads } = this, seen = new Set(), positions = [], colours = [], clip = this.faces.material.uniforms.clip.value;
    for (let i = 0; i < 4 * quads.n && seen.size < mostDots; ++i) {
      const place = quads.corner[i], node = quads.node ? quads.node[place] : place;
      if (seen.has(node)) continue;
      seen.add(node);
      const colour = colourOf(node);
      if (!colour) continue;
      const p = [0, 1, 2].map((k) => quads.points[3 * place + k] + (quads.offset ? quads.offset[3 * (i >> 2) + k] : 0));
      if (clip.x * p[0] + clip.y * p[1] + clip.z * p[2] > clip.w) continue;
      positions.push(...p);
      colours.push(...colour.map((v) => v / 255));
    }
    if (!positions.length) return;
    const dots = this.dots(Float32Array.from(positions), '#000000', 9, false);
    dots.geometry.setAttribute('tint', new THREE.BufferAttribute(Float32Array.from(colours), 3));
    dots.material.defines = { TINTED: 1 };
    this.nodeDots.add(dots);
  }

  lines(positions, colour, width, onTop = false) {
    if (positions.length / 6 > thinLines) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
      return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: colour, depthTest: !onTop, transparent: onTop }));
    }
    return lineMesh(positions, colour, width, onTop);
  }
  dots(positions, colour, size, onTop = true) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
    const material = new THREE.ShaderMaterial({
      transparent: true, depthTest: !onTop, uniforms: { colour: { value: new THREE.Color(colour) }, size: { value: size } },
      vertexShader: dotVertexShader, fragmentShader: dotFragmentShader,
    });
    const object = new THREE.Points(geometry, material);
    object.frustumCulled = false;
    return object;
  }

  async loadCad() {
    const cad = await this.scene.cad();
    if (!cad?.point) return;
    this.cadArrays = cad;
    const geometry = new THREE.BufferGeometry(), n = cad.quad.length / 4, index = new Uint32Array(6 * n);
    for (let q = 0; q < n; ++q) {
      const [a, b, c, d] = cad.quad.subarray(4 * q, 4 * q + 4);
      index.set([a, b, c, a, c, d], 6 * q);
    }
    geometry.setAttribute('position', new THREE.BufferAttribute(cad.point, 3));
    geometry.setAttribute('normal', new THREE.BufferAttribute(cad.normal, 3));
    geometry.setAttribute('uv', new THREE.BufferAttribute(cad.at, 2));
    geometry.setAttribute('tint', new THREE.BufferAttribute(new Uint8Array((4 * cad.point.length) / 3).fill(255), 4, true));
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    this.cad.geometry.dispose();
    this.cad.geometry = geometry;
    this.cadTree_ = null;
    this.clear(this.curves);
    this.curves.add(this.lines(cad.segment, this.theme.ink, 2));
  }

  clear(group) {
    for (const child of [...group.children]) {
      group.remove(child);
      child.geometry.dispose();
      child.material.dispose();
    }
  }
  async showPlanes(sheets) {
    this.clear(this.planes);
    // They are seen through the mesh.
    const material = this.faces.material, isThin = sheets.length > 0;
    material.uniforms.opacity.value = isThin ? 0.22 : 1;
    material.transparent = isThin;
    material.depthWrite = !isThin;
    material.needsUpdate = true;
    if (!isThin) return;
    const inside = await this.scene.inside();
    sheets.forEach((sheet, i) => {
      const mesh = new THREE.Mesh(quadGeometry(twistPlane(inside, sheet)), quadMaterial({ opacity: 0.72, lines: 0.8, offset: -1 }));
      const colour = [[64, 150, 120], [200, 120, 60], [110, 100, 190], [190, 80, 110]][i % 4], tint = mesh.geometry.getAttribute('tint').array;
      for (let k = 0; k < tint.length; k += 4) tint.set([...colour, 255], k);
      mesh.frustumCulled = false;
      this.planes.add(mesh);
    });
  }

  /** Places of what these entities are made of: { quads | segments | points }. positions: 0-based. */
  async shapeOf(kind, positions) {
    const { scene, quads } = this, wanted = new Set(positions);
    const whereQuads = (test) => {
      const which = [];
      for (let q = 0; q < quads.n && which.length < mostMarked; ++q) if (test(q)) which.push(q);
      return someQuads(quads, which);
    };
    const ofHexes = async (hexes) => {
      const set = hexes;
      const found = whereQuads((q) => set.has(quads.hex[q]));
      if (found.n || set.size > mostMarked / 6 || !scene.hasInside) return { quads: found };
      return { quads: hexQuads(await scene.inside(), set), isHidden: true };
    };
    if (kind === 'vertex') {
      const cad = await scene.cad();
      return { points: cad ? Float32Array.from(positions.flatMap((p) => [...cad.vertex.subarray(3 * p, 3 * p + 3)])) : new Float32Array() };
    }
    if (kind === 'curve') {
      const cad = await scene.cad(), out = [];
      if (!cad) return { segments: new Float32Array() };
      for (let i = 0; i < cad.segment_curve.length; ++i)
        if (wanted.has(cad.segment_curve[i] - 1)) out.push(...cad.segment.subarray(6 * i, 6 * i + 6));
      return { segments: Float32Array.from(out) };
    }
    if (scene.isCad && this.cadArrays) {
      const { volumes_of_surface: volumes } = scene.meta;
      if (kind === 'surface') return { quads: this.cadQuads((surface) => wanted.has(surface)), isSmooth: true };
      if (kind === 'volume') return { quads: this.cadQuads((surface) => volumes[surface].some((v) => wanted.has(v - 1))), isSmooth: true };
      return { points: new Float32Array() };
    }
    if (kind === 'surface') {
      const found = whereQuads((q) => quads.surface[q] > 0 && wanted.has(quads.surface[q] - 1));
      if (found.n) return { quads: found };
      const all = skinQuads(scene, true), which = [];
      for (let q = 0; q < all.n; ++q) if (wanted.has(all.surface[q] - 1)) which.push(q);
      return { quads: someQuads(all, which), isHidden: true };
    }
    if (kind === 'volume') {
      const volume = scene.insideNow?.volume ?? (await scene.channel(0));
      return { quads: whereQuads((q) => wanted.has(volume[quads.hex[q]] - 1)) };
    }
    if (kind === 'hex') {
      // A few are seen through all else, from all sides.
      const isCheap = scene.insideNow || scene.meta.n_hexes < 100000;
      if (wanted.size <= 50 && scene.hasInside && isCheap && this.quads.offset === null) return { quads: hexQuads(await scene.inside(), wanted), isHidden: true };
      return ofHexes(wanted);
    }
    if (kind === 'block' || kind === 'nodeset' || kind === 'sideset') {
      const sets = await scene.sets(), lists = positions.map((p) => sets[`${kind} ${scene.meta[kind][p][0]}`]);
      if (kind === 'block') {
        const hexes = new Set();
        for (const list of lists) for (const h of list) hexes.add(h);
        return ofHexes(hexes);
      }
      if (kind === 'sideset') {
        const sides = new Set();
        for (const list of lists) for (const s of list) sides.add(s);
        const found = whereQuads((q) => sides.has(6 * quads.hex[q] + quads.side[q]));
        return { quads: found };
      }
      return { points: await this.nodePoints(lists.flatMap((list) => [...list])) };
    }
    if (kind === 'node') return { points: await this.nodePoints(positions) };
    if (kind === 'face') {
      const found = whereQuads((q) => wanted.has(quads.face[q]));
      if (found.n || !scene.hasInside) return { quads: found };
      const inside = await scene.inside(), { sides } = inside.faces, all = hexQuads(inside, positions.map((f) => (sides[2 * f] / 6) | 0));
      return { quads: someQuads(all, positions.map((f, i) => 6 * i + (sides[2 * f] % 6))), isHidden: true };
    }
    if (kind === 'edge') {
      const { skin } = scene, out = [];
      const at = (points, i) => points.subarray(3 * i, 3 * i + 3);
      if (!scene.insideNow && positions.length < 2000) {
        const known = (this.skinEdge_ ??= new Map(Array.from(skin.edge_index, (e, i) => [e, i])));
        if (positions.every((e) => known.has(e))) {
          for (const e of positions) {
            const i = known.get(e);
            out.push(...at(skin.point, skin.edge[2 * i]), ...at(skin.point, skin.edge[2 * i + 1]));
          }
          return { segments: Float32Array.from(out) };
        }
      }
      const inside = await scene.inside();
      for (const e of positions) out.push(...at(inside.points, inside.edges.nodes[2 * e]), ...at(inside.points, inside.edges.nodes[2 * e + 1]));
      return { segments: Float32Array.from(out) };
    }
    if (kind === 'sheet') {
      const inside = await scene.inside(), hexes = new Set();
      for (const sheet of positions) for (const h of inside.hexesOfSheet(sheet)) hexes.add(h);
      return ofHexes(hexes);
    }
    return { points: new Float32Array() };
  }
  async nodePoints(nodes) {
    const { skin, insideNow } = this.scene;
    let points = insideNow?.points, place = (n) => n;
    if (!points) {
      const local = (this.localNode_ ??= new Map(Array.from(skin.node, (n, i) => [n, i])));
      if (nodes.every((n) => local.has(n))) {
        points = skin.point;
        place = (n) => local.get(n);
      } else points = (await this.scene.inside()).points;
    }
    const out = new Float32Array(3 * nodes.length);
    nodes.forEach((n, i) => out.set(points.subarray(3 * place(n), 3 * place(n) + 3), 3 * i));
    return out;
  }

  /** Shows a shape in a colour; strong: what is picked, else what the mouse is at. */
  mark(group, shape, colour, strong) {
    this.clear(group);
    if (!shape) return;
    if (shape.quads?.n) {
      const material = quadMaterial({ opacity: strong ? 0.62 : 0.4, lines: shape.isSmooth ? 0 : strong ? 0.7 : 0.35, offset: -1, onTop: shape.isHidden });
      material.uniforms.clip.value.copy(shape.isHidden ? noClip() : this.faces.material.uniforms.clip.value);
      const mesh = new THREE.Mesh(quadGeometry(shape.quads), material), tint = mesh.geometry.getAttribute('tint').array;
      const c = new THREE.Color(colour);
      for (let k = 0; k < tint.length; k += 4) { tint[k] = 255 * c.r; tint[k + 1] = 255 * c.g; tint[k + 2] = 255 * c.b; }
      mesh.frustumCulled = false;
      group.add(mesh);
    }
    if (shape.segments?.length) group.add(this.lines(shape.segments, colour, strong ? 5 : 4, true));
    if (shape.points?.length) group.add(this.dots(shape.points, colour, strong ? 12 : 10));
  }
  dispose() {
    this.dropCoarse();
    for (const group of [this.curves, this.marks, this.hints, this.planes, this.nodeDots]) this.clear(group);
    for (const object of [this.faces, this.section, this.sectionLines, this.cad]) { object.geometry.dispose(); object.material.dispose(); }
  }
}

/** Box of a shape: { center, radius }, null for an empty one. */
export function boundsOf(shape) {
  const box = new THREE.Box3(), p = new THREE.Vector3();
  const add = (array) => { for (let i = 0; i < array.length; i += 3) box.expandByPoint(p.set(array[i], array[i + 1], array[i + 2])); };
  if (shape.points) add(shape.points);
  if (shape.segments) add(shape.segments);
  if (shape.quads)
    for (let i = 0; i < 4 * shape.quads.n; ++i) {
      const at = 3 * shape.quads.corner[i], moved = 3 * (i >> 2), { offset } = shape.quads;
      p.set(shape.quads.points[at], shape.quads.points[at + 1], shape.quads.points[at + 2]);
      if (offset) p.set(p.x + offset[moved], p.y + offset[moved + 1], p.z + offset[moved + 2]);
      box.expandByPoint(p);
    }
  if (box.isEmpty()) return null;
  return { center: box.getCenter(new THREE.Vector3()), radius: box.getSize(p).length() / 2 };
}
