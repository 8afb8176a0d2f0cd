// The page in a real browser by keys alone: where Tab stops, and that each control does there what it does for a mouse.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { browser as launch, drawn, idsOf, open, settled, shot, value } from './support.mjs';

let browser;
before(async () => { browser = await launch(); });
after(() => browser.close());

/** Marks what Tab is to stop at, in the order of the page; of radio buttons one. Returns how many there are. */
const markStops = (page) => page.evaluate(() => {
  const groups = new Map();
  let n = 0;
  for (const e of document.querySelectorAll('a[href], button, input, select, summary, [tabindex]')) {
    if (e.disabled || e.tabIndex < 0 || !e.checkVisibility() || e.closest('dialog')) continue;
    if (e.type === 'radio' && groups.has(e.name)) e.dataset.stop = groups.get(e.name);
    else {
      if (e.type === 'radio') groups.set(e.name, n);
      e.dataset.stop = n++;
    }
  }
  return n;
});
/** Where the focus is, and whether that is seen: a ring, inside of the window, under nothing else. */
const focused = (page) => page.evaluate(() => {
  const e = document.activeElement, ringed = e.closest('#pick-kinds') ? e.nextElementSibling : e, { outlineStyle, outlineWidth } = getComputedStyle(ringed);
  const box = ringed.getBoundingClientRect(), above = document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2);
  return {
    stop: Number(e.dataset.stop), what: e.outerHTML.slice(0, 90),
    isRinged: outlineStyle !== 'none' && parseFloat(outlineWidth) >= 1,
    isSeen: box.top >= 0 && box.left >= 0 && box.bottom <= innerHeight && box.right <= innerWidth && Boolean(above) && (above === e || ringed.contains(above) || above.contains(ringed)),
  };
});
async function tabTo(page, selector) {
  for (let i = 0; i < 150; ++i) {
    if (i > 0) await page.keyboard.press('Tab');
    if (await page.evaluate((s) => document.activeElement.matches(s), selector)) return;
  }
  assert.fail(`${selector} is not reached by Tab`);
}

