// A session behind the page: a prompt, what commands say, and the mesh as it changes.
import { Scene, short } from './scene.js';
import { completed, unpack } from './unpack.js';

const element = (id) => document.getElementById(id);
const formats = ['.msh', '.vtu', '.e', '.inp', '.mesh', '.png', '.html'];
const make = (tag, properties = {}, ...children) => {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
};

/** Until the tab is looked at, but no longer than this. */
const untilSeen = (milliseconds) =>
  new Promise((resolve) => {
    const done = () => { document.removeEventListener('visibilitychange', done); resolve(); };
    document.addEventListener('visibilitychange', done);
    setTimeout(done, milliseconds);
  });

export class Live {
  constructor(app) {
    this.app = app;
    app.live = this;
    this.token = new URLSearchParams(location.search).get('token') ?? '';
    this.history = [];
    this.files = new Set();
    this.next = 0;
    this.version = -1;
    this.blocks = new Map();  // name -> { number, arrays }
  }

  async ask(path, body, more = {}) {
    const response = await fetch(path, {
      ...more, method: body ? 'POST' : 'GET', body: body ? JSON.stringify(body) : undefined,
      headers: { 'X-Hextwist-Token': this.token, ...(body ? { 'Content-Type': 'application/json' } : {}) },
    });
    if (!response.ok) {
      const { error = response.statusText } = await response.json().catch(() => ({}));
      throw Object.assign(new Error(error), { status: response.status });
    }
    return response;
  }

  async start() {
    this.build();
    while (!(await this.joined())) await new Promise((resolve) => setTimeout(resolve, 1000));
    // A closed tab makes room for another one.
    addEventListener('pagehide', () => {
      this.isGone = true;  // who asks for news once more would be back
      this.waiting?.abort();
      this.ask('leave', { id: this.id }, { keepalive: true }).catch(() => {});
    });
    addEventListener('pageshow', (e) => { if (e.persisted) location.reload(); });
    this.follow();
    await new Promise((resolve) => { this.isThere = resolve; });
  }
  /** Says why where there can be no session yet. */
  async joined() {
    try {
      await this.join();
      this.connected(true);
      return true;
    } catch (error) {
      this.connected(false, error.status ? `${error.message} (trying again)` : undefined);
      return false;
    }
  }
  /** The session of this tab, or a new one where that is gone. */
  async join() {
    let before = sessionStorage.getItem('hextwist-session') ?? '';
    if (before && before !== this.id && !(await this.isOurs(before))) before = '';
    const { id, known } = await (await this.ask('session', { id: before })).json();
    sessionStorage.setItem('hextwist-session', id);
    if (id !== before) await this.isOurs(id);
    if (this.id && !known) this.log('note', 'the session of before is gone: this is a new one');
    if (!known) {
      this.next = 0;
      this.version = -1;
      this.blocks.clear();
    }
    this.id = id;
  }
  /** Takes a session for this tab. False: another tab has it, which this one was copied from, with all that it remembers. */
  async isOurs(id) {
    if (!navigator.locks) return true;  // not on this machine
    const taken = () => new Promise((resolve) => {
      navigator.locks.request(`hextwist ${id}`, { ifAvailable: true }, (lock) => {
        resolve(lock !== null);
        return lock ? new Promise(() => {}) : null;
      });
    });
    // After a reload the lock of the page before may take a moment to go; on a busy machine a long one.
    const isReload = performance.getEntriesByType('navigation')[0]?.type === 'reload';
    for (let i = 0; i < (isReload ? 60 : 5); ++i) {
      if (await taken()) return true;
      await new Promise((resolve) => setTimeout(resolve, 100));
    }
    return false;
  }
  async follow() {
    // A machine that has lost its network, or has it back, is told so: no use to wait for an answer to what was asked before.
    for (const kind of ['offline', 'online']) addEventListener(kind, () => this.waiting?.abort());
    while (!this.isGone) {
      try {
        this.waiting = new AbortController();
        // A browser has six connections to a server at most: tabs that nobody looks at do not hold one.
        // Nor does one wait whose connection was lost: it is to know when it is back.
        const isLookedAt = !document.hidden, news = await (await this.ask(`events?id=${this.id}&since=${this.next}&wait=${isLookedAt && this.isConnected ? 15 : 0}`, null, { signal: this.waiting.signal })).json();
        this.connected(true);
        this.next = news.next;
        this.isShown = false;
        for (const event of news.events) this.happened(event);
        this.progress(news);
        if (news.version !== this.version && !news.running) await this.reload(news.version);
        this.isShown = !news.running;
        if (!news.running) this.isThere?.();
        if (!isLookedAt) await untilSeen(4000);
      } catch (error) {
        if (this.isGone) return;
        if (error.status === 404) await this.joined();
        else if (error.status === 403) {
          this.connected(false, error.message);
          this.isThere?.();
          return;
        } else if (error.status !== 409) this.connected(false);
        await new Promise((resolve) => setTimeout(resolve, 700));
      }
    }
  }
  connected(yes, why = 'connection lost, trying again') {
    this.isConnected = yes;
    element('connection').textContent = yes ? '' : why;
    element('connection').hidden = yes;
  }

