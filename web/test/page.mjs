// Drives the page as a person does, in headless Chromium:
// node page.mjs FOLDER [--command SUPERDEFORM] [--models FOLDER] [--shots FOLDER] [--quick]
//
// FOLDER holds the built page. Ends with `N passed, N failed`; exit code 77 where there is no Chromium.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import http from 'node:http';
import os from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';
import { beside, licensed, withShapes } from './made.mjs';

const here = path.dirname(fileURLToPath(import.meta.url));
const [folder, ...flags] = process.argv.slice(2);
const flag = (name) => (flags.includes(name) ? (flags[flags.indexOf(name) + 1] ?? true) : null);
const [command, shots, models, quick] = [flag('--command'), flag('--shots'), flag('--models'), flags.includes('--quick')];
const DATA = path.join(here, '../../tests/data');
const DRESS = path.join(DATA, 'quaternius_female_dress.glb');
const ROGUE = path.join(DATA, 'kaykit_rogue.glb');
const UNRIGGED = path.join(DATA, 'quaternius_female_dress_unrigged.glb');
/** How long anything may take: a loaded machine draws without a graphics card. */
const PATIENCE = 240e3;

const executable = process.env.CHROMIUM ?? ['chromium', 'chromium-browser', 'google-chrome'].map((name) => `/usr/bin/${name}`).find((at) => fs.existsSync(at));
if (!executable) {
  console.log('there is no Chromium: CHROMIUM names one');
  process.exit(77);
}
const scratch = fs.mkdtempSync(path.join(os.tmpdir(), 'superdeform-page-'));
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm' };
const server = http.createServer((request, answer) => {
  const name = request.url === '/' ? 'index.html' : request.url.slice(1);
  const at = path.join(folder, path.basename(name));
  if (!fs.existsSync(at)) return answer.writeHead(404).end();
  answer.writeHead(200, { 'content-type': TYPES[path.extname(at)] ?? 'application/octet-stream' });
  answer.end(fs.readFileSync(at));
});
await new Promise((done) => server.listen(0, '127.0.0.1', done));
const address = `http://127.0.0.1:${server.address().port}/`;

let [passed, failed] = [0, 0];
async function check(name, work) {
  const start = performance.now();
  try {
    const said = await work();
    passed++;
    console.log(`ok   ${name}${said ? `: ${said}` : ''} (${((performance.now() - start) / 1000).toFixed(1)} s)`);
  } catch (error) {
    failed++;
    console.log(`FAIL ${name}: ${error.message}`);
  }
}
function that(holds, what) {
  if (!holds) throw new Error(what);
}

const browser = await chromium.launchPersistentContext(path.join(scratch, 'profile'), {
  executablePath: executable, headless: true, viewport: { width: 1280, height: 800 }, acceptDownloads: true, locale: 'en-GB',
  args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', '--disable-dev-shm-usage', '--disable-background-networking', '--disable-component-update'],
});
browser.setDefaultTimeout(PATIENCE);
const complaints = [];
const requests = [];
async function opened(url, size) {
  const page = await browser.newPage();
  if (size) await page.setViewportSize(size);
  // Choosers are caught from the start: to begin with it takes longer than a key.
  page.on('filechooser', () => {});
  page.on('console', (message) => message.type() === 'error' && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(error.message));
  page.on('request', (request) => requests.push(request.url()));
  await page.goto(url);
  await page.waitForSelector('body[data-ready=yes]');
  return page;
}
const heads = (page) => page.textContent('#heads-after');
/** Waits until nothing is being made. */
async function rested(page) {
  await page.waitForFunction(() => document.getElementById('view').ariaBusy !== 'true' && document.getElementById('busy').hidden);
  await page.waitForFunction(() => !document.getElementById('download').disabled && document.getElementById('heads-after').textContent);
}
const choose = (page, files) => page.setInputFiles('#file', files);
/** Lets files fall on the page: { name, buffer }. */
async function drop(page, files) {
  const given = files.map(({ name, buffer }) => ({ name, text: buffer.toString('base64') }));
  await page.evaluate((all) => {
    const transfer = new DataTransfer();
    for (const { name, text } of all) transfer.items.add(new File([Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0))], name));
    for (const kind of ['dragenter', 'dragover', 'drop']) {
      document.getElementById('view').dispatchEvent(new DragEvent(kind, { dataTransfer: transfer, bubbles: true, cancelable: true }));
    }
  }, given);
}
async function named(page, name) {
  await page.waitForFunction((is) => document.getElementById('file-name').textContent === is, name);
  await rested(page);
}
async function slide(page, name, value) {
  await page.evaluate(([id, to]) => {
    const input = document.getElementById(id);
    input.value = to;
    input.dispatchEvent(new Event('input'));
    input.dispatchEvent(new Event('change'));
  }, [`slider-${name}`, value]);
}
/** Shows what a slider shows while it moves, and what comes out: of how many numbers of the picture differ from what was there
 * before, and from each other. */
