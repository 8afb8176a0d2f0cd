// The viewer: what is picked, shown, cut; controls and keys.
import * as THREE from 'three';
import { Colouring } from './colouring.js';
import { fillHelp } from './help.js';
import { labelPlaces } from './labels.js';
import { EntityList } from './list.js';
import { boundsOf, Pane } from './pane.js';
import { commands, Picks, rangeText, readRange } from './picks.js';
import { short } from './scene.js';
import { Stage } from './stage.js';

const element = (id) => document.getElementById(id);
const kindsToPick = [['geometry', 'auto'], ['vertex'], ['curve'], ['surface'], ['volume'], ['node'], ['edge'], ['face'], ['hex'], ['block'], ['sheet'], ['nodeset'], ['sideset']];
const themes = {
  light: { back: '#f7f9fc', ink: '#1b2230', pick: '#c2410c', hint: '#2563c9', plain: [214, 221, 231], label: 'rgba(29,36,48,0.88)', labelText: '#fff', axes: ['#c8372d', '#3c8a34', '#2f62c4'], edge: [0.12, 0.14, 0.18], cad: [0.74, 0.78, 0.84] },
  dark: { back: '#191e26', ink: '#e8edf5', pick: '#ff8a4c', hint: '#6aa2f5', plain: [148, 158, 174], label: 'rgba(232,237,245,0.92)', labelText: '#14181f', axes: ['#ff7b70', '#74c96a', '#7fa8ff'], edge: [0.05, 0.06, 0.08], cad: [0.5, 0.55, 0.63] },
};

export class App {
  constructor() {
    const dark = document.documentElement.dataset.theme ? document.documentElement.dataset.theme === 'dark' : matchMedia('(prefers-color-scheme: dark)').matches;
    this.theme = {};
    this.setTheme(dark ? 'dark' : 'light');
    this.picks = new Picks();
    this.picks.changed = () => this.picked();
    this.clip = { mode: 'off', normal: [1, 0, 0], distance: 0 };
    this.shownHexes = null;  // per hex, null: all
    this.explode = 0;
    this.panes = [];
    this.queue = Promise.resolve();
    this.stage = new Stage(element('view'), element('over'), this.theme, {
      hover: (found, at) => this.hover(found, at),
      pick: (found, add) => this.clicked(found, add),
      area: (pane, hexes, add) => this.pickHexes([...hexes], add),
    });
    this.colouring = new Colouring(this);
    this.list = new EntityList(this, { pick: (...pick) => this.picks.pick(...pick), fit: (kind, position) => this.fitTo(kind, [position]) });
    this.controls();
    this.keys();
  }

  get pane() { return this.panes[this.panes.length - 1]; }
  get scene() { return this.pane.scene; }
  draw() { this.stage.draw(); }
  say(text) { element('status').value = text; }

