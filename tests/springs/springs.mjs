// Springs in three-vrm, before and after a conversion: at rest, and three seconds of each of five motions after one of rest.
//
//     node tests/springs/springs.mjs BEFORE.vrm AFTER.vrm...
//
// Needs three and @pixiv/three-vrm in ./node_modules, or in the folder that NODE_MODULES names. Prints a table:
// joints, the greatest and the mean swing in degrees, how deep tips are in their colliders (% of the height) and in how many
// of all joints and frames, and the share of cloth vertices inside the body where meshes are called so (cloth, skirt, dress;
// body), the mean of six frames. Exits with 1 where a figure of a result is more than 1.15 times the source's, beyond what
// one tip or one vertex makes.
import { readFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
import path from 'node:path';

const folder = path.resolve(process.env.NODE_MODULES ?? 'node_modules');
const load = (file) => import(pathToFileURL(path.join(folder, file)));
globalThis.self ??= globalThis;
const THREE = await load('three/build/three.module.js');
const { GLTFLoader } = await load('three/examples/jsm/loaders/GLTFLoader.js');
const { VRMLoaderPlugin } = await load('@pixiv/three-vrm/lib/three-vrm.module.js');

const WORST = 1.15;
const STEP = 1 / 60;

/** The file without pictures and materials, which need a browser. */
function bare(file) {
    const bytes = readFileSync(file);
    const length = bytes.readUInt32LE(12);
    const json = JSON.parse(bytes.subarray(20, 20 + length).toString());
    for (const key of ['images', 'textures', 'samplers', 'materials', 'animations', 'extensionsRequired']) delete json[key];
    json.extensionsUsed = (json.extensionsUsed ?? []).filter((name) => /^VRM(C_vrm|C_springBone.*|C_node.*)?$/.test(name));
    for (const mesh of json.meshes) for (const primitive of mesh.primitives) { delete primitive.material; delete primitive.extensions; }
    const vrm0 = json.extensions?.VRM;
    if (vrm0) { delete vrm0.materialProperties; delete vrm0.meta?.texture; }
    if (json.extensions?.VRMC_vrm?.meta) delete json.extensions.VRMC_vrm.meta.thumbnailImage;
    let text = Buffer.from(JSON.stringify(json));
    text = Buffer.concat([text, Buffer.alloc((4 - (text.length % 4)) % 4, 32)]);
    const rest = bytes.subarray(20 + length);
    const head = Buffer.alloc(20);
    head.write('glTF');
    [2, 20 + text.length + rest.length, text.length, 0x4e4f534a].forEach((number, index) => head.writeUInt32LE(number, 4 + 4 * index));
    const all = Buffer.concat([head, text, rest]);
    return all.buffer.slice(all.byteOffset, all.byteOffset + all.length);
}

async function read(file) {
    const loader = new GLTFLoader();
    loader.register((parser) => new VRMLoaderPlugin(parser));
    const gltf = await loader.parseAsync(bare(file), '');
    const vrm = gltf.userData.vrm;
    vrm.scene.updateMatrixWorld(true);
    return vrm;
}

/** Legs swing by so many radians, so many times a second, and the knee that is behind bends by a part of that. */
function stride(bone, t, reach, tempo, knee) {
    const swing = reach * Math.sin(2 * Math.PI * tempo * t);
    bone('leftUpperLeg')?.rotation.set(-swing, 0, 0);
    bone('rightUpperLeg')?.rotation.set(swing, 0, 0);
    bone('leftLowerLeg')?.rotation.set(knee * Math.max(0, -swing), 0, 0);
    bone('rightLowerLeg')?.rotation.set(knee * Math.max(0, swing), 0, 0);
}

const MOTIONS = {
    rest() {},
    /** Legs by 20 degrees, once a second. */
    walk(bone, t) {
        stride(bone, t, 0.35, 1, 0.5);
    },
    /** Legs by 35 degrees, one and a half times a second, knees by as much; the hips turn against the chest. */
    run(bone, t) {
        stride(bone, t, 0.6, 1.5, 1);
        const turn = 0.15 * Math.sin(3 * Math.PI * t);
        bone('hips')?.rotation.set(0, turn, 0);
        bone('spine')?.rotation.set(0, -2 * turn, 0);
    },
    /** Legs by 52 degrees, 2.2 times a second, as in a real run. */
    sprint(bone, t) {
        stride(bone, t, 0.9, 2.2, 1);
    },
    /** The head by 40 degrees from side to side, one and a half times a second. */
    shake(bone, t) {
        bone('head')?.rotation.set(0, 0.7 * Math.sin(3 * Math.PI * t), 0);
    },
    /** The head nods by 25 degrees, twice a second, and the body turns by 45 degrees and back in two seconds. */
    nod(bone, t) {
        bone('head')?.rotation.set(0.44 * Math.sin(4 * Math.PI * t), 0, 0);
        bone('hips')?.rotation.set(0, 0.79 * Math.sin(Math.PI * t), 0);
    },
};

function skinned(mesh) {
    const points = [];
    const p = new THREE.Vector3();
    for (let vertex = 0; vertex < mesh.geometry.attributes.position.count; vertex++) {
        mesh.getVertexPosition(vertex, p);
        points.push(p.clone().applyMatrix4(mesh.matrixWorld));
    }
    return points;
}

/** Triangles of what is called so, as flat numbers. */
function triangles(meshes) {
    const flat = [];
    for (const mesh of meshes) {
        const points = skinned(mesh);
        for (const vertex of mesh.geometry.index.array) flat.push(...points[vertex].toArray());
    }
    return Float64Array.from(flat);
}

/** van Oosterom and Strackee, 1983. */
function winding(flat, p) {
    let sum = 0;
    for (let i = 0; i < flat.length; i += 9) {
        const [ax, ay, az] = [flat[i] - p.x, flat[i + 1] - p.y, flat[i + 2] - p.z];
        const [bx, by, bz] = [flat[i + 3] - p.x, flat[i + 4] - p.y, flat[i + 5] - p.z];
        const [cx, cy, cz] = [flat[i + 6] - p.x, flat[i + 7] - p.y, flat[i + 8] - p.z];
        const [a, b, c] = [Math.hypot(ax, ay, az), Math.hypot(bx, by, bz), Math.hypot(cx, cy, cz)];
        const volume = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
        const edges = a * b * c + (ax * bx + ay * by + az * bz) * c + (bx * cx + by * cy + bz * cz) * a + (cx * ax + cy * ay + cz * az) * b;
        sum += 2 * Math.atan2(volume, edges);
    }
    return sum / (4 * Math.PI);
}

function named(vrm, pattern) {
    const found = [];
    vrm.scene.traverse((object) => { if (object.isSkinnedMesh && pattern.test(`${object.name} ${object.parent?.name}`)) found.push(object); });
    return found;
}

function clothInside(vrm) {
    const cloth = named(vrm, /skirt|dress|cloth/i).filter((mesh) => !/tights/i.test(mesh.name));
    const body = named(vrm, /body/i);
    if (cloth.length === 0 || body.length === 0) return null;
    const flat = triangles(body);
    const points = cloth.flatMap(skinned);
    return points.filter((p) => winding(flat, p) > 0.5).length / points.length;
}

async function simulate(file, motion) {
    const vrm = await read(file);
    const height = new THREE.Box3().setFromObject(vrm.scene).getSize(new THREE.Vector3()).y;
    const joints = [...(vrm.springBoneManager?.joints ?? [])].filter((joint) => joint.child);
    const rest = new Map(joints.map((joint) => [joint, joint.bone.quaternion.clone()]));
    const bone = (name) => vrm.humanoid.getNormalizedBoneNode(name);
    const [tip, way] = [new THREE.Vector3(), new THREE.Vector3()];
    const figures = { joints: joints.length, swing: 0, mean: 0, deepest: 0, inside: 0, cloth: null };
    let [count, within, cloth, frames] = [0, 0, 0, 0];
    for (let frame = 0; frame < 240; frame++) {
        if (frame >= 60) MOTIONS[motion](bone, (frame - 60) * STEP);
        vrm.update(STEP);
        vrm.scene.updateMatrixWorld(true);
        if (frame < 60) continue;
        for (const joint of joints) {
            const swing = THREE.MathUtils.radToDeg(joint.bone.quaternion.angleTo(rest.get(joint)));
            figures.swing = Math.max(figures.swing, swing);
            figures.mean += swing;
            count += 1;
            tip.setFromMatrixPosition(joint.child.matrixWorld);
            let deepest = 0;
            for (const group of joint.colliderGroups) {
                for (const collider of group.colliders) {
                    const distance = collider.shape.calculateCollision(collider.colliderMatrix, tip, joint.settings.hitRadius, way);
                    deepest = Math.max(deepest, -distance / height);
                }
            }
            figures.deepest = Math.max(figures.deepest, deepest);
            within += deepest > 1e-3 ? 1 : 0;
        }
        if (frame % 30 === 0) {
            const share = clothInside(vrm);
            if (share !== null) { cloth += share; frames += 1; }
        }
    }
    figures.mean /= Math.max(1, count);
    figures.inside = within / Math.max(1, count);
    figures.cloth = frames > 0 ? cloth / frames : null;
    if (!Number.isFinite(figures.swing + figures.mean + figures.deepest)) throw new Error(`${file}: a spring is no number`);
    return figures;
}

const files = process.argv.slice(2);
if (files.length < 2) {
    console.error('give a VRM file and what was made of it: springs.mjs BEFORE.vrm AFTER.vrm...');
    process.exit(2);
}
console.log('| file | motion | joints | swing | mean | deepest, % H | inside, % | cloth inside, % |');
console.log('| --- | --- | --- | --- | --- | --- | --- | --- |');
let isWorse = false;
for (const motion of Object.keys(MOTIONS)) {
    let source = null;
    for (const file of files) {
        const figures = await simulate(file, motion);
        const { joints, swing, mean, deepest, inside, cloth } = figures;
        const numbers = [swing.toFixed(1), mean.toFixed(1), (100 * deepest).toFixed(2), (100 * inside).toFixed(1), cloth === null ? '-' : (100 * cloth).toFixed(1)];
        console.log(`| ${path.basename(file)} | ${motion} | ${joints} | ${numbers.join(' | ')} |`);
        source ??= figures;
        const worse = [
            ['swing', swing > WORST * source.swing + 1],
            ['deepest', deepest > WORST * source.deepest + 2e-3],
            ['inside', inside > WORST * source.inside + 5e-3],
            ['cloth', cloth !== null && cloth > WORST * source.cloth + 5e-3],
        ];
        for (const [what] of worse.filter(([, is]) => is)) {
            console.error(`${path.basename(file)}, ${motion}: ${what} is more than ${WORST} x the source's`);
            isWorse = true;
        }
    }
}
process.exit(isWorse ? 1 : 0);