async function moving(page, name, value) {
  // Springs come to rest.
  const seen = async () => (await page.waitForTimeout(2500), half(await pixels(page), 48));
  const still = await seen();
  await page.evaluate(([id, to]) => {
    document.getElementById(id).value = to;
    document.getElementById(id).dispatchEvent(new Event('input'));
  }, [`slider-${name}`, value]);
  await page.waitForFunction(() => document.getElementById('view').ariaBusy !== 'true');
  const glimpse = await seen();
  await slide(page, name, value);
  await rested(page);
  return [differs(still, glimpse), differs(glimpse, await seen())];
}
async function downloaded(page, button) {
  const [download] = await Promise.all([page.waitForEvent('download'), page.click(button)]);
  const at = path.join(scratch, download.suggestedFilename());
  await download.saveAs(at);
  return at;
}
const shot = (page, name) => shots && page.screenshot({ path: path.join(shots, `${name}.png`) });
const pixels = (page) => page.evaluate(() => {
  const canvas = document.getElementById('canvas');
  const copy = Object.assign(document.createElement('canvas'), { width: 96, height: 64 });
  copy.getContext('2d').drawImage(canvas, 0, 0, 96, 64);
  return [...copy.getContext('2d').getImageData(0, 0, 96, 64).data];
});
/** Of what `pixels` gives, the half that begins at a column: 0 before, 48 after. */
const half = (all, from) => all.filter((_, i) => (i >> 2) % 96 >= from && (i >> 2) % 96 < from + 48);
const differs = (one, two) => one.reduce((sum, value, index) => sum + (Math.abs(value - two[index]) > 8), 0);