  /** Shows a scene. before: loads what was before, which can be shown beside it; null: nothing. keep: the eye stays. */
  async open(scene, { before = null, keep = false } = {}) {
    if (this.panes.length && this.scene.isCad !== scene.isCad) keep = false;  // a mesh has come, or has gone
    for (const pane of this.panes) pane.dispose();
    this.before = before;
    this.panes = [new Pane(scene, this.theme)];
    element('title').textContent = scene.meta.title;
    document.title = `${scene.meta.title} – hextwist`;
    element('counts').textContent = scene.isCad ? `${scene.count('surface').toLocaleString('en')} surfaces, no mesh` : `${scene.meta.n_hexes.toLocaleString('en')} hexes, ${scene.meta.n_nodes.toLocaleString('en')} nodes`;
    const beforeButton = document.querySelector('[data-toggle="before"]');
    beforeButton.hidden = !before;
    if (!before) beforeButton.setAttribute('aria-pressed', false);
    const { start } = scene.meta;
    if (!keep) {
      this.stage.eye.look(...start.view);
      this.stage.eye.fit(new THREE.Vector3(), scene.radius / this.stage.narrowness);
      this.shownHexes = null;
      this.explode = 0;
    }
    if (scene.isCad || !keep) element('what').value = start.what;
    this.stage.setPanes(this.panes);
    this.applyLook();
    await this.pane.loadCad();
    this.list.reset(scene);
    await this.colouring.reset(scene);
    if (keep) {
      this.shownHexes = null;
      await this.rebuild();
      await this.repick();
    } else {
      element('explode').value = 0;
      if (start.kind) {
        await this.pickIds(start.kind, start.ids);
        if (['hex', 'volume', 'block', 'sheet', 'face', 'surface', 'sideset'].includes(start.kind) && scene.hasInside && !scene.isCad) await this.showOnly();
      }
      if (start.cut) await this.startCut(start.cut);
      if (start.labels) {
        this.setKind(start.labels);
        this.toggle('labels', true);
      }
    }
    // The first hover shall not wait for it.
    (window.requestIdleCallback ?? setTimeout)(() => this.pane.tree());
    if (scene.meta.left_out.length) this.say(`left out, as the page would be too large: ${scene.meta.left_out.join(', ')}`);
  }

  async showBefore(on) {
    const narrowBefore = this.stage.narrowness;
    if (on && this.before && this.panes.length === 1) {
      const { before } = this, scene = await this.busy('loading the mesh before', before);
      if (!scene || this.before !== before) return;  // there is another mesh by now
      const pane = new Pane(scene, this.theme);
      await pane.loadCad();
      this.panes.unshift(pane);
    } else if (!on && this.panes.length > 1) this.panes.shift().dispose();
    this.stage.setPanes(this.panes);
    this.stage.eye.height *= narrowBefore / this.stage.narrowness;  // all of it is seen in narrow panes as well
    element('names').className = this.panes.length > 1 ? 'two' : '';
    this.applyLook();
    await this.colouring.choose(this.colouring.key);
    await this.rebuild();
  }

  /** Runs a task that may take a moment, and says so if it does. */
  async busy(what, task) {
    const timer = setTimeout(() => { element('busy').textContent = what; element('busy').hidden = false; }, 120);
    try {
      return await task();
    } catch (error) {
      this.say(error.message);
      throw error;
    } finally {
      clearTimeout(timer);
      element('busy').hidden = true;
    }
  }

  // What is picked.