test('Tab stops at every control in order, shows where it is, and is held nowhere', async () => {
  const page = await open(browser, drawn('tabs', 'bracket', '', 'quality shape'), { width: 1366, height: 768 });
  for (const theme of ['light', 'dark']) {
    const n = await markStops(page), back = [];
    assert.ok(n > 60, `${n}`);
    for (let i = 0; i < n; ++i) {
      if (i > 0 || theme === 'light') await page.keyboard.press('Tab');
      const at = await focused(page);
      assert.equal(at.stop, i, at.what);
      assert.ok(at.isRinged, `no ring: ${at.what}`);
      assert.ok(at.isSeen, `out of sight: ${at.what}`);
    }
    for (let i = n - 2; i >= 0; --i) {
      await page.keyboard.press('Shift+Tab');
      back.push((await focused(page)).stop === i);
    }
    assert.ok(back.every(Boolean), 'backwards it is the same');
    await page.keyboard.press('t');
    await settled(page);
    if (theme === 'light') assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), 'dark');
  }
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('everything can be done by keys', async () => {
  const page = await open(browser, drawn('keys', 'bracket', 'refine vertex 9 depth 1 graded')), press = (key) => page.keyboard.press(key);
  const app = (f) => page.evaluate(f), eye = () => app(() => { const { azimuth, elevation, height, isParallel, target } = hextwist.stage.eye; return { azimuth, elevation, height, isParallel, x: target.x }; });
  /** Goes to a control, presses keys there; something is to have changed. */
  const operate = async (selector, keys, of) => {
    await tabTo(page, selector);
    const before = JSON.stringify(await app(of));
    for (const key of [keys].flat()) await press(key);
    const end = performance.now() + 20000;
    while (JSON.stringify(await app(of)) === before) {
      assert.ok(performance.now() < end, `${keys} at ${selector} changes nothing: ${before}; said: ${await value(page, 'status')}`);
      await page.waitForTimeout(10);
    }
    await settled(page);
  };
  // The header.
  await app(() => hextwist.stage.eye.zoom(2));
  await operate('[data-do="fit"]', 'Enter', () => hextwist.stage.eye.height);
  for (const view of ['1 0 0', '-1 0 0', '0 1 0', '0 -1 0', '0 0 1', '0 0 -1']) {
    await operate(`[data-view="${view}"]`, 'Enter', () => hextwist.stage.eye.direction.toArray());
    const direction = await app(() => hextwist.stage.eye.direction.toArray());
    view.split(' ').forEach((v, k) => assert.ok(Math.abs(v - direction[k]) < 1e-9, `${view}: ${direction}`));
  }
  await operate('[data-toggle="parallel"]', 'Space', () => hextwist.stage.eye.isParallel);
  await operate('[data-toggle="edges"]', 'Space', () => hextwist.pane.faces.material.uniforms.lines.value);
  await operate('#what', 'ArrowDown', () => [hextwist.pane.faces.visible, hextwist.pane.cad.visible]);
  await press('ArrowUp');
  await operate('[data-toggle="labels"]', 'Enter', () => Boolean(hextwist.labels));
  await operate('[data-do="theme"]', 'Enter', () => document.documentElement.dataset.theme);
  await operate('[data-do="help"]', 'Enter', () => document.getElementById('help').open);
  for (let i = 0; i < 3; ++i) {
    await press('Tab');
    assert.ok(await app(() => document.activeElement === document.body || document.activeElement.closest('#help') !== null), 'what is below the help is not reached');
  }
  await press('Escape');
  assert.equal(await app(() => document.activeElement.dataset.do), 'help', 'back where it was');
  // The list: a search, several picks, a fit.
  await operate('#list-kind', 'c', () => hextwist.list.kind);
  assert.equal(await value(page, 'list-kind'), 'curve');
  await operate('#search', [...'circle'], () => hextwist.list.rows.length);
  await operate('#list', ['Home', 'Enter'], () => [[...hextwist.picks.ids.keys()], hextwist.stage.eye.height]);
  const first = idsOf(await value(page, 'range'))[0];
  await operate('#list', ['ArrowDown', 'Space'], () => hextwist.picks.size);
  assert.equal(idsOf(await value(page, 'range')).length, 2);
  assert.equal(idsOf(await value(page, 'range'))[0], first);
  // The view: turn, move, zoom, pick what is in the middle, a box.
  await tabTo(page, '#view');
  for (const key of ['0', 'ArrowLeft', 'ArrowUp', 'Shift+ArrowLeft', '+', '-', '-', '0']) {
    const before = await eye();
    await press(key);
    assert.notDeepEqual(await eye(), before, key);
  }
  await press('Escape');
  await press('f');
  await press('Enter');
  await page.waitForFunction(() => /^(surface|curve|vertex) \d+$/.test(document.getElementById('range').value));
  await press('0');
  await press('x');
  assert.equal(await page.getAttribute('[data-toggle="box"]', 'aria-pressed'), 'true');
  await press('Escape');
  await press('f');
  for (const key of ['ArrowRight', 'ArrowUp', 'ArrowUp']) await press(key);
  await press('Enter');
  await page.waitForFunction(() => document.getElementById('range').value.startsWith('hex '));
  // The same hexes by the mouse.
  const byKeys = await value(page, 'range'), box = await (await page.$('#view')).boundingBox(), half = await app(() => hextwist.stage.keyBox);
  assert.ok(idsOf(byKeys).length > 3, byKeys);
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await app(() => hextwist.picks.clear());
  await page.mouse.move(x - half.x * box.height, y - half.y * box.height);
  await page.mouse.down();
  await page.mouse.move(x + half.x * box.height, y + half.y * box.height, { steps: 3 });
  await page.mouse.up();
  await page.waitForFunction(() => document.getElementById('range').value !== '');
  assert.equal(await value(page, 'range'), byKeys);
  await press('x');
  // Kinds, a range that is typed, a command that is copied.
  await operate('#right summary', 'Enter', () => document.querySelector('#right details').open);
  await press('Enter');
  await operate('input[name="pick"]', 'ArrowRight', () => hextwist.stage.kind);
  await operate('[data-toggle="box"]', 'Space', () => hextwist.stage.areaTool);
  await operate('[data-toggle="lasso"]', 'Space', () => hextwist.stage.areaTool);
  await press('Space');
  await operate('#through', 'Space', () => hextwist.stage.through);
  await operate('#range', ['Control+A', ...'hexes 3 5 to 9 by 2', 'Enter'], () => [...hextwist.picks.ids.keys()]);
  assert.deepEqual(await app(() => [hextwist.picks.kind, [...hextwist.picks.ids.keys()]]), ['hex', [3, 5, 7, 9]]);
  for (const [typed, said] of [['hex 3 to', /'' is not an id/], ['hx 3', /a range is a kind and ids/], ['hex 9 to 3', /there is nothing/], ['hex 1 999999', /1 of these 2 ids do not exist/], ['vertex all', /^\d+ picked$/]]) {
    await app(() => hextwist.say(''));
    await operate('#range', ['Control+A', ...typed, 'Enter'], () => document.getElementById('status').value);
    assert.match(await value(page, 'status'), said);
  }
  await operate('[data-copy="range"]', 'Enter', () => document.getElementById('status').value);
  await operate('#command-kind', 'ArrowDown', () => document.getElementById('command').value);
  await operate('[data-copy="command"]', 'Enter', () => document.getElementById('status').value);
  await press('r');
  await operate('#range', ['Control+A', ...'hex 5', 'Enter'], () => document.getElementById('range').value);
  const shown = () => hextwist.shownHexes?.reduce((sum, v) => sum + v, 0) ?? null;
  for (const one of ['only', 'all', 'column', 'all', 'sheets', 'hide', 'all']) await operate(`[data-do="${one}"]`, 'Enter', one === 'sheets' ? () => hextwist.picks.kind : shown);
  await operate('#range', ['Control+A', ...'hex 5', 'Enter'], () => document.getElementById('range').value);
  await operate('[data-do="clear"]', 'Enter', () => hextwist.picks.size);
  // Colours.
  await operate('#colour', [...'shape'], () => hextwist.colouring.key);
  assert.equal(await value(page, 'colour'), 'shape');
  await operate('#low', ['Control+A', ...'0.25', 'Enter'], () => hextwist.colouring.range.low);
  await operate('#high', ['Control+A', ...'0.75', 'Enter'], () => hextwist.colouring.range.high);
  await operate('[data-do="auto"]', 'Enter', () => hextwist.colouring.range.low);
  await operate('#histogram button:not([disabled])', 'Enter', () => hextwist.picks.size);
  await operate('[data-do="worst-next"]', 'Enter', () => document.getElementById('worst-now').value);
  await operate('[data-do="worst-back"]', 'Enter', () => document.getElementById('worst-now').value);
  // Cuts.
  await operate('input[name="cut"]', 'ArrowRight', () => hextwist.clip.mode);
  await operate('#cut-axis', 'ArrowDown', () => hextwist.clip.normal);
  await operate('#cut-flip', 'Space', () => hextwist.clip.normal);
  await operate('#cut-at', 'ArrowRight', () => hextwist.clip.distance);
  await operate('input[name="cut"]:checked', ['ArrowRight', 'ArrowRight'], () => hextwist.clip.mode);
  await operate('#explode', 'ArrowRight', () => hextwist.explode);
  await operate('#explode', 'Home', () => hextwist.explode);
  await operate('[data-do="refined-planes"]', 'Enter', () => hextwist.picks.kind);
  await operate('#planes', 'Space', () => hextwist.pane.planes.children.length);
  // Keys of their own, wherever the focus is.
  await press('/');
  assert.equal(await app(() => document.activeElement.id), 'search');
  await press('Escape');
  assert.equal(await app(() => document.activeElement.id), 'view');
  for (const [key, of] of Object.entries({ p: () => hextwist.stage.eye.isParallel, l: () => hextwist.labels, c: () => hextwist.clip.mode, ']': () => hextwist.clip.distance, t: () => hextwist.themeName, k: () => hextwist.stage.kind, e: () => hextwist.pane.faces.material.uniforms.lines.value, g: () => hextwist.pane.cad.visible, o: () => hextwist.stage.areaTool, w: () => document.getElementById('worst-now').value, a: () => hextwist.wanted, '?': () => document.getElementById('help').open }))
    await operate('#view', key, of);
  await shot(page, 'keys');
  assert.deepEqual(page.problems, []);
  await page.close();
});
