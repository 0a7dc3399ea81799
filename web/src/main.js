// The page: what is clicked, and what becomes of it.
import { Client } from './client.js';
import { Character, gathered } from './character.js';
import { dropped, save } from './files.js';
import { FIRST, History } from './history.js';
import { notes } from './notes.js';
import { GROUPS, groupSliders, ROWS } from './rows.js';
import { Slider } from './sliders.js';
import { Stage } from './stage.js';
import { Shown } from './shown.js';
import { POSES } from './poses.js';
import { choose, current, label, languages, t } from './words.js';
import { bytesOf, workerAddress } from 'parts';

const $ = (id) => document.getElementById(id);
const STYLES = ['sd2', 'sd2.5', 'sd3', 'sd4'];

const stage = new Stage($('canvas'));
const history = new History();
const sliders = new Map();
let client;
let character = null;
let reference = null;
/** What the sliders show, before it is part of the history. */
let shown = FIRST;

// ---- what is going on

let working = 0;

/** Says what is being done while it is done. */
async function during(sentence, work) {
  working += 1;
  $('busy-text').textContent = sentence;
  $('progress').removeAttribute('value');
  // What is done at once needs no words.
  const later = setTimeout(() => ($('busy').hidden = false), 250);
  try {
    return await work();
  } finally {
    clearTimeout(later);
    working -= 1;
    if (!working) $('busy').hidden = true;
  }
}

let tasks = 0;

/** Says to assistive technology that the view is not final until `task` is done. */
async function untilFinal(task) {
  $('view').setAttribute('aria-busy', ++tasks > 0);
  try {
    return await task();
  } finally {
    $('view').setAttribute('aria-busy', --tasks > 0);
  }
}

function tell(sentence) {
  $('alert').firstElementChild.textContent = sentence;
  $('alert').hidden = !sentence;
}

/** What went wrong, for people; a fault of the library loses nothing but its instance. */
async function failed(error) {
  if (error.name === 'Cancelled') return;
  if (error.name === 'Fault') {
    tell(t('error.fault', error.message));
    if (isOpen) await reopen();
  } else {
    tell(error.message);
  }
}

// ---- opening

let opening = 0;
/** The character that was shown last with its result: what cancelling another goes back to. */
let finished = null;
/** False while another character is being opened: what is set then waits. */
let isOpen = false;

const open = (given) => untilFinal(() => opens(given));

async function opens(given) {
  const turn = ++opening;
  tell('');
  let next;
  try {
    const files = await gathered(given);
    await started;
    if (turn !== opening || !client) return;
    isOpen = false;
    wanted = null;
    await running?.catch(() => {});
    next = new Character(client, files);
    await during(t('busy.open', next.name), async () => {
      await openAllowed(next);
      if (turn === opening) await show(next);
    });
  } catch (error) {
    if (turn !== opening) return;
    // The library has closed what was open before.
    await failed(error);
    if (character && !isOpen) await reopen();
  }
}

/** Opens a character; where its licence forbids changes, the user is asked. */
async function openAllowed(next) {
  try {
    await next.open();
  } catch (error) {
    if (error.option !== 'allow_prohibited') throw error;
    if (!(await confirmed(error.message))) throw Object.assign(new Error(), { name: 'Cancelled' });
    await next.open(true);
  }
}

function confirmed(sentence) {
  const dialog = $('licence');
  $('licence-text').textContent = sentence;
  $('licence-mine').checked = false;
  $('licence-go').disabled = true;
  dialog.returnValue = 'no';
  dialog.showModal();
  return new Promise((done) => dialog.addEventListener('close', () => done(dialog.returnValue === 'yes'), { once: true }));
}

async function show(next) {
  const before = await shownOrNote(next, () => next.before());
  character = next;
  isOpen = true;
  document.body.classList.remove('none');
  $('empty').hidden = true;
  $('tags').hidden = false;
  $('heads-before').textContent = $('heads-after').textContent = '';
  stage.show('before', before);
  stage.show('after', null);
  if (before) {
    stage.drawDoubts();
    stage.frame();
  }
  $('file-name').textContent = $('file-name').title = next.name;
  $('another').hidden = false;
  $('controls').disabled = false;
  showLooks(before);
  await update(true);
}

/** What cannot be shown can still be converted. */
async function shownOrNote(of, read) {
  try {
    return await read();
  } catch (error) {
    if (['Cancelled', 'Fault', 'Refused'].includes(error.name)) throw error;
    tell(t('notes.not_shown', error.message));
    return null;
  }
}