  describe(found) {
    const { kind, position, id, pane, hit } = found, row = pane.scene.row(kind, position), parts = [`${kind} ${id}`];
    if (row.name) parts.push(`"${row.name}"`);
    if (row.note) parts.push(row.note);
    if (kind !== 'hex' && hit?.hex >= 0) parts.push(`hex ${pane.scene.hexId(hit.hex)}`);
    const value = kind === 'node' ? this.colouring.said(pane, position, 'node') : hit?.hex >= 0 ? this.colouring.said(pane, hit.hex, 'hex') : '';
    if (value) parts.push(value);
    return parts.join(' · ');
  }
  async hover(found, at) {
    const tip = element('tip'), stage = this.stage;
    const key = found ? `${found.kind} ${found.id} ${this.panes.indexOf(found.pane)}` : '';
    if (found && at) {
      tip.textContent = this.describe(found);
      tip.hidden = false;
      const wide = tip.offsetWidth;
      tip.style.left = `${Math.min(at[0] + 14, stage.width - wide - 4)}px`;
      tip.style.top = `${at[1] + 34 > stage.height ? at[1] - 28 : at[1] + 14}px`;
      if (found.hit) {
        const p = found.hit.point.toArray().map((v, k) => short(v + found.pane.scene.meta.origin[k]));
        element('where').textContent = `(${p.join(', ')})`;
      }
    } else {
      tip.hidden = true;
      element('where').textContent = '';
    }
    if (key === this.hovered) return;
    this.hovered = key;
    for (const pane of this.panes) if (pane !== found?.pane) pane.mark(pane.hints, null);
    if (found) {
      const shape = await found.pane.shapeOf(found.kind, [found.position]);
      if (this.hovered !== key) return;
      found.pane.mark(found.pane.hints, shape, this.theme.hint, false);
    }
    this.draw();
  }
  clicked(found, add) {
    if (!found) {
      if (!add) this.picks.clear();
      return;
    }
    this.picks.pick(found.kind, found.id, found.position, add);
    this.say(this.describe(found));
    this.lastHit = found.hit;
    this.list.reveal(found.kind, found.position);
  }
  async pickHexes(hexes, add = false) {
    if (this.scene.skin.quad_hex_id && this.scene.hasInside) await this.busy('loading ids', () => this.scene.inside());
    const pairs = hexes.map((h) => [this.scene.hexId(h), h]);
    this.picks.set('hex', add && this.picks.kind === 'hex' ? [...this.picks.ids, ...pairs] : pairs);
    this.say(`${hexes.length.toLocaleString('en')} ${hexes.length === 1 ? 'hex' : 'hexes'} picked`);
  }
  async pickNodes(nodes) {
    if (this.scene.skin.node_id && this.scene.hasInside) await this.busy('loading ids', () => this.scene.inside());
    this.picks.set('node', nodes.map((n) => [this.scene.nodeId(n), n]));
    this.say(`${nodes.length.toLocaleString('en')} ${nodes.length === 1 ? 'node' : 'nodes'} picked`);
  }
  async pickIds(kind, ids) {
    if (!this.scene.meta[kind] && this.scene.hasInside && this.scene.count(kind) === null) await this.scene.inside();
    if ((kind === 'hex' && this.scene.skin.quad_hex_id) || (kind === 'node' && this.scene.skin.node_id)) await this.scene.inside();
    this.picks.set(kind, ids.map((id) => [id, this.scene.find(kind, id)]).filter(([, position]) => position >= 0));
  }
  /** What was typed as a range. */
  async pickTyped(text) {
    if (!text.trim()) return this.picks.clear();
    if (!this.panes.length) return this.say('there is no mesh');
    try {
      const { kind, ids } = readRange(text, this.picks.kind), { scene } = this;
      if (scene.count(kind) === null || ids === null) await this.busy('loading the inside', () => scene.inside());
      const n = scene.count(kind) ?? 0;
      await this.pickIds(kind, ids ?? Array.from({ length: n }, (_, i) => scene.row(kind, i).id));
      const known = new Set(ids ?? []).size, missing = ids ? known - this.picks.size : 0;
      if (this.list.kind !== kind && n) await this.list.show(kind);
      this.say(missing ? `${missing.toLocaleString('en')} of these ${known.toLocaleString('en')} ids do not exist` : `${this.picks.size.toLocaleString('en')} picked`);
    } catch (error) {
      this.say(error.message);
    }
  }
  /** After the mesh has changed: what is still there stays picked. */
  async repick() { await this.pickIds(this.picks.kind, [...this.picks.ids.keys()]); }

