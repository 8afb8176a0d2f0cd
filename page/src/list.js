// The list of entities of a kind: only the rows that are seen exist, so a million hexes are a list like any.
import { kindNamed, kinds, pluralOf } from './scene.js';

const rowHeight = 24;
const mostHeight = 24e6;  // browsers end somewhere beyond 30 million pixels

export class EntityList {
  /** on: { pick(kind, id, position, add), fit(kind, position) } */
  constructor(app, on) {
    this.app = app;
    this.on = on;
    this.box = document.getElementById('list');
    this.space = document.getElementById('list-space');
    this.search = document.getElementById('search');
    this.select = document.getElementById('list-kind');
    this.hint = document.getElementById('list-hint');
    this.usualHint = this.hint.textContent;
    this.at = 0;
    this.box.addEventListener('scroll', () => this.render());
    this.search.addEventListener('input', () => this.filter());
    this.search.addEventListener('keydown', (e) => { if (e.key === 'Enter' && this.rows.length) this.choose(0, false, true); });
    this.select.addEventListener('change', () => this.show(this.select.value));
    this.box.addEventListener('click', (e) => {
      const item = e.target.closest('.item');
      if (!item) return;
      const i = Number(item.dataset.at);
      // The second click of a double one comes to a row that was made anew by the first: it fits, and leaves what is picked.
      if (e.detail >= 2) this.on.fit(this.kind, this.rows.at(i));
      else this.choose(i, e.ctrlKey || e.metaKey || e.shiftKey, false);
    });
    this.box.addEventListener('keydown', (e) => {
      const step = { ArrowDown: 1, ArrowUp: -1, PageDown: 10, PageUp: -10, Home: -1e9, End: 1e9 }[e.key];
      if (step) {
        this.at = Math.max(0, Math.min(this.rows.length - 1, this.at + step));
        const top = this.at * rowHeight;
        if (top < this.box.scrollTop) this.box.scrollTop = top;
        if (top + rowHeight > this.box.scrollTop + this.box.clientHeight) this.box.scrollTop = top + rowHeight - this.box.clientHeight;
        this.render();
      } else if (e.key === 'Enter' || e.key === ' ') this.choose(this.at, e.key === ' ' || e.ctrlKey, e.key === 'Enter');
      else return;
      e.preventDefault();
      e.stopPropagation();
    });
    new ResizeObserver(() => this.render()).observe(this.box);
  }

