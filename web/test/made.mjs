// Files that tests make of a GLB.

/** The JSON of a GLB and its binary. */
export function parts(file) {
  const size = file.readUInt32LE(12);
  return { json: JSON.parse(file.subarray(20, 20 + size)), binary: file.subarray(28 + size) };
}

/** A GLB of JSON and binary. */
export function glb({ json, binary }) {
  json.buffers[0].byteLength = binary.length;
  let text = Buffer.from(JSON.stringify(json));
  text = Buffer.concat([text, Buffer.alloc((4 - (text.length % 4)) % 4, ' ')]);
  const tail = Buffer.alloc((4 - (binary.length % 4)) % 4);
  const head = Buffer.alloc(28);
  head.write('glTF');
  head.writeUInt32LE(2, 4);
  head.writeUInt32LE(28 + text.length + binary.length + tail.length, 8);
  head.writeUInt32LE(text.length, 12);
  head.write('JSON', 16);
  head.writeUInt32LE(binary.length + tail.length, 20);
  head.write('BIN\0', 24);
  return Buffer.concat([head.subarray(0, 20), text, head.subarray(20), binary, tail]);
}

/** As a .gltf with its buffer beside it: [JSON, binary]. */
export function beside(file, name) {
  const { json, binary } = parts(file);
  json.buffers[0].uri = name;
  return [Buffer.from(JSON.stringify(json)), binary];
}

/** With a licence in its own words. */
export function licensed(file, licence) {
  const { json, binary } = parts(file);
  json.asset.extras = { license: licence };
  return glb({ json, binary });
}

/** With so many morph targets more on every mesh, called by `name(index)`, each a wave of `size` units. */
export function withShapes(file, count, name, size) {
  const { json, binary } = parts(file);
  const blocks = [binary, Buffer.alloc((4 - (binary.length % 4)) % 4)];
  let at = blocks[0].length + blocks[1].length;
  const shape = (vertices, index) => {
    const deltas = Float32Array.from({ length: 3 * vertices }, (_, i) => (i % 3 === 1 ? size * Math.sin(0.01 * i + index) : 0));
    const block = Buffer.from(deltas.buffer);
    const bounds = { min: [0, -size, 0], max: [0, size, 0] };
    json.bufferViews.push({ buffer: 0, byteOffset: at, byteLength: block.length });
    json.accessors.push({ bufferView: json.bufferViews.length - 1, componentType: 5126, count: vertices, type: 'VEC3', ...bounds });
    blocks.push(block);
    at += block.length;
    return { POSITION: json.accessors.length - 1 };
  };
  for (const mesh of json.meshes) {
    for (const primitive of mesh.primitives) {
      const { count: vertices } = json.accessors[primitive.attributes.POSITION];
      primitive.targets = Array.from({ length: count }, (_, index) => shape(vertices, index));
    }
    mesh.weights = Array(count).fill(0);
    mesh.extras = { ...mesh.extras, targetNames: Array.from({ length: count }, (_, index) => name(index)) };
  }
  return glb({ json, binary: Buffer.concat(blocks) });
}
