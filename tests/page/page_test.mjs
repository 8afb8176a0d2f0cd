// The page in a real browser: what is picked, coloured, cut; names of controls.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { browser as launch, difference, drawn, idsOf, kindOf, listed, model, open, output, random, run, settled, shot, source, spawn, toLine, truth, value } from './support.mjs';

let browser;
before(async () => { browser = await launch(); });
after(() => browser.close());

/** Parallel, from a direction; returns the frame of the canvas. */
async function lookFrom(page, mesh, direction) {
  if ((await page.getAttribute('[data-toggle="parallel"]', 'aria-pressed')) !== 'true') await page.click('[data-toggle="parallel"]');
  await page.click(`[data-view="${direction}"]`);
  await page.evaluate(() => hextwist.picks.clear());
  await page.click('[data-do="fit"]');
  const box = await (await page.$('#view')).boundingBox(), height = await page.evaluate(() => hextwist.stage.eye.height);
  const view = mesh.look(direction.split(' ').map(Number), height, box.width, box.height);
  return { box, view };
}
async function clickAt(page, { box }, [x, y]) {
  await page.evaluate(() => hextwist.picks.clear());
  await page.mouse.click(box.x + x, box.y + y);
  return page.evaluate(async () => { await hextwist.stage.picking; return document.getElementById('range').value; });
}

for (const name of ['bracket', 'pipe_tee', 'sphere', 'inclusion'])
  test(`a click finds the entity of every kind that is there: ${name}`, async () => {
    const mesh = truth(name), next = random(7), [x, y] = mesh.middle.map((v) => v + 0.01);
    // Parts of it are in sets; of those that overlap the first counts.
    const halves = (kind) => [`${kind} with x_coord < ${x}`, `${kind} with ${kind === 'node' ? '' : `x_coord >= ${x} and `}y_coord < ${y}`], kindIn = { block: 'hex', sideset: 'face', nodeset: 'node' }, ids = { block: [7, 8], sideset: [5, 6], nodeset: [6, 9] };
    const sets = Object.entries(kindIn).flatMap(([set, kind]) => [`reset ${set}`, ...halves(kind === 'face' ? 'face in surface all' : kind).map((what, i) => `${set} ${ids[set][i]} ${what}`)]).join('; ');
    const said = [0, 1].map((i) => run([...model(name), '-c', [sets, ...Object.entries(kindIn).map(([set, kind]) => `list ${kind} in ${set} ${ids[set][i]}`)].join('; ')]));
    const members = Object.fromEntries(Object.entries(kindIn).map(([set, kind]) => [set, said.map((text) => new Set(listed(text, kind)))]));
    const setOf = (set, member) => { const i = members[set].findIndex((all) => all.has(member)); return i < 0 ? '' : `${set} ${ids[set][i]}`; }, met = new Set();
    const page = await open(browser, drawn(`picks_${name}`, name, sets));
    for (const direction of ['1 -1 0.7', '0 -1 0']) {
      const frame = await lookFrom(page, mesh, direction), { view, box } = frame;
      const seen = (p, slack) => { const at = mesh.pixel(view, p), hit = mesh.meet(view, ...at); return !hit || mesh.depth(view, p) > hit.depth - slack; };
      for (const kind of ['hex', 'face', 'surface', 'volume', 'node', 'edge', 'block', 'sideset', 'nodeset', 'sheet']) {
        await kindOf(page, kind);
        for (let tries = 0, done = 0; done < (kind in kindIn ? 5 : 3) && tries < 400; ++tries) {
          const at = [next() * box.width, next() * box.height], hit = mesh.meet(view, ...at);
          if (!hit || hit.margin < 2) continue;
          const { face, corners } = hit, to = corners.map((c) => Math.hypot(c[0] - at[0], c[1] - at[1]));
          const sides = corners.map((c, i) => toLine(...at, c, corners[(i + 1) % 4])), nearest = (d) => d.indexOf(Math.min(...d)), isClear = (d) => { const s = [...d].sort((a, b) => a - b); return s[1] - s[0] > 2; };
          if ((kind.startsWith('node') && !isClear(to)) || (['edge', 'sheet'].includes(kind) && !isClear(sides))) continue;
          const k = nearest(sides), ends = [face.cycle[k], face.cycle[(k + 1) % 4]].sort((a, b) => a - b);
          const id = { hex: face.hexes[0].id, face: face.id, surface: face.surface, volume: face.hexes[0].volume, node: face.cycle[nearest(to)], edge: mesh.edgeIds.get(ends.join()) };
          const expected = kind in kindIn ? setOf(kind, id[kindIn[kind]]) : `${kind} ${kind === 'sheet' ? listed(run([...model(name), '-c', `list sheet in edge ${id.edge}`]), 'sheet') : id[kind]}`;
          assert.equal(await clickAt(page, frame, at), expected, `${name} from ${direction} at ${at}`);
          met.add(expected);
          done += kind === 'sheet' ? 3 : 1;  // the program is asked for each
        }
      }
      // Curves at the middles of their edges, vertices at their places; kind "auto" finds the same.
      for (const kind of ['curve', 'geometry']) {
        await kindOf(page, kind);
        for (let done = 0, tries = 0; done < 3 && tries < 300; ++tries) {
          const edge = mesh.curves[Math.floor(next() * mesh.curves.length)], [p, q] = edge.nodes.map((n) => mesh.points.get(n));
          const middle = p.map((v, i) => (v + q[i]) / 2), at = mesh.pixel(view, middle);
          if (!seen(middle, 1e-3) || Math.hypot(...mesh.pixel(view, p).map((v, i) => v - mesh.pixel(view, q)[i])) < 8) continue;
          const near = (other) => other.curve !== edge.curve && toLine(...at, ...other.nodes.map((n) => mesh.pixel(view, mesh.points.get(n)))) < 12;
          if (mesh.curves.some(near)) continue;
          if ([...mesh.vertices.values()].some((n) => Math.hypot(...mesh.pixel(view, mesh.points.get(n)).map((v, i) => v - at[i])) < 14)) continue;
          assert.equal(await clickAt(page, frame, at), `curve ${edge.curve}`, `${name} from ${direction}`);
          ++done;
        }
      }
      await kindOf(page, 'vertex');
      for (const [id, node] of [...mesh.vertices].slice(0, 8)) {
        const p = mesh.points.get(node), at = mesh.pixel(view, p);
        if (!seen(p, 1e-3) || [...mesh.vertices].some(([other, n]) => other !== id && Math.hypot(...mesh.pixel(view, mesh.points.get(n)).map((v, i) => v - at[i])) < 10)) continue;
        assert.equal(await clickAt(page, frame, at), `vertex ${id}`);
      }
    }
    for (const set of Object.keys(kindIn)) for (const id of ids[set]) assert.ok(met.has(`${set} ${id}`), `${set} ${id} was never met`);
    await shot(page, `picks_${name}`);
    assert.deepEqual(page.problems, []);
    await page.close();
  });

