// hextwist serve in a real browser, and what it refuses.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { existsSync, mkdirSync, readdirSync, rmSync, statSync, symlinkSync, writeFileSync } from 'node:fs';
import { request } from 'node:http';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { browser as launch, model, open, output, program, source } from './support.mjs';

const folder = join(output, 'served');
let browser, server, address;

/** Starts the server; resolves with the address that it prints. */
function serve(args) {
  const child = spawn(program, ['serve', ...args], { cwd: folder, stdio: ['ignore', 'pipe', 'pipe'] });
  return new Promise((resolve, reject) => {
    let said = '';
    child.stdout.on('data', (data) => {
      said += data;
      const found = said.match(/http:\/\/\S+/);
      if (found) resolve({ child, address: found[0] });
    });
    child.on('exit', (status) => reject(new Error(`ended with ${status}: ${said}`)));
  });
}
const ended = (child) => new Promise((resolve) => child.on('exit', (status) => resolve(status)));

before(async () => {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  browser = await launch();
  ({ child: server, address } = await serve(model('bracket')));
});
after(async () => {
  await browser.close();
  const end = ended(server);
  server.kill('SIGINT');
  assert.equal(await end, 0);
});

const hexes = (page) => page.evaluate(() => hextwist.scene.meta.n_hexes);
const idle = (page) => page.waitForFunction(() => !hextwist.live.running && !hextwist.live.busy);
async function command(page, text) {
  const before = await page.evaluate(() => hextwist.live.next);
  await page.fill('#prompt', text);
  await page.press('#prompt', 'Enter');
  await page.waitForFunction((n) => hextwist.live.next > n && !hextwist.live.running && hextwist.live.isShown, before);
}
const log = (page) => page.textContent('#log');

