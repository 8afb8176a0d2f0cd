// What gives the colours, with its scale, its histogram and its worst hexes.
import { css, rowColour, scale, scaleColour, scaleKind, scaleRange } from './colours.js';
import { pluralOf, short } from './scene.js';
import { rowOf, setKeys, setRows } from './sets.js';

const nBars = 24, mostLegend = 14, mostPicked = 200000;
const element = (id) => document.getElementById(id);

export class Colouring {
  /** app: scene, panes, pickHexes(hexes), pickNodes(nodes), goTo(kind, position), nameOf(kind, position), busy(), draw(). */
  constructor(app) {
    this.app = app;
    this.select = element('colour');
    this.select.addEventListener('change', () => this.choose(this.select.value));
    for (const id of ['low', 'high'])
      element(id).addEventListener('change', () => {
        const value = Number(element(id).value);
        if (element(id).value.trim() !== '' && Number.isFinite(value)) this.range[id] = value;
        this.shown();
      });
    this.worstAt = -1;
  }

  /** Offers what the scene has. */
  reset(scene) {
    const before = this.key, { channels } = scene.meta;
    this.select.replaceChildren(new Option('nothing', 'none'), new Option('surface', 'surface'));
    if (scene.isCad) this.select.append(new Option('volume', 'volume'));
    else if (scene.hasInside) this.select.append(new Option('sheet (the smallest through a hex)', 'sheet'));
    for (const [key, text] of Object.entries(setKeys)) if (key === 'owner' ? !scene.isCad : scene.meta[key].length) this.select.append(new Option(text, key));
    const groups = {};
    channels.forEach((channel, i) => {
      groups[channel.group] ??= Object.assign(document.createElement('optgroup'), { label: channel.group });
      const option = new Option(channel.name + (channel.there ? '' : ' (left out: too large)'), channel.name);
      option.disabled = !channel.there;
      groups[channel.group].append(option);
    });
    this.select.append(...Object.values(groups));
    const usual = scene.meta.block.length > 1 ? 'block' : scene.meta.volume.length > 1 ? 'volume' : 'none';
    const keys = [...this.select.options].filter((o) => !o.disabled).map((o) => o.value);
    const wanted = before ?? (scene.meta.start.colour || usual);
    return this.choose(keys.includes(wanted) ? wanted : usual);
  }

  async choose(key) {
    this.select.value = key;
    this.key = key;
    const { scene } = this.app, i = scene.meta.channels.findIndex((c) => c.name === key);
    this.channel = i >= 0 ? scene.meta.channels[i] : null;
    this.valuesOf = new Map();
    this.setsOf = new Map();
    await this.app.busy(`loading ${key}`, async () => {
      for (const pane of this.app.panes) {
        this.valuesOf.set(pane, await this.load(pane.scene, key));
        this.setsOf.set(pane, key in setKeys ? await setRows(pane.scene, key) : null);
      }
    });
    if (this.key !== key) return;
    this.values = this.valuesOf.get(this.app.pane);
    this.sets = this.setsOf.get(this.app.pane);
    this.worstAt = -1;
    this.auto();
    const [before] = this.app.panes;
    if (this.values && !this.valuesOf.get(before)) this.app.say(`the mesh before has no ${key}`);
  }
  async load(scene, key) {
    if (key === 'none' || key === 'surface' || key in setKeys || scene.isCad) return null;
    if (key === 'sheet') {
      const inside = await scene.inside(), { ofEdge, n } = inside.sheets, { ofHex } = inside.edges, sizes = new Uint32Array(n);
      const sheetOf = (h, axis) => ofEdge[ofHex[12 * h + 4 * axis]];
      for (let h = 0; h < inside.nHexes; ++h) for (let axis = 0; axis < 3; ++axis) ++sizes[sheetOf(h, axis)];
      const out = new Uint32Array(inside.nHexes);
      for (let h = 0; h < out.length; ++h) {
        const s = [0, 1, 2].map((axis) => sheetOf(h, axis)).sort((a, b) => sizes[a] - sizes[b] || a - b);
        out[h] = s[0] + 1;
      }
      return out;
    }
    const i = scene.meta.channels.findIndex((c) => c.name === key);
    return i < 0 ? null : scene.channel(i);
  }
  auto() {
    this.range = null;
    if (this.values && this.channel && !this.channel.is_class) this.range = scaleRange(this.channel, this.values);
    this.shown();
  }

