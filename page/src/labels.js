// Where the ids of entities may stand: per entity some places, of which the first that is seen is taken.

const most = 60000, places = 24;

/** { texts, places: per text an array of points, three numbers each, textOf(q): what a drawn face has, where it is faces that have them }. */
export async function labelPlaces(pane, kind) {
  const { scene, quads } = pane, of = new Map();
  let keyOf = null;
  const add = (key, x, y, z) => {
    if (!key || (of.size >= most && !of.has(key))) return;
    if (!of.has(key)) of.set(key, []);
    of.get(key).push(x, y, z);
  };
  if (kind === 'vertex' || kind === 'curve') {
    const cad = await scene.cad();
    if (!cad?.vertex) return { texts: [], places: [] };
    if (kind === 'vertex') for (let i = 0; 3 * i < cad.vertex.length; ++i) add(i + 1, ...cad.vertex.subarray(3 * i, 3 * i + 3));
    else cad.segment_curve.forEach((c, i) => add(c, ...cad.segment.subarray(6 * i, 6 * i + 3)));
  } else if (kind === 'edge') {
    const { edge, edge_index, point } = scene.skin;
    edge_index.forEach((e, i) => add(e + 1, ...[0, 1, 2].map((k) => (point[3 * edge[2 * i] + k] + point[3 * edge[2 * i + 1] + k]) / 2)));
  } else if (scene.isCad) {
    const { quad, quad_surface, point } = pane.cadArrays ?? { quad_surface: [] };
    quad_surface.forEach((surface, q) => {
      const c = [0, 1, 2].map((k) => [0, 1, 2].reduce((sum, i) => sum + point[3 * quad[4 * q + i] + k] / 3, 0));
      if (kind === 'surface') add(surface, ...c);
      if (kind === 'volume') for (const volume of scene.meta.volumes_of_surface[surface - 1]) add(volume, ...c);
    });
  } else {
    const volume = kind === 'volume' ? (scene.insideNow?.volume ?? (await scene.channel(0))) : null;
    keyOf = { surface: (q) => quads.surface[q], face: (q) => quads.face[q] + 1, volume: (q) => volume[quads.hex[q]], hex: (q) => scene.hexId(quads.hex[q]) }[kind] ?? null;
    for (let q = 0; q < quads.n; ++q) {
      const c = [0, 0, 0], moved = quads.offset?.subarray(3 * q, 3 * q + 3) ?? [0, 0, 0];
      for (let k = 0; k < 4; ++k) {
        const at = quads.corner[4 * q + k], p = quads.points.subarray(3 * at, 3 * at + 3);
        if (kind === 'node') {
          const id = scene.nodeId(quads.node ? quads.node[at] : at);
          if (!of.has(id)) add(id, p[0] + moved[0], p[1] + moved[1], p[2] + moved[2]);
        } else for (let j = 0; j < 3; ++j) c[j] += (p[j] + moved[j]) / 4;
      }
      if (keyOf) add(keyOf(q), ...c);
    }
  }
  // The middle ones first, then others all over it.
  const sorted = [...of].map(([key, points]) => {
    const n = points.length / 3, middle = [0, 1, 2].map((k) => points.reduce((sum, v, i) => (i % 3 === k ? sum + v : sum), 0) / n);
    const distance = (i) => (points[3 * i] - middle[0]) ** 2 + (points[3 * i + 1] - middle[1]) ** 2 + (points[3 * i + 2] - middle[2]) ** 2;
    const order = Array.from({ length: n }, (_, i) => i).sort((a, b) => distance(a) - distance(b));
    const step = Math.max(1, n / places), chosen = [];
    for (let i = 0; i < n && chosen.length < 3 * places; i += step) {
      const at = order[Math.floor(i)];
      chosen.push(points[3 * at], points[3 * at + 1], points[3 * at + 2]);
    }
    return [String(key), chosen];
  });
  return { texts: sorted.map(([text]) => text), places: sorted.map(([, chosen]) => chosen), textOf: keyOf && ((q) => String(keyOf(q))) };
}