  async picked() {
    const { picks } = this, ticket = (this.ticket = {});
    element('range').value = picks.size ? `${picks.kind} ${rangeText(picks.ids.keys())}` : '';
    element('command').value = await this.commandText();
    element('run-command').hidden = !this.live || !picks.size;
    this.list.render();
    if (picks.kind !== 'group') {
      const shape = picks.size ? await this.busy('looking it up', () => this.pane.shapeOf(picks.kind, [...picks.ids.values()])) : null;
      if (this.ticket !== ticket) return;
      // Twist planes say where a sheet is; its hexes would hide them.
      const planes = element('planes').checked && picks.kind === 'sheet' ? [...picks.ids.values()].slice(0, 60) : [];
      await this.pane.showPlanes(planes);
      this.pane.mark(this.pane.marks, planes.length ? null : shape, this.theme.pick, true);
    }
    this.draw();
  }
  async commandText() {
    const kind = element('command-kind').value;
    if (this.picks.kind === 'sheet' && kind.startsWith('refine') && this.picks.size === 1) {
      // A sheet is named by one of its edges.
      const inside = await this.scene.inside(), edge = inside.sheets.ofEdge.indexOf([...this.picks.ids.values()][0]);
      return `refine sheet edge ${edge + 1}`;
    }
    return this.picks.text(kind);
  }
  async fitTo(kind, positions, around = 1.3) {
    const shape = await this.busy('looking it up', () => this.pane.shapeOf(kind, positions)), bounds = boundsOf(shape);
    if (!bounds) return;
    this.stage.eye.fit(bounds.center, Math.max(bounds.radius * around, this.scene.radius * 0.04) / this.stage.narrowness);
    this.draw();
  }
  fit() {
    if (this.picks.size) return this.fitTo(this.picks.kind, [...this.picks.ids.values()]);
    // What has been taken apart needs more room.
    const bounds = this.explode ? boundsOf(this.pane) : null;
    this.stage.eye.fit(bounds?.center ?? new THREE.Vector3(), (bounds?.radius ?? this.scene.radius) / this.stage.narrowness);
    this.draw();
  }
  /** Picks a hex or node and fits to it. */
  async goTo(kind, position) {
    if (this.scene.hasInside) await this.busy('loading the inside', () => this.scene.inside());
    await (kind === 'hex' ? this.pickHexes([position]) : this.pickNodes([position]));
    await this.picked();
    await this.fitTo(kind, [position], 7);
    this.say(`${this.nameOf(kind, position)} · ${this.colouring.said(this.pane, position, kind)}`);
  }
  nameOf(kind, position) { return `${kind} ${kind === 'hex' ? this.scene.hexId(position) : this.scene.nodeId(position)}`; }

  // What is shown.