  /** Arrays of a block; only what has changed is sent. */
  async load(name) {
    const have = this.blocks.get(name);
    const response = await this.ask(`block?id=${this.id}&name=${name}&have=${have?.number ?? 0}`).catch((error) => {
      if (error.status === 404) return null;
      throw error;
    });
    if (!response || response.status === 204) return null;
    const bytes = new Uint8Array(await response.arrayBuffer());
    this.received = (this.received ?? 0) + bytes.length;
    let arrays = await unpack(bytes);
    if (response.headers.get('X-Hextwist-Difference') === '1') arrays = completed(arrays, have.arrays);
    if (!/^(before-)?c\d+$/.test(name)) this.blocks.set(name, { number: Number(response.headers.get('X-Hextwist-Number')), arrays });
    return arrays;
  }
  async reload(version) {
    const { app } = this, isFirst = app.panes.length === 0, isTwo = app.panes.length > 1;
    const scene = await Scene.open((name) => this.load(name));
    this.version = version;
    if (!scene) {
      app.say('there is no mesh yet: import one, or create a brick');
      return;
    }
    let before = null;
    const openBefore = () => (before ??= Scene.open((name) => this.load(`before-${name}`)).catch((error) => { before = null; throw error; }));
    await app.open(scene, { before: scene.meta.has_before ? openBefore : null, keep: !isFirst });
    if (isTwo) await app.showBefore(true);
  }

  happened({ kind, text, record }) {
    if (kind === 'record') return this.report(record);
    if (kind === 'file') {
      this.files.add(text);
      const link = make('button', { textContent: `save ${text}`, title: `Download ${text}` });
      link.addEventListener('click', () => this.save(text).catch((error) => this.log('error', `error: ${error.message}`)));
      this.append(link, '\n');
      return;
    }
    if (kind === 'command') {
      if (this.history[this.history.length - 1] !== text) this.history.push(text);
      this.at = this.history.length;
    }
    this.log(kind, kind === 'command' ? `> ${text}` : text);
  }
  log(kind, text) {
    this.append(make('span', { className: kind === 'command' ? 'said' : kind, textContent: `${text}\n` }));
    if (kind === 'command') element('log').scrollTop = element('log').scrollHeight;
  }
  append(...nodes) {
    const log = element('log'), atEnd = log.scrollTop + log.clientHeight > log.scrollHeight - 40;
    log.append(...nodes);
    while (log.childNodes.length > 3000) log.firstChild.remove();
    if (atEnd) log.scrollTop = log.scrollHeight;
  }
  report(record) {
    const box = element('report'), row = (name, value) => make('tr', {}, make('th', { scope: 'row', textContent: name }), make('td', { textContent: value }));
    const pair = (both) => (both.after ? `${both.before && both.before.min !== both.after.min ? `${short(both.before.min)} → ` : ''}${short(both.after.min)}` : '–');
    const rows = [
      row('command', record.command), row('done', record.ok ? 'yes' : `no: ${record.error}`),
      row('hexes', record.hexes_before === record.hexes_after ? record.hexes_after.toLocaleString('en') : `${record.hexes_before.toLocaleString('en')} → ${record.hexes_after.toLocaleString('en')}${record.dry_run ? ' (dry run)' : ''}`),
      row('smallest shape', pair(record.shape)), row('scaled Jacobian', pair(record.scaled_jacobian)),
      row(record.off_cad.model === 'cad' ? 'off the CAD' : 'off the skin', short(record.off_cad.max)), row('seconds', short(record.seconds.total)),
    ];
    box.replaceChildren(make('table', {}, make('tbody', {}, ...rows)));
  }
  progress({ running, stage, share }) {
    this.running = running;
    element('cancel').disabled = !running;
    for (const id of ['undo', 'redo', 'export']) element(id).disabled = running;
    element('progress').hidden = !running;
    element('stage-now').textContent = running ? stage : '';
    if (running && share > 0) element('progress').value = share;
    else element('progress').removeAttribute('value');
  }

