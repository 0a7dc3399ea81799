// What is set, and what was set before.

export const FIRST = Object.freeze({ style: { built_in: 'sd2.5' }, options: {} });

const same = (one, two) => JSON.stringify(one) === JSON.stringify(two);

export class History {
  #past = [];
  #future = [];
  now = FIRST;

  /** Takes new settings; undone ones are forgotten. */
  push(settings) {
    if (same(settings, this.now)) return false;
    this.#past.push(this.now);
    this.#future = [];
    this.now = settings;
    return true;
  }

  get canUndo() {
    return this.#past.length > 0;
  }

  get canRedo() {
    return this.#future.length > 0;
  }

  undo() {
    if (!this.canUndo) return;
    this.#future.push(this.now);
    this.now = this.#past.pop();
  }

  redo() {
    if (!this.canRedo) return;
    this.#past.push(this.now);
    this.now = this.#future.pop();
  }
}
