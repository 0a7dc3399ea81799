// The library in this thread: messages in, messages out (web/sdweb/src/message.rs), and a new instance after a fault.

const text = new TextDecoder();

/** What the library refused, in one sentence; `option` names what it is about. */
export class Refused extends Error {
  constructor({ error, option }) {
    super(error);
    this.name = 'Refused';
    this.option = option ?? null;
  }
}

/** A fault of the library. The engine goes on with nothing open. */
export class Fault extends Error {
  constructor(sentence) {
    super(sentence);
    this.name = 'Fault';
  }
}

export class Engine {
  /** `module`: the compiled WebAssembly; `progress` is told shares of the work, 0 to 1. */
  static async start(module, progress = () => {}) {
    const engine = new Engine();
    engine.module = module;
    engine.imports = { superdeform: { progress } };
    await engine.restart();
    return engine;
  }

  async restart() {
    this.exports = (await WebAssembly.instantiate(this.module, this.imports)).exports;
  }

  /** The bytes that the library holds in memory. */
  get memory() {
    return this.exports.memory.buffer.byteLength;
  }

  /**
   * Asks `question`, an object with `do`, about `files` ({ name, bytes }): gives the answer's object, in its `files` copies
   * of the files in it.
   */
  async ask(question, files = []) {
    try {
      return this.#answered(question, files);
    } catch (error) {
      if (error instanceof Refused) throw error;
      const sentence = this.#fault(error);
      await this.restart();
      throw new Fault(sentence);
    }
  }

  #answered(question, files) {
    const { exports } = this;
    const listed = files.map(({ name, bytes }) => ({ name, size: bytes.length }));
    const json = new TextEncoder().encode(JSON.stringify({ ...question, files: listed }));
    const size = files.reduce((sum, { bytes }) => sum + bytes.length, 4 + json.length);
    const at = exports.sd_room(size) >>> 0;
    const room = new Uint8Array(exports.memory.buffer, at, size);
    new DataView(room.buffer, at).setUint32(0, json.length, true);
    room.set(json, 4);
    let next = 4 + json.length;
    for (const { bytes } of files) {
      room.set(bytes, next);
      next += bytes.length;
    }
    exports.sd_call();
    return this.#read();
  }

  #read() {
    const { exports } = this;
    const answer = new Uint8Array(exports.memory.buffer, exports.sd_answer() >>> 0, exports.sd_answer_size());
    const size = new DataView(answer.buffer, answer.byteOffset).getUint32(0, true);
    const json = JSON.parse(text.decode(answer.subarray(4, 4 + size)));
    if (json.error) throw new Refused(json);
    let next = 4 + size;
    json.files = (json.files ?? []).map(({ name, size: bytes }) => {
      next += bytes;
      return { name, bytes: answer.slice(next - bytes, next) };
    });
    return json;
  }

  /** What the library said before it stopped; without a sentence, it had no memory left. */
  #fault(error) {
    if (!(error instanceof WebAssembly.RuntimeError || error instanceof RangeError)) return error.message;
    const { exports } = this;
    const said = text.decode(new Uint8Array(exports.memory.buffer, exports.sd_fault() >>> 0, exports.sd_fault_size()));
    return said || `the library stopped (${error.message}); most likely it needs more memory than there is`;
  }
}
