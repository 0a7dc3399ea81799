// Rows of a slider with its name, its number and a way back.
import { t } from './words.js';

const percent = (value) => `${Math.round(100 * value)} %`;

/** What stands where. Ranges and defaults come from the library; a slider may show less of a range than there is. */
export const ROWS = {
  main: ['heads', 'amount', 'youth', 'head_scale', 'hair_length'],
  face: ['youth_eye', 'youth_lower', 'youth_nose', 'youth_cheek', 'youth_jaw', 'youth_skull', 'youth_ear', 'face_squash', 'smile'],
  body: ['profile', 'seat', 'hair_lay'],
};

const SHOWN = {
  heads: { low: 1.8, high: 6, step: 0.1, text: (value) => value.toFixed(1) },
  // 1.5 is the style's own, as in the Unity window.
  head_scale: { low: 0.75, high: 2.25, step: 0.015, text: (value) => percent(value / 1.5) },
  face_squash: { low: 0, high: 1.5, step: 0.01 },
};

export class Slider {
  /** `changed(name, value, isLast)`: while it moves, and when it is let go. */
  constructor(name, row, changed) {
    Object.assign(this, { name, fallback: row.default, changed });
    const { low, high, step, text } = { low: row.low, high: row.high, step: 0.01, text: percent, ...SHOWN[name] };
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
    const key = this.name === 'heads' ? 'slider.heads' : `option.${this.name}`;
    this.label.textContent = t(key);
    this.element.title = this.name === 'head_scale' ? '' : t(`${key}.tooltip`);
    if (this.fallback !== null) this.back.title = t('reset.one', this.text(this.fallback));
    this.back.setAttribute('aria-label', `${t(key)}: ${this.back.title}`);
  }

  /** Shows a value; `null`: what it is unless set. */
  set(value, fallback = this.fallback) {
    const now = value ?? fallback;
    this.input.value = now;
    this.output.textContent = this.text(now);
    this.input.setAttribute('aria-valuetext', this.output.textContent);
    this.element.classList.toggle('set', this.name !== 'heads' && value !== null && value !== this.fallback);
  }
}
