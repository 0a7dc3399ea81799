// What a person should know, in plain words.
import { t } from './words.js';

/** A warning in plain words, and below them in the library's own; in these alone where there are no others. */
function told({ code, message }, name) {
  const own = message.startsWith(`${name}: `) ? message.slice(name.length + 2) : message;
  // Plain words may name numbers of the library's sentence, in their order.
  const plain = t(`warning.${code}`, ...(own.match(/\d+(\.\d+)?/g) ?? []));
  if (plain) return { text: plain, detail: own };
  return { text: own.startsWith(name) ? own : own[0].toUpperCase() + own.slice(1), detail: '' };
}

/** An address without what it asks for: some licences are questions of thirty words. */
const short = (name) => name.replace(/^https?:\/\/([^?#]+).*$/, '$1');

function licence({ licence: of }, allowed) {
  if (!of) return [];
  const name = short(of.name || of.because);
  const authors = of.authors?.length ? of.authors.join(', ') : '';
  const lines = name ? [authors ? t('notes.licence_by', name, authors) : t('notes.licence', name)] : [];
  if (of.changes === 'prohibited' && allowed) lines.push(t('notes.prohibited'));
  if (of.changes === 'not to share') lines.push(t('notes.not_to_share'));
  return lines.map((text) => ({ kind: 'licence', text }));
}

/** All notes on a character: { kind, text, detail }. */
export function notes(character) {
  const { about, latest } = character;
  const list = licence(about, character.allowed);
  if (about.new_rig) list.push({ kind: '', text: t('notes.new_rig') });
  const doubted = Object.entries(about.joints).filter(([, { confidence }]) => confidence < 0.5).map(([role]) => role);
  if (doubted.length) list.push({ kind: 'doubt', text: t('notes.doubted', doubted.join(', ')) });
  const warnings = latest?.report.warnings ?? about.warnings;
  const own = ['modification_prohibited', 'redistribution_prohibited'];
  const said = warnings.filter(({ code }) => !own.includes(code));
  for (const { text, detail } of said.map((warning) => told(warning, character.name))) {
    const before = list.find((note) => note.text === text);
    if (before) before.detail += `; ${detail}`;
    else list.push({ kind: '', text, detail });
  }
  list.push({ kind: '', text: t('notes.size', about.vertices.toLocaleString(), about.morph_targets) });
  return list;
}
