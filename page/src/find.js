// What is at a place of the picture.
import * as THREE from 'three';
import { edgeBetween, faceCycle } from './topology.js';

const reach = 9;  // pixels to vertices and curves

const barycentre = new THREE.Vector3();

/** Is a point on the side of the plane that is taken away? */
export const isCutOff = (p, clip) => clip.x * p.x + clip.y * p.y + clip.z * p.z > clip.w;
/** The first of the triangles of a tree that a ray meets where they are not cut off. */
export function firstMet(tree, ray, clip) {
  if (!tree) return null;
  if (!clip.x && !clip.y && !clip.z) return tree.raycastFirst(ray, THREE.DoubleSide);
  let first = null;
  for (const each of tree.raycast(ray, THREE.DoubleSide)) if (!isCutOff(each.point, clip) && (!first || each.distance < first.distance)) first = each;
  return first;
}

/** The first thing that a ray meets: { quad } or { cut } with its hex, and the point. */
function meet(pane, ray) {
  let best = null;
  const clip = pane.faces.material.uniforms.clip.value, hit = firstMet(pane.tree(), ray, clip);
  if (hit) best = { quad: hit.faceIndex >> 1, hex: pane.quads.hex[hit.faceIndex >> 1], point: hit.point, distance: hit.distance };
  if (pane.scene.isCad) {
    const onCad = firstMet(pane.cadTree(), ray, clip);
    if (onCad) best = { quad: -1, hex: -1, surface: pane.cadArrays.quad_surface[onCad.faceIndex >> 1], point: onCad.point, distance: onCad.distance };
  }
  if (pane.cut) {
    const { triangles, hexOf } = pane.cut, a = new THREE.Vector3(), b = new THREE.Vector3(), c = new THREE.Vector3();
    for (let t = 0; t < hexOf.length; ++t) {
      const point = ray.intersectTriangle(a.fromArray(triangles, 9 * t), b.fromArray(triangles, 9 * t + 3), c.fromArray(triangles, 9 * t + 6), false, barycentre);
      if (!point) continue;
      const distance = point.distanceTo(ray.origin);
      if (!best || distance < best.distance) best = { quad: -1, hex: hexOf[t], point: point.clone(), distance };
    }
  }
  return best;
}

/** Distance in pixels of (x, y) from the line between two points of the screen. */
function toSegment(x, y, a, b) {
  const dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
  const t = square > 0 ? Math.max(0, Math.min(1, ((x - a.x) * dx + (y - a.y) * dy) / square)) : 0;
  return [Math.hypot(x - a.x - t * dx, y - a.y - t * dy), a.z + t * (b.z - a.z)];
}

/**
 * The entity of a kind at pixel (x, y) of a pane of width x height; kind 'geometry': vertex before curve before surface.
 * Returns { kind, position, id, hit } or null.
 */