/** Opens what was open, after the library began anew; `anew`: something else is shown. */
async function reopen(anew) {
  try {
    if (reference) await client.ask({ do: 'reference' }, reference.files);
    if (!character) return;
    await character.open(character.allowed);
    isOpen = true;
    await (anew ? show(character) : update(true));
  } catch (error) {
    tell(error.message);
  }
}

// ---- settings become results

let wanted = null;
let running = null;

/** Shows what the settings make of the character: `whole` with its file and its numbers, else a glimpse. */
function update(whole) {
  wanted = whole || wanted === 'whole' ? 'whole' : 'glimpse';
  running ??= untilFinal(run).finally(() => (running = null));
  return running;
}

async function run() {
  while (wanted && isOpen) {
    const whole = wanted === 'whole';
    wanted = null;
    try {
      if (whole) await during(t('busy.deform'), () => result());
      else stage.renew(await character.glimpse(shown));
    } catch (error) {
      wanted = null;
      throw error;
    }
  }
}

async function result() {
  const of = character;
  // Something to see at once: a new file is read more slowly than an old one is renewed.
  if (stage.after.shown) stage.renew(await of.glimpse(shown));
  const { bytes, report } = await of.result(shown);
  if (wanted || of !== character) return;
  const after = await shownOrNote(of, () => Shown.read(bytes, of.about));
  if (of !== character) return after?.dispose();
  stage.show('after', after);
  finished = of;
  const heads = (figure) => figure.heads.toFixed(1);
  $('heads-before').textContent = t('heads', heads(report.target));
  $('heads-after').textContent = t('heads', heads(report.result));
  $('busy-text').textContent = t('status.ready', of.name, heads(report.target), heads(report.result));
  settleParts(report);
  showNotes();
}

function showNotes() {
  if (!character) return;
  const list = notes(character);
  const row = ({ kind, text, detail }) => {
    const item = Object.assign(document.createElement('li'), { className: kind, textContent: text });
    if (detail) item.append(Object.assign(document.createElement('small'), { textContent: detail, lang: 'en' }));
    return item;
  };
  $('notes-list').replaceChildren(...list.map(row));
  $('notes-count').textContent = list.length;
}

function showActions() {
  const ready = !!character?.latest;
  for (const id of ['download', 'picture', 'report']) $(id).disabled = !ready;
  $('download').textContent = ready ? t('download.as', character.resultName.split('.').pop().toUpperCase()) : t('download');
  $('undo').disabled = !history.canUndo;
  $('redo').disabled = !history.canRedo;
  $('reset').disabled = JSON.stringify(shown) === JSON.stringify(FIRST);
}

// ---- settings

/** Shows and applies settings; `isLast`: they stay. */
function set(settings, isLast) {
  shown = settings;
  if (isLast) history.push(settings);
  showSettings();
  if (character) update(isLast).catch(failed);
}

function changed(name, value, isLast) {
  const next = { style: shown.style, options: { ...shown.options } };
  if (name === 'heads') next.style = value === null ? FIRST.style : { heads: value };
  else put(next.options, name, value);
  set(next, isLast);
}

/** Sets an option, or a part's own (`hand.length_scale`); `null`: it is unset. */
function put(options, name, value) {
  const [group, part] = name.split('.');
  if (part) {
    const groups = { ...options.groups, [group]: { ...options.groups?.[group] } };
    put(groups[group], part, value);
    put(groups, group, Object.keys(groups[group]).length ? groups[group] : null);
    return put(options, 'groups', Object.keys(groups).length ? groups : null);
  }
  if (value === null) delete options[name];
  else options[name] = value;
}

/** What an option, or a part's own, is set to; `null`: unset. */
function valueOf(options, name) {
  const [group, part] = name.split('.');
  return (part ? options.groups?.[group]?.[part] : options[name]) ?? null;
}

/** Sliders of parts stand at what the style makes of each part until they are moved. */
function settleParts({ coefficients }) {
  for (const [name, slider] of sliders) {
    const [group, part] = name.split('.');
    const found = coefficients?.[group]?.[part];
    if (found !== undefined && valueOf(shown.options, name) === null) slider.settle(found);
  }
  showSettings();
}

/** The number of heads that a style stands for. */
function headsOf({ heads, built_in: name, reference: like }) {
  return heads ?? (like ? reference.heads : Number(name.slice(2)));
}

function showSettings() {
  for (const [name, slider] of sliders) {
    slider.set(name === 'heads' ? headsOf(shown.style) : valueOf(shown.options, name));
  }
  for (const button of $('styles').children) button.setAttribute('aria-pressed', shown.style.built_in === button.value);
  $('like').setAttribute('aria-pressed', !!shown.style.reference);
  $('like').textContent = reference ? t('like.set', reference.name) : t('like');
  for (const box of document.querySelectorAll('[data-option]')) box.checked = (shown.options[box.dataset.option] ?? box.dataset.unset) === box.dataset.on;
  showActions();
}