test('sets are picked by what is in them', async () => {
  const page = await open(browser, drawn('sets', null, 'create brick x 4 interval 4; sideset 5 surface 1; nodeset 6 curve 1; reset block; block 7 hex 1 to 64'));
  const mesh = truth(null, 'create brick x 4 interval 4');
  for (const direction of ['1 -1 0.7', '-1 0 0', '0 0 -1', '0 1 0', '1 0 0', '0 0 1']) {
    const frame = await lookFrom(page, mesh, direction), at = [frame.box.width / 2, frame.box.height / 2 + 9], hit = mesh.meet(frame.view, ...at);
    await kindOf(page, 'sideset');
    assert.equal(await clickAt(page, frame, at), hit.face.surface === 1 ? 'sideset 5' : '', direction);
    await kindOf(page, 'block');
    assert.equal(await clickAt(page, frame, at), 'block 7');
  }
  await page.selectOption('#list-kind', 'nodeset');
  await page.click('#list .item');
  assert.equal(await value(page, 'range'), 'nodeset 6');
  assert.equal(await value(page, 'command'), 'refine node in nodeset 6');
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('several picks make one range, and commands that the program takes', async () => {
  const page = await open(browser, drawn('ranges', 'bracket'));
  await page.selectOption('#list-kind', 'curve');
  for (const [i, id] of [3, 5, 6, 7, 12].entries()) await page.click(`#list .item:has-text("curve ${id}") >> nth=0`, { modifiers: i ? ['Control'] : [] });
  assert.equal(await value(page, 'range'), 'curve 3 5 to 7 12');
  assert.equal(await value(page, 'command'), 'refine curve 3 5 to 7 12');
  // Taken out again.
  await page.click('#list .item:has-text("curve 12")', { modifiers: ['Control'] });
  assert.equal(await value(page, 'range'), 'curve 3 5 to 7');
  const kinds = await page.$$eval('#command-kind option', (all) => all.map((o) => o.value));
  assert.ok(kinds.length >= 8);
  for (const kind of ['vertex', 'curve', 'surface', 'volume', 'node', 'edge', 'face', 'hex', 'block', 'nodeset', 'sideset', 'sheet']) {
    await page.selectOption('#list-kind', kind);
    await page.waitForSelector('#list .item');
    await page.click('#list .item');
    const texts = [];
    for (const command of kinds.filter((k) => k !== 'range alone')) {
      await page.selectOption('#command-kind', command);
      await page.waitForTimeout(5);
      texts.push(await value(page, 'command'));
    }
    // Those that cut hexes come last. What does not apply to the kind (no levels to take back) is said; the words are
    // always understood.
    const cuts = texts.filter((text) => text.startsWith('refine'));
    for (const cut of cuts) {
      const said = spawn([...model('bracket'), '--keep-going', '-c', [...texts.filter((text) => !cuts.includes(text)), cut].join('; ')]);
      assert.doesNotMatch(said, /expected|unexpected|does not exist|ambiguous/, texts.join('; '));
    }
  }
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('a double click in the list fits; what is picked elsewhere is seen in it', async () => {
  const page = await open(browser, drawn('list', 'bracket')), eye = () => page.evaluate(() => hextwist.stage.eye.height), whole = await eye();
  await page.selectOption('#list-kind', 'curve');
  await page.dblclick('#list .item:has-text("curve 5")');
  assert.equal(await value(page, 'range'), 'curve 5');
  await page.waitForFunction((whole) => hextwist.stage.eye.height < 0.8 * whole, whole);
  // Whatever is searched for, and however long the list is.
  await page.fill('#search', 'line');
  await page.selectOption('#list-kind', 'hex');
  await page.fill('#search', '7');
  await page.evaluate(() => hextwist.clicked({ kind: 'hex', id: 400, position: 399, pane: hextwist.pane, hit: null }));
  await page.waitForSelector('#list .item[aria-selected="true"]:has-text("hex 400")');
  const [item, list] = await Promise.all(['#list .item[aria-selected="true"]', '#list'].map(async (s) => (await page.$(s)).boundingBox()));
  assert.ok(item.y >= list.y && item.y + item.height <= list.y + list.height, 'the row is seen');
  assert.equal(await value(page, 'search'), '');
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('the list is searched by name, id and type', async () => {
  const page = await open(browser, drawn('search', 'bracket', 'curve 4 name "rim of the bore"'));
  const rows = () => page.$$eval('#list .item', (all) => all.map((e) => e.textContent));
  await page.selectOption('#list-kind', 'curve');
  await page.fill('#search', 'bore');
  assert.equal((await rows()).length, 1);
  assert.match((await rows())[0], /curve 4.*rim of the bore/);
  await page.press('#search', 'Enter');
  assert.equal(await value(page, 'range'), 'curve 4');
  await page.fill('#search', 'circle');
  const circles = listed(run([...model('bracket'), '-c', 'list curve with radius > 0']), 'curve');
  assert.deepEqual((await rows()).map((text) => Number(text.match(/curve (\d+)/)[1])), circles);
  await page.selectOption('#list-kind', 'hex');
  await page.fill('#search', '417');
  assert.deepEqual((await rows()).map((t) => t.trim()), ['hex 417']);
  // A kind that is named is listed, whatever was; of a name that is one of others a button leads there.
  for (const [said, kind, first] of [['curve 5', 'curve', /^curve 5circle/], ['surfaces plane', 'surface', /^surface \d+plane/], ['hex 12', 'hex', /^hex 12$/]]) {
    await page.fill('#search', said);
    await page.waitForFunction((kind) => hextwist.list.kind === kind, kind);
    assert.match((await rows())[0], first);
    if (kind !== 'surface') assert.equal((await rows()).length, 1);
  }
  await page.fill('#search', 'bore');
  assert.equal((await rows()).length, 0);
  await page.click('#list-hint button:has-text("1 of curves")');
  assert.match((await rows())[0], /curve 4.*rim of the bore/);
  await page.fill('#search', 'no such name');
  assert.match(await page.textContent('#list-hint'), /Nothing/);
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('colours, histogram and worst ten are those of the program', async () => {
  const page = await open(browser, drawn('colours', 'bracket', 'refine curve 5 depth 1')), start = [...model('bracket')];
  const report = JSON.parse((run([...start, '-c', 'refine curve 5 depth 1', '--json', join(output, 'r.json')]), readFileSync(join(output, 'r.json'), 'utf8')));
  const worst = report.commands.at(-1).shape.after;
  const before = await page.screenshot();
  await page.selectOption('#colour', 'shape');
  await settled(page);
  assert.notEqual(Buffer.compare(before, await shot(page, 'colours')), 0);
  assert.match(await page.textContent('#legend'), /shape/);
  const bars = await page.$$('#histogram button:not([disabled])');
  let total = 0;
  for (const bar of bars.slice(0, 6)) {
    const [, from, to, count] = (await bar.getAttribute('aria-label')).match(/(\S+) to (\S+): ([\d,]+) hex/);
    await bar.click();
    const picked = idsOf(await value(page, 'range'));
    assert.equal(picked.length, Number(count.replace(',', '')));
    total += picked.length;
    const width = Number(to) - Number(from), inner = listed(run([...start, '-c', `refine curve 5 depth 1; list hex with quality shape > ${Number(from) + 0.01 * width} and quality shape < ${Number(to) - 0.01 * width}`]), 'hex');
    for (const id of inner) assert.ok(picked.includes(id), `hex ${id} between ${from} and ${to}`);
  }
  assert.ok(total > 0);
  await page.click('[data-do="worst-next"]');
  // Of equal ones it may be another.
  await page.waitForFunction(() => /^1: hex (\d+), /.test(document.getElementById('worst-now').value));
  await page.waitForFunction(() => document.getElementById('worst-now').value.includes(`${document.getElementById('range').value},`));
  const values = [];
  for (let i = 0; i < 9; ++i) {
    values.push(Number((await value(page, 'worst-now')).split(', ')[1]));
    await page.click('[data-do="worst-next"]');
  }
  assert.deepEqual(values, [...values].sort((a, b) => a - b));
  assert.ok(Math.abs(values[0] - worst.min) < 1e-3 * worst.min);
  // Everything that is offered can be chosen.
  const offered = await page.$$eval('#colour option:not([disabled])', (all) => all.map((o) => o.value));
  for (const name of ['volume', 'level', 'template', 'sheet', 'scaled Jacobian', 'oddy', 'dimension']) assert.ok(offered.includes(name), name);
  for (const name of offered) { await page.selectOption('#colour', name); await settled(page); }
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('levels, fields and wished sizes give colours', async () => {
  const page = await open(browser, drawn('fields', null, 'create brick x 4 interval 4; refine hex 22 graded; sizing function f "1 + 0.1*abs(x)"', 'hex all quality shape'));
  assert.equal(await value(page, 'colour'), 'shape');
  for (const [name, what] of [['level', /level 1/], ['template', /one into 27/], ['actual / wished size', /actual/]]) {
    await page.selectOption('#colour', name);
    await settled(page);
    assert.match(await page.textContent('#legend'), what);
  }
  await page.selectOption('#colour', 'template');
  await settled(page);
  await page.click('#histogram button:has-text("one into 27")');
  assert.equal(idsOf(await value(page, 'range')).length, 27);
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('fields on nodes have a histogram and a worst ten of nodes', async () => {
  const file = join(output, 'field.vtk'), n = 3, at = Array.from({ length: n + 1 }, (_, i) => i), points = at.flatMap((z) => at.flatMap((y) => at.map((x) => [x, y, z])));
  const id = (x, y, z) => x + (n + 1) * (y + (n + 1) * z), cells = at.slice(0, n).flatMap((z) => at.slice(0, n).flatMap((y) => at.slice(0, n).map((x) => [0, 1].flatMap((k) => [id(x, y, z + k), id(x + 1, y, z + k), id(x + 1, y + 1, z + k), id(x, y + 1, z + k)]))));
  const heat = points.map(([x, y, z]) => x + 10 * y + 100 * z);
  writeFileSync(file, ['# vtk DataFile Version 3.0', 'a grid', 'ASCII', 'DATASET UNSTRUCTURED_GRID', `POINTS ${points.length} double`, ...points.map((p) => p.join(' ')), `CELLS ${cells.length} ${9 * cells.length}`,
    ...cells.map((c) => [8, ...c].join(' ')), `CELL_TYPES ${cells.length}`, ...cells.map(() => 12), `POINT_DATA ${points.length}`, 'SCALARS heat double 1', 'LOOKUP_TABLE default', ...heat].join('\n') + '\n');
  run(['view', file, '-o', join(output, 'field.html')]);
  const page = await open(browser, `file://${join(output, 'field.html')}`);
  await page.selectOption('#colour', 'heat');
  await settled(page);
  const bar = await page.$('#histogram button:not([disabled])'), [, from, to, count] = (await bar.getAttribute('aria-label')).match(/(\S+) to (\S+): ([\d,]+) nodes?$/);
  await bar.click();
  assert.match(await value(page, 'range'), /^node /);
  assert.deepEqual(idsOf(await value(page, 'range')), heat.map((v, i) => [v, i + 1]).filter(([v]) => v >= Number(from) && v < Number(to)).map(([, i]) => i));
  assert.equal(idsOf(await value(page, 'range')).length, Number(count));
  await page.click('[data-do="worst-next"]');
  await page.waitForFunction(() => document.getElementById('range').value === 'node 64');
  assert.equal(await value(page, 'worst-now'), '1: node 64, 333');
  await kindOf(page, 'node');
  await page.click('[data-view="1 0 0"]');
  await page.click('[data-do="all"]');
  await settled(page);
  const box = await (await page.$('#view')).boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.waitForFunction(() => /^node \d+ .*heat \d+/.test(document.getElementById('tip').textContent));
  const [, node, said] = (await page.textContent('#tip')).match(/node (\d+) .*heat ([\d.]+)/);
  assert.equal(Number(said), heat[node - 1]);
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('a cut shows whole hexes inside, and a click finds them', async () => {
  const commands = 'create brick x 6 interval 6', page = await open(browser, drawn('cut', null, commands)), mesh = truth(null, commands);
  const frame = await lookFrom(page, mesh, '1 0 0');
  await kindOf(page, 'hex');
  await page.click('input[name="cut"][value="crinkle"]');
  await page.$eval('#cut-at', (e) => { e.value = 0.5; e.dispatchEvent(new Event('input')); });
  await settled(page);
  const outside = new Set(mesh.skin.map((face) => face.hexes[0].id)), shownFaces = mesh.faces.filter((face) => {
    const kept = face.hexes.filter((hex) => hex.nodes.reduce((sum, n) => sum + mesh.points.get(n)[0] / 8, 0) < 0);
    return kept.length === 1;
  });
  let inside = 0;
  for (const at of [[0.5, 0.45], [0.47, 0.6], [0.55, 0.4], [0.3, 0.5]]) {
    const pixel = [frame.box.width * at[0], frame.box.height * at[1]], hit = mesh.meet(frame.view, ...pixel, shownFaces);
    const range = await clickAt(page, frame, pixel);
    const expected = hit ? hit.face.hexes.find((hex) => hex.nodes.reduce((sum, n) => sum + mesh.points.get(n)[0], 0) < 0).id : null;
    assert.equal(range, expected === null ? '' : `hex ${expected}`);
    if (expected !== null && !outside.has(expected)) ++inside;
  }
  assert.ok(inside > 0, 'no hex inside was met');
  await shot(page, 'cut');
  await page.click('input[name="cut"][value="plane"]');
  await page.$eval('#cut-at', (e) => { e.value = 0.42; e.dispatchEvent(new Event('input')); });
  await settled(page);
  const range = await clickAt(page, frame, [frame.box.width / 2 + 7, frame.box.height / 2 + 7]);
  assert.ok(!outside.has(idsOf(range)[0]), range);
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('sheets and columns are those of the program', async () => {
  const page = await open(browser, drawn('sheets', 'cam'));
  await page.selectOption('#list-kind', 'sheet');
  await page.waitForSelector('#list .item');
  await page.fill('#search', '7');
  await page.click('#list .item');
  await page.click('[data-do="only"]');
  await settled(page);
  const shown = await page.evaluate(() => Array.from(hextwist.shownHexes.keys()).filter((h) => hextwist.shownHexes[h]).map((h) => hextwist.scene.hexId(h)));
  assert.deepEqual(shown, listed(run([...model('cam'), '-c', 'list hex in sheet 7']), 'hex'));
  await page.check('#planes');
  await settled(page);
  await shot(page, 'sheet');
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('boxes and lassos pick hexes', async () => {
  const commands = 'create brick x 6 interval 6', page = await open(browser, drawn('boxes', null, commands)), mesh = truth(null, commands);
  const frame = await lookFrom(page, mesh, '0 -1 0'), { box, view } = frame;
  const rectangle = [[box.width * 0.42, box.height * 0.4], [box.width * 0.61, box.height * 0.7]];
  const expected = mesh.skin.filter((face) => {
    const p = [0, 1, 2].map((k) => face.cycle.reduce((sum, n) => sum + mesh.points.get(n)[k] / 4, 0)), [x, y] = mesh.pixel(view, p);
    return p[1] < -2.9 && x > rectangle[0][0] && x < rectangle[1][0] && y > rectangle[0][1] && y < rectangle[1][1];
  }).map((face) => face.hexes[0].id).sort((a, b) => a - b);
  await page.click('[data-toggle="box"]');
  await page.mouse.move(box.x + rectangle[0][0], box.y + rectangle[0][1]);
  await page.mouse.down();
  await page.mouse.move(box.x + rectangle[1][0], box.y + rectangle[1][1], { steps: 4 });
  await page.mouse.up();
  await settled(page);
  assert.ok(expected.length > 1);
  assert.deepEqual(idsOf(await value(page, 'range')), expected);
  await page.click('[data-toggle="lasso"]');
  await page.mouse.move(box.x + rectangle[0][0], box.y + rectangle[0][1]);
  await page.mouse.down();
  for (const [x, y] of [[rectangle[1][0], rectangle[0][1]], rectangle[1], [rectangle[0][0], rectangle[1][1]]]) await page.mouse.move(box.x + x, box.y + y, { steps: 3 });
  await page.mouse.up();
  await settled(page);
  assert.deepEqual(idsOf(await value(page, 'range')), expected);
  // Through and through: the hexes behind them as well.
  await page.check('#through');
  await page.click('[data-toggle="box"]');
  await page.mouse.move(box.x + rectangle[0][0], box.y + rectangle[0][1]);
  await page.mouse.down();
  await page.mouse.move(box.x + rectangle[1][0], box.y + rectangle[1][1], { steps: 4 });
  await page.mouse.up();
  await settled(page);
  assert.equal(idsOf(await value(page, 'range')).length, 6 * expected.length);
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('the page and the picture of a command show the same', async () => {
  const page = await open(browser, drawn('same', 'pipe_tee')), mesh = truth('pipe_tee');
  const { box } = await lookFrom(page, mesh, '1 -1 0.7');
  await page.mouse.move(5, 300);
  await page.evaluate(() => { hextwist.pane.curves.visible = false; document.getElementById('over').hidden = true; document.getElementById('legend').hidden = true; });
  const size = [Math.round(box.width), Math.round(box.height)];
  run([...model('pipe_tee'), '-c', `draw pixels ${size[0]} ${size[1]} to '${join(output, 'same_picture.png')}' overwrite`]);
  await settled(page);
  const seen = await page.screenshot({ path: join(output, 'same_page.png'), clip: { x: box.x, y: box.y, width: size[0], height: size[1] } });
  const picture = readFileSync(join(output, 'same_picture.png'));
  const blank = await browser.newPage();
  // Bounding box and filled part of that box, of either: the scale differs, what is seen does not.
  const [a, b] = await blank.evaluate(async (images) => {
    const results = [];
    for (const image of images) {
      const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${image}`)).blob()), canvas = new OffscreenCanvas(bitmap.width, bitmap.height), pen = canvas.getContext('2d');
      pen.drawImage(bitmap, 0, 0);
      const { data } = pen.getImageData(0, 0, bitmap.width, bitmap.height), back = data.slice(0, 3);
      const isInk = (x, y) => [0, 1, 2].some((k) => Math.abs(data[4 * (y * bitmap.width + x) + k] - back[k]) > 8);
      let x0 = 1e9, x1 = -1, y0 = 1e9, y1 = -1;
      for (let y = 0; y < bitmap.height; ++y) for (let x = 0; x < bitmap.width; ++x) if (isInk(x, y)) { x0 = Math.min(x0, x); x1 = Math.max(x1, x); y0 = Math.min(y0, y); y1 = Math.max(y1, y); }
      const n = 60, mask = [];
      for (let j = 0; j < n; ++j) for (let i = 0; i < n; ++i) mask.push(isInk(Math.round(x0 + ((x1 - x0) * (i + 0.5)) / n), Math.round(y0 + ((y1 - y0) * (j + 0.5)) / n)) ? 1 : 0);
      results.push({ aspect: (x1 - x0) / (y1 - y0), mask });
    }
    return results;
  }, [seen.toString('base64'), picture.toString('base64')]);
  assert.ok(Math.abs(a.aspect - b.aspect) < 0.02 * b.aspect, `${a.aspect} and ${b.aspect}`);
  const differ = a.mask.filter((v, i) => v !== b.mask[i]).length;
  assert.ok(differ < 0.03 * a.mask.length, `${differ} of ${a.mask.length} places differ`);
  assert.deepEqual(page.problems, []);
  await page.close();
  await blank.close();
});

/** Looks as `draw` does: parallel, all of it in the middle, nothing over it. */
const frameAsDrawn = (page, direction) => page.evaluate(async (direction) => {
  const { stage, scene, pane } = hextwist, { eye } = stage;
  eye.isParallel = true;
  eye.look(...direction);
  const camera = eye.update(stage.width / stage.height), axes = [0, 1, 2].map((k) => camera.matrixWorld.elements.slice(4 * k, 4 * k + 3));
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity], point = scene.isCad ? pane.cadArrays.point : scene.skin.point;
  for (let i = 0; i < point.length; i += 3)
    axes.forEach((axis, k) => {
      const d = axis[0] * point[i] + axis[1] * point[i + 1] + axis[2] * point[i + 2];
      low[k] = Math.min(low[k], d);
      high[k] = Math.max(high[k], d);
    });
  eye.target.set(...[0, 1, 2].map((k) => axes.reduce((sum, axis, j) => sum + (axis[k] * (low[j] + high[j])) / 2, 0)));
  eye.height = stage.height / (0.92 * Math.min(stage.width / (high[0] - low[0]), stage.height / (high[1] - low[1])));
  for (const id of ['over', 'legend', 'tip']) document.getElementById(id).style.visibility = 'hidden';
  stage.render();
  await new Promise((r) => setTimeout(r, 300));  // until it has settled
  stage.render();
}, direction);

test('screens and pictures show the same, light and dark', async () => {
  const looks = [
    ['bracket', 'refine vertex 9 depth 1; refine curve 22 depth 1', 'quality shape'],
    ['bracket', 'refine vertex 9 depth 1; refine curve 22 depth 1', 'color level clip y'],
    ['pipe_tee', '', 'color surface'],
    ['pipe_tee', '', "color 'scaled jacobian' clip y crinkle"],
    ['inclusion', '', 'color volume clip 1 -1 0.4'],
    ['bracket', '', 'color sideset'],
    ['cam', '', 'color sheet'],
    ['bent_bar', '', 'geometry'],
  ];
  const shares = [];
  for (const [i, [name, commands, words]] of looks.entries()) {
    const page = await open(browser, drawn(`look_${i}`, name, commands, words)), box = await (await page.$('#view')).boundingBox(), size = [Math.floor(box.width), Math.floor(box.height)];
    // What is cut away lies before the eye of the command: seen from elsewhere it is another picture.
    const directions = words.includes('clip') ? ['1 -1 0.7'] : i === 0 ? ['1 -1 0.7', '0 -1 0', '-1 -0.5 -0.4', '0 0 1'] : ['1 -1 0.7', '-1 -0.5 -0.4'];
    const pictures = directions.map((direction, k) => join(output, `look_${i}_${k}_picture.png`));
    run([...model(name), '-c', [commands, ...directions.map((direction, k) => `draw ${words} legend off from ${direction} pixels ${size.join(' ')} to '${pictures[k]}' overwrite`)].filter(Boolean).join('; ')]);
    // Neutral faces are darker in the dark.
    for (const theme of /sideset|geometry/.test(words) ? ['light'] : ['light', 'dark']) {
      if (theme === 'dark') await page.click('[data-do="theme"]');
      // Curves are white there, and those of pictures are not.
      await page.evaluate((isDark) => { hextwist.pane.curves.visible = !isDark; }, theme === 'dark');
      for (const [k, direction] of directions.entries()) {
        await frameAsDrawn(page, direction.split(' ').map(Number));
        const seen = await page.screenshot({ path: join(output, `look_${i}_${k}_${theme}.png`), clip: { x: box.x, y: box.y, width: size[0], height: size[1] } });
        const share = await difference(browser, seen, readFileSync(pictures[k]), theme === 'dark' ? 45 : 30);
        shares.push(`${name} ${words} from ${direction} ${theme}: ${(100 * share).toFixed(2)}%`);
        assert.ok(share < 0.04, shares.at(-1));
        // It would be seen if they differed.
        if (k > 0) assert.ok((await difference(browser, seen, readFileSync(pictures[0]), 45)) > 0.1, `${name} ${words}: another direction looks the same`);
      }
    }
    assert.deepEqual(page.problems, []);
    await page.close();
  }
  writeFileSync(join(output, 'looks.txt'), shares.join('\n'));
});

test('sets and owners give colours; their rows pick them', async () => {
  const page = await open(browser, drawn('set_colours', null, "create brick x 4 interval 4; sideset 5 surface 1 name 'left'; nodeset 6 curve 1 2; group 'some' add hex 1 to 4 curve 3 surface 2", 'color sideset'));
  assert.equal(await value(page, 'colour'), 'sideset');
  assert.match(await page.textContent('#legend'), /sideset 5 left/);
  await page.click('#histogram button:has-text("sideset 5 left")');
  assert.equal(await value(page, 'range'), 'sideset 5');
  const coloured = () => page.evaluate(() => {
    const { quads, faces, nodeDots } = hextwist.pane, tint = faces.geometry.getAttribute('tint').array, of = {};
    for (let q = 0; q < quads.n; ++q) if (tint[16 * q] < 200) (of[quads.surface[q]] ??= []).push(quads.hex[q] + 1);
    return { of, dots: nodeDots.children.reduce((sum, dots) => sum + dots.geometry.getAttribute('position').count, 0) };
  });
  assert.deepEqual(Object.entries((await coloured()).of).map(([surface, hexes]) => [surface, hexes.length]), [['1', 16]]);
  await page.selectOption('#colour', 'nodeset');
  await settled(page);
  assert.equal((await coloured()).dots, listed(run(['-c', 'create brick x 4 interval 4; list node in curve 1 2']), 'node').length);
  await page.selectOption('#colour', 'group');
  await settled(page);
  const group = await coloured(), hexes = new Set(Object.values(group.of).flat()), inSurface = listed(run(['-c', 'create brick x 4 interval 4; list hex in surface 2']), 'hex');
  assert.deepEqual([...hexes].sort((a, b) => a - b), [...new Set([1, 2, 3, 4, ...inSurface])].sort((a, b) => a - b));
  assert.equal(group.dots, 5);
  await page.selectOption('#colour', 'owner');
  await settled(page);
  assert.equal((await coloured()).dots, 98);
  assert.match(await page.textContent('#histogram'), /nodes of vertices8nodes of curves36nodes of surfaces54/);
  await page.click('#histogram button:has-text("nodes of vertices")');
  assert.deepEqual(idsOf(await value(page, 'range')), listed(run(['-c', 'create brick x 4 interval 4; list node in vertex all']), 'node'));
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('a page begins as its command says', async () => {
  const page = await open(browser, drawn('begins', 'bracket', 'refine vertex 9 depth 1', `color level clip x at 20 label surface title 'A part' from 0 -1 0.2`));
  assert.equal(await page.textContent('#title'), 'A part');
  assert.equal(await value(page, 'colour'), 'level');
  assert.equal(await page.$eval('input[name="cut"]:checked', (e) => e.value), 'plane');
  assert.equal(await value(page, 'cut-axis'), '1 0 0');
  const { clip, origin, labels, kind, direction } = await page.evaluate(() => ({ clip: hextwist.clip, origin: hextwist.scene.meta.origin, labels: hextwist.stage.nLabels, kind: hextwist.stage.kind, direction: hextwist.stage.eye.direction.toArray() }));
  assert.ok(Math.abs(clip.normal[0] * (clip.distance + clip.normal[0] * origin[0]) - 20) < 1e-4);
  assert.equal(kind, 'surface');
  assert.ok(labels > 1, `${labels} labels`);
  assert.ok(Math.abs(direction[1] + Math.cos(Math.atan(0.2))) < 1e-6);
  // The controls go on from there.
  await page.focus('#cut-at');
  await page.keyboard.press('ArrowRight');
  await settled(page);
  const moved = await page.evaluate(() => hextwist.clip);
  assert.deepEqual(moved.normal, clip.normal);
  const size = await page.evaluate(() => hextwist.scene.meta.size);
  assert.ok(Math.abs(moved.distance - clip.distance) < 0.02 * size && moved.distance !== clip.distance);
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('CAD without a mesh is shown, picked, coloured and labelled', async () => {
  const cad = join(source, 'models', 'bracket.step'), file = join(output, 'cad_alone.html');
  run(['view', cad, '-o', file]);
  const page = await open(browser, `file://${file}`), mesh = truth('bracket');
  assert.equal(await page.textContent('#counts'), '11 surfaces, no mesh');
  for (const direction of ['1 -1 0.7', '0 -1 0']) {
    const frame = await lookFrom(page, mesh, direction), next = random(3);
    await kindOf(page, 'surface');
    for (let tries = 0, done = 0; done < 5 && tries < 300; ++tries) {
      const at = [next() * frame.box.width, next() * frame.box.height], hit = mesh.meet(frame.view, ...at);
      // Away from other surfaces, as the mesh is not quite on round ones.
      if (!hit || [-4, 4].some((d) => [[d, 0], [0, d]].some(([x, y]) => mesh.meet(frame.view, at[0] + x, at[1] + y)?.face.surface !== hit.face.surface))) continue;
      assert.equal(await clickAt(page, frame, at), `surface ${hit.face.surface}`, direction);
      ++done;
    }
    await kindOf(page, 'volume');
    const at = [frame.box.width / 2, frame.box.height / 2];
    if (mesh.meet(frame.view, ...at)) assert.equal(await clickAt(page, frame, at), 'volume 1');
  }
  await page.selectOption('#list-kind', 'curve');
  assert.equal((await page.$$('#list .item')).length > 10, true);
  const before = await page.screenshot();
  await page.selectOption('#colour', 'surface');
  await settled(page);
  assert.notEqual(Buffer.compare(before, await shot(page, 'cad_alone')), 0);
  await page.click('[data-toggle="labels"]');
  await settled(page);
  assert.ok((await page.evaluate(() => hextwist.stage.nLabels)) >= 1);
  for (const one of ['crinkle', 'plane', 'off']) { await page.click(`input[name="cut"][value="${one}"]`); await settled(page); }
  for (const one of ['only', 'hide', 'column', 'sheets', 'all', 'fit', 'refined-planes']) { await page.click(`[data-do="${one}"]`); await settled(page); }
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('levels and templates of files', async () => {
  const levels = join(output, 'l.levels'), mesh = join(output, 'l.vtu'), file = join(output, 'levels.html');
  run([...model('bracket'), '-c', `refine vertex 9 depth 1 graded; export vtk '${mesh}' overwrite; export levels '${levels}' overwrite`]);
  const cad = model('bracket').slice(0, 2);
  for (const [args, hasTemplates] of [[[mesh], false], [[mesh, '--levels', levels], true], [['--levels', levels], true]]) {
    run(['view', ...cad, ...args, '-o', file]);
    const page = await open(browser, `file://${file}`), offered = await page.$$eval('#colour option', (all) => all.map((o) => o.value));
    assert.ok(offered.includes('level'), args.join(' '));
    assert.equal(offered.includes('template'), hasTemplates, args.join(' '));
    await page.selectOption('#colour', 'level');
    await settled(page);
    assert.match(await page.textContent('#legend'), /level 0level 1/);
    assert.deepEqual(page.problems, []);
    await page.close();
  }
});

test('hover, copy, labels, the true CAD, explosions, hiding and the mesh before', async () => {
  const before = join(output, 'before.msh'), after = join(output, 'after.msh'), file = join(output, 'both.html');
  run([...model('inclusion'), '-c', `export mesh '${before}' overwrite; refine curve 1 depth 1; export mesh '${after}' overwrite`]);
  const cad = model('inclusion').slice(0, 2);
  run(['view', after, ...cad, '--before', before, '-o', file]);
  const page = await open(browser, `file://${file}`), mesh = truth('inclusion', 'refine curve 1 depth 1'), frame = await lookFrom(page, mesh, '0 -1 0');
  // Hover says kind and id, and the value of what gives the colours.
  await kindOf(page, 'hex');
  const at = [frame.box.width / 2 + 5, frame.box.height / 2 + 5], hit = mesh.meet(frame.view, ...at);
  await page.selectOption('#colour', 'shape');
  await settled(page);
  await page.mouse.move(frame.box.x + at[0], frame.box.y + at[1]);
  await page.waitForFunction(() => !document.getElementById('tip').hidden);
  assert.match(await page.textContent('#tip'), new RegExp(`^hex ${hit.face.hexes[0].id} · shape 0?\\.?\\d`));
  assert.match(await page.textContent('#where'), /^\(.+, .+, .+\)$/);
  // Copy.
  await page.mouse.click(frame.box.x + at[0], frame.box.y + at[1]);
  await page.waitForFunction(() => document.getElementById('range').value !== '');
  await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  await page.click('[data-copy="command"]');
  await page.waitForFunction(() => document.getElementById('status').value.startsWith('copied: '));
  assert.equal(await page.evaluate(() => navigator.clipboard.readText()), `refine hex ${hit.face.hexes[0].id}`);
  // Labels: ids that are seen, of the kind that is picked.
  await kindOf(page, 'surface');
  const corner = await lookFrom(page, mesh, '1 -1 0.7'), seen = new Set();
  await page.click('[data-toggle="labels"]');
  await settled(page);
  for (let y = 4; y < corner.box.height; y += 12) for (let x = 4; x < corner.box.width; x += 12) { const face = mesh.meet(corner.view, x, y)?.face; if (face?.surface) seen.add(face.surface); }
  assert.equal(await page.evaluate(() => hextwist.stage.nLabels), seen.size);
  await page.click('[data-toggle="labels"]');
  // The mesh on true surfaces, and these alone.
  const shots = [await page.screenshot()];
  for (const what of ['both', 'cad']) {
    await page.selectOption('#what', what);
    await settled(page);
    shots.push(await shot(page, `what_${what}`));
  }
  assert.ok((await difference(browser, shots[0], shots[2], 10)) > 0.05);
  assert.ok((await difference(browser, shots[1], shots[2], 10)) > 0.02, 'lines of the mesh');
  await page.selectOption('#what', 'mesh');
  // Hide and show.
  const shown = () => page.evaluate(() => new Set(hextwist.pane.quads.hex).size), all = await shown();
  await page.selectOption('#list-kind', 'volume');
  await page.click('#list .item');
  await page.click('[data-do="hide"]');
  await settled(page);
  assert.notEqual(await shown(), all);
  await page.click('[data-do="all"]');
  await settled(page);
  assert.equal(await shown(), all);
  // The parts of the model are moved away from each other, and show their own skins.
  const extent = () => page.evaluate(() => { const p = hextwist.pane.faces.geometry.getAttribute('position').array; let low = Infinity, high = -Infinity; for (let i = 0; i < p.length; i += 3) { low = Math.min(low, p[i]); high = Math.max(high, p[i]); } return [hextwist.pane.quads.n, high - low]; });
  const whole = await extent();
  await page.$eval('#explode', (e) => { e.value = 0.5; e.dispatchEvent(new Event('input')); });
  await settled(page);
  const apart = await extent();
  assert.ok(apart[0] > whole[0], 'the surfaces between are seen');
  // The ball has left the cube that it lies in the middle of.
  const box3 = await page.evaluate(() => {
    const { quads, faces } = hextwist.pane, p = faces.geometry.getAttribute('position').array, volume = hextwist.scene.insideNow.volume, of = {};
    for (let q = 0; q < quads.n; ++q) { const v = (of[volume[quads.hex[q]]] ??= [Infinity, -Infinity]), z = p[12 * q + 2]; v[0] = Math.min(v[0], z); v[1] = Math.max(v[1], z); }
    return Object.values(of);
  });
  assert.equal(box3.length, 2);
  assert.notDeepEqual(box3[0].map((z) => Math.round(z)), box3[1].map((z) => Math.round(z)));
  assert.ok(Math.max(box3[0][1], box3[1][1]) > 0.9 * Math.max(...box3.map(([low, high]) => high - low)), 'one is above the other');
  await page.evaluate(() => hextwist.picks.clear());
  await page.click('[data-do="fit"]');
  const reach = await page.evaluate(() => {
    const { eye, paneWidth, height } = hextwist.stage, camera = eye.update(paneWidth / height), at = hextwist.pane.faces.geometry.getAttribute('position').array, p = eye.target.clone();
    let most = 0;
    for (let i = 0; i < at.length; i += 3) { p.fromArray(at, i).project(camera); most = Math.max(most, Math.abs(p.x), Math.abs(p.y)); }
    return most;
  });
  assert.ok(reach < 1.001, `all parts are seen after a fit: ${reach}`);
  await shot(page, 'explode');
  await page.$eval('#explode', (e) => { e.value = 0; e.dispatchEvent(new Event('input')); });
  await settled(page);
  // Side by side, under one camera.
  await page.click('[data-toggle="before"]');
  await page.waitForFunction(() => hextwist.panes.length === 2);
  await settled(page);
  assert.deepEqual(await page.evaluate(() => hextwist.panes.map((pane) => pane.scene.meta.n_hexes)), [run([before, '-c', 'list hex all']), run([after, '-c', 'list hex all'])].map((text) => Number(text.match(/([\d,]+) hexes/)[1].replaceAll(',', ''))));
  // All of the mesh is seen in either.
  const corners = await page.evaluate(() => {
    const { eye, paneWidth, height } = hextwist.stage, { point } = hextwist.scene.skin, camera = eye.update(paneWidth / height), p = eye.target.clone();
    let most = 0;
    for (let i = 0; i < point.length; i += 3) { p.fromArray(point, i).project(camera); most = Math.max(most, Math.abs(p.x), Math.abs(p.y)); }
    return most;
  });
  assert.ok(corners < 1.001, `${corners}`);
  await shot(page, 'both');
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('a column of hexes, and the planes of a refinement', async () => {
  const commands = 'create brick x 6 interval 6; refine hex 100', page = await open(browser, drawn('column', null, commands)), mesh = truth(null, commands);
  const frame = await lookFrom(page, mesh, '0 -1 0');
  await kindOf(page, 'face');
  // Near the rim nothing is refined: six hexes behind each other.
  const at = [frame.box.width / 2 - frame.view.scale * 2.5, frame.box.height / 2 - frame.view.scale * 2.5], hit = mesh.meet(frame.view, ...at);
  assert.equal(await clickAt(page, frame, at), `face ${hit.face.id}`);
  await page.click('[data-do="column"]');
  await settled(page);
  const middle = (hex, k) => hex.nodes.reduce((sum, n) => sum + mesh.points.get(n)[k] / 8, 0), near = (a, b) => Math.abs(a - b) < 1e-6;
  const expected = mesh.hexes.filter((hex) => [0, 2].every((k) => near(middle(hex, k), middle(hit.face.hexes[0], k)))).map((hex) => hex.id);
  assert.deepEqual(idsOf(await value(page, 'range')), expected);
  assert.equal(expected.length, 6);
  await page.click('[data-do="all"]');
  await page.click('[data-do="refined-planes"]');
  await settled(page);
  assert.match(await value(page, 'range'), /^sheet /);
  const sheets = (more) => listed(run(['-c', `create brick x 6 interval 6; ${more}list sheet all`]), 'sheet').length;
  assert.equal(await page.evaluate(() => hextwist.pane.planes.children.length), sheets('refine hex 100; ') - sheets(''), 'the sheets that were put in');
  await shot(page, 'planes');
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('what a refinement has put in is shown however it was made, beside the mesh before', async () => {
  // By single and parallel sheets, as the paper has it: no levels.
  const commands = 'create brick x 4 interval 4; refine curve 1', page = await open(browser, drawn('put_in', null, commands));
  const mesh = truth(null, commands), old = truth(null, 'create brick x 4 interval 4');
  const corners = (mesh, hex) => hex.nodes.map((n) => mesh.points.get(n).join(' ')).sort().join(), known = new Set(old.hexes.map((hex) => corners(old, hex)));
  const isNew = new Set(mesh.hexes.filter((hex) => !known.has(corners(mesh, hex))).map((hex) => hex.id));
  assert.ok(isNew.size > 0 && isNew.size < mesh.hexes.length);
  await page.selectOption('#colour', 'changed');
  await settled(page);
  await page.click('#histogram button:has-text("changed")');
  await page.waitForFunction(() => document.getElementById('range').value !== '');
  assert.deepEqual(idsOf(await value(page, 'range')), [...isNew].sort((a, b) => a - b));
  // Sheets all of whose hexes are new.
  const n = listed(run(['-c', `${commands}; list sheet all`]), 'sheet').length, within = [];
  for (let sheet = 1; sheet <= n; ++sheet) if (listed(run(['-c', `${commands}; list hex in sheet ${sheet}`]), 'hex').every((id) => isNew.has(id))) within.push(sheet);
  await page.click('[data-do="refined-planes"]');
  await page.waitForFunction(() => document.getElementById('range').value.startsWith('sheet ') && hextwist.pane.planes.children.length > 0);
  assert.ok(within.length > 0);
  assert.deepEqual(idsOf(await value(page, 'range')), within);
  assert.equal(await page.evaluate(() => hextwist.pane.planes.children.length), within.length);
  await page.click('[data-toggle="before"]');
  await page.waitForFunction(() => hextwist.panes.length === 2);
  assert.deepEqual(await page.evaluate(() => hextwist.panes.map((pane) => pane.scene.meta.n_hexes)), [old.hexes.length, mesh.hexes.length]);
  // One block and one volume can't be moved apart, and are not moved at all.
  await page.click('[data-toggle="before"]');
  const place = () => page.evaluate(() => Array.from(hextwist.pane.faces.geometry.getAttribute('position').array.slice(0, 30))), there = await place();
  await page.$eval('#explode', (e) => { e.value = 0.5; e.dispatchEvent(new Event('input')); });
  await page.waitForFunction(() => /nothing to move apart/.test(document.getElementById('status').value));
  assert.deepEqual(await place(), there);
  assert.deepEqual(page.problems, []);
  await page.close();
  // A mesh from a file without its history: it is said.
  const file = join(output, 'put_in.msh');
  run(['-c', `${commands}; export mesh '${file}' overwrite`]);
  run(['view', file, '-o', join(output, 'put_in.html')]);
  const bare = await open(browser, `file://${join(output, 'put_in.html')}`);
  await bare.click('[data-do="refined-planes"]');
  await bare.waitForFunction(() => /how this mesh was refined is not in this page/.test(document.getElementById('status').value));
  assert.equal(await bare.isHidden('[data-toggle="before"]'), true);
  await bare.close();
});

test('controls have names and roles, and nothing sticks out', async () => {
  const page = await open(browser, drawn('names', 'bracket', '', 'quality shape'));
  const unnamed = await page.evaluate(() => {
    const nameOf = (e) => e.getAttribute('aria-label') || e.textContent.trim() || e.title || [...(e.labels ?? [])].map((l) => l.textContent.trim()).join('');
    return [...document.querySelectorAll('button, input, select, [role], canvas:not([aria-hidden])')].filter((e) => !nameOf(e)).map((e) => e.outerHTML.slice(0, 100));
  });
  assert.deepEqual(unnamed.filter((e) => !e.includes('id="busy"')), []);
  const tree = await (await page.context().newCDPSession(page)).send('Accessibility.getFullAXTree');
  const roles = tree.nodes.filter((n) => !n.ignored).map((n) => `${n.role?.value}: ${n.name?.value}`);
  for (const wanted of ['button: Fit', 'button: From plus x', 'combobox: By', 'slider: At', 'searchbox: Search by name, id or type', 'listbox: List of entities', 'radio: curve', 'checkbox: flip', 'group: Look from'])
    assert.ok(roles.some((r) => r.startsWith(wanted)), wanted);
  for (const size of [[1280, 720], [1024, 640]]) {
    await page.setViewportSize({ width: size[0], height: size[1] });
    const wide = await page.evaluate(() => [...document.querySelectorAll('header button, #left *, #right button, #right input, #right select')].filter((e) => e.offsetParent && !e.closest('#list')).map((e) => [e, e.getBoundingClientRect()]).filter(([e, b]) => b.right > innerWidth + 1 || b.left < -1).map(([e]) => e.outerHTML.slice(0, 80)));
    assert.deepEqual(wide, [], size.join(' x '));
  }
  writeFileSync(join(output, 'roles.txt'), roles.join('\n'));
  // Text is read well on what is behind it, light and dark: 4.5 to 1, as WCAG has it. Nothing is cut off.
  await page.setViewportSize({ width: 1366, height: 768 });
  await page.selectOption('#list-kind', 'curve');
  await page.click('#list .item');
  await page.click('[data-do="worst-next"]');
  await page.waitForFunction(() => document.getElementById('worst-now').value.startsWith('1: '));
  await page.selectOption('#list-kind', 'curve');
  await page.click('#list .item');
  for (const theme of ['light', 'dark']) {
    const poor = await page.evaluate(() => {
      const numbers = (text) => text.match(/[\d.]+/g).map(Number), part = (v) => { const s = v / 255; return s <= 0.03928 ? s / 12.92 : ((s + 0.055) / 1.055) ** 2.4; };
      const light = ([r, g, b]) => 0.2126 * part(r) + 0.7152 * part(g) + 0.0722 * part(b), poor = [];
      for (const e of document.querySelectorAll('body *')) {
        const hasText = [...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim()) || (e.matches('input, output') && e.value);
        if (!hasText || e.disabled || !e.checkVisibility() || e.closest('#stage, option, script, style, dialog')) continue;
        let behind = e;
        while (behind && numbers(getComputedStyle(behind).backgroundColor)[3] === 0) behind = behind.parentElement;
        const [a, b] = [light(numbers(getComputedStyle(e).color)), light(numbers(getComputedStyle(behind).backgroundColor))], ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
        if (ratio < 4.5) poor.push(`${ratio.toFixed(2)}: ${e.outerHTML.slice(0, 80)}`);
        if (e.matches('button, span, output, h1') && e.scrollWidth > e.clientWidth + 1 && e.clientWidth > 0) poor.push(`cut off: ${e.outerHTML.slice(0, 80)}`);
      }
      return poor;
    });
    assert.deepEqual(poor, [], theme);
    await page.click('[data-do="theme"]');
    await settled(page);
  }
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('names in a mesh are text and nothing else', async () => {
  const page = await open(browser, drawn('hostile', null, `create brick x 2 interval 2; block 7 hex 1 name '</script><img src=x onerror=alert(1)>&"'; block 8 hex 2`));
  await page.selectOption('#list-kind', 'block');
  assert.ok((await page.textContent('#list')).includes('</script><img src=x onerror=alert(1)>&"'));
  assert.equal(await page.$('img'), null);
  assert.deepEqual(page.problems, []);
  await page.close();
});
