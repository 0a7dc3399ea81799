// Builds the page: node build.mjs WASM FOLDER
//
// FOLDER gets the page as static files, and superdeform.html, the same page as one file that works without a server.
import { createHash } from 'node:crypto';
import fs from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import esbuild from 'esbuild';

const here = path.dirname(fileURLToPath(import.meta.url));
const [wasm, folder] = process.argv.slice(2);
if (!folder) {
  console.error('usage: node build.mjs WASM FOLDER');
  process.exit(2);
}
const read = (name) => fs.readFileSync(path.join(here, name), 'utf8');
const LANGUAGES = ['en', 'ja', 'ko', 'zh'];
const PARTS = { 'superdeform.wasm': wasm, 'sample.glb': path.join(here, '../tests/data/quaternius_female_dress_unrigged.glb') };

/** The page's own words, and of the Unity window's the names of options and parts and what warnings tell. */
function words() {
  const all = LANGUAGES.map((language) => {
    const unity = JSON.parse(read(`../unity/Editor/Localization/${language}.json`));
    const shared = Object.entries(unity).filter(([key]) => /^(option|warning|group|tune)\./.test(key));
    return [language, { ...Object.fromEntries(shared), ...JSON.parse(read(`src/words/${language}.json`)) }];
  });
  return JSON.stringify(Object.fromEntries(all));
}

/** Where the page's parts come from: from beside it, each fetched once, so that nothing is asked for later; or from within it. */
function parts(within) {
  const fetched = `const fetched = {};
  export const bytesOf = (name) => (fetched[name] ??= load(name));
  const load = async (name) => {
    const answer = await fetch(name);
    if (!answer.ok) throw new Error(name + ': ' + answer.status);
    return new Uint8Array(await answer.arrayBuffer());
  };`;
  const held = `export const bytesOf = async (name) => {
    const text = document.getElementById(name).textContent;
    return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  };`;
  return `${within ? held : fetched}
  // Of its own bytes, so that a new one can be had without a network.
  export const workerAddress = async () => URL.createObjectURL(new Blob([await bytesOf('worker.js')], { type: 'text/javascript' }));`;
}

async function script(entry, within) {
  const plugin = {
    name: 'made',
    setup(build) {
      const of = { words: () => `export const words = ${words()};`, parts: () => parts(within) };
      build.onResolve({ filter: /^(words|parts)$/ }, ({ path: name }) => ({ path: name, namespace: 'made' }));
      build.onLoad({ filter: /.*/, namespace: 'made' }, ({ path: name }) => ({ contents: of[name](), loader: 'js' }));
    },
  };
  const built = await esbuild.build({
    entryPoints: [path.join(here, 'src', entry)], bundle: true, minify: true, write: false, plugins: [plugin],
    format: entry === 'worker.js' ? 'iife' : 'esm', target: 'es2022', legalComments: 'eof', logLevel: 'error',
  });
  // Within a page, no text may end its script.
  return built.outputFiles[0].text.replaceAll('</script', '<\\/script');
}

const hash = (text) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`;

/** What the page may load: nothing from elsewhere, and nothing but what it is made of. */
function policy(scripts, connect, workers) {
  const rules = [
    "default-src 'none'", `script-src ${scripts} 'wasm-unsafe-eval'`, `worker-src ${workers}`, "style-src 'unsafe-inline'",
    `connect-src ${connect}`, 'img-src blob: data:', "base-uri 'none'", "form-action 'none'",
  ];
  return `<meta http-equiv="Content-Security-Policy" content="${rules.join('; ')}">`;
}

function page(rules, inner) {
  const style = `<style>${read('src/style.css').replace(/\s*\n\s*/g, '')}</style>`;
  // As functions: the texts hold dollar signs.
  return read('src/index.html').replace('<!--policy-->', () => rules).replace('<!--style-->', () => style).replace('<!--script-->', () => inner);
}

fs.rmSync(folder, { recursive: true, force: true });
fs.mkdirSync(folder, { recursive: true });
const write = (name, content) => fs.writeFileSync(path.join(folder, name), content);
write('worker.js', await script('worker.js'));
write('page.js', await script('main.js'));
write('index.html', page(policy("'self'", "'self' blob:", 'blob:'), '<script type="module" src="page.js"></script>'));
for (const [name, from] of Object.entries(PARTS)) fs.copyFileSync(from, path.join(folder, name));

const inline = await script('main.js', true);
const held = [...Object.keys(PARTS), 'worker.js'].map((name) => `<script type="text/plain" id="${name}">${fs.readFileSync(path.join(folder, name), 'base64')}</script>`);
const inner = [...held, `<script type="module">${inline}</script>`].join('\n');
write('superdeform.html', page(policy(`${hash(inline)} blob:`, 'blob:', 'blob:'), inner));