const refer = (given) => untilFinal(() => refers(given));

async function refers(given) {
  tell('');
  try {
    const files = await gathered(given);
    const name = files[0].name.split('/').pop();
    const found = await during(t('busy.reference', name), () => client.ask({ do: 'reference' }, files));
    reference = { files, name, heads: Math.min(6, Math.max(1.8, found.heads ?? 2.5)) };
    set({ ...shown, style: { reference: true, of: name } }, true);
  } catch (error) {
    if (reference && error.name === 'Refused') await client.ask({ do: 'reference' }, reference.files);
    await failed(error);
  }
}

function buildSettings(options) {
  const rows = new Map(options.map((row) => [row.name, row]));
  const add = (name) => {
    const slider = new Slider(name, rows.get(name), changed);
    sliders.set(name, slider);
    return slider.element;
  };
  $('main-sliders').append(...ROWS.main.map(add));
  const title = (key) => {
    const element = document.createElement('h3');
    element.dataset.t = key;
    return element;
  };
  const boxes = () => [box('height', 'option.height.keep', 'keep', 'style'), box('repair', 'option.repair', 'on', 'on')];
  const parts = (groups) => groupSliders(groups).map(add);
  const more = {
    'tune.face': () => ROWS.face.map(add),
    'tune.hair': () => ROWS.hair.map(add),
    'tune.body': () => [...ROWS.body.map(add), ...boxes(), ...parts(GROUPS.body)],
    'tune.ends': () => parts(GROUPS.ends),
  };
  for (const [key, rows] of Object.entries(more)) $('more-sliders').append(title(key), ...rows());
  for (const name of STYLES) {
    const button = Object.assign(document.createElement('button'), { type: 'button', value: name, textContent: name.slice(2) });
    button.addEventListener('click', () => set({ ...shown, style: { built_in: name } }, true));
    $('styles').append(button);
  }
  for (const pose of Object.keys(POSES)) {
    const button = Object.assign(document.createElement('button'), { type: 'button', value: pose });
    button.dataset.t = `pose.${pose}`;
    button.addEventListener('click', () => takePose(pose));
    $('poses').append(button);
  }
}

/** A box for an option of two words. */
function box(option, key, on, unset) {
  const row = Object.assign(document.createElement('label'), { className: 'check' });
  const input = Object.assign(document.createElement('input'), { type: 'checkbox' });
  Object.assign(input.dataset, { option, on, unset });
  const text = document.createElement('span');
  text.dataset.t = key;
  row.append(input, ' ', text);
  const off = { height: 'style', repair: 'off' }[option];
  input.addEventListener('change', () => changed(option, (input.checked ? on : off) === unset ? null : input.checked ? on : off, true));
  return row;
}

// ---- poses and looks

function takePose(pose) {
  stage.takePose(pose);
  for (const button of $('poses').children) button.setAttribute('aria-pressed', button.value === pose);
}

/** The sliders of what the character's face can do. */
let looks = [];

function showLooks(before) {
  stage.express({ blink: 0, aa: 0 });
  looks = ['blink', 'aa']
    .filter((name) => before?.has(name))
    .map((name) => {
      const slider = new Slider(name, { low: 0, high: 1, default: 0 }, (_, value) => {
        slider.set(value);
        stage.express({ [name]: value ?? 0 });
      });
      slider.set(null);
      return slider;
    });
  $('looks').replaceChildren(...looks.map(({ element }) => element));
  $('springs-row').hidden = !before?.hasSprings;
}

// ---- the rest of the page

function relabel() {
  label(document);
  document.title = 'superdeform';
  for (const slider of [...sliders.values(), ...looks]) slider.relabel();
  for (const button of $('styles').children) button.setAttribute('aria-label', t('style.label', button.value.slice(2)));
  if (!character) $('file-name').textContent = t('no_file');
  else $('file-name').textContent = character.name;
  if (character?.latest) {
    $('heads-before').textContent = t('heads', character.latest.report.target.heads.toFixed(1));
    $('heads-after').textContent = t('heads', character.latest.report.result.heads.toFixed(1));
  }
  showSettings();
  showNotes();
}

/** Lets a button or a box choose files. */
function chooses(button, input, then) {
  button.addEventListener('click', () => input.click());
  input.addEventListener('change', () => {
    const files = [...input.files].map((file) => ({ name: file.name, file }));
    input.value = '';
    if (files.length) then(files);
  });
}

