// For node: the library lies beside this file.
import { readFile } from 'node:fs/promises';
import { of } from './superdeform.js';

export const { superdeform, load } = of(async () => WebAssembly.compile(await readFile(new URL('./superdeform.wasm', import.meta.url))));
export { Fault, Refused } from './superdeform.js';
export default superdeform;
