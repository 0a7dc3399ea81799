// One character on the page: read by three and three-vrm as any viewer reads it, and renewed in place while a slider moves.
import { Box3, BufferAttribute, Matrix4, Quaternion, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { VRMLoaderPlugin, VRMUtils } from '@pixiv/three-vrm';
import { Figure, LIMB_ROLES } from './poses.js';

const loader = new GLTFLoader();
loader.register((parser) => new VRMLoaderPlugin(parser));

const COUNTS = { VEC3: 3, VEC4: 4, MAT4: 16 };
/** Names of shapes in files that have no expressions of their own. */
const SHAPES = { blink: /^(blink|eyes?_?closed?|vrc\.blink|fcl_eye_close|まばたき)$/i, aa: /^(aa?|vrc\.v_aa|mouth_?open|jaw_?open|fcl_mth_a|あ)$/i };

/** The JSON of a glimpse and its binary. */
function parts(bytes) {
  const size = new DataView(bytes.buffer, bytes.byteOffset).getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + size)));
  return { json, binary: bytes.subarray(28 + size) };
}

/** The numbers of an accessor of a glimpse, which are packed floats. */
function numbers({ json, binary }, index) {
  const { bufferView, count, type } = json.accessors[index];
  const items = COUNTS[type];
  const from = binary.byteOffset + json.bufferViews[bufferView].byteOffset;
  return { array: new Float32Array(binary.buffer, from, items * count), items };
}

/** Puts numbers where the old ones are drawn from. */
function renewAttribute(geometry, name, { array, items }) {
  const old = geometry.attributes[name];
  if (!old) return;
  if (!old.isInterleavedBufferAttribute && old.array instanceof Float32Array && old.array.length === array.length) {
    old.array.set(array);
    old.needsUpdate = true;
  } else {
    geometry.setAttribute(name, new BufferAttribute(array.slice(), items));
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
    shown.joints = shown.#joints();
    shown.bones = Object.fromEntries(LIMB_ROLES.filter((role) => shown.joints[role]).map((role) => [role, shown.joints[role]]));
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

  /** The node of each humanoid role. */
  #joints() {
    const { associations, json } = this.gltf.parser;
    const [byIndex, byName] = [new Map(), new Map()];
    for (const [node, { nodes }] of associations) {
      if (nodes === undefined || !node.isObject3D) continue;
      byIndex.set(nodes, node);
      byName.set(json.nodes[nodes].name, node);
    }
    const found = Object.entries(this.about.joints).map(([role, joint]) => [role, byIndex.get(joint.node) ?? byName.get(joint.name)]);
    return Object.fromEntries(found.filter(([, node]) => node));
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

  /** Takes the vertices and joints of a glimpse of the same character. */
  renew(bytes) {
    const file = parts(bytes);
    const { associations } = this.gltf.parser;
    const springs = this.vrm?.springBoneManager;
    const done = new Set();
    this.figure.take('rest', 0);
    springs?.reset();
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
    // They keep where their bones rest.
    springs?.setInitState();
    this.take(this.pose, this.time);
    this.settle();
  }

  /** What a glimpse says of the node that an object belongs to. */
  #nodeOf(file, object) {
    const { associations } = this.gltf.parser;
    let holder = object;
    while (holder && associations.get(holder)?.nodes === undefined) holder = holder.parent;
    return file.json.nodes[associations.get(holder)?.nodes] ?? {};
  }

  #renewMesh(file, object, { primitives = 0 }) {
    // A mesh that two nodes show may be one in the file that is shown and two in the glimpse, and the other way round.
    const primitive = file.json.meshes[this.#nodeOf(file, object).mesh]?.primitives[primitives];
    for (const [key, name] of [['POSITION', 'position'], ['NORMAL', 'normal'], ['TANGENT', 'tangent']]) {
      const accessor = primitive?.attributes[key];
      if (accessor !== undefined) renewAttribute(object.geometry, name, numbers(file, accessor));
    }
  }

  #renewNode(node, object) {
    if (node.matrix) new Matrix4().fromArray(node.matrix).decompose(object.position, new Quaternion(), new Vector3());
    else object.position.fromArray(node.translation ?? [0, 0, 0]);
  }

  #renewSkin(file, mesh, done) {
    if (done.has(mesh.skeleton)) return;
    done.add(mesh.skeleton);
    const binds = file.json.skins[this.#nodeOf(file, mesh).skin]?.inverseBindMatrices;
    const matrices = binds !== undefined && numbers(file, binds).array;
    mesh.skeleton.boneInverses.forEach((inverse, joint) => (matrices ? inverse.fromArray(matrices, 16 * joint) : inverse.identity()));
  }

  /** The middle between its feet; null where it has none. */
  standsAt() {
    this.root.updateMatrixWorld(true);
    const [left, right] = ['leftFoot', 'rightFoot'].map((role) => this.bones[role]?.getWorldPosition(new Vector3()));
    return left && right ? left.lerp(right, 0.5) : null;
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
