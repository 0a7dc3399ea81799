// The page's side of the worker: questions that wait for their answers, and an end to them.

/** The user ended it. */
export class Cancelled extends Error {
  constructor() {
    super('cancelled');
    this.name = 'Cancelled';
  }
}

export class Client {
  #waiting = new Map();
  #last = 0;

  /** `address`: of the worker's script; `module`: the compiled WebAssembly; `progress` is told shares, 0 to 1. */
  constructor(address, module, progress) {
    Object.assign(this, { address, module, progress });
  }

  /** Starts the worker; `warmUp`: a file to get going with. Gives what can be set. */
  async start(warmUp) {
    const worker = new Worker(this.address);
    this.worker = worker;
    worker.onmessage = ({ data }) => {
      if (data.share !== undefined) return this.progress(data.share);
      const { done, failed } = this.#waiting.get(data.id);
      this.#waiting.delete(data.id);
      if (!data.error) return done(data.answer);
      failed(Object.assign(new Error(data.error.message), data.error));
    };
    worker.onerror = (event) => this.#end(new Error(event.message || 'the worker could not start'));
    return (await this.#post('start', { module: this.module, warmUp })).options;
  }

  ask(question, files = []) {
    return this.#post('ask', { question, files });
  }

  memory() {
    return this.#post('memory', {});
  }

  /** True while an answer is awaited. */
  get busy() {
    return this.#waiting.size > 0;
  }

  /** Ends what is being done, with everything that was open, and starts anew. */
  async cancel() {
    this.worker.terminate();
    this.#end(new Cancelled());
    await this.start();
  }

  #end(error) {
    const waiting = [...this.#waiting.values()];
    this.#waiting.clear();
    for (const { failed } of waiting) failed(error);
  }

  #post(what, given) {
    const id = ++this.#last;
    return new Promise((done, failed) => {
      this.#waiting.set(id, { done, failed });
      this.worker.postMessage({ id, what, given });
    });
  }
}