function listen() {
  chooses($('choose'), $('file'), open);
  $('another').addEventListener('click', () => $('file').click());
  chooses($('like'), $('reference-file'), refer);
  $('sample').addEventListener('click', async () => {
    const sample = await bytesOf('sample.glb');
    open([{ name: 'sample.glb', file: new Blob([sample]) }]);
  });
  for (const event of ['dragenter', 'dragover']) addEventListener(event, (e) => (e.preventDefault(), document.body.classList.add('over')));
  for (const event of ['dragleave', 'drop']) addEventListener(event, (e) => (e.preventDefault(), document.body.classList.remove('over')));
  addEventListener('drop', async (event) => {
    const files = await dropped(event.dataTransfer);
    if (files.length) (event.target.closest?.('#like') ? refer : open)(files);
  });
  $('alert-close').addEventListener('click', () => tell(''));
  $('cancel').addEventListener('click', cancel);
  $('licence-mine').addEventListener('change', () => ($('licence-go').disabled = !$('licence-mine').checked));
  $('undo').addEventListener('click', () => step('undo'));
  $('redo').addEventListener('click', () => step('redo'));
  $('reset').addEventListener('click', () => set(FIRST, true));
  $('springs').addEventListener('change', () => {
    stage.springs = $('springs').checked;
    for (const { shown: of } of stage.halves) of?.settle();
    stage.touch();
  });
  $('download').addEventListener('click', () => give(character.latest.name, [character.latest.bytes], 'model/gltf-binary'));
  $('report').addEventListener('click', () => give(character.latest.name.replace(/\.\w+$/, '.json'), [character.latest.text], 'application/json'));
  $('picture').addEventListener('click', picture);
  $('language').append(...languages.map(({ code, name }) => new Option(name, code, false, code === current())));
  $('language').addEventListener('change', () => (choose($('language').value), relabel()));
  addEventListener('keydown', keys);
  $('canvas').addEventListener('keydown', turnByKeys);
}

const cancel = () => untilFinal(cancels);

async function cancels() {
  opening += 1;
  wanted = null;
  isOpen = false;
  const isAnother = finished !== null && finished !== character;
  if (isAnother) character = finished;
  await client.cancel();
  await reopen(isAnother);
}

function step(way) {
  history[way]();
  if (history.now.style.reference && !reference) return step(way);
  set(history.now, false);
  if (character) update(true).catch(failed);
}

/** A slider that moves yet is let go first; so what is saved is what is seen. */
async function give(name, content, type) {
  if (running) await running;
  save(name, new Blob(content, { type }));
  $('busy-text').textContent = t('status.saved', name);
}

async function picture() {
  const words = [`${t('before')} · ${$('heads-before').textContent}`, `${t('after')} · ${$('heads-after').textContent}`];
  const blob = await stage.picture(words, '#f1ecf5');
  save(character.latest.name.replace(/\.\w+$/, '.png'), blob);
}

function keys(event) {
  if (!(event.ctrlKey || event.metaKey) || $('licence').open) return;
  const key = event.key.toLowerCase();
  const way = key === 'y' || (key === 'z' && event.shiftKey) ? 'redo' : key === 'z' ? 'undo' : null;
  if (!way || $(way).disabled) return;
  event.preventDefault();
  step(way);
}

function turnByKeys(event) {
  const ways = { ArrowLeft: [-0.15], ArrowRight: [0.15], '+': [0, 0.1], '=': [0, 0.1], '-': [0, -0.1] };
  if (event.key === '0' && character) stage.frame();
  else if (ways[event.key] && !event.ctrlKey) stage.turn(...ways[event.key]);
  else return;
  event.preventDefault();
}

// ---- start

async function start() {
  document.body.classList.add('none');
  relabel();
  listen();
  try {
    const [library, sample, worker] = await Promise.all([bytesOf('superdeform.wasm'), bytesOf('sample.glb'), workerAddress()]);
    const module = await WebAssembly.compile(library);
    client = new Client(worker, module, (share) => ($('progress').value = share));
    // Questions wait for the warming up; sliders do not.
    const options = client.start({ name: 'sample.glb', bytes: sample });
    buildSettings(await options);
    takePose('a');
    relabel();
    // For the page's own tests, and whoever is curious in the console.
    globalThis.superdeform = { ask: (question, files) => client.ask(question, files), memory: () => client.memory() };
    document.body.dataset.ready = 'yes';
  } catch (error) {
    for (const id of ['choose', 'sample', 'file']) $(id).disabled = true;
    tell(t('error.start', error.message));
  }
}

const started = start();