  /** Kinds that this mesh has any of. */
  reset(scene) {
    this.scene = scene;
    const kind = this.kind ?? 'surface';
    this.select.replaceChildren();
    for (const each of [...kinds, 'group']) {
      const n = scene.count(each);
      if (n === 0 || ((each === 'edge' || each === 'face' || each === 'sheet') && (scene.isCad || !scene.hasInside))) continue;
      this.select.append(new Option(`${pluralOf(each)}${n === null ? '' : ` (${n.toLocaleString('en')})`}`, each));
    }
    this.show([...this.select.options].some((o) => o.value === kind) ? kind : this.select.options[0].value);
  }
  async show(kind) {
    this.kind = kind;
    this.select.value = kind;
    if (this.scene.count(kind) === null || ((kind === 'hex' || kind === 'node') && (this.scene.skin.node_id || this.scene.skin.quad_hex_id) && this.scene.hasInside))
      await this.app.busy('loading the inside', () => this.scene.inside());
    this.at = 0;
    this.filter();
  }
  /** Makes an entity seen in the list, whatever was searched for. */
  async reveal(kind, position) {
    if (![...this.select.options].some((o) => o.value === kind)) return;
    const isHidden = this.search.value !== '' && (this.kind !== kind || this.placeOf(position) < 0);
    if (isHidden) this.search.value = '';
    if (this.kind !== kind) await this.show(kind);
    else if (isHidden) this.filter();
    const i = this.placeOf(position), first = this.box.scrollTop / rowHeight, n = this.box.clientHeight / rowHeight;
    // Lists that are scrolled in larger steps go by shares.
    const whole = this.rows.length * rowHeight;
    if (whole > mostHeight) this.box.scrollTop = (i / this.rows.length) * (mostHeight - this.box.clientHeight);
    else if (i < first || i + 1 > first + n) this.box.scrollTop = (i - n / 2) * rowHeight;
    this.at = i;
    this.render();
  }
  /** Where in the list a position is, -1 where it is not. */
  placeOf(position) { return this.found ? this.found.indexOf(position) : position; }
  /** Positions of those of a kind that the words say, null for all. */
  matches(kind, words) {
    if (!words.length) return null;
    const isKind = kindNamed(words[0]) === kind, said = isKind ? words.slice(1) : words, n = this.scene.count(kind) ?? 0, list = [];
    if (!this.scene.meta[kind]) {
      // Of what has no names: the id alone.
      if (!said.length) return isKind ? null : [];
      const position = said.length === 1 && /^#?\d+$/.test(said[0]) ? this.scene.find(kind, Number(said[0].replace('#', ''))) : -1;
      return position >= 0 ? [position] : [];
    }
    for (let i = 0; i < n; ++i) {
      const { id, name, note } = this.scene.row(kind, i), text = `${id} ${name} ${note}`.toLowerCase();
      if (said.every((word) => (/^#?\d+$/.test(word) ? String(id) === word.replace('#', '') || name.toLowerCase().includes(word) : text.includes(word)))) list.push(i);
    }
    return list;
  }
  filter() {
    const words = this.search.value.trim().toLowerCase().split(/\s+/).filter(Boolean), list = this.matches(this.kind, words);
    this.found = list;
    this.rows = list ? { length: list.length, at: (i) => list[i] } : { length: this.scene.count(this.kind) ?? 0, at: (i) => i };
    const named = kindNamed(words[0] ?? ''), offered = [...this.select.options].map((o) => o.value);
    // "curve 5" is one whatever is listed now.
    if (!this.rows.length && named && named !== this.kind && offered.includes(named)) return this.show(named);
    this.at = Math.min(this.at, Math.max(0, this.rows.length - 1));
    this.space.style.height = `${Math.min(mostHeight, this.rows.length * rowHeight)}px`;
    this.box.scrollTop = 0;
    this.hint.replaceChildren(...(this.rows.length || !words.length ? [this.usualHint] : this.elsewhere(words, offered)));
    this.render();
  }
  /** Where else there is what is searched for. */
  elsewhere(words, kindsOffered) {
    const found = [];
    for (const kind of kindsOffered.filter((each) => each !== this.kind && this.scene.meta[each])) {
      const n = this.matches(kind, words)?.length;
      if (!n) continue;
      const button = Object.assign(document.createElement('button'), { textContent: `${n} of ${pluralOf(kind)}` });
      button.addEventListener('click', () => { this.show(kind); this.search.focus(); });
      found.push(button, ' ');
    }
    return found.length ? [`None of ${pluralOf(this.kind)}; `, ...found] : ['Nothing is called so.'];
  }
  render() {
    if (!this.rows) return;
    const { rows, box, space } = this, whole = rows.length * rowHeight, shown = Math.min(mostHeight, whole);
    // Taller lists than there can be are scrolled in larger steps.
    const room = Math.max(1, shown - box.clientHeight), top = whole > shown ? (box.scrollTop / room) * (whole - box.clientHeight) : box.scrollTop;
    const first = Math.max(0, Math.floor(top / rowHeight) - 2), last = Math.min(rows.length, first + Math.ceil(box.clientHeight / rowHeight) + 5);
    const picks = this.app.picks, items = [];
    for (let i = first; i < last; ++i) {
      const { id, name, note } = this.scene.row(this.kind, rows.at(i)), item = document.createElement('div');
      item.className = `item${i === this.at ? ' at' : ''}`;
      item.id = `item-${i}`;
      item.dataset.at = i;
      item.setAttribute('role', 'option');
      item.setAttribute('aria-selected', picks.kind === this.kind && picks.ids.has(id));
      item.setAttribute('aria-posinset', i + 1);
      item.setAttribute('aria-setsize', rows.length);
      item.style.top = `${box.scrollTop + i * rowHeight - top}px`;
      item.append(`${this.kind} ${id}`);
      if (name || note) item.append(Object.assign(document.createElement('small'), { textContent: [name, note].filter(Boolean).join(' · ') }));
      item.title = [`${this.kind} ${id}`, name, note].filter(Boolean).join(' · ');
      items.push(item);
    }
    space.replaceChildren(...items);
    box.setAttribute('aria-activedescendant', rows.length ? `item-${this.at}` : '');
  }
  choose(i, add, fit) {
    this.at = i;
    const position = this.rows.at(i);
    this.on.pick(this.kind, this.scene.row(this.kind, position).id, position, add);
    if (fit) this.on.fit(this.kind, position);
  }
}
