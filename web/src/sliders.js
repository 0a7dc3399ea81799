// Rows of a slider with its name, its number and a way back.
import { GROUPS } from './rows.js';
import { t } from './words.js';

const percent = (value) => `${Math.round(100 * value)} %`;

const ONLY = { ...GROUPS.body, ...GROUPS.ends };
/** Of a part's number: 1 keeps what it is. */
const PART = { low: 0.1, high: 2, text: (value) => value.toFixed(2) };

/** What a slider is called, and what it does. */
function named(name) {
  const [group, part] = name.split('.');
  if (!part) {
    const key = ['slider', 'look'].map((kind) => `${kind}.${name}`).find((own) => t(own)) ?? `option.${name}`;
    return [t(key), name === 'head_scale' ? '' : t(`${key}.tooltip`)];
  }
  const is = ONLY[group];
  const title = is ? t(`group.${is}`, t(`group.${group}`)) : `${t(`group.${group}`)} · ${t(`option.${part}`)}`;
  return [title, t(is ? `tune.${is}.tooltip` : `option.${part}.tooltip`)];
}

const SHOWN = {
  heads: { low: 1.8, high: 6, step: 0.1, text: (value) => value.toFixed(1) },
  // 1.5 is the style's own, as in the Unity window.
  head_scale: { low: 0.75, high: 2.25, step: 0.015, text: (value) => percent(value / 1.5) },
  face_squash: { low: 0, high: 1.5, step: 0.01 },
};

export class Slider {
  /** `changed(name, value, isLast)`: while it moves, and when it is let go. */
  constructor(name, row = { default: 1 }, changed) {
    Object.assign(this, { name, fallback: row.default, changed });
    const { low, high, step, text } = { low: row.low, high: row.high, step: 0.01, text: percent, ...(name.includes('.') ? PART : SHOWN[name]) };
    this.text = text;
    const input = Object.assign(document.createElement('input'), { type: 'range', min: low, max: high, step, id: `slider-${name}` });
    const label = Object.assign(document.createElement('label'), { htmlFor: input.id });
    const output = Object.assign(document.createElement('output'), { htmlFor: input.id });
    const back = Object.assign(document.createElement('button'), { type: 'button', textContent: '⟲' });
    this.element = Object.assign(document.createElement('div'), { className: 'row' });
    this.element.append(label, output, back, input);
    Object.assign(this, { input, label, output, back });
    input.addEventListener('input', () => this.#tell(false));
    input.addEventListener('change', () => this.#tell(true));
    back.addEventListener('click', () => {
      changed(name, null, true);
      input.focus();
    });
    this.relabel();
  }

  #tell(isLast) {
    const value = Number(this.input.value);
    this.set(value);
    this.changed(this.name, value, isLast);
  }

  relabel() {
    const [title, tooltip] = named(this.name);
    this.label.textContent = title;
    this.element.title = tooltip;
    if (this.fallback !== null) this.back.title = t('reset.one', this.text(this.fallback));
    this.back.setAttribute('aria-label', `${title}: ${this.back.title}`);
  }

  /** What it is unless set. */
  settle(fallback) {
    this.fallback = fallback;
    this.relabel();
  }

  /** Shows a value; `null`: what it is unless set. */
  set(value) {
    const now = value ?? this.fallback;
    this.input.value = now;
    this.output.textContent = this.text(now);
    this.input.setAttribute('aria-valuetext', this.output.textContent);
    this.element.classList.toggle('set', this.name !== 'heads' && value !== null && value !== this.fallback);
  }
}
