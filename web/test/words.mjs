// Every language has every word that the page uses, with the same places for values: node words.mjs
import fs from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { GROUPS, ROWS } from '../src/rows.js';

const here = path.dirname(fileURLToPath(import.meta.url));
const read = (name) => JSON.parse(fs.readFileSync(path.join(here, '..', name), 'utf8'));
const places = (sentence) => [...sentence.matchAll(/\{\d\}/g)].map(([place]) => place).sort().join();
const faults = [];
let count = 0;
const own = read('src/words/en.json');
const sources = ['index.html', 'main.js', 'notes.js', 'character.js', 'sliders.js'].map((name) => fs.readFileSync(path.join(here, '../src', name), 'utf8'));
const used = sources.flatMap((text) => [...text.matchAll(/(?:\bt\('|data-t="|data-t-label="|title\(')([a-z_.]+)['"]/g)].map(([, key]) => key));
const parts = Object.entries({ ...GROUPS.body, ...GROUPS.ends }).flatMap(([group, is]) => [`group.${group}`, ...(is ? [`group.${is}`, `tune.${is}.tooltip`] : [])]);
const options = Object.values(ROWS).flat().filter((name) => name !== 'heads').map((name) => `option.${name}`);
for (const language of ['en', 'ja', 'ko', 'zh']) {
  const words = { ...read(`../unity/Editor/Localization/${language}.json`), ...read(`src/words/${language}.json`) };
  for (const key of new Set([...Object.keys(own), ...used, ...parts, ...options])) {
    count += 1;
    if (!words[key]) faults.push(`${language} has no ${key}`);
    else if (own[key] && places(own[key]) !== places(words[key])) faults.push(`${language}: ${key} has other values than in English`);
  }
}
for (const key of Object.keys(own)) {
  const isUsed = used.includes(key) || ['name', 'pose.', 'look.', 'slider.'].some((start) => key.startsWith(start));
  if (!isUsed) faults.push(`nothing uses ${key}`);
}
for (const fault of faults) console.log(fault);
console.log(`${count - faults.length} passed, ${faults.length} failed`);
process.exit(faults.length ? 1 : 0);
