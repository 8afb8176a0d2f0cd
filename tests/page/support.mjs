// A browser, the program, and what a mesh says of a pixel: read from the text that the program writes for Gmsh, found
// by trying every face. No code of the page is used.
import { execFileSync, spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';

const setting = (name) => {
  if (!process.env[name]) throw new Error(`${name} is not set: these tests are run by ctest`);
  return process.env[name];
};
export const program = setting('HEXTWIST_PROGRAM'), source = setting('HEXTWIST_SOURCE'), output = setting('HEXTWIST_OUTPUT');
const chromiumPath = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find(existsSync);
if (!chromiumPath) {
  console.log('skipped: there is no Chromium (Debian: chromium)');
  process.exit(77);
}
mkdirSync(output, { recursive: true });
const { chromium } = createRequire(join(setting('HEXTWIST_NODE_MODULES'), 'x.js'))('playwright-core');

/** Without a sandbox where it is root who asks, as in containers; drawing by software, as there is no screen. */
export const browser = () =>
  chromium.launch({
    executablePath: chromiumPath,
    args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'],
  });

/** A tab on a page that is ready. problems: what the console and the network had to complain of. */
export async function open(browser, address, size = { width: 1280, height: 720 }) {
  const page = await browser.newPage({ viewport: size, colorScheme: 'light' });
  page.setDefaultTimeout(120000);
  page.problems = [];
  page.on('console', (m) => { if (m.type() === 'error' || m.type() === 'warning') page.problems.push(m.text()); });
  page.on('pageerror', (e) => page.problems.push(e.message));
  page.on('request', (r) => { if (!r.url().startsWith(address.split('?')[0]) && !r.url().startsWith('data:')) page.problems.push(`asks for ${r.url()}`); });
  await page.goto(address);
  await page.waitForFunction(() => window.hextwist?.ready);
  return page;
}

export const run = (args, options = {}) => execFileSync(program, args, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'], cwd: output, ...options });
/** What a run that may fail says on standard error. */
export const spawn = (args) => spawnSync(program, args, { encoding: 'utf8', cwd: output }).stderr;
export const model = (name) => ['--cad', join(source, 'models', `${name}.brep`), join(source, 'models', `${name}.msh`)];

/** Kept with the results. */
export const shot = (page, name) => page.screenshot({ path: join(output, `${name}.png`) });
export const value = (page, id) => page.$eval(`#${id}`, (e) => e.value);
/** Until cuts and the like are done. */
export const settled = (page) => page.evaluate(async () => { await hextwist.queue; await new Promise((r) => setTimeout(r, 60)); });
/** What a click picks from now on. */
export const kindOf = (page, kind) => page.click(`#pick-kinds label:has(input[value="${kind}"])`);

/** Runs commands on a model (null: none) and draws the page; returns its address. */
export function drawn(name, start, commands = '', words = '') {
  const file = join(output, `${name}.html`);
  run([...(start ? model(start) : []), '-c', `${commands ? commands + '; ' : ''}draw ${words} to '${file}' overwrite`]);
  return `file://${file}`;
}

const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((v) => v / Math.hypot(...a));

/** The mesh after these commands, with entities and ids. */
export function truth(start, commands = '') {
  const file = join(output, 'truth.msh');
  run([...(start ? model(start) : []), '-c', `${commands ? commands + '; ' : ''}export gmsh '${file}' text version 2.2 overwrite`]);
  const lines = readFileSync(file, 'utf8').split('\n'), after = (mark) => lines.indexOf(mark) + 2;
  const points = new Map(), quads = [], curves = [], vertices = new Map(), hexes = [];
  for (let i = after('$Nodes'); lines[i] !== '$EndNodes'; ++i) {
    const [id, ...p] = lines[i].trim().split(' ').map(Number);
    points.set(id, p);
  }
  for (let i = after('$Elements'); lines[i] !== '$EndElements'; ++i) {
    const [id, type, nTags, ...rest] = lines[i].trim().split(' ').map(Number), entity = rest[1], nodes = rest.slice(nTags);
    if (type === 15) vertices.set(entity, nodes[0]);
    if (type === 1) curves.push({ curve: entity, nodes });
    if (type === 3) quads.push({ surface: entity, nodes });
    if (type === 5) hexes.push({ id, volume: entity, nodes });
  }
  return new Truth(points, quads, curves, vertices, hexes);
}

const faceCorners = [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
const edgeEnds = [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];
const byParts = (a, b) => { for (let i = 0; i < a.length; ++i) if (a[i] !== b[i]) return a[i] - b[i]; return 0; };

class Truth {
  constructor(points, quads, curves, vertices, hexes) {
    Object.assign(this, { points, quads, curves, vertices, hexes });
    const all = [...points.values()], low = [0, 1, 2].map((k) => Math.min(...all.map((p) => p[k]))), high = [0, 1, 2].map((k) => Math.max(...all.map((p) => p[k])));
    this.middle = [0, 1, 2].map((k) => (low[k] + high[k]) / 2);
    // Ids of faces and edges by what the manual says of their order.
    const faces = new Map(), edges = new Map();
    for (const hex of hexes) {
      for (const corners of faceCorners) {
        const cycle = corners.map((c) => hex.nodes[c]), at = cycle.indexOf(Math.min(...cycle));
        const key = [cycle[at], cycle[(at + 2) % 4], Math.min(cycle[(at + 1) % 4], cycle[(at + 3) % 4])], name = key.join();
        if (faces.has(name)) faces.get(name).hexes.push(hex);
        else faces.set(name, { key, cycle, hexes: [hex] });
      }
      for (const [a, b] of edgeEnds) {
        const key = [Math.min(hex.nodes[a], hex.nodes[b]), Math.max(hex.nodes[a], hex.nodes[b])];
        edges.set(key.join(), { key });
      }
    }
    this.faces = [...faces.values()].sort((a, b) => byParts(a.key, b.key));
    this.faces.forEach((face, i) => { face.id = i + 1; });
    this.edges = [...edges.values()].sort((a, b) => byParts(a.key, b.key));
    this.edges.forEach((edge, i) => { edge.id = i + 1; });
    this.edgeIds = new Map(this.edges.map((edge) => [edge.key.join(), edge.id]));
    const surfaces = new Map(quads.map((quad) => [[...quad.nodes].sort((a, b) => a - b).join(), quad.surface]));
    this.skin = this.faces.filter((face) => face.hexes.length === 1);
    for (const face of this.faces) face.surface = surfaces.get([...face.cycle].sort((a, b) => a - b).join()) ?? 0;
  }

  /** What is seen in parallel projection from a direction, z up: frame of the screen, `height` of the model across it. */
  look(direction, height, width, pixels) {
    const back = unit(direction);
    let right = cross([0, 0, 1], back);
    right = Math.hypot(...right) < 1e-9 ? [1, 0, 0] : unit(right);
    return { right, up: cross(back, right), back, scale: pixels / height, width, pixels };
  }
  pixel(view, p) {
    const d = sub(p, this.middle);
    return [view.width / 2 + view.scale * dot(d, view.right), view.pixels / 2 - view.scale * dot(d, view.up)];
  }
  depth(view, p) { return dot(sub(p, this.middle), view.back); }

  /** The face that is met first at a pixel: { face, depth, margin }: how far from its rim, in pixels. */
  meet(view, x, y, faces = this.skin) {
    let best = null;
    for (const face of faces) {
      const p = face.cycle.map((n) => { const q = this.points.get(n), [u, v] = this.pixel(view, q); return [u, v, this.depth(view, q)]; });
      for (const [i, j, k] of [[0, 1, 2], [0, 2, 3]]) {
        const [a, b, c] = [p[i], p[j], p[k]], area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if (Math.abs(area) < 1e-9) continue;
        const u = ((b[0] - x) * (c[1] - y) - (b[1] - y) * (c[0] - x)) / area, v = ((c[0] - x) * (a[1] - y) - (c[1] - y) * (a[0] - x)) / area, w = 1 - u - v;
        if (u < 0 || v < 0 || w < 0) continue;
        const depth = u * a[2] + v * b[2] + w * c[2];
        if (!best || depth > best.depth) best = { face, depth, corners: p };
      }
    }
    if (best) best.margin = Math.min(...best.corners.map((a, i) => toLine(x, y, a, best.corners[(i + 1) % 4])));
    return best;
  }
}

export function toLine(x, y, a, b) {
  const dx = b[0] - a[0], dy = b[1] - a[1], square = dx * dx + dy * dy;
  const t = square > 0 ? Math.max(0, Math.min(1, ((x - a[0]) * dx + (y - a[1]) * dy) / square)) : 0;
  return Math.hypot(x - a[0] - t * dx, y - a[1] - t * dy);
}

/**
 * How much two pictures differ: the share of cells of 8 by 8 pixels whose average colours are more than `tolerance` (of
 * 255) apart in one of red, green, blue. The backgrounds, the colours at the upper left, count as the same.
 */
export async function difference(browser, a, b, tolerance = 30) {
  const page = await browser.newPage();
  const share = await page.evaluate(async ([images, tolerance]) => {
    const cell = 8, [p, q] = await Promise.all(images.map(async (image) => {
      const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${image}`)).blob()), { width, height } = bitmap, pen = new OffscreenCanvas(width, height).getContext('2d');
      pen.drawImage(bitmap, 0, 0);
      const { data } = pen.getImageData(0, 0, width, height), back = data.slice(0, 3), sums = [];
      for (let y = 0; y + cell <= height; y += cell)
        for (let x = 0; x + cell <= width; x += cell) {
          const sum = [0, 0, 0];
          for (let j = 0; j < cell; ++j)
            for (let i = 0; i < cell; ++i) {
              const at = 4 * ((y + j) * width + x + i), isBack = [0, 1, 2].every((k) => data[at + k] === back[k]);
              for (let k = 0; k < 3; ++k) sum[k] += (isBack ? 255 : data[at + k]) / cell ** 2;
            }
          sums.push(sum);
        }
      return { width, height, sums };
    }));
    if (p.width !== q.width || p.height !== q.height) return 1;
    const isDrawn = (sum) => sum.some((v) => v < 250), drawn = p.sums.filter((sum, i) => isDrawn(sum) || isDrawn(q.sums[i])).length;
    return p.sums.filter((sum, i) => sum.some((v, k) => Math.abs(v - q.sums[i][k]) > tolerance)).length / Math.max(1, drawn);
  }, [[a, b].map((image) => image.toString('base64')), tolerance]);
  await page.close();
  return share;
}

/** Repeatable numbers from 0 to 1. */
export function random(seed) {
  return () => {
    seed = (seed * 1664525 + 1013904223) >>> 0;
    return seed / 2 ** 32;
  };
}

/** Ids in what `list` prints: a line for each of a kind, or a table with the kind on top of its first column. */
export function listed(text, kind) {
  const lines = text.split('\n'), head = lines.findIndex((line) => line.startsWith(`${kind} `) && !/^\S+ \d/.test(line));
  const rows = head < 0 ? lines.map((line) => line.match(`^\\s*${kind} (\\d+)`)) : lines.slice(head + 1).map((line) => line.match(/^(\d+)/));
  return rows.filter(Boolean).map((row) => Number(row[1]));
}

/** The same numbers as a range of commands: "hex 1 3 to 5". */
export function idsOf(range) {
  const words = range.split(' ').slice(1), ids = [];
  for (let i = 0; i < words.length; ++i) {
    if (words[i] === 'to') {
      const last = Number(words[++i]);
      while (ids[ids.length - 1] < last) ids.push(ids[ids.length - 1] + 1);
    } else ids.push(Number(words[i]));
  }
  return ids;
}
