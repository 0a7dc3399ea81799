// The same conversions by the command line and by the WebAssembly in node: node native.mjs WASM COMMAND MODELS...
//
// Prints a line for each model: whether the files are the same bytes, else what differs and by how much; then how long both
// took. Ends with `N passed, N failed`: a result passes within 1e-6 of the figure's height and with the same JSON but for
// rounding.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { Engine } from '../src/engine.js';

/** How far a result may be from the command line's, over the height. */
const MOST = 1e-6;
const [wasm, command, ...models] = process.argv.slice(2);
const COUNTS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };
const ARRAYS = { 5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array };

function parts(bytes) {
  const size = new DataView(bytes.buffer, bytes.byteOffset).getUint32(12, true);
  return { json: JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + size))), binary: bytes.subarray(28 + size) };
}

function numbers({ json, binary }, accessor) {
  const view = json.bufferViews[accessor.bufferView];
  if (!view) return [];
  const [Array, items] = [ARRAYS[accessor.componentType], COUNTS[accessor.type]];
  const packed = items * Array.BYTES_PER_ELEMENT;
  const from = (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
  const bytes = new Uint8Array(packed * accessor.count);
  for (let i = 0; i < accessor.count; i++) {
    const at = from + i * (view.byteStride ?? packed);
    bytes.set(binary.subarray(at, at + packed), i * packed);
  }
  return new Array(bytes.buffer);
}

/** The largest difference between numbers of two values of the same form; Infinity where the form differs. */
function apart(one, two) {
  if (typeof one === 'number' && typeof two === 'number') return Math.abs(one - two);
  if (one === null || typeof one !== 'object') return one === two ? 0 : Infinity;
  const keys = Object.keys(one);
  if (two === null || typeof two !== 'object' || keys.join() !== Object.keys(two).join()) return Infinity;
  return Math.max(0, ...keys.map((key) => apart(one[key], two[key])));
}

/** The largest difference of two files, and where. */
function difference(one, two) {
  const [a, b] = [parts(one), parts(two)];
  if (a.json.accessors.length !== b.json.accessors.length) return [Infinity, 'accessors'];
  let worst = [apart(a.json, b.json), 'JSON'];
  a.json.accessors.forEach((accessor, index) => {
    const [x, y] = [numbers(a, accessor), numbers(b, b.json.accessors[index])];
    if (x.length !== y.length) worst = [Infinity, `accessor ${index}`];
    for (let i = 0; i < x.length; i++) if (Math.abs(x[i] - y[i]) > worst[0]) worst = [Math.abs(x[i] - y[i]), `accessor ${index}`];
  });
  return worst;
}

const median = (list) => [...list].sort((a, b) => a - b)[list.length >> 1];
const module = await WebAssembly.compile(fs.readFileSync(wasm));
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'superdeform-web-'));
let [passed, failed, same] = [0, 0, 0];
const ratios = [];
for (const model of models) {
  const name = path.basename(model);
  const out = path.join(folder, name.replace(/\.(\w+)$/, '_sd.$1'));
  const reported = `${out}.json`;
  try {
    execFileSync(command, ['--quiet', '--threads', '1', model, '--heads', '2.5', '-o', out, '--report', reported], { stdio: 'pipe' });
    const engine = await Engine.start(module);
    const times = {};
    const timed = async (what, question, files) => {
      const start = performance.now();
      const answer = await engine.ask(question, files);
      times[what] = performance.now() - start;
      return answer;
    };
    await timed('open', { do: 'open' }, [{ name, bytes: fs.readFileSync(model) }]);
    // The first one is slow: code that has not run is compiled.
    await timed('first', { do: 'set', style: { heads: 3 } });
    await timed('heads', { do: 'set', style: { heads: 2.5 } });
    const { files, report } = await timed('write', { do: 'write', name: path.basename(out) });
    await timed('amount', { do: 'set', style: { heads: 2.5 }, options: { amount: 0.5, repair: 'kept' } });
    await timed('glimpse', { do: 'glimpse' });
    const [ours, theirs] = [Buffer.from(files[0].bytes), fs.readFileSync(out)];
    const { timing_ms: native, target } = JSON.parse(fs.readFileSync(reported, 'utf8'));
    const [most, where] = ours.equals(theirs) ? [0, ''] : difference(ours, theirs);
    const share = most / target.height;
    const verdict = ours.equals(theirs) ? 'same bytes' : `${share.toExponential(1)} H (${where})`;
    same += ours.equals(theirs);
    const good = share <= MOST && JSON.parse(report).warnings.length === JSON.parse(fs.readFileSync(reported, 'utf8')).warnings.length;
    good ? passed++ : failed++;
    // A second deformer of the same character, warm: what the command line's deform and measure do.
    await engine.ask({ do: 'open' }, [{ name, bytes: fs.readFileSync(model) }]);
    await timed('warm', { do: 'set', style: { heads: 2.5 } });
    const ratio = times.warm / (native.measure + native.deform);
    ratios.push(ratio);
    const shown = Object.entries(times).map(([what, ms]) => `${what} ${ms.toFixed(0)}`).join(' ');
    console.log(`${good ? 'ok  ' : 'FAIL'} ${name}: ${verdict}; ms: ${shown}; native ${(native.measure + native.deform).toFixed(0)}, ratio warm ${ratio.toFixed(2)}; ${(engine.memory / 1e6).toFixed(0)} MB`);
  } catch (error) {
    failed++;
    console.log(`FAIL ${name}: ${error.stderr?.toString().trim() || error.stack}`);
  }
}
fs.rmSync(folder, { recursive: true, force: true });
console.log(`${same} of ${models.length} the same bytes; warm, WebAssembly takes ${median(ratios)?.toFixed(2)} times as long as the command line on one thread`);
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