export async function find(pane, camera, width, height, x, y, kind) {
  const ray = new THREE.Raycaster();
  ray.setFromCamera(new THREE.Vector2((2 * x) / width - 1, 1 - (2 * y) / height), camera);
  const hit = meet(pane, ray.ray), { scene, quads } = pane;
  const matrix = new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
  const p = new THREE.Vector3();
  const screen = (px, py, pz) => {
    p.set(px, py, pz).applyMatrix4(matrix);
    return { x: ((p.x + 1) * width) / 2, y: ((1 - p.y) * height) / 2, z: p.z };
  };
  // What is nearer than what is hit, or as near but for a little.
  const depth = hit ? screen(hit.point.x, hit.point.y, hit.point.z).z : Infinity;
  const slack = hit ? Math.abs(screen(...hit.point.clone().addScaledVector(ray.ray.direction, 0.02 * scene.radius).toArray()).z - depth) : 0;
  const isSeen = (z) => z > -1 && z < 1 && z <= depth + slack;
  const found = (which, position, id = position + 1) => ({ kind: which, position, id, hit });
  const cadArrays = quads.offset ? null : pane.cadArrays;  // of what is taken apart the CAD stays behind

  if (kind === 'vertex' && !cadArrays) return null;
  if ((kind === 'geometry' || kind === 'vertex') && cadArrays) {
    let best = kind === 'vertex' ? 25 : reach, which = -1;
    for (let i = 0; 3 * i < cadArrays.vertex.length; ++i) {
      const s = screen(cadArrays.vertex[3 * i], cadArrays.vertex[3 * i + 1], cadArrays.vertex[3 * i + 2]);
      const d = Math.hypot(s.x - x, s.y - y);
      if (d < best && isSeen(s.z)) { best = d; which = i; }
    }
    if (which >= 0) return found('vertex', which);
    if (kind === 'vertex') return null;
  }
  if (kind === 'curve' && !cadArrays) return null;
  if ((kind === 'geometry' || kind === 'curve') && cadArrays) {
    let best = kind === 'curve' ? 16 : reach - 2, which = -1;
    const { segment, segment_curve } = cadArrays;
    for (let i = 0; i < segment_curve.length; ++i) {
      const a = screen(segment[6 * i], segment[6 * i + 1], segment[6 * i + 2]);
      if (Math.abs(a.x - x) > width || Math.abs(a.y - y) > height) continue;
      const [d, z] = toSegment(x, y, a, screen(segment[6 * i + 3], segment[6 * i + 4], segment[6 * i + 5]));
      if (d < best && isSeen(z)) { best = d; which = segment_curve[i] - 1; }
    }
    if (which >= 0) return found('curve', which);
    if (kind === 'curve') return null;
  }
  if (!hit) return null;
  const { hex, quad } = hit;
  if (scene.isCad) {
    if (kind === 'geometry' || kind === 'surface') return found('surface', hit.surface - 1);
    const [volume] = scene.meta.volumes_of_surface[hit.surface - 1];
    return kind === 'volume' && volume ? found('volume', volume - 1) : null;
  }
  if (kind === 'hex') return found('hex', hex, scene.hexId(hex));
  if (kind === 'volume') {
    const volume = (scene.insideNow?.volume ?? (await scene.channel(0)))[hex];
    return volume ? found('volume', volume - 1) : null;
  }
  if (kind === 'block') {
    const sets = await scene.sets();
    const i = scene.meta.block.findIndex((row) => has(sets[`block ${row[0]}`], hex));
    return i < 0 ? null : found('block', i, scene.meta.block[i][0]);
  }
  if (quad < 0) return kind === 'geometry' ? found('hex', hex, scene.hexId(hex)) : null;
  if (kind === 'geometry' || kind === 'surface') {
    const surface = quads.surface[quad];
    if (surface) return found('surface', surface - 1);
    return kind === 'geometry' ? found('hex', hex, scene.hexId(hex)) : null;
  }
  if (kind === 'face') return found('face', quads.face[quad]);
  const places = [0, 1, 2, 3].map((k) => quads.corner[4 * quad + k]), { points } = quads;
  const offset = quads.offset ? quads.offset.subarray(3 * quad, 3 * quad + 3) : [0, 0, 0];
  const corners = places.map((i) => screen(points[3 * i] + offset[0], points[3 * i + 1] + offset[1], points[3 * i + 2] + offset[2]));
  const nodeOf = (k) => (quads.node ? quads.node[places[k]] : places[k]);
  if (kind === 'node' || kind === 'nodeset') {
    const d = corners.map((c) => Math.hypot(c.x - x, c.y - y)), node = nodeOf(d.indexOf(Math.min(...d)));
    if (kind === 'node') return found('node', node, scene.nodeId(node));
    const sets = await scene.sets(), i = scene.meta.nodeset.findIndex((row) => has(sets[`nodeset ${row[0]}`], node));
    return i < 0 ? null : found('nodeset', i, scene.meta.nodeset[i][0]);
  }
  if (kind === 'sideset') {
    const sets = await scene.sets(), side = 6 * hex + quads.side[quad];
    const i = scene.meta.sideset.findIndex((row) => has(sets[`sideset ${row[0]}`], side));
    return i < 0 ? null : found('sideset', i, scene.meta.sideset[i][0]);
  }
  const d = [0, 1, 2, 3].map((k) => toSegment(x, y, corners[k], corners[(k + 1) % 4])[0]), k = d.indexOf(Math.min(...d));
  const cycle = faceCycle[quads.side[quad]], e = edgeBetween(cycle[k], cycle[(k + 1) % 4]);
  if (kind === 'edge' && !scene.insideNow) {
    // Of the skin it is known without the inside.
    const a = places[k], b = places[(k + 1) % 4], low = nodeOf(k) < nodeOf((k + 1) % 4) ? a : b, high = low === a ? b : a;
    const edge = skinEdge(scene, low, high);
    if (edge >= 0) return found('edge', edge);
  }
  const inside = await scene.inside(), edge = inside.edges.ofHex[12 * hex + e];
  if (kind === 'edge') return found('edge', edge);
  if (kind === 'sheet') return found('sheet', inside.sheets.ofEdge[edge]);
  return null;
}

