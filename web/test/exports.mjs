// Which functions of the C interface a WebAssembly library exports: node exports.mjs LIBRARY HEADER
import fs from 'node:fs';

const [library, header] = process.argv.slice(2);
const declared = [...fs.readFileSync(header, 'utf8').matchAll(/^SDEF_API .*?\b(sdef_\w+)\(/gm)].map(([, name]) => name).sort();
const module = await WebAssembly.compile(fs.readFileSync(library));
const exported = WebAssembly.Module.exports(module).filter(({ kind }) => kind === 'function').map(({ name }) => name).sort();
const missing = declared.filter((name) => !exported.includes(name));
const more = exported.filter((name) => !declared.includes(name));
if (missing.length) console.log(`not exported: ${missing.join(', ')}`);
if (more.length) console.log(`not in the header: ${more.join(', ')}`);

// They can be called, too: what needs no structs.
const { exports } = await WebAssembly.instantiate(module, {});
const text = (at) => {
  const bytes = new Uint8Array(exports.memory.buffer, at);
  return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
};
const version = text(exports.sdef_version());
const answers = exports.sdef_abi_version() === 1 && /^\d+\.\d+\.\d+/.test(version) && text(exports.sdef_status_name(9)) === 'SDEF_STATUS_BUSY';
if (!answers) console.log(`version ${version}, ABI ${exports.sdef_abi_version()}: no answers of the library`);
console.log(`${exported.length} functions, ${declared.length} in the header; version ${version}`);
const checks = [declared.length > 0 && missing.length === 0, more.length === 0, answers];
console.log(`${checks.filter(Boolean).length} passed, ${checks.filter((holds) => !holds).length} failed`);
process.exit(checks.every(Boolean) ? 0 : 1);
