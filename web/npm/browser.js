// For browsers: the library is fetched from beside this file, unless `load` was given it.
import { of } from './superdeform.js';

export const { superdeform, load } = of(async () => {
  const answer = await fetch(new URL('./superdeform.wasm', import.meta.url));
  if (!answer.ok) throw new Error(`superdeform.wasm: ${answer.status}; give it to load()`);
  return WebAssembly.compile(await answer.arrayBuffer());
});
export { Fault, Refused } from './superdeform.js';
export default superdeform;
