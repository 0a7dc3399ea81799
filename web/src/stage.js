// Two characters side by side, seen from the same place at the same scale.
import {
  CanvasTexture, CircleGeometry, Color, DirectionalLight, HemisphereLight, Mesh, MeshBasicMaterial, NeutralToneMapping,
  PerspectiveCamera, Scene, SphereGeometry, Vector2, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

/** A joint below this is drawn as doubted, as the command line draws it. */
const DOUBTED = 0.5;
/** Pixels at the top, and as many at the bottom, that the words above the figures need. */
const WORDS = 36;
/** Seconds that springs move on after something changed. */
const SETTLING = 1.5;

function half() {
  const scene = new Scene();
  scene.add(new HemisphereLight(0xffffff, 0xb4a8b4, 2.8));
  const sun = new DirectionalLight(0xffffff, 2.4);
  sun.position.set(1, 2, 3);
  scene.add(sun);
  const ground = new Mesh(new CircleGeometry(1, 48), new MeshBasicMaterial({ map: shade(), transparent: true, depthWrite: false }));
  ground.rotation.x = -Math.PI / 2;
  ground.visible = false;
  scene.add(ground);
  return { scene, ground, shown: null };
}

/** A soft spot of shade on the floor. */
function shade() {
  const canvas = Object.assign(document.createElement('canvas'), { width: 128, height: 128 });
  const context = canvas.getContext('2d');
  const fade = context.createRadialGradient(64, 64, 0, 64, 64, 64);
  fade.addColorStop(0, 'rgba(60, 45, 80, .38)');
  fade.addColorStop(0.5, 'rgba(60, 45, 80, .14)');
  fade.addColorStop(1, 'rgba(60, 45, 80, 0)');
  context.fillStyle = fade;
  context.fillRect(0, 0, 128, 128);
  return new CanvasTexture(canvas);
}

export class Stage {
  before = half();
  after = half();
  pose = 'a';
  springs = true;
  weights = { blink: 0, aa: 0 };
  #time = 0;
  #until = 0;
  #last = 0;
  #dirty = true;

  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    // What is white keeps its shape in a light that is right for what is dark.
    this.renderer.toneMapping = NeutralToneMapping;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.camera = new PerspectiveCamera(26, 1, 0.01, 1000);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enablePan = false;
    this.controls.addEventListener('change', () => (this.#dirty = true));
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
    const turn = (now) => {
      requestAnimationFrame(turn);
      this.#frame(now / 1000);
    };
    requestAnimationFrame(turn);
  }

  get halves() {
    return [this.before, this.after];
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / 2 / height;
    this.camera.updateProjectionMatrix();
    this.#dirty = true;
    if (this.before.shown && !this.#moved) this.frame();
  }

  /** Shows a character in `before` or `after`, or nothing. */
  show(side, shown) {
    const place = this[side];
    place.shown?.dispose();
    place.shown = shown;
    place.ground.visible = !!shown;
    if (!shown) return this.touch();
    place.scene.add(shown.root);
    shown.take(this.pose, this.#time);
    shown.express(this.weights);
    shown.settle();
    this.#floor(place);
    this.touch();
  }

  #floor(place) {
    const box = place.shown.box();
    const size = box.getSize(new Vector3());
    place.ground.scale.setScalar(Math.max(0.28 * size.y, 0.001));
    // Below the feet: what is carried may reach far aside.
    const middle = place.shown.standsAt() ?? box.getCenter(new Vector3());
    place.ground.position.set(middle.x, Math.max(box.min.y, 0) + 0.001 * size.y, middle.z);
  }

  /** New vertices and joints of the character after. */
  renew(bytes) {
    this.after.shown.renew(bytes);
    this.#dirty = true;
  }

  /** Joints of a new rig that are in doubt, on the character before. */
  drawDoubts() {
    const { shown } = this.before;
    const doubted = Object.entries(shown.about.joints).filter(([role, { confidence }]) => confidence < DOUBTED && shown.joints[role]);
    const size = 0.012 * shown.box().getSize(new Vector3()).y;
    const material = new MeshBasicMaterial({ color: 0xff7a1a, depthTest: false, transparent: true, opacity: 0.9 });
    for (const [role] of doubted) {
      const dot = new Mesh(new SphereGeometry(size, 16, 12), material);
      dot.renderOrder = 9;
      dot.position.copy(shown.joints[role].getWorldPosition(new Vector3()));
      // It goes where its joint goes, in its own size.
      shown.joints[role].attach(dot);
    }
    this.touch();
    return doubted.length;
  }

  /** Looks at both from the front, a little from the side. */
  frame() {
    const boxes = this.halves.filter(({ shown }) => shown).map(({ shown }) => shown.box());
    const size = boxes.reduce((most, box) => most.max(box.getSize(new Vector3())), new Vector3());
    const middle = boxes[0].getCenter(new Vector3());
    const tangent = Math.tan((this.camera.fov * Math.PI) / 360);
    const width = Math.hypot(size.x, 0.6 * size.z);
    const { clientHeight: height } = this.canvas.parentElement;
    const high = (size.y / 2 / tangent) * Math.max(1.16, height / Math.max(height - 2 * WORDS, 1));
    const distance = Math.max(high, (1.16 * (width / 2)) / (tangent * this.camera.aspect)) + size.z / 2;
    const target = new Vector3(0, boxes[0].min.y + size.y / 2, middle.z);
    this.controls.target.copy(target);
    this.camera.position.copy(target).add(new Vector3(0.3, 0.06, 0.95).normalize().multiplyScalar(distance));
    Object.assign(this.camera, { near: distance / 100, far: distance * 20 });
    this.camera.updateProjectionMatrix();
    this.controls.minDistance = distance / 12;
    this.controls.maxDistance = distance * 3;
    this.controls.update();
    this.#moved = false;
    this.#dirty = true;
  }

  #moved = false;

  /** Turns and zooms by keys: shares of a turn, and of the distance. */
  turn(across, nearer = 0) {
    const arm = this.camera.position.clone().sub(this.controls.target);
    arm.applyAxisAngle(new Vector3(0, 1, 0), across).multiplyScalar(1 - nearer);
    this.camera.position.copy(this.controls.target).add(arm);
    this.controls.update();
    this.#moved = true;
    this.#dirty = true;
  }

  takePose(pose) {
    this.pose = pose;
    this.#time = 0;
    this.touch();
  }

  express(weights) {
    Object.assign(this.weights, weights);
    for (const { shown } of this.halves) shown?.express(this.weights);
    this.#dirty = true;
  }

  /** Something changed: springs move for a while. */
  touch() {
    this.#until = performance.now() / 1000 + SETTLING;
    for (const { shown } of this.halves) shown?.take(this.pose, this.#time);
    this.#dirty = true;
  }

  #frame(now) {
    const passed = Math.min(now - this.#last, 0.1);
    this.#last = now;
    const walks = this.pose === 'walk' && this.halves.some(({ shown }) => shown);
    if (walks) {
      this.#time += passed;
      for (const { shown } of this.halves) shown?.take('walk', this.#time);
    }
    const lives = this.springs && (walks || now < this.#until) && this.halves.some(({ shown }) => shown?.hasSprings);
    if (lives) for (const { shown } of this.halves) shown?.live(passed);
    if (walks || lives || this.#dirty) this.draw();
  }

  draw() {
    this.#dirty = false;
    const size = this.renderer.getSize(new Vector2());
    this.renderer.setScissorTest(true);
    const width = size.x / 2;
    this.halves.forEach(({ scene }, index) => {
      this.renderer.setViewport(index * width, 0, width, size.y);
      this.renderer.setScissor(index * width, 0, width, size.y);
      this.renderer.render(scene, this.camera);
    });
  }

  /** A PNG of both, with a word under each. */
  async picture(words, background) {
    this.draw();
    const { width, height } = this.renderer.domElement;
    const canvas = Object.assign(document.createElement('canvas'), { width, height });
    const context = canvas.getContext('2d');
    context.fillStyle = background;
    context.fillRect(0, 0, width, height);
    context.drawImage(this.renderer.domElement, 0, 0);
    context.fillStyle = new Color(0x4a4458).getStyle();
    context.font = `600 ${Math.round(height / 36)}px system-ui, sans-serif`;
    context.textAlign = 'center';
    words.forEach((word, index) => context.fillText(word, (width * (1 + 2 * index)) / 4, height - height / 40));
    return new Promise((done) => canvas.toBlob(done, 'image/png'));
  }
}
