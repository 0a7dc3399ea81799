// What node and browsers share: bytes in, bytes out.
import { Engine } from './engine.js';

export { Fault, Refused } from './engine.js';

/** The options of this package; all others are the library's own. */
const OWN = ['heads', 'style', 'reference', 'name', 'files', 'allowProhibited', 'leafJoints', 'legColliders', 'evenEyes'];

function styleOf({ heads, style, reference }) {
  if (reference) return { reference: true };
  if (heads !== undefined) return { heads };
  return typeof style === 'object' ? { json: JSON.stringify(style) } : { built_in: style ?? 'sd2.5' };
}

const named = (files) => Object.entries(files ?? {}).map(([name, bytes]) => ({ name, bytes }));

/** `compile`: gives the compiled WebAssembly where nobody has given one. */
export function of(compile) {
  let module;
  const load = (source) => (module = WebAssembly.compile(source));
  const superdeform = async (bytes, options = {}) => {
    module ??= compile();
    // An engine of its own: calls may run beside each other, and a fault of one ends no other.
    const engine = await Engine.start(await module);
    const name = options.name ?? 'character.glb';
    const rest = Object.fromEntries(Object.entries(options).filter(([key]) => !OWN.includes(key)));
    const open = { do: 'open', allow_prohibited: options.allowProhibited === true, leg_colliders: options.legColliders === true };
    await engine.ask(open, [{ name, bytes }, ...named(options.files)]);
    if (options.reference) await engine.ask({ do: 'reference' }, [{ name: 'reference.glb', bytes: options.reference }]);
    await engine.ask({ do: 'set', style: styleOf(options), options: rest });
    const write = { do: 'write', name: name.replace(/\.gltf$/i, '.glb'), by_reference: !!options.reference, leaf_joints: options.leafJoints === true, even_eyes: options.evenEyes };
    const { report, files } = await engine.ask(write);
    return { bytes: files[0].bytes, report: JSON.parse(report) };
  };
  return { superdeform, load };
}
