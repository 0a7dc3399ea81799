// Poses of a humanoid, whatever its bones are called and however they are turned: where limbs point, in the character's own
// directions (x: its left, y: up, z: forward), and turns of other bones.
import { Matrix4, Quaternion, Vector3 } from 'three';

const CHAINS = ['UpperArm', 'LowerArm', 'Hand', 'UpperLeg', 'LowerLeg', 'Foot'];
/** Each limb's bone and the one at its end. */
const LIMBS = [['UpperArm', 'LowerArm'], ['LowerArm', 'Hand'], ['UpperLeg', 'LowerLeg'], ['LowerLeg', 'Foot']];

const mirrored = ([x, y, z]) => [-x, y, z];
const both = (limbs) => ({ left: limbs, right: Object.fromEntries(Object.entries(limbs).map(([k, v]) => [k, mirrored(v)])) });
const swing = (angle, side = 0) => [side, -Math.cos(angle), Math.sin(angle)];

/** Where limbs point at a time (seconds); what is not named stays as it rests. */
export const POSES = {
  rest: () => ({ left: {}, right: {} }),
  t: () => both({ UpperArm: [1, 0, 0], LowerArm: [1, 0, 0] }),
  a: () => both({ UpperArm: [0.7, -0.7, 0], LowerArm: [0.7, -0.7, 0] }),
  walk: (time) => {
    const phase = Math.sin(time * 5);
    const side = (sign, x) => ({
      UpperLeg: swing(0.5 * sign * phase),
      LowerLeg: swing(0.5 * sign * phase - 0.35 - 0.35 * Math.max(0, -sign * Math.cos(time * 5))),
      UpperArm: swing(-0.5 * sign * phase, 0.35 * x),
      LowerArm: swing(-0.5 * sign * phase + 0.35, 0.2 * x),
    });
    return { left: side(1, 1), right: side(-1, -1) };
  },
  sit: () => both({ UpperLeg: [0.12, -0.1, 1], LowerLeg: [0.02, -1, 0.05], UpperArm: [0.3, -0.9, 0.25], LowerArm: [0.05, -0.6, 0.8] }),
};

const isWithin = (node, above) => !!node && (node.parent === above || isWithin(node.parent, above));

/** The bones of one shown character, as it rests. */
export class Figure {
  /** `bones`: the node of each humanoid role; `root`: what they are in. */
  constructor(bones, root) {
    this.root = root;
    root.updateMatrixWorld(true);
    const toRoot = new Matrix4().copy(root.matrixWorld).invert();
    this.bones = new Map();
    for (const [role, node] of Object.entries(bones)) {
      const matrix = new Matrix4().multiplyMatrices(toRoot, node.matrixWorld);
      const turn = new Quaternion().setFromRotationMatrix(new Matrix4().extractRotation(matrix));
      this.bones.set(role, { node, local: node.quaternion.clone(), place: node.position.clone(), matrix, turn, at: new Vector3().setFromMatrixPosition(matrix) });
    }
    this.axes = this.#axes();
  }

  /** From the character's directions to the root's. */
  #axes() {
    const [left, right] = ['leftUpperLeg', 'rightUpperLeg'].map((role) => this.bones.get(role)?.at);
    const up = new Vector3(0, 1, 0);
    const x = left && right ? left.clone().sub(right).setY(0) : new Vector3(1, 0, 0);
    if (x.lengthSq() === 0) x.set(1, 0, 0);
    x.normalize();
    return new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(x, up, new Vector3().crossVectors(x, up)));
  }

  /** Takes a pose; feet stay on the ground. */
  take(pose, time) {
    const wanted = POSES[pose](time);
    for (const { node, local, place } of this.bones.values()) {
      node.quaternion.copy(local);
      node.position.copy(place);
    }
    for (const side of ['left', 'right']) {
      // What the bones above have turned, in the root's directions.
      let above = new Quaternion();
      for (const [bone, end] of LIMBS) {
        if (bone === 'UpperLeg') above = new Quaternion();
        const [own, next] = [this.bones.get(side + bone), this.bones.get(side + end)];
        const direction = wanted[side][bone];
        if (!own || !next || !direction) continue;
        const rests = next.at.clone().sub(own.at).normalize();
        const points = new Vector3(...direction).normalize().applyQuaternion(this.axes);
        const turn = new Quaternion().setFromUnitVectors(rests, points.applyQuaternion(above.clone().invert()));
        const inRest = own.turn.clone().invert().multiply(turn).multiply(own.turn);
        own.node.quaternion.copy(own.local).multiply(inRest);
        above.multiply(turn);
      }
    }
    this.root.position.y = 0;
    if (pose !== 'rest') for (const side of ['left', 'right']) this.#carryFoot(side);
    if (pose === 'walk' || pose === 'sit') this.root.position.y = this.#lift();
  }

  /** Rigs that are animated by targets hang feet elsewhere than on the leg: there they go where the leg goes. */
  #carryFoot(side) {
    const [leg, foot] = ['LowerLeg', 'Foot'].map((bone) => this.bones.get(side + bone));
    if (!leg || !foot || isWithin(foot.node, leg.node)) return;
    this.root.updateMatrixWorld(true);
    const carried = new Matrix4().copy(leg.node.matrixWorld).multiply(leg.matrix.clone().invert()).multiply(foot.matrix);
    carried.premultiply(foot.node.parent.matrixWorld.clone().invert());
    carried.decompose(foot.node.position, foot.node.quaternion, new Vector3());
  }

  /** How far the figure must rise for its lower foot to be where it rests. */
  #lift() {
    this.root.updateMatrixWorld(true);
    const feet = ['leftFoot', 'rightFoot'].map((role) => this.bones.get(role)).filter(Boolean);
    const lifts = feet.map(({ node, at }) => at.y * this.root.scale.y - new Vector3().setFromMatrixPosition(node.matrixWorld).y);
    return lifts.length ? Math.max(...lifts) : 0;
  }
}

export const LIMB_ROLES = ['left', 'right'].flatMap((side) => CHAINS.map((bone) => side + bone));