  async hexesPicked() {
    const { picks, scene, pane } = this, inside = await scene.inside(), positions = [...picks.ids.values()];
    if (picks.kind === 'hex') return new Set(positions);
    if (picks.kind === 'sheet') return new Set(positions.flatMap((s) => inside.hexesOfSheet(s)));
    if (picks.kind === 'volume') return new Set(Array.from(inside.volume.keys()).filter((h) => positions.includes(inside.volume[h] - 1)));
    if (picks.kind === 'block') {
      const sets = await scene.sets();
      return new Set(positions.flatMap((p) => [...sets[`block ${scene.meta.block[p][0]}`]]));
    }
    const shape = await pane.shapeOf(picks.kind, positions), hexes = new Set();
    if (shape.quads) for (const h of shape.quads.hex) hexes.add(h);
    else {
      // Hexes that touch it.
      const nodes = new Set(await this.nodesPicked(inside));
      for (let h = 0; h < inside.nHexes; ++h)
        for (let c = 0; c < 8; ++c) if (nodes.has(inside.hexes[8 * h + c])) { hexes.add(h); break; }
    }
    return hexes;
  }
  async nodesPicked(inside) {
    const { picks, scene } = this, positions = [...picks.ids.values()];
    if (picks.kind === 'node') return positions;
    if (picks.kind === 'edge') return positions.flatMap((e) => [inside.edges.nodes[2 * e], inside.edges.nodes[2 * e + 1]]);
    if (picks.kind === 'nodeset') {
      const sets = await scene.sets();
      return positions.flatMap((p) => [...sets[`nodeset ${scene.meta.nodeset[p][0]}`]]);
    }
    const ids = new Set(positions.map((p) => p + 1)), out = [], { curve_edge, curve_of_edge } = scene.skin;
    if (picks.kind === 'curve') curve_of_edge.forEach((c, i) => { if (ids.has(c)) out.push(curve_edge[2 * i], curve_edge[2 * i + 1]); });
    else inside.ownerDim.forEach((dim, n) => { if (dim === 0 && ids.has(inside.ownerId[n])) out.push(n); });
    return out;
  }
  async showOnly(hexes = null) {
    const wanted = hexes ?? (await this.hexesPicked());
    if (!wanted.size) return this.say('nothing is picked');
    this.shownHexes = new Uint8Array(this.scene.meta.n_hexes);
    for (const h of wanted) this.shownHexes[h] = 1;
    await this.rebuild();
    this.say(`${wanted.size.toLocaleString('en')} of ${this.scene.meta.n_hexes.toLocaleString('en')} hexes shown`);
  }
  async hide() {
    const wanted = await this.hexesPicked();
    this.shownHexes ??= new Uint8Array(this.scene.meta.n_hexes).fill(1);
    for (const h of wanted) this.shownHexes[h] = 0;
    this.picks.clear();
    await this.rebuild();
  }
  async column() {
    if (this.scene.isCad) return this.say('there is no mesh');
    const hit = this.lastHit, inside = await this.scene.inside(), hex = this.picks.kind === 'hex' && this.picks.size ? [...this.picks.ids.values()][0] : hit?.hex;
    if (hex === undefined) return this.say('pick a face or a hex first: the column runs through the face that was clicked');
    const side = hit && hit.quad >= 0 && hit.hex === hex ? this.pane.quads.side[hit.quad] : 0;
    const hexes = inside.column(hex, side);
    await this.pickHexes(hexes);
    await this.showOnly(new Set(hexes));
    this.say(`column of ${hexes.length} hexes`);
  }
  async sheetsOfPicked() {
    const inside = await this.scene.inside();
    let sheets;
    if (this.picks.kind === 'edge') sheets = [...this.picks.ids.values()].map((e) => inside.sheets.ofEdge[e]);
    else sheets = [...(await this.hexesPicked())].slice(0, 1000).flatMap((h) => inside.sheetsOfHex(h));
    const pairs = [...new Set(sheets)].sort((a, b) => a - b).map((s) => [s + 1, s]);
    if (!pairs.length) return this.say('nothing is picked');
    element('planes').checked = true;
    this.picks.set('sheet', pairs);
    this.list.reveal('sheet', pairs[0][1]);
  }
  /** Sheets that run through hexes which were cut, and through no other: by levels, or by the last change. */
  async planesOfRefinement() {
    if (this.scene.isCad) return this.say('there is no mesh');
    const { channels } = this.scene.meta, i = ['template', 'changed'].map((name) => channels.findIndex((c) => c.name === name && c.is_class)).find((at) => at >= 0) ?? -1;
    if (i < 0) return this.say('how this mesh was refined is not in this page: it is where the commands are run, and with --before or --levels');
    const inside = await this.scene.inside();
    const cut = await this.scene.channel(i), outside = new Uint8Array(inside.sheets.n);
    for (let h = 0; h < inside.nHexes; ++h) if (!cut[h]) for (const s of inside.sheetsOfHex(h)) outside[s] = 1;
    const sheets = Array.from(outside.keys()).filter((s) => !outside[s]);
    element('planes').checked = true;
    this.picks.set('sheet', sheets.slice(0, 60).map((s) => [s + 1, s]));
    if (sheets.length) this.list.reveal('sheet', sheets[0]);
    this.say(`${sheets.length} sheets lie within what was refined${sheets.length > 60 ? ', 60 of them shown' : ''}`);
    this.draw();
  }

