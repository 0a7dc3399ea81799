// The page's sentences in the user's language; names of options and parts and what warnings tell are those of the Unity window.
import { words } from 'words';

const chosen = () => {
  const stored = (() => {
    try {
      return localStorage.getItem('language');
    } catch {
      return null;
    }
  })();
  const wanted = [stored, ...navigator.languages].filter(Boolean).map((tag) => tag.slice(0, 2));
  return wanted.find((language) => words[language]) ?? 'en';
};

let language = chosen();

export const languages = Object.entries(words).map(([code, { name }]) => ({ code, name }));
export const current = () => language;

export function choose(code) {
  language = code;
  try {
    localStorage.setItem('language', code);
  } catch {
    // A page that is opened as a file may keep nothing.
  }
}

/** A sentence, with what stands in its {0}, {1}; English where the language lacks it, '' where nobody has it. */
export function t(key, ...values) {
  const sentence = words[language][key] ?? words.en[key] ?? '';
  return sentence.replace(/\{(\d)\}/g, (_, index) => values[index] ?? '');
}

/** Gives every element with `data-t` its sentence. */
export function label(root) {
  document.documentElement.lang = language;
  for (const element of root.querySelectorAll('[data-t]')) element.textContent = t(element.dataset.t);
  for (const element of root.querySelectorAll('[data-t-label]')) {
    const sentence = t(element.dataset.tLabel);
    element.setAttribute('aria-label', sentence);
    if (element.tagName === 'BUTTON') element.title = sentence;
  }
}