  async run(text) {
    if (!text.trim()) return;
    try {
      await this.ask('run', { id: this.id, text });
      if (element('prompt').value === text) element('prompt').value = '';
    } catch (error) {
      this.log('error', `error: ${error.message}`);
    }
  }
  async save(name) {
    const blob = await (await this.ask(`file?id=${this.id}&name=${encodeURIComponent(name)}`)).blob();
    const link = make('a', { href: URL.createObjectURL(blob), download: name.split('/').pop() });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }
  async complete() {
    const line = element('prompt').value, list = element('offers');
    const { words } = await (await this.ask('complete', { id: this.id, line })).json();
    const start = line.match(/[^\s;,"']*$/)[0];
    const take = (word) => {
      element('prompt').value = line.slice(0, line.length - start.length).replace(word.startsWith('"') ? /"$/ : /$^/, '') + word + ' ';
      this.offer([]);
      element('prompt').focus();
    };
    if (words.length === 1) return take(words[0]);
    // As far as all of them agree.
    let common = words[0] ?? '';
    for (const word of words) while (!word.startsWith(common)) common = common.slice(0, -1);
    if (common.length > start.length && common.startsWith(start)) element('prompt').value = line.slice(0, line.length - start.length) + common;
    this.offer(words, take);
  }
  offer(words, take) {
    const list = element('offers');
    this.offers = words.slice(0, 200);
    this.offerAt = -1;
    this.take = take;
    list.replaceChildren(...this.offers.map((word, i) => {
      const item = make('li', { textContent: word, id: `offer-${i}`, role: 'option' });
      item.addEventListener('click', () => take(word));
      return item;
    }));
    list.hidden = !words.length;
    element('prompt').setAttribute('aria-expanded', words.length > 0);
  }

  build() {
    const prompt = make('input', { id: 'prompt', type: 'text', autocomplete: 'off', spellcheck: false, placeholder: 'refine curve 3 5 – Tab completes, arrows go through what was said' });
    prompt.setAttribute('aria-label', 'Command');
    prompt.setAttribute('role', 'combobox');
    prompt.setAttribute('aria-controls', 'offers');
    prompt.setAttribute('aria-expanded', 'false');
    const button = (id, text, title, action) => {
      const made = make('button', { id, textContent: text, title });
      made.addEventListener('click', action);
      return made;
    };
    const format = make('select', { id: 'format', title: 'Format of Export' }, ...formats.map((f) => new Option(f, f)));
    format.setAttribute('aria-label', 'Format of Export');
    const exported = () => {
      const file = `${this.app.panes.length ? this.app.scene.meta.title : 'mesh'}_out${format.value}`;
      return this.run(format.value === '.png' || format.value === '.html' ? `draw to "${file}" overwrite` : `export mesh "${file}" overwrite`);
    };
    const offers = make('ul', { id: 'offers', role: 'listbox', hidden: true });
    offers.setAttribute('aria-label', 'Completions');
    const log = make('div', { id: 'log', tabIndex: 0, role: 'log' }), report = make('div', { id: 'report' });
    log.setAttribute('aria-label', 'What commands say');
    report.setAttribute('role', 'region');
    report.setAttribute('aria-label', 'Report on the last command');
    const progress = make('progress', { id: 'progress', hidden: true, max: 1 });
    progress.setAttribute('aria-label', 'Progress');
    element('live').append(
      make('div', { id: 'said' }, log, report),
      make('div', { id: 'prompt-row' }, offers, prompt, make('span', { id: 'stage-now' }), progress, make('span', { id: 'connection', hidden: true, role: 'alert' }),
        button('cancel', 'Cancel', 'Stop the running command', () => this.ask('cancel', { id: this.id }).catch((error) => this.log('error', `error: ${error.message}`))),
        button('undo', 'Undo', 'Undo the last command', () => this.run('undo')), button('redo', 'Redo', 'Redo what was undone', () => this.run('redo')),
        button('export', 'Export', 'Write the mesh into a file in the folder of the session', exported), format),
    );
    element('live').hidden = false;
    element('run-command').addEventListener('click', () => this.run(element('command').value));
    prompt.addEventListener('input', () => this.offer([]));
    prompt.addEventListener('keydown', (e) => {
      const { offers: words = [] } = this;
      if (e.key === 'Tab' && !e.shiftKey && prompt.value) this.complete().catch((error) => this.log('error', error.message));
      else if (words.length && (e.key === 'ArrowDown' || e.key === 'ArrowUp')) {
        this.offerAt = (this.offerAt + (e.key === 'ArrowDown' ? 1 : -1) + words.length) % words.length;
        [...element('offers').children].forEach((item, i) => item.setAttribute('aria-selected', i === this.offerAt));
        element(`offer-${this.offerAt}`).scrollIntoView({ block: 'nearest' });
        prompt.setAttribute('aria-activedescendant', `offer-${this.offerAt}`);
      } else if (e.key === 'Enter') {
        if (words.length && this.offerAt >= 0) this.take(words[this.offerAt]);
        else {
          this.offer([]);
          this.run(prompt.value);
        }
      } else if (e.key === 'Escape') {
        if (words.length) this.offer([]);
        else element('view').focus();
      } else if (e.key === 'ArrowUp' || e.key === 'ArrowDown') {
        this.at = Math.max(0, Math.min(this.history.length, (this.at ?? this.history.length) + (e.key === 'ArrowUp' ? -1 : 1)));
        prompt.value = this.history[this.at] ?? '';
      } else return;
      e.preventDefault();
      e.stopPropagation();
    });
  }
}