  /** What has the values. */
  get onWhat() { return this.channel?.on === 'node' ? 'node' : 'hex'; }
  get isClass() { return this.key === 'sheet' || Boolean(this.channel?.is_class); }
  className(number) { return this.channel?.classes.find(([n]) => n === number)?.[1] ?? `${this.key} ${number}`; }

  /** Paints the panes and shows scale and histogram. */
  shown() {
    for (const pane of this.app.panes) this.paint(pane);
    this.legend();
    this.histogram();
    this.showWorst();
    this.app.draw();
  }
  paint(pane) {
    const values = this.valuesOf.get(pane), sets = this.setsOf.get(pane), neutral = this.app.theme.plain;
    pane.paintCad(this.key === 'surface' ? (surface) => rowColour(surface - 1)
      : this.key === 'volume' && pane.scene.isCad ? (surface) => rowColour((pane.scene.meta.volumes_of_surface[surface - 1][0] ?? 10) - 1) : null);
    pane.showDots(sets ? (node) => (sets.node.has(node) ? rowColour(sets.rows[sets.node.get(node)].colour) : null) : null);
    if (sets) {
      pane.paint((hex, surface, side) => {
        const row = side < 0 ? sets.hex.get(hex) : rowOf(pane.scene, sets, hex, side);
        return row === undefined ? neutral : rowColour(sets.rows[row].colour);
      }, false);
    } else if (this.key === 'surface') pane.paint((hex, surface) => (surface ? rowColour(surface - 1) : neutral), false);
    else if (!values) pane.paint(() => neutral, false);
    else if (this.isClass) {
      const colours = this.classColours();
      pane.paint((hex) => colours(values[hex]), false);
    } else {
      const { low, high } = this.range, table = scale(scaleKind(this.channel)), factor = 255 / (high - low || 1), out = [0, 0, 0];
      pane.paint((i) => {
        const v = values[i];
        if (v !== v) { out[0] = out[1] = out[2] = 128; return out; }
        const t = 3 * (v <= low ? 0 : v >= high ? 255 : Math.round(factor * (v - low)));
        out[0] = table[t]; out[1] = table[t + 1]; out[2] = table[t + 2];
        return out;
      }, this.channel.on === 'node');
    }
  }
  classColours() {
    const order = this.channel?.classes.map(([n]) => n) ?? [];
    if (this.key === 'level') return (n) => scaleColour('plain', 0, 1, 0.3 + (0.7 * n) / Math.max(1, this.mostLevel ?? 1));
    const place = new Map(order.map((n, i) => [n, i]));
    return (n) => rowColour(place.has(n) ? place.get(n) : n === 0 ? 9 : n - 1);
  }
  classCounts() {
    const counts = new Map();
    for (const v of this.values) counts.set(v, (counts.get(v) ?? 0) + 1);
    return [...counts].sort((a, b) => a[0] - b[0]);
  }

  legend() {
    const box = element('legend');
    box.replaceChildren();
    element('scale').hidden = !this.range;
    if (this.range) {
      const { low, high } = this.range, kind = scaleKind(this.channel), title = document.createElement('b');
      title.textContent = this.key;
      const bar = document.createElement('div'), strip = document.createElement('i'), numbers = document.createElement('ol');
      bar.className = 'bar';
      strip.style.background = `linear-gradient(to top, ${Array.from({ length: 11 }, (_, i) => css(scaleColour(kind, 0, 1, i / 10))).join(',')})`;
      for (let i = 4; i >= 0; --i) numbers.append(Object.assign(document.createElement('li'), { textContent: short(low + ((high - low) * i) / 4) }));
      bar.append(strip, numbers);
      box.append(title, Object.assign(document.createElement('div'), { style: 'height:10px' }), bar);
      element('low').value = short(low);
      element('high').value = short(high);
      return;
    }
    const rows = this.classRows();
    for (const { text, colour } of rows.slice(0, mostLegend)) {
      const row = document.createElement('div'), swatch = document.createElement('i');
      row.className = 'class';
      swatch.style.background = css(colour);
      row.append(swatch, text);
      box.append(row);
    }
    if (rows.length > mostLegend) box.append(`and ${rows.length - mostLegend} more`);
  }
  /** What the colours of things mean: [{ text, colour, count, pick() }], none for values. */
  classRows() {
    const { picks, scene } = this.app;
    if (this.sets)
      return this.sets.rows.map((row) => ({
        text: row.text, count: row.count, colour: rowColour(row.colour),
        pick: () => picks.set(row.kind, row.nodes ? [...row.nodes.slice(0, mostPicked)].map((n) => [scene.nodeId(n), n]) : [[row.id, row.position]]),
      }));
    if (!this.values || !this.isClass) return [];
    if (this.key === 'level') this.mostLevel = Math.max(...this.classCounts().map(([n]) => n));
    const colours = this.classColours();
    return this.classCounts().map(([n, count]) => ({ text: this.className(n), count, colour: colours(n), pick: () => this.pickWhere((v) => v === n) }));
  }

