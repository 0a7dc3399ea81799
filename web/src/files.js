// Files that are dropped or chosen, and files that are saved.

/** A page cannot hold more: the library needs a file some four times, and 4 GB is all that WebAssembly has. */
export const MOST_BYTES = 512e6;
const MODEL = /\.(vrm|glb|gltf)$/i;

/** All files of a drop, those in folders too, by their paths. */
export async function dropped(transfer) {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
  if (!entries.length) return [...transfer.files].map((file) => ({ name: file.name, file }));
  return (await Promise.all(entries.map((entry) => under(entry)))).flat();
}

async function under(entry) {
  if (entry.isFile) {
    const file = await new Promise((done, failed) => entry.file(done, failed));
    return [{ name: entry.fullPath.replace(/^\//, ''), file }];
  }
  const reader = entry.createReader();
  const inside = [];
  for (;;) {
    // A reader gives a hundred at a time.
    const some = await new Promise((done, failed) => reader.readEntries(done, failed));
    if (!some.length) break;
    inside.push(...some);
  }
  return (await Promise.all(inside.map(under))).flat();
}

/** The model first, then what may lie beside it; what is no model stays first where there is none. */
export function ordered(files) {
  const model = files.find(({ name }) => MODEL.test(name));
  return model ? [model, ...files.filter((file) => file !== model)] : files;
}

export const isModel = ({ name }) => MODEL.test(name);

export async function read({ name, file }) {
  return { name, bytes: new Uint8Array(await file.arrayBuffer()) };
}

/** Gives a file to the user. */
export function save(name, blob) {
  const address = URL.createObjectURL(blob);
  const link = Object.assign(document.createElement('a'), { href: address, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 60e3);
}
