// The engine in a worker: one question after another.
import { Engine } from './engine.js';

let engine;

const asked = {
  start: async ({ module, warmUp }) => {
    engine = await Engine.start(module, (share) => postMessage({ share }));
    if (warmUp) setTimeout(run, 0, module, warmUp);
    return { options: (await engine.ask({ do: 'options' })).options };
  },
  ask: ({ question, files }) => engine.ask(question, files),
  memory: () => ({ memory: engine.memory }),
};

/** Browsers make code fast that has run before, so a small figure goes through it while the user looks for a file. */
async function run(module, file) {
  try {
    const first = await Engine.start(module);
    const steps = [{ do: 'open' }, { do: 'set', style: { heads: 3 } }, { do: 'set', style: { heads: 2.5 } }, { do: 'glimpse' }, { do: 'write' }];
    for (const step of steps) {
      await first.ask(step, step.do === 'open' ? [file] : []);
      // The user's own questions come between.
      await new Promise((done) => setTimeout(done, 0));
    }
  } catch {
    // What fails here fails where somebody asks for it, and says so there.
  }
}

onmessage = async ({ data: { id, what, given } }) => {
  try {
    const answer = await asked[what](given);
    postMessage({ id, answer }, (answer.files ?? []).map(({ bytes }) => bytes.buffer));
  } catch (error) {
    postMessage({ id, error: { name: error.name, message: error.message, option: error.option } });
  }
};