  /** After cut, explosion or choice of hexes: one at a time, the last one counts. */
  rebuild() {
    this.wanted = (this.wanted ?? 0) + 1;
    const mine = this.wanted;
    this.queue = this.queue.then(async () => {
      if (mine !== this.wanted) return;
      await this.busy('cutting', async () => {
        for (const pane of this.panes) {
          await pane.rebuild({ clip: this.clip, shown: pane === this.pane ? this.shownHexes : null, explode: this.explode });
          this.colouring.paint(pane);
        }
        this.applyLook();
      });
      await this.picked();
      await this.label();
    }).catch((error) => this.say(error.message));
    return this.queue;
  }
  sayParts() {
    if (this.explode && this.pane.parts_?.n === 1) this.say('this mesh is one block and one volume: there is nothing to move apart');
  }
  cutChanged(turned = false) {
    const mode = document.querySelector('input[name="cut"]:checked').value, axis = element('cut-axis').value, flip = element('cut-flip').checked ? -1 : 1;
    const along = (axis === 'view' ? this.stage.eye.direction.toArray() : axis.split(' ').map(Number));
    // What is cut off is on the side of the eye, unless that is to be the other way round.
    if (turned || !this.clipSign) this.clipSign = this.stage.eye.direction.dot(new THREE.Vector3(...along)) < 0 ? -1 : 1;
    const sign = flip * this.clipSign, normal = along.map((v) => v * sign);
    const [low, high] = this.extent(normal);
    const t = Number(element('cut-at').value), at = sign > 0 ? t : 1 - t;
    this.clip = { mode, normal, distance: low + (high - low) * (0.001 + 0.998 * at) };
    return this.rebuild();
  }
  /** The cut that a scene begins with; the controls say what it is. */
  startCut({ mode, normal, distance }) {
    const select = element('cut-axis'), axis = normal.findIndex((v) => Math.abs(v) > 1 - 1e-9);
    let value = normal.join(' ');
    if (axis >= 0) value = [0, 1, 2].map((k) => (k === axis ? 1 : 0)).join(' ');
    else select.append(new Option(`(${normal.map(short).join(', ')})`, value));
    select.value = value;
    document.querySelector(`input[name="cut"][value="${mode}"]`).checked = true;
    this.clipSign = axis >= 0 ? Math.sign(normal[axis]) : 1;
    const [low, high] = this.extent(normal), part = (distance - low) / (high - low || 1);
    element('cut-at').value = this.clipSign > 0 ? part : 1 - part;
    this.clip = { mode, normal, distance };
    return this.rebuild();
  }
  /** From one end to the other along a direction. */
  extent(normal) {
    let low = Infinity, high = -Infinity;
    const point = this.scene.isCad ? (this.pane.cadArrays?.point ?? []) : this.scene.skin.point;
    for (let i = 0; i < point.length; i += 3) {
      const d = normal[0] * point[i] + normal[1] * point[i + 1] + normal[2] * point[i + 2];
      if (d < low) low = d;
      if (d > high) high = d;
    }
    return [low, high];
  }
  async label() {
    if (!this.labels) {
      this.stage.labelPoints = null;
      return this.draw();
    }
    this.stage.labelPoints = await this.busy('labels', () => this.labelPlaces(this.labelKind()));
    this.draw();
  }
  labelKind() { return this.stage.kind === 'geometry' ? 'surface' : this.stage.kind; }
  labelPlaces(kind) { return labelPlaces(this.pane, kind); }

  clear() {
    this.picks.clear();
    this.say('');
  }

  // Controls.