function skinEdge(scene, low, high) {
  if (!scene.skinEdges_) {
    scene.skinEdges_ = new Map();
    const { edge, edge_index } = scene.skin, n = scene.skin.node.length;
    for (let i = 0; i < edge_index.length; ++i) scene.skinEdges_.set(edge[2 * i] * n + edge[2 * i + 1], edge_index[i]);
  }
  return scene.skinEdges_.get(low * scene.skin.node.length + high) ?? -1;
}

/** Is a number in an ascending list? */
function has(list, value) {
  let low = 0, high = list?.length ?? 0;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low < (list?.length ?? 0) && list[low] === value;
}

/** Hexes of which a drawn face has its middle within a polygon of the screen; hidden ones too where `through`. */
export function hexesWithin(pane, camera, width, height, polygon, through) {
  const matrix = new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse), p = new THREE.Vector3();
  const { quads, scene } = pane, hexes = new Set(), ray = new THREE.Raycaster();
  const [x0, x1] = [Math.min(...polygon.map((v) => v[0])), Math.max(...polygon.map((v) => v[0]))];
  const [y0, y1] = [Math.min(...polygon.map((v) => v[1])), Math.max(...polygon.map((v) => v[1]))];
  const isWithin = (x, y) => {
    if (x < x0 || x > x1 || y < y0 || y > y1) return false;
    let odd = false;
    for (let i = 0, j = polygon.length - 1; i < polygon.length; j = i++) {
      const [ax, ay] = polygon[i], [bx, by] = polygon[j];
      if (ay > y !== by > y && x < ((bx - ax) * (y - ay)) / (by - ay) + ax) odd = !odd;
    }
    return odd;
  };
  const project = (x, y, z) => {
    p.set(x, y, z).applyMatrix4(matrix);
    return p.z > -1 && p.z < 1 && isWithin(((p.x + 1) * width) / 2, ((1 - p.y) * height) / 2);
  };
  if (through && scene.insideNow) {
    const { centres, nHexes } = scene.insideNow;
    for (let h = 0; h < nHexes; ++h)
      if ((!pane.shown || pane.shown[h]) && project(centres[3 * h], centres[3 * h + 1], centres[3 * h + 2])) hexes.add(h);
    return hexes;
  }
  const tree = pane.tree(), middle = new THREE.Vector3(), clip = pane.faces.material.uniforms.clip.value;
  for (let q = 0; q < quads.n; ++q) {
    middle.set(0, 0, 0);
    for (let k = 0; k < 4; ++k) {
      const at = 3 * quads.corner[4 * q + k];
      middle.x += quads.points[at] / 4; middle.y += quads.points[at + 1] / 4; middle.z += quads.points[at + 2] / 4;
    }
    if (quads.offset) middle.add(p.fromArray(quads.offset, 3 * q));
    if (isCutOff(middle, clip)) continue;
    if (!project(middle.x, middle.y, middle.z)) continue;
    if (!through) {
      // Seen: nothing is met before it.
      ray.setFromCamera(new THREE.Vector2(p.x, p.y), camera);
      const first = firstMet(tree, ray.ray, clip);
      if (first && first.faceIndex >> 1 !== q && first.distance < ray.ray.origin.distanceTo(middle) - 1e-3 * scene.radius) continue;
    }
    hexes.add(quads.hex[q]);
  }
  return hexes;
}
