// What has been picked: entities of one kind, and what can be said of them in a command.
import { kindNamed } from './scene.js';

const mostTyped = 2e6;

/** "1 3 5 to 9" */
export function rangeText(ids) {
  const sorted = Float64Array.from(ids).sort(), parts = [];
  for (let i = 0; i < sorted.length;) {
    let j = i;
    while (j + 1 < sorted.length && sorted[j + 1] === sorted[j] + 1) ++j;
    if (j - i >= 2) parts.push(`${sorted[i]} to ${sorted[j]}`);
    else for (let k = i; k <= j; ++k) parts.push(String(sorted[k]));
    i = j + 1;
  }
  return parts.join(' ');
}

/**
 * What a range says, as commands have them: "curve 3 5 to 9 by 2", "hexes all"; a range without a kind is of `usual`. Throws what
 * is wrong with it. Returns { kind, ids }, ids null for all.
 */
export function readRange(text, usual) {
  const words = text.trim().toLowerCase().replaceAll(',', ' ').split(/\s+/).filter(Boolean), ids = [];
  const kind = /^(\d|all$)/.test(words[0] ?? '') ? usual : kindNamed(words.shift() ?? '');
  if (!kind || !words.length) throw new Error('a range is a kind and ids: hex 3 5 to 9 by 2, or curve all');
  if (words.length === 1 && words[0] === 'all') return { kind, ids: null };
  const number = (word) => {
    if (!/^\d{1,15}$/.test(word ?? '')) throw new Error(`'${word ?? ''}' is not an id`);
    return Number(word);
  };
  while (words.length) {
    const first = number(words.shift());
    if (words[0] !== 'to') {
      ids.push(first);
      continue;
    }
    words.shift();
    const last = number(words.shift());
    let step = 1;
    if (words[0] === 'by') {
      words.shift();
      step = number(words.shift());
    }
    if (step < 1 || last < first) throw new Error(`from ${first} to ${last} by ${step} there is nothing`);
    if ((last - first) / step > mostTyped) throw new Error(`${first} to ${last} are too many`);
    for (let id = first; id <= last; id += step) ids.push(id);
  }
  return { kind, ids };
}

/** "curve 3 5", in words that every command takes. */
export const target = (kind, ids) => `${kind} ${rangeText(ids)}`;

const inSets = { block: 'hex', nodeset: 'node', sideset: 'face', group: 'hex', sheet: 'hex' };
/** What can be refined: of sets what lies in them. */
const refinable = (kind, ids) => (inSets[kind] ? `${inSets[kind]} in ${target(kind, ids)}` : target(kind, ids));

export const commands = {
  refine: (kind, ids) => `refine ${refinable(kind, ids)}`,
  'refine, depth 2': (kind, ids) => `refine ${refinable(kind, ids)} depth 2`,
  coarsen: (kind, ids) => `coarsen ${refinable(kind, ids)}`,
  list: (kind, ids) => `list ${target(kind, ids)}`,
  quality: (kind, ids) => `quality ${target(kind, ids)} shape histogram`,
  smooth: (kind, ids) => `smooth ${target(kind, ids)}`,
  'block of hexes': (kind, ids) => `block 100 ${kind === 'volume' || kind === 'hex' ? '' : 'hex in '}${target(kind, ids)}`,
  group: (kind, ids) => `group "picked" add ${target(kind, ids)}`,
  draw: (kind, ids) => `draw ${target(kind, ids)} to "picked.png" overwrite`,
  'range alone': (kind, ids) => target(kind, ids),
};

export class Picks {
  constructor() { this.kind = 'curve'; this.ids = new Map(); this.changed = () => {}; }  // id -> position
  clear() { this.ids.clear(); this.changed(); }
  /** add: to what there is, or out of it. */
  pick(kind, id, position, add) {
    if (!add || kind !== this.kind) {
      const again = !add && kind === this.kind && this.ids.size === 1 && this.ids.has(id);
      this.kind = kind;
      this.ids.clear();
      if (!again) this.ids.set(id, position);
    } else if (!this.ids.delete(id)) this.ids.set(id, position);
    this.changed();
  }
  set(kind, pairs) { this.kind = kind; this.ids = new Map(pairs); this.changed(); }
  get size() { return this.ids.size; }
  text(command) { return this.size ? commands[command](this.kind, this.ids.keys()) : ''; }
}