  setTheme(name) {
    document.documentElement.dataset.theme = name;
    Object.assign(this.theme, themes[name]);
    this.themeName = name;
  }
  async switchTheme() {
    this.setTheme(this.themeName === 'dark' ? 'light' : 'dark');
    for (const pane of this.panes) await pane.loadCad();
    this.applyLook();
    this.colouring.shown();
    await this.picked();
  }
  applyLook() {
    const what = element('what').value, edges = document.querySelector('[data-toggle="edges"]').getAttribute('aria-pressed') === 'true';
    for (const pane of this.panes) {
      const ofFaces = pane.faces.material.uniforms, ofCad = pane.cad.material.uniforms;
      // Lines of the mesh lie on the CAD where that is shown; inside there is none.
      pane.faces.visible = what === 'mesh' || (what === 'both' && pane.shown !== null);
      pane.cad.visible = pane.scene.isCad || (what !== 'mesh' && pane.quads.offset === null);
      pane.curves.visible = pane.quads.offset === null;  // they stay where the CAD is
      ofFaces.lines.value = edges ? 0.55 : 0;
      ofCad.lines.value = what === 'both' ? 0.75 : 0;
      for (const uniforms of [ofFaces, ofCad]) uniforms.ink.value.set(...this.theme.edge);
      ofCad.colour.value.set(...this.theme.cad);
      pane.sectionLines.material.color.setRGB(...this.theme.edge, 'srgb');
    }
    this.draw();
  }
  toggle(name, on = null) {
    const button = document.querySelector(`[data-toggle="${name}"]`);
    if (button.hidden) return;
    const pressed = on ?? button.getAttribute('aria-pressed') !== 'true';
    button.setAttribute('aria-pressed', pressed);
    if (name === 'parallel') this.stage.eye.isParallel = pressed;
    if (name === 'edges') this.applyLook();
    if (name === 'labels') { this.labels = pressed; this.label(); }
    if (name === 'before') this.showBefore(pressed).catch(() => button.setAttribute('aria-pressed', false));
    if (name === 'box' || name === 'lasso') {
      const other = name === 'box' ? 'lasso' : 'box';
      if (pressed) document.querySelector(`[data-toggle="${other}"]`).setAttribute('aria-pressed', false);
      this.stage.areaTool = pressed ? name : null;
      element('view').classList.toggle('box', pressed);
    }
    this.draw();
  }
  do(name) {
    const actions = {
      fit: () => this.fit(), theme: () => this.switchTheme(), help: () => element('help').showModal(), clear: () => this.clear(),
      only: () => this.showOnly(), hide: () => this.hide(), column: () => this.column(), sheets: () => this.sheetsOfPicked(),
      all: () => { this.shownHexes = null; return this.rebuild(); }, auto: () => this.colouring.auto(),
      'worst-next': () => this.colouring.step(1), 'worst-back': () => this.colouring.step(-1), 'refined-planes': () => this.planesOfRefinement(),
    };
    return actions[name]();
  }
  setKind(kind) {
    this.stage.kind = kind;
    document.querySelector(`input[name="pick"][value="${kind}"]`).checked = true;
    if (this.labels) this.label();
  }
  async copy(id) {
    const text = element(id).value;
    if (!text) return;
    try {
      await navigator.clipboard.writeText(text);
    } catch {
      // Pages from the disk may have no clipboard; the older way needs the field.
      element(id).select();
      document.execCommand('copy');
    }
    this.say(`copied: ${text.length > 80 ? text.slice(0, 77) + '...' : text}`);
  }

  controls() {
    const picks = element('pick-kinds');
    for (const [kind, text = kind] of kindsToPick) {
      const label = document.createElement('label'), input = Object.assign(document.createElement('input'), { type: 'radio', name: 'pick', value: kind });
      input.checked = kind === 'geometry';
      if (kind === 'geometry') label.title = 'Vertex before curve before surface';
      input.addEventListener('change', () => this.setKind(kind));
      label.append(input, Object.assign(document.createElement('span'), { textContent: text }));
      picks.append(label);
    }
    for (const name of Object.keys(commands)) element('command-kind').append(new Option(name, name));
    element('range').addEventListener('change', () => this.pickTyped(element('range').value));
    element('command-kind').addEventListener('change', () => this.picked());
    element('what').addEventListener('change', () => this.applyLook());
    for (const button of document.querySelectorAll('[data-toggle]')) button.addEventListener('click', () => this.toggle(button.dataset.toggle));
    for (const button of document.querySelectorAll('[data-do]')) button.addEventListener('click', () => this.do(button.dataset.do));
    for (const button of document.querySelectorAll('[data-copy]')) button.addEventListener('click', () => this.copy(button.dataset.copy));
    for (const button of document.querySelectorAll('[data-view]'))
      button.addEventListener('click', () => { this.stage.eye.look(...button.dataset.view.split(' ').map(Number)); this.draw(); });
    for (const input of document.querySelectorAll('input[name="cut"]')) input.addEventListener('change', () => this.cutChanged(true));
    element('cut-axis').addEventListener('change', () => this.cutChanged(true));
    element('cut-flip').addEventListener('change', () => this.cutChanged());
    element('cut-at').addEventListener('input', () => { if (this.clip.mode !== 'off') this.cutChanged(); });
    element('explode').addEventListener('input', () => { this.explode = Number(element('explode').value); this.rebuild().then(() => this.sayParts()); });
    element('through').addEventListener('change', () => { this.stage.through = element('through').checked; });
    element('planes').addEventListener('change', () => this.picked());
    fillHelp(element('help'));
  }