test('commands change the mesh in the page; undo and redo too', async () => {
  const page = await open(browser, address);
  assert.equal(await hexes(page), 488);
  const whole = await page.evaluate(() => hextwist.live.received);
  await command(page, 'refine vertex 9');
  const fine = await hexes(page);
  assert.ok(fine > 488);
  const changed = (await page.evaluate(() => hextwist.live.received)) - whole;
  assert.ok(changed < whole / 2, `${changed} of ${whole} bytes were sent for a small change`);
  assert.match(await log(page), /> refine vertex 9\nrefine vertex 9: 488 -> \d+ hexes/);
  assert.match(await page.textContent('#report'), /488 → /);
  // What the differences add up to is the mesh as a whole.
  const same = await page.evaluate(async () => {
    const live = hextwist.live, scene = hextwist.scene;
    live.blocks.delete('skin');
    const fresh = await live.load('skin');
    return Object.keys(fresh).every((key) => fresh[key].length === scene.skin[key].length && fresh[key].every((v, i) => Object.is(v, scene.skin[key][i])));
  });
  assert.ok(same);
  await page.click('#undo');
  await page.waitForFunction(() => hextwist.scene.meta.n_hexes === 488);
  await page.click('#redo');
  await page.waitForFunction(() => hextwist.scene.meta.n_hexes > 488);
  // The mesh before the last change, with all that gives colours.
  await page.click('[data-toggle="before"]');
  await page.waitForFunction(() => hextwist.panes.length === 2);
  await page.selectOption('#colour', 'shape');
  await page.waitForFunction(() => hextwist.colouring.valuesOf.size === 2);
  assert.deepEqual(await page.evaluate(() => hextwist.panes.map((pane) => hextwist.colouring.valuesOf.get(pane)?.length === pane.scene.meta.n_hexes)), [true, true]);
  assert.equal(await page.evaluate(() => hextwist.panes[0].scene.meta.n_hexes), 488);
  await page.screenshot({ path: join(output, 'live.png') });
  await command(page, 'refine vertex 1');
  assert.deepEqual(await page.evaluate(() => hextwist.panes.map((pane) => pane.scene.meta.n_hexes)), [fine, await hexes(page)]);
  await page.selectOption('#colour', 'changed');
  await page.waitForFunction(() => hextwist.colouring.key === 'changed' && hextwist.colouring.values?.every((v) => v === 0 || v === 1));
  assert.equal(await page.evaluate(() => hextwist.colouring.values.reduce((sum, v) => sum + (v === 0 ? 1 : 0), 0)), fine - 1, 'one hex was cut');
  for (let i = 0; i < 2; ++i) await command(page, 'undo');
  assert.equal(await page.isHidden('[data-toggle="before"]'), true, 'nothing is before the mesh of the file');
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('what is picked can be run; a wrong word is pointed at and changes nothing', async () => {
  const page = await open(browser, address);
  await page.selectOption('#list-kind', 'curve');
  await page.click('#list .item:has-text("curve 5")');
  await page.click('#run-command');
  await page.waitForFunction(() => hextwist.scene.meta.n_hexes > 488);
  assert.equal(await page.$eval('#range', (e) => e.value), 'curve 5');
  const before = await hexes(page);
  await command(page, 'refine crve 3');
  assert.match(await log(page), /expected node, edge.*found 'crve' \(did you mean 'curve'\?\)/);
  assert.equal(await hexes(page), before);
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('the prompt completes words and ids, and remembers', async () => {
  const page = await open(browser, address);
  await page.fill('#prompt', 'refine surf');
  await page.press('#prompt', 'Tab');
  await page.waitForFunction(() => document.getElementById('prompt').value.startsWith('refine surface'));
  await page.fill('#prompt', 'refine curve 3 to ');
  await page.press('#prompt', 'Tab');
  await page.waitForFunction(() => document.getElementById('prompt').value.trim() === 'refine curve 3 to 27' || !document.getElementById('offers').hidden);
  assert.match((await page.$eval('#prompt', (e) => e.value)) + (await page.textContent('#offers')), /27/);
  await page.press('#prompt', 'Escape');
  await command(page, 'list curve 3');
  await command(page, 'list curve 4');
  await page.press('#prompt', 'ArrowUp');
  await page.press('#prompt', 'ArrowUp');
  assert.equal(await page.$eval('#prompt', (e) => e.value), 'list curve 3');
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('a long command shows its progress and is cancelled', async () => {
  const page = await open(browser, address);
  await command(page, 'create brick x 10 interval 30');
  await page.fill('#prompt', 'refine hex 1 to 20000 smooth');
  await page.press('#prompt', 'Enter');
  await page.waitForFunction(() => hextwist.live.running && document.getElementById('stage-now').textContent !== '');
  assert.equal(await page.isDisabled('#undo'), true);
  await page.click('#cancel');
  await page.waitForFunction(() => !hextwist.live.running);
  assert.match(await log(page), /cancelled/);
  assert.equal(await hexes(page), 27000);
  await command(page, 'refine hex 5');
  assert.ok((await hexes(page)) > 27000, 'the session goes on');
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('files are written below the folder and can be saved', async () => {
  const page = await open(browser, address);
  await page.selectOption('#format', '.vtu');
  await page.fill('#prompt', 'list cur');
  await page.focus('#export');
  await page.keyboard.press('Enter');
  await page.waitForSelector('#log button:has-text("save bracket_out.vtu")');
  assert.ok(statSync(join(folder, 'bracket_out.vtu')).size > 1000);
  assert.equal(await page.$eval('#prompt', (e) => e.value), 'list cur', 'what is being typed stays');
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('#log button')]);
  assert.equal(download.suggestedFilename(), 'bracket_out.vtu');
  assert.equal(statSync(await download.path()).size, statSync(join(folder, 'bracket_out.vtu')).size);
  // Not outside of it, by whatever way.
  writeFileSync(join(output, 'outside.jou'), 'refine hex 1\n');
  symlinkSync(output, join(folder, 'link'));
  symlinkSync(join(output, 'outside.jou'), join(folder, 'linked.jou'));
  symlinkSync(join(output, 'outside_new.vtu'), join(folder, 'dangling.vtu'));
  const before = readdirSync(output).sort();
  for (const outside of ["export mesh '../outside.vtu'", "export mesh '/tmp/outside.vtu'", "import mesh '/etc/passwd'", 'set safe off', "export mesh 'link/outside.vtu'", "export mesh 'dangling.vtu' overwrite",
    "export openfoam 'link/outside.foam'", "draw to 'link/outside.png'", "draw to '../outside.html'", "playback 'linked.jou'", "playback '../outside.jou'", "record 'link/outside.jou'", "import mesh 'link/before.msh'", "import mesh '/proc/self/environ'",
    "import step 'link/a.step'", "{include('../outside.jou')}"]) {
    const seen = (await log(page)).length;
    await command(page, outside);
    assert.match((await log(page)).slice(seen), /the session is safe|expected|only files below|not a command/, outside);
  }
  assert.deepEqual(readdirSync(output).sort(), before);
  assert.equal(await hexes(page), 488);
  for (const name of ['link/before.msh', 'linked.jou', '../outside.jou', 'bracket_out.vtu/../../outside.jou'])
    assert.equal((await ask(`/file?id=${await page.evaluate(() => hextwist.live.id)}&name=${encodeURIComponent(name)}`)).status, 404, name);
  await page.close();
});

test('a reload finds the session of the tab, another tab has its own', async () => {
  const page = await open(browser, address);
  await command(page, 'refine vertex 1');
  const before = await hexes(page);
  await page.reload();
  await page.waitForFunction(() => window.hextwist?.ready);
  assert.equal(await hexes(page), before);
  assert.match(await log(page), /> refine vertex 1/);
  const other = await open(browser, address);
  assert.equal(await hexes(other), 488);
  await other.close();
  // A copy of a tab has what the tab remembers, and still a session of its own.
  const [copy] = await Promise.all([page.waitForEvent('popup'), page.evaluate(() => { window.open(location.href); })]);
  await copy.waitForFunction(() => window.hextwist?.ready);
  assert.equal(await hexes(copy), 488);
  assert.notEqual(await copy.evaluate(() => hextwist.live.id), await page.evaluate(() => hextwist.live.id));
  await command(copy, 'refine vertex 2');
  assert.equal(await hexes(page), before);
  await copy.reload();
  await copy.waitForFunction(() => window.hextwist?.ready);
  assert.match(await log(copy), /> refine vertex 2/);
  await copy.close();
  await page.reload();
  await page.waitForFunction(() => window.hextwist?.ready);
  assert.equal(await hexes(page), before);
  await page.close();
});

test('a lost connection is said, and the session goes on when it is back', async () => {
  const page = await open(browser, address);
  await page.context().setOffline(true);
  await page.waitForFunction(() => !document.getElementById('connection').hidden);
  assert.match(await page.textContent('#connection'), /connection lost/);
  await page.context().setOffline(false);
  await page.waitForFunction(() => document.getElementById('connection').hidden);
  await command(page, 'refine vertex 2');
  assert.ok((await hexes(page)) > 488);
  await page.close();
});

/** A request as no browser would send it: { status, body }. */
function ask(path, { method = 'GET', headers = {}, body } = {}, at = address) {
  const { hostname, port, searchParams } = new URL(at), token = searchParams.get('token');
  return new Promise((resolve, reject) => {
    const sent = request({ hostname, port, path, method, headers: { 'X-Hextwist-Token': token, ...headers } }, (response) => {
      let text = '';
      response.on('data', (data) => { text += data; });
      response.on('end', () => resolve({ status: response.statusCode, body: text, headers: response.headers }));
    });
    sent.on('error', reject);
    sent.end(body);
  });
}

test('what does not come from the page is refused', async () => {
  const other = await serve(model('bracket')), address = other.address;
  const { status: fine, body } = await ask('/session', { method: 'POST', body: '{}' }, address);
  assert.equal(fine, 200);
  const { id } = JSON.parse(body), port = new URL(address).port;
  const cases = [
    [403, '/', { headers: { 'X-Hextwist-Token': 'wrong' } }, /token is wrong/],
    [403, '/?token=wrong', { headers: { 'X-Hextwist-Token': '' } }, /token is wrong/],
    [403, `/events?id=${id}&token=${new URL(address).searchParams.get('token')}`, { headers: { 'X-Hextwist-Token': '' } }, /token is wrong/],
    [403, `/events?id=${id}`, { headers: { Origin: 'http://evil.example' } }, /from the page itself/],
    [403, '/session', { method: 'POST', body: '{}', headers: { Origin: 'null' } }, /from the page itself/],
    [403, `/events?id=${id}`, { headers: { 'Sec-Fetch-Site': 'cross-site' } }, /from the page itself/],
    [403, '/', { headers: { Host: `evil.example:${port}` } }, /not the address/],
    [404, '/etc/passwd', {}, /nothing at this address/],
    [404, '/../../etc/passwd', {}, /nothing at this address/],
    [404, `/file?id=${id}&name=/etc/passwd`, {}, /no such file/],
    [404, `/file?id=${id}&name=..%2Fpage_test.html`, {}, /no such file/],
    [404, '/events?id=nobody&since=0', {}, /no such session/],
    [404, `/block?id=${id}&name=c999&have=0`, {}, /no such part|running/],
    [404, `/block?id=${id}&name=..%2F..&have=-1`, {}, /no such part|running/],
    [400, '/run', { method: 'POST', body: 'no JSON' }, /not a JSON object/],
    [400, '/run', { method: 'POST', body: '[1, 2]' }, /not a JSON object/],
    [400, '/run', { method: 'POST', body: JSON.stringify({ id: 7, text: 'list' }) }, /id of a session/],
    [400, '/run', { method: 'POST', body: JSON.stringify({ id, text: 7 }) }, /no text/],
    [400, '/run', { method: 'POST', body: JSON.stringify({ id, text: '  ' }) }, /no text/],
    [400, '/run', { method: 'POST', body: Buffer.from([0x7b, 0x22, 0xff, 0xfe, 0x22]) }, /not a JSON object/],
    [413, '/run', { method: 'POST', body: JSON.stringify({ id, text: 'x'.repeat(150000) }) }, /at most 100000 characters/],
    [413, '/run', { method: 'POST', body: 'x'.repeat(400000) }, /larger than/],
    [411, '/run', { method: 'POST', body: '{}', headers: { 'Transfer-Encoding': 'chunked' } }, /length of a request/],
    [400, '/complete', { method: 'POST', body: JSON.stringify({ id, line: 'x'.repeat(9000) }) }, /no line/],
  ];
  await new Promise((resolve) => setTimeout(resolve, 1500));  // until its files are read
  for (const [status, path, options, text] of cases) {
    const answer = await ask(path, options, address).catch((error) => ({ status: 413, body: `larger than: ${error.code}` }));  // hung up on
    assert.equal(answer.status, status, `${path} ${JSON.stringify(options).slice(0, 120)}: ${answer.body.slice(0, 200)}`);
    assert.match(answer.body, text, path);
  }
  const { headers } = await ask('/', { headers: {} }, address);
  assert.match(headers['content-security-policy'], /default-src 'none'.*connect-src 'self'.*frame-ancestors 'none'/);
  assert.equal(headers['access-control-allow-origin'], undefined);
  // The page of another origin gets nothing, in a real browser too.
  const page = await browser.newPage();
  await page.goto('data:text/html,<title>foreign</title>');
  const foreign = await page.evaluate((to) => fetch(to).then((r) => r.status, (e) => String(e)), address);
  assert.match(String(foreign), /Failed to fetch|403/);
  await page.close();
  const wrong = await browser.newPage();
  const response = await wrong.goto(address.replace(/token=./, 'token=x'));
  assert.equal(response.status(), 403);
  await wrong.close();
  // None of that has ended it or its session.
  assert.equal((await ask(`/events?id=${id}&since=0`, {}, address)).status, 200);
  // No more sessions than eight, while those that there are have been seen of late.
  let last;
  for (let i = 0; i < 8; ++i) last = await ask('/session', { method: 'POST', body: '{}' }, address);
  assert.equal(last.status, 429);
  assert.match(last.body, /there are 8 sessions already/);
  const end = ended(other.child);
  other.child.kill('SIGINT');
  assert.equal(await end, 0);
});

test('more tabs than a browser has connections do not wait for each other', async () => {
  const other = await serve([]), context = await browser.newContext({ viewport: { width: 640, height: 480 } }), tabs = [];
  // All but the last are behind it.
  await context.addInitScript(() => { Object.defineProperty(document, 'hidden', { get: () => !window.isInFront }); });
  for (let i = 0; i < 7; ++i) {
    const tab = await context.newPage();
    // A connection is held by who asks to wait for news.
    tab.waits = [];
    tab.on('request', (r) => { const wait = new URL(r.url()).searchParams.get('wait'); if (wait !== null) tab.waits.push(Number(wait)); });
    await tab.goto(other.address);
    await tab.waitForFunction(() => window.hextwist?.ready);
    tabs.push(tab);
  }
  const front = tabs.at(-1), toFront = (tab, isIt) => tab.evaluate((isIt) => { window.isInFront = isIt; document.dispatchEvent(new Event('visibilitychange')); }, isIt);
  for (const tab of tabs) assert.ok(tab.waits.length > 0 && tab.waits.every((wait) => wait === 0), `a tab that nobody looks at waits: ${tab.waits}`);
  const asked = front.waitForRequest((r) => r.url().includes('&wait='));
  await toFront(front, true);
  assert.match((await asked).url(), /&wait=[1-9]/, 'one that is looked at hears of news at once');
  await command(front, 'create brick x 1 interval 2');
  assert.equal(await hexes(front), 8);
  for (const tab of tabs.slice(0, -1)) assert.ok(tab.waits.every((wait) => wait === 0), `${tab.waits}`);
  // One that comes to the front instead hears of its own.
  await toFront(front, false);
  await toFront(tabs[0], true);
  await command(tabs[0], 'create brick x 1 interval 3');
  assert.equal(await hexes(tabs[0]), 27);
  assert.equal(await hexes(front), 8);
  await context.close();
  const end = ended(other.child);
  other.child.kill('SIGINT');
  assert.equal(await end, 0);
});

test('a closed tab makes room; one too many says so and waits', async () => {
  const other = await serve([]), context = await browser.newContext({ viewport: { width: 640, height: 480 } }), ids = [];
  for (let i = 0; i < 6; ++i) ids.push(JSON.parse((await ask('/session', { method: 'POST', body: '{}' }, other.address)).body).id);
  // They are looked at, however long all of this takes.
  const looks = setInterval(() => ids.forEach((id) => ask(`/events?id=${id}&since=0&wait=0`, {}, other.address).catch(() => {})), 2000);
  const tab = async () => { const page = await context.newPage(); await page.goto(other.address); return page; }, isReady = (page) => page.waitForFunction(() => window.hextwist?.ready);
  const first = await tab(), second = await tab();
  for (const page of [first, second]) await isReady(page);
  await second.close();
  const third = await tab();
  await isReady(third);
  const late = await tab();
  await late.waitForFunction(() => !document.getElementById('connection').hidden);
  assert.match(await late.textContent('#connection'), /8 sessions already: close a tab/);
  await third.close();
  await isReady(late);
  await command(late, 'create brick x 1 interval 2');
  assert.equal(await hexes(late), 8);
  await context.close();
  clearInterval(looks);
  const end = ended(other.child);
  other.child.kill('SIGINT');
  assert.equal(await end, 0);
});

test('it ends while a command runs, and leaves no half of a file', async () => {
  const other = await serve([]), page = await open(browser, other.address), files = readdirSync(folder).sort();
  await command(page, 'create brick x 10 interval 30');
  await page.fill('#prompt', "refine hex 1 to 20000 smooth; export mesh 'half.vtu'");
  await page.press('#prompt', 'Enter');
  await page.waitForFunction(() => hextwist.live.running && document.getElementById('stage-now').textContent !== '');
  const end = ended(other.child);
  other.child.kill('SIGTERM');
  assert.equal(await end, 0);
  assert.deepEqual(readdirSync(folder).sort(), files, 'what was to be run next was not');
  await page.waitForFunction(() => !document.getElementById('connection').hidden);
  await page.close();
});

test('the session is used by keys alone', async () => {
  const page = await open(browser, address), press = (key) => page.keyboard.press(key), focus = () => page.evaluate(() => document.activeElement.id);
  await page.focus('#view');
  await press(':');
  assert.equal(await focus(), 'prompt');
  // Words that are offered are chosen by arrows; an empty prompt holds nobody.
  await page.keyboard.type('refine ve');
  await press('Tab');
  await page.waitForFunction(() => document.getElementById('prompt').value.startsWith('refine vertex'));
  await page.fill('#prompt', 'refine s');
  await press('Tab');
  await page.waitForFunction(() => !document.getElementById('offers').hidden);
  await press('ArrowDown');
  await press('Enter');
  assert.match(await page.$eval('#prompt', (e) => e.value), /^refine (surface|sheet) $/);
  await press('Escape');
  assert.equal(await focus(), 'view');
  await press(':');
  await page.fill('#prompt', 'refine vertex 1');
  await press('Enter');
  await page.waitForFunction(() => hextwist.scene.meta.n_hexes > 488);
  await page.waitForFunction(() => !document.getElementById('undo').disabled && document.getElementById('prompt').value === '');
  const reached = [];
  for (let i = 0; i < 4; ++i) { await press('Tab'); reached.push(await focus()); }
  assert.deepEqual(reached, ['undo', 'redo', 'export', 'format']);
  for (let i = 0; i < 4; ++i) await press('Shift+Tab');
  assert.equal(await focus(), 'prompt');
  await press('Shift+Tab');
  assert.notEqual(await focus(), 'prompt');
  await press(':');
  await press('Tab');
  await press('Space');
  await page.waitForFunction(() => hextwist.scene.meta.n_hexes === 488);
  assert.deepEqual(page.problems, []);
  await page.close();
});

test('CAD without a mesh is shown until there is one', async () => {
  const other = await serve(['--cad', join(source, 'models', 'bracket.brep')]);
  const page = await open(browser, other.address);
  assert.equal(await page.textContent('#counts'), '11 surfaces, no mesh');
  await page.selectOption('#list-kind', 'surface');
  await page.click('#list .item:has-text("surface 7")');
  assert.equal(await page.$eval('#range', (e) => e.value), 'surface 7');
  await page.screenshot({ path: join(output, 'live_cad.png') });
  await command(page, 'create brick x 3 interval 3');
  assert.equal(await hexes(page), 27);
  assert.equal(await page.textContent('#counts'), '27 hexes, 64 nodes');
  assert.deepEqual(page.problems, []);
  await page.close();
  const end = ended(other.child);
  other.child.kill('SIGTERM');
  assert.equal(await end, 0);
});

test('a command may take so long and no longer; an address that is taken is an error', async () => {
  const other = await serve(['--time-limit', '0.5']);
  const page = await open(browser, other.address);
  assert.deepEqual(page.problems, [], 'without a mesh too');
  await command(page, 'create brick x 10 interval 30; refine hex 1 to 20000 smooth');
  assert.match(await log(page), /cancelled: it took more than 0.5 s/);
  assert.equal(await hexes(page), 27000);
  await page.close();
  await assert.rejects(serve(['--port', new URL(other.address).port]), /ended with 1/);
  const end = ended(other.child);
  other.child.kill('SIGTERM');
  assert.equal(await end, 0);
});
