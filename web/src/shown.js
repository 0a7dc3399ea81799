// One character on the page: read by three and three-vrm as any viewer reads it, and renewed in place while a slider moves.
import { Box3, BufferAttribute, Matrix4, Quaternion, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { VRMLoaderPlugin, VRMUtils } from '@pixiv/three-vrm';
import { Figure, LIMB_ROLES } from './poses.js';

const loader = new GLTFLoader();
loader.register((parser) => new VRMLoaderPlugin(parser));

const ARRAYS = { 5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array };
const COUNTS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };
/** Names of shapes in files that have no expressions of their own. */
const SHAPES = { blink: /^(blink|eyes?_?closed?|vrc\.blink|fcl_eye_close|まばたき)$/i, aa: /^(aa?|vrc\.v_aa|mouth_?open|jaw_?open|fcl_mth_a|あ)$/i };

/** The JSON of a GLB and its binary, which begins where numbers may. */
function parts(given) {
  const bytes = given.byteOffset % 4 ? given.slice() : given;
  const view = new DataView(bytes.buffer, bytes.byteOffset);
  const size = view.getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + size)));
  return { json, binary: bytes.subarray(28 + size) };
}

/** The numbers of an accessor, packed; null for what is stored in another way. */
function numbers({ json, binary }, index) {
  const accessor = json.accessors[index];
  const view = json.bufferViews[accessor.bufferView];
  if (!view || accessor.sparse) return null;
  const [Array, items] = [ARRAYS[accessor.componentType], COUNTS[accessor.type]];
  const size = Array.BYTES_PER_ELEMENT;
  const from = (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
  const step = (view.byteStride ?? items * size) / size;
  const found = new Array(binary.buffer, binary.byteOffset + from, step * (accessor.count - 1) + items);
  if (step === items) return { array: found.slice(), items, normalized: accessor.normalized ?? false };
  const array = new Array(items * accessor.count);
  for (let to = 0, at = 0; to < array.length; at += step - items) {
    for (let item = 0; item < items; item++) array[to++] = found[at++];
  }
  return { array, items, normalized: accessor.normalized ?? false };
}

/** Puts numbers where the old ones are drawn from. */
function renewAttribute(geometry, name, found) {
  const old = geometry.attributes[name];
  if (!old || !found) return;
  if (!old.isInterleavedBufferAttribute && old.array.constructor === found.array.constructor && old.array.length === found.array.length) {
    old.array.set(found.array);
    old.needsUpdate = true;
  } else {
    geometry.setAttribute(name, new BufferAttribute(found.array, found.items, found.normalized));
  }
}

export class Shown {
  /** `about`: what the library knows of the character. */
  static async read(bytes, about) {
    const shown = new Shown();
    const gltf = await loader.parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), '');
    const vrm = gltf.userData.vrm;
    Object.assign(shown, { gltf, vrm, about, root: vrm?.scene ?? gltf.scene, pose: 'rest', time: 0 });
    if (vrm) {
      VRMUtils.rotateVRM0(vrm);
      // Poses turn the file's own bones.
      vrm.humanoid.autoUpdateHumanBones = false;
    }
    shown.root.traverse((node) => {
      node.frustumCulled = false;
      // Metal shows nothing but what is around it, and here is nothing.
      for (const material of [node.material ?? []].flat()) if (material.metalness) material.metalness = 0;
    });
    shown.bones = shown.#bones();
    shown.figure = new Figure(shown.bones, shown.root);
    shown.shapes = shown.#shapes();
    return shown;
  }

  get hasSprings() {
    return (this.vrm?.springBoneManager?.joints.size ?? 0) > 0;
  }

  /** Which of blinking and the mouth can be shown. */
  has(expression) {
    return this.vrm?.expressionManager?.getExpression(expression) ? true : this.shapes[expression].length > 0;
  }

  #bones() {
    const { associations, json } = this.gltf.parser;
    const [byIndex, byName] = [new Map(), new Map()];
    for (const [node, { nodes }] of associations) {
      if (nodes === undefined || !node.isObject3D) continue;
      byIndex.set(nodes, node);
      byName.set(json.nodes[nodes].name, node);
    }
    const bones = {};
    for (const role of LIMB_ROLES) {
      const joint = this.about.joints[role];
      const node = joint && (byIndex.get(joint.node) ?? byName.get(joint.name));
      if (node) bones[role] = node;
    }
    return bones;
  }

  #shapes() {
    const shapes = { blink: [], aa: [] };
    this.root.traverse((mesh) => {
      for (const [name, index] of Object.entries(mesh.morphTargetDictionary ?? {})) {
        for (const [shape, pattern] of Object.entries(SHAPES)) if (pattern.test(name)) shapes[shape].push({ mesh, index });
      }
    });
    return shapes;
  }

  take(pose, time) {
    this.pose = pose;
    this.time = time;
    this.figure.take(pose, time);
  }

  /** `weights`: { blink, aa }, 0 to 1. */
  express(weights) {
    for (const [name, weight] of Object.entries(weights)) {
      this.vrm?.expressionManager?.setValue(name, weight);
      if (!this.vrm) for (const { mesh, index } of this.shapes[name]) mesh.morphTargetInfluences[index] = weight;
    }
    this.vrm?.expressionManager?.update();
  }

  /** Springs and what else lives in a VRM, so many seconds on. */
  live(seconds) {
    this.vrm?.update(seconds);
  }

  /** Springs as they hang at rest. */
  settle() {
    this.root.updateMatrixWorld(true);
    this.vrm?.springBoneManager?.reset();
  }

  /** Takes vertices and joints of a file of the same character: no textures, no materials, nothing parsed but its JSON. */
  renew(bytes) {
    const file = parts(bytes);
    const { associations } = this.gltf.parser;
    const done = new Set();
    this.figure.take('rest', 0);
    for (const [object, at] of associations) {
      if (!object.isObject3D) continue;
      if (object.isMesh && at.meshes !== undefined && !done.has(object.geometry)) {
        done.add(object.geometry);
        this.#renewMesh(file, object, at);
      }
      if (at.nodes !== undefined) this.#renewNode(file.json.nodes[at.nodes], object);
    }
    this.root.traverse((mesh) => mesh.isSkinnedMesh && this.#renewSkin(file, mesh, done));
    this.figure = new Figure(this.bones, this.root);
    this.take(this.pose, this.time);
  }

  #renewMesh(file, object, at) {
    const primitive = file.json.meshes[at.meshes].primitives[at.primitives ?? 0];
    for (const [key, name] of [['POSITION', 'position'], ['NORMAL', 'normal'], ['TANGENT', 'tangent']]) {
      const accessor = primitive.attributes[key];
      if (accessor !== undefined) renewAttribute(object.geometry, name, numbers(file, accessor));
    }
  }

  #renewNode(node, object) {
    if (node.matrix) new Matrix4().fromArray(node.matrix).decompose(object.position, new Quaternion(), new Vector3());
    else if (node.translation) object.position.fromArray(node.translation);
  }

  #renewSkin(file, mesh, done) {
    if (done.has(mesh.skeleton)) return;
    done.add(mesh.skeleton);
    const { associations } = this.gltf.parser;
    let holder = mesh;
    while (holder && associations.get(holder)?.nodes === undefined) holder = holder.parent;
    const skin = file.json.skins?.[file.json.nodes[associations.get(holder)?.nodes]?.skin];
    const matrices = skin?.inverseBindMatrices !== undefined && numbers(file, skin.inverseBindMatrices);
    if (matrices) mesh.skeleton.boneInverses.forEach((inverse, joint) => inverse.fromArray(matrices.array, 16 * joint));
  }

  /** The box around it as it stands. */
  box() {
    this.root.updateMatrixWorld(true);
    return new Box3().setFromObject(this.root, true);
  }

  dispose() {
    this.root.removeFromParent();
    VRMUtils.deepDispose(this.root);
  }
}
