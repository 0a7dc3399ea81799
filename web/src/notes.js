// What a person should know, in plain words.
import { t } from './words.js';

/** A warning in the user's language where there are words for it; else the library's own sentence. */
function told({ code, message }) {
  const known = t(`warning.${code}`);
  if (!known) return message;
  // Of warnings that were written for the Unity window, what stands in {0} is the library's sentence.
  return known.includes('{0}') ? known.replace('{0}', message) : known;
}

function licence({ licence: of }, allowed) {
  if (!of) return [];
  const name = of.name || of.because;
  const authors = of.authors?.length ? of.authors.join(', ') : '';
  const lines = name ? [authors ? t('notes.licence_by', name, authors) : t('notes.licence', name)] : [];
  if (of.changes === 'prohibited' && allowed) lines.push(t('notes.prohibited'));
  if (of.changes === 'not to share') lines.push(t('notes.not_to_share'));
  return lines.map((text) => ({ kind: 'licence', text }));
}

/** All notes on a character: { kind, text }. */
export function notes(character, language) {
  const { about, latest } = character;
  const list = licence(about, character.allowed);
  if (about.new_rig) list.push({ kind: '', text: t('notes.new_rig') });
  const doubted = Object.entries(about.joints).filter(([, { confidence }]) => confidence < 0.5).map(([role]) => role);
  if (doubted.length) list.push({ kind: 'doubt', text: t('notes.doubted', doubted.join(', ')) });
  const warnings = latest?.report.warnings ?? about.warnings;
  const own = ['modification_prohibited', 'redistribution_prohibited'];
  const said = warnings.filter(({ code }) => !own.includes(code));
  for (const warning of said) list.push({ kind: '', text: language === 'en' ? warning.message : told(warning) });
  list.push({ kind: '', text: t('notes.size', about.vertices.toLocaleString(), about.morph_targets) });
  return list;
}