if (shots) fs.mkdirSync(shots, { recursive: true });
let page;
await check('the page starts', async () => {
  page = await opened(address);
  await shot(page, 'empty');
});
const loaded = requests.length;
await check('a file that is chosen becomes super-deformed', async () => {
  const start = performance.now();
  await choose(page, DRESS);
  await rested(page);
  const took = performance.now() - start;
  that(/^2\.[3-7] heads$/.test(await heads(page)), `it has ${await heads(page)}`);
  const seen = await pixels(page);
  that(differs(seen, seen.map((_, i) => seen[i % 4])) > 200, 'the picture is one colour');
  await shot(page, 'desktop');
  return `drop to shown ${(took / 1000).toFixed(1)} s, ${await heads(page)}`;
});
await check('what is downloaded is what the command line writes', async () => {
  await slide(page, 'heads', 2.5);
  await rested(page);
  const ours = fs.readFileSync(await downloaded(page, '#download'));
  that(ours.subarray(0, 4).toString() === 'glTF', 'it is no GLB');
  if (!command) return 'no command line to compare with';
  const theirs = path.join(scratch, 'theirs.glb');
  execFileSync(command, ['-q', DRESS, '--heads', '2.5', '-o', theirs]);
  that(ours.equals(fs.readFileSync(theirs)), 'the bytes differ');
  return `${ours.length} bytes, the same`;
});
if (!quick) {
  await check('sliders move the figure and are undone by keys', async () => {
    const before = await heads(page);
    const still = await pixels(page);
    await slide(page, 'heads', 4);
    await rested(page);
    that(/^(3\.[7-9]|4\.[0-3])/.test(await heads(page)), `4 heads came out as ${await heads(page)}`);
    that(differs(still, await pixels(page)) > 60, 'the picture stayed as it was');
    await page.keyboard.press('Control+z');
    await rested(page);
    that((await heads(page)) === before, `undone it has ${await heads(page)}`);
    await page.keyboard.press('Control+Shift+z');
    await rested(page);
    await page.keyboard.press('Control+z');
    await rested(page);
  });
  await check('a part of the body has its own sliders', async () => {
    const report = async () => JSON.parse(fs.readFileSync(await downloaded(page, '#report'), 'utf8')).coefficients.upper_arm;
    const shows = () => page.inputValue('#slider-upper_arm\\.length_scale').then(Number);
    const before = await report();
    that(Math.abs((await shows()) - before.length_scale) <= 0.005, `the slider shows ${await shows()} where the style makes ${before.length_scale}`);
    await slide(page, 'upper_arm.length_scale', 0.9);
    await slide(page, 'upper_arm.thickness_scale', 0.8);
    await rested(page);
    const after = await report();
    that(after.length_scale === 0.9 && after.thickness_scale === 0.8, `the upper arms have ${JSON.stringify(after)}`);
    await page.keyboard.press('Control+z');
    await page.keyboard.press('Control+z');
    await rested(page);
    that(JSON.stringify(await report()) === JSON.stringify(before), 'undone, they are not as before');
    that(Math.abs((await shows()) - before.length_scale) <= 0.005, `undone, the slider shows ${await shows()}`);
  });
  await check('a slider is followed while it moves', async () => {
    const frames = {};
    for (const [name, from, to] of [['amount', 0.3, 1], ['heads', 2.2, 3]]) {
      frames[name] = await page.evaluate(async ([id, low, high]) => {
        const times = [];
        const input = document.getElementById(id);
        const { ask } = globalThis.superdeform;
        for (let i = 0; i < 7; i++) {
          const value = low + ((high - low) * i) / 6;
          const start = performance.now();
          const style = id === 'slider-heads' ? { heads: value } : { heads: 2.5 };
          await ask({ do: 'set', style, options: { amount: id === 'slider-amount' ? value : 1, repair: 'kept' } });
          await ask({ do: 'glimpse' });
          times.push(performance.now() - start);
        }
        return times.sort((a, b) => a - b)[3];
      }, [`slider-${name}`, from, to]);
    }
    await slide(page, 'heads', 2.6);
    await rested(page);
    return `the worker needs ${frames.amount.toFixed(0)} ms for a frame of Amount, ${frames.heads.toFixed(0)} ms for one of Heads`;
  });
  await check('what is seen while a slider moves is what comes out', async () => {
    const said = [];
    for (const value of [0.4, 0]) {
      const [moved, apart] = await moving(page, 'amount', value);
      that(moved > 60 && apart < moved / 7, `${moved} numbers of the picture moved, ${apart} once more as it was let go`);
      said.push(`${moved} moved, ${apart} once more`);
    }
    await slide(page, 'amount', 1);
    await rested(page);
    return said.join('; ');
  });
  await check('poses move both', async () => {
    const still = await pixels(page);
    for (const pose of ['t', 'sit', 'walk']) {
      await page.click(`#poses [value=${pose}]`);
      await page.waitForTimeout(700);
      that(differs(still, await pixels(page)) > 60, `${pose} looks like before`);
      await shot(page, `pose-${pose}`);
    }
    await page.click('#poses [value=a]');
  });
  await check('a file and what lies beside it are dropped', async () => {
    const [json, binary] = beside(fs.readFileSync(ROGUE), 'parts/rogue.bin');
    await drop(page, [{ name: 'rogue.bin', buffer: binary }, { name: 'rogue.gltf', buffer: json }]);
    await named(page, 'rogue.gltf');
    that(path.basename(await downloaded(page, '#download')) === 'rogue_sd.glb', 'it is not saved as a GLB');
  });
  await check('eyes shut and the mouth opens, before and after', async () => {
    const names = ['eyes_closed', 'mouth_open'];
    await drop(page, [{ name: 'shapes.glb', buffer: withShapes(fs.readFileSync(ROGUE), 2, (index) => names[index], 0.4) }]);
    await named(page, 'shapes.glb');
    for (const name of ['blink', 'aa']) {
      const still = await pixels(page);
      await slide(page, name, 1);
      await page.waitForTimeout(500);
      const moved = await pixels(page);
      for (const [side, from] of [['before', 0], ['after', 48]]) {
        that(differs(half(still, from), half(moved, from)) > 20, `${name} moves nothing ${side}`);
      }
      await slide(page, name, 0);
    }
  });
  await check('opening is cancelled, and the last character stays', async () => {
    // So much that it takes longer than the moment after which the page says that it is busy.
    const large = withShapes(fs.readFileSync(UNRIGGED), 120, (index) => `shape ${index}`, 0.01);
    await choose(page, { name: 'large.glb', mimeType: 'model/gltf-binary', buffer: large });
    await page.waitForFunction(() => !document.getElementById('busy').hidden && !document.getElementById('cancel').click(), null, { polling: 20 });
    await rested(page);
    that((await page.textContent('#file-name')) === 'shapes.glb', 'the file is open all the same');
    that(await page.isHidden('#alert'), await page.textContent('#alert span'));
    await choose(page, DRESS);
    await named(page, path.basename(DRESS));
  });
  await check('what came without a rig gets one, and says so', async () => {
    await choose(page, UNRIGGED);
    await named(page, path.basename(UNRIGGED));
    const notes = await page.$$eval('#notes-list li', (list) => list.map((item) => item.firstChild.textContent));
    that(notes.some((note) => note.includes('without a usable rig')), notes.join('; '));
    that(new Set(notes).size === notes.length && !notes.some((note) => /\{\d\}/.test(note)), notes.join('; '));
    await choose(page, DRESS);
    await named(page, path.basename(DRESS));
  });
  const avatar = models && ['godette.vrm', 'catbot.vrm'].map((name) => path.join(models, name)).find((at) => fs.existsSync(at));
  if (avatar) await check('a VRM swings, blinks and stays a VRM', async () => {
    await choose(page, avatar);
    await page.waitForSelector('#licence[open], body:not(:has(#busy:not([hidden])))');
    await named(page, path.basename(avatar));
    that(await page.isVisible('#springs-row'), 'it has no springs');
    for (const name of ['blink', 'aa']) that(await page.isVisible(`#slider-${name}`), `it has no ${name}`);
    // Hair hangs on bones that springs turn.
    const [moved, apart] = await moving(page, 'amount', 0.3);
    that(moved > 60 && apart < moved / 7, `${moved} numbers of the picture moved, ${apart} once more as it was let go`);
    await slide(page, 'amount', 1);
    await rested(page);
    await page.selectOption('#language', 'ja');
    that((await page.textContent('label[for=slider-blink]')) !== 'Blink', 'Blink is English in Japanese');
    await page.selectOption('#language', 'en');
    await page.uncheck('#springs');
    await page.check('#springs');
    await shot(page, 'vrm');
    const ours = await downloaded(page, '#download');
    that(ours.endsWith('_sd.vrm'), ours);
    await choose(page, DRESS);
    await named(page, path.basename(DRESS));
  });
  await check('a style is taken from a model', async () => {
    await page.setInputFiles('#reference-file', ROGUE);
    await page.waitForFunction(() => document.getElementById('like').getAttribute('aria-pressed') === 'true');
    await rested(page);
    that((await page.textContent('#like')).includes('kaykit_rogue.glb'), 'the button does not say whose');
  });
  await check('bad files get a sentence, and the page goes on', async () => {
    const good = fs.readFileSync(DRESS);
    const large = path.join(scratch, 'large.glb');
    fs.closeSync(fs.openSync(large, 'w'));
    fs.truncateSync(large, 600e6);
    const draco = Buffer.from('{"asset":{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression"],"extensionsUsed":["KHR_draco_mesh_compression"],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}}}]}]}');
    const bad = [
      { name: 'notes.txt', mimeType: 'text/plain', buffer: Buffer.from('hello') },
      { name: 'text.vrm', mimeType: '', buffer: Buffer.from('hello') },
      { name: 'cut.glb', mimeType: '', buffer: good.subarray(0, 5000) },
      { name: 'draco.gltf', mimeType: '', buffer: draco },
      large,
    ];
    const said = [];
    for (const file of bad) {
      await choose(page, file);
      await page.waitForSelector('#alert:not([hidden])');
      const sentence = await page.textContent('#alert span');
      that(sentence.includes(path.basename(file.name ?? file)), `${file.name ?? file}: ${sentence}`);
      said.push(sentence);
      await shot(page, 'bad');
      await page.click('#alert-close');
    }
    await slide(page, 'youth', 0.4);
    await rested(page);
    that((await page.textContent('#file-name')) === 'quaternius_female_dress.glb', 'the good file is gone');
    return `\n       ${said.join('\n       ')}`;
  });
  await check('a fault of the library costs its instance alone', async () => {
    const fault = await page.evaluate(() => globalThis.superdeform.ask({ do: 'fault' }).catch((error) => `${error.name}: ${error.message}`));
    that(/^Fault: .*a fault was asked for/s.test(fault), fault);
    await slide(page, 'youth', 0.6);
    await page.waitForSelector('#alert:not([hidden])');
    await page.click('#alert-close');
    await slide(page, 'youth', 0.7);
    await rested(page);
  });
  await check('a licence that forbids changes is asked about', async () => {
    const buffer = licensed(fs.readFileSync(ROGUE), 'CC-BY-ND-4.0 (http://creativecommons.org/licenses/by-nd/4.0/)');
    await choose(page, { name: 'forbidden.glb', mimeType: '', buffer });
    await page.waitForSelector('#licence[open]');
    await shot(page, 'licence');
    that(await page.isDisabled('#licence-go'), 'one may go on without saying anything');
    await page.keyboard.press('Escape');
    await rested(page);
    that((await page.textContent('#file-name')) === 'quaternius_female_dress.glb', 'refused, the old file is gone');
    await choose(page, { name: 'forbidden.glb', mimeType: '', buffer });
    await page.waitForSelector('#licence[open]');
    await page.check('#licence-mine');
    await page.click('#licence-go');
    await page.waitForFunction(() => document.getElementById('file-name').textContent === 'forbidden.glb');
    await rested(page);
  });
  await check('everything works by keys', async () => {
    await page.focus('#another');
    const [chooser] = await Promise.all([page.waitForEvent('filechooser'), page.keyboard.press('Enter')]);
    await chooser.setFiles(DRESS);
    await page.waitForFunction(() => document.getElementById('file-name').textContent === 'quaternius_female_dress.glb');
    await rested(page);
    await page.focus('#slider-head_scale');
    const before = await page.inputValue('#slider-head_scale');
    for (let i = 0; i < 5; i++) await page.keyboard.press('ArrowRight');
    await rested(page);
    that(Number(await page.inputValue('#slider-head_scale')) > Number(before), 'the slider stays');
    await page.focus('#canvas');
    const still = await pixels(page);
    for (let i = 0; i < 6; i++) await page.keyboard.press('ArrowRight');
    await page.waitForTimeout(600);
    that(differs(still, await pixels(page)) > 60, 'the figures do not turn');
    const unnamed = await page.evaluate(() => [...document.querySelectorAll('button, input:not([type=file]), select, progress')]
      .filter((element) => !(element.getAttribute('aria-label') || element.labels?.length || element.textContent.trim()))
      .map((element) => element.outerHTML.slice(0, 80)));
    that(!unnamed.length, `without a name: ${unnamed.join(', ')}`);
    const stops = await page.evaluate(() => [...document.querySelectorAll('[tabindex]')].filter((element) => element.tabIndex > 0).length);
    that(!stops, 'the order of keys is not that of the page');
  });
  await check('picture and report are saved', async () => {
    const picture = fs.readFileSync(await downloaded(page, '#picture'));
    that(picture.subarray(1, 4).toString() === 'PNG', 'it is no PNG');
    const report = JSON.parse(fs.readFileSync(await downloaded(page, '#report'), 'utf8'));
    that(report.result.heads > 1, 'the report has no heads');
  });
  await check('four languages have all words', async () => {
    for (const code of ['ja', 'ko', 'zh', 'en']) {
      await page.selectOption('#language', code);
      const empty = await page.evaluate(() => [...document.querySelectorAll('[data-t], .row label')].filter((element) => !element.textContent).length);
      that(!empty, `${empty} empty words in ${code}`);
      await shot(page, `language-${code}`);
    }
  });
}
await check('no request leaves the page after it is loaded, and without a network it goes on', async () => {
  const later = requests.slice(loaded).filter((url) => !/^(blob|data):/.test(url));
  that(!later.length, later.join(', '));
  await browser.setOffline(true);
  await choose(page, ROGUE);
  await page.waitForFunction(() => document.getElementById('file-name').textContent === 'kaykit_rogue.glb');
  await rested(page);
  await browser.setOffline(false);
  return `${loaded} requests to load it`;
});
await check('its own rules keep it from asking elsewhere', async () => {
  const before = complaints.length;
  const answer = await page.evaluate(() => fetch('http://127.0.0.1:9/').then(() => 'an answer', (error) => error.name));
  await page.waitForTimeout(300);
  const said = complaints.splice(before).join(' ');
  that(answer === 'TypeError' && /Content Security Policy/.test(said), `${answer}; ${said}`);
});
await check('on a phone it is usable', async () => {
  const phone = await opened(address, { width: 390, height: 844 });
  await shot(phone, 'phone-empty');
  await phone.click('#sample');
  await rested(phone);
  await shot(phone, 'phone');
  const wide = await phone.evaluate(() => document.documentElement.scrollWidth);
  that(wide <= 390, `it is ${wide} wide`);
  await phone.close();
});
await check('one file works without a server', async () => {
  const single = await opened(`file://${path.resolve(folder, 'superdeform.html')}`);
  await single.click('#sample');
  await rested(single);
  await shot(single, 'sample');
  await single.close();
});
await check('nothing was complained about in the console', () => that(!complaints.length, complaints.join(' | ')));
await browser.close();
server.close();
fs.rmSync(scratch, { recursive: true, force: true });
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