  keys() {
    const views = [...document.querySelectorAll('[data-view]')];
    const cuts = ['off', 'crinkle', 'plane'], whats = ['mesh', 'both', 'cad'];
    document.addEventListener('keydown', async (e) => {
      const typing = e.target.matches('input:not([type="range"]):not([type="radio"]):not([type="checkbox"]), select, textarea');
      if (e.key === 'Escape' && !element('help').open && e.target.id !== 'prompt') {
        if (e.target.id === 'range') this.picked();
        if (typing) element('view').focus();
        else this.clear();
        return;
      }
      if (typing || e.ctrlKey || e.metaKey || e.altKey || element('help').open) return;
      const { eye } = this.stage, onView = e.target.id === 'view' || e.target === document.body;
      const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[e.key];
      if (arrow && onView) {
        if (e.shiftKey) eye.move(-0.06 * arrow[0], -0.06 * arrow[1]);
        else if (this.stage.areaTool) this.stage.growKeyBox(arrow[0], -arrow[1]);
        else eye.turn((arrow[0] * Math.PI) / 18, (arrow[1] * Math.PI) / 18);
        this.stage.showsCross = true;
      } else if (e.key === 'Enter' && onView) {
        this.stage.showsCross = true;
        e.preventDefault();
        if (this.stage.areaTool) await this.stage.pickKeyBox(e.shiftKey);
        else this.clicked(await this.stage.find(this.stage.width - this.stage.paneWidth / 2, this.stage.height / 2), e.shiftKey);
      } else if (e.key === '+' || e.key === '=') eye.zoom(0.85);
      else if (e.key === '-') eye.zoom(1 / 0.85);
      else if (e.key >= '0' && e.key <= '6') views[Number(e.key)].click();
      else if (e.key === '[' || e.key === ']') {
        element('cut-at').value = Number(element('cut-at').value) + (e.key === '[' ? -0.02 : 0.02);
        if (this.clip.mode !== 'off') this.cutChanged();
      } else {
        const action = {
          f: () => this.do('fit'), p: () => this.toggle('parallel'), e: () => this.toggle('edges'), l: () => this.toggle('labels'), b: () => this.toggle('before'),
          t: () => this.do('theme'), x: () => this.toggle('box'), o: () => this.toggle('lasso'), w: () => this.do('worst-next'), '?': () => this.do('help'),
          '/': () => element('search').focus(), r: () => { element('range').focus(); element('range').select(); }, a: () => this.do('all'), i: () => this.do('only'), h: () => this.do('hide'),
          g: () => { element('what').value = whats[(whats.indexOf(element('what').value) + 1) % 3]; this.applyLook(); },
          c: () => { document.querySelector(`input[name="cut"][value="${cuts[(cuts.indexOf(this.clip.mode) + 1) % 3]}"]`).checked = true; this.cutChanged(true); },
          k: () => { const all = kindsToPick.map(([kind]) => kind); this.setKind(all[(all.indexOf(this.stage.kind) + 1) % all.length]); this.say(`picks: ${this.stage.kind}`); },
          ':': () => element('prompt')?.focus(),
        }[e.key.toLowerCase()];
        if (!action) return;
        action();
      }
      e.preventDefault();
      this.draw();
    });
  }
}