  histogram() {
    const box = element('histogram');
    box.replaceChildren();
    const rows = this.classRows();
    box.className = rows.length ? 'classes' : '';
    box.hidden = !rows.length && !this.values;
    element('worst').hidden = !this.range;
    if (box.hidden) return;
    box.setAttribute('aria-label', `Histogram: each bar picks its ${pluralOf(this.onWhat)}`);
    for (const { text, count, colour, pick } of rows.slice(0, 400)) {
      const button = document.createElement('button'), swatch = document.createElement('i');
      swatch.style.background = css(colour);
      button.append(swatch, Object.assign(document.createElement('span'), { textContent: text }), count.toLocaleString('en'));
      button.addEventListener('click', pick);
      box.append(button);
    }
    if (rows.length) return;
    const { least, most } = this.range, kind = scaleKind(this.channel), width = (most - least) / nBars || 1, counts = new Uint32Array(nBars);
    for (const v of this.values) if (v === v) ++counts[Math.min(nBars - 1, Math.max(0, Math.floor((v - least) / width)))];
    const highest = Math.max(1, ...counts);
    counts.forEach((count, i) => {
      const from = least + i * width, to = from + width, button = document.createElement('button'), bar = document.createElement('i');
      // A few hexes are seen as well.
      bar.style.height = count ? `${Math.max(4, (100 * Math.sqrt(count)) / Math.sqrt(highest))}%` : '0';
      bar.style.background = css(scaleColour(kind, this.range.low, this.range.high, (from + to) / 2));
      const said = `${short(from)} to ${short(to)}: ${count.toLocaleString('en')} ${count === 1 ? this.onWhat : pluralOf(this.onWhat)}`;
      button.title = said;
      button.setAttribute('aria-label', said);
      button.disabled = count === 0;
      button.append(bar);
      button.addEventListener('click', () => this.pickWhere((v) => v >= from && (i === nBars - 1 ? v <= most : v < to)));
      box.append(button);
    });
  }
  pickWhere(test) {
    const list = [];
    for (let i = 0; i < this.values.length && list.length < mostPicked; ++i) if (test(this.values[i])) list.push(i);
    return this.onWhat === 'node' ? this.app.pickNodes(list) : this.app.pickHexes(list);
  }

  worst() {
    const bad = this.channel.small_is_better ?? this.channel.name === 'actual / wished size', count = Math.min(10, this.values.length);
    const isField = this.channel.group === 'fields', worse = bad || isField ? (a, b) => b - a : (a, b) => a - b;
    const best = [];
    for (let h = 0; h < this.values.length; ++h) {
      const v = this.values[h];
      if (v !== v) continue;
      if (best.length === count && worse(v, this.values[best[count - 1]]) >= 0) continue;
      let i = best.length;
      while (i > 0 && worse(v, this.values[best[i - 1]]) < 0) --i;
      best.splice(i, 0, h);
      if (best.length > count) best.pop();
    }
    return best;
  }
  step(by) {
    if (!this.range) return;
    this.worstList = this.worstAt < 0 ? this.worst() : this.worstList;
    this.worstAt = this.worstAt < 0 ? 0 : (this.worstAt + by + this.worstList.length) % this.worstList.length;
    this.showWorst();
    return this.app.goTo(this.onWhat, this.worstList[this.worstAt]);
  }
  showWorst() {
    const at = this.worstAt;
    element('worst-now').value = at < 0 ? '–' : `${at + 1}: ${this.app.nameOf(this.onWhat, this.worstList[at])}, ${short(this.values[this.worstList[at]])}`;
  }

  /** What the colours say of a hex or node. */
  said(pane, position, kind) {
    const values = this.valuesOf?.get(pane);
    if (!values || this.onWhat !== kind) return '';
    return this.isClass ? (this.key === 'sheet' ? `sheet ${values[position]}` : this.className(values[position])) : `${this.key} ${short(values[position])}`;
  }
}
