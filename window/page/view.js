// The picture: renders the 3D scene and the texts over it, only when something has changed.
import * as THREE from './three.module.js';
import { FlatRenderer } from './flat_renderer.js';
import { Camera } from './camera.js';
import { theme, onThemeChange } from './palette.js';
import { Quality } from './quality.js';

const still_ms = 350;  // without a change the picture is drawn once more, finer

/** Items have `update(camera)`, called before each picture, and `label(pen, camera)`, which writes over it; both may be missing. */
export class View {
  constructor(canvas, labels, pointer) {
    this.canvas = canvas;
    this.labels = labels;
    this.pen = new Pen(labels.getContext('2d'));
    this.items = [];
    this.scene = new THREE.Scene();
    this.pictures = 0;
    this.drawing_ms = 0;  // of the newest picture, as far as this thread waits for it
    this.asked = false;
    this.afterPicture = [];
    this.isFlat = new URLSearchParams(location.search).has('flat') || document.createElement('canvas').getContext('webgl') === null;
    this.inSoftware = !this.isFlat && drawsInSoftware();
    const wanted = { antialias: !this.inSoftware, powerPreference: 'high-performance', alpha: false };
    this.renderer = this.isFlat ? new FlatRenderer(canvas) : new THREE.WebGLRenderer({ canvas, context: canvas.getContext('webgl2', wanted) ?? undefined, ...wanted });
    this.quality = new Quality(() => {
      this.resize();
      this.onQuality?.();
    });
    this.camera = new Camera(canvas, { invalidate: () => this.invalidate(), ...pointer });
    canvas.addEventListener('webglcontextlost', (event) => {
      event.preventDefault();
      this.lost = true;
      this.onLost?.(true);
    });
    canvas.addEventListener('webglcontextrestored', () => {
      this.lost = false;
      this.onLost?.(false);
      this.invalidate();
    });
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    onThemeChange(() => {
      for (const item of this.items) item.retint?.();
      this.invalidate();
    });
    this.resize();
  }

  addItem(item) {
    this.items.push(item);
  }

  resize() {
    const box = this.canvas.parentElement.getBoundingClientRect();
    const width = Math.max(1, Math.floor(box.width)), height = Math.max(1, Math.floor(box.height));
    const screen = Math.min(2, window.devicePixelRatio || 1);
    this.size = { width, height, screen };
    this.labels.width = width * screen;
    this.labels.height = height * screen;
    this.sharpen(false);
    this.camera.resize(width, height);
  }

  /** Pixels of the picture: those of the screen or what quality leaves of them; of a still one twice as many, where nothing else smooths edges. */
  sharpen(still) {
    const { width, height, screen } = this.size;
    const ratio = still ? 2 : this.quality.ratio < 1 ? this.quality.ratio : Math.min(this.quality.ratio, screen);
    if (ratio === this.pixelRatio && width === this.width && height === this.height) return;
    Object.assign(this, { pixelRatio: ratio, width, height });
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
  }

  /** Asks for a new picture. */
  invalidate() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      const start = performance.now();
      this.render();
      requestAnimationFrame((now) => this.quality.note(performance.now() - start, now));
    });
  }

  render(still = false) {
    if (this.lost) return this.onPicture?.();  // frames go on coming
    clearTimeout(this.stillTimer);
    if (!still && this.inSoftware && this.quality.still) this.stillTimer = setTimeout(() => this.asked || this.render(true), still_ms);
    this.sharpen(still);
    const start = performance.now();
    this.beforePicture?.();
    for (const item of this.items) item.update?.(this.camera);
    this.renderer.setClearColor(theme().sky);
    this.renderer.render(this.scene, this.camera.eye);
    this.pen.begin(this.size.screen, this.camera.width_px, this.camera.height_px);
    for (const item of this.items) item.label?.(this.pen, this.camera);
    this.pen.finish();
    this.pictures++;
    this.drawing_ms = performance.now() - start;
    for (const call of this.afterPicture.splice(0)) call();
    this.onPicture?.();
  }

  /** The next picture as a PNG blob. */
  snapshot() {
    return new Promise((resolve) => {
      this.render();
      const both = document.createElement('canvas');
      both.width = this.canvas.width;
      both.height = this.canvas.height;
      const context = both.getContext('2d');
      for (const layer of [this.canvas, this.labels]) context.drawImage(layer, 0, 0, both.width, both.height);
      both.toBlob(resolve, 'image/png');
    });
  }
}

/** Without a graphics processor each sample more costs as much as the picture itself. */
function drawsInSoftware() {
  const context = document.createElement('canvas').getContext('webgl');
  if (context === null) return false;
  const names = context.getExtension('WEBGL_debug_renderer_info');
  const name = names === null ? '' : context.getParameter(names.UNMASKED_RENDERER_WEBGL);
  context.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

/** Writes texts over the picture, legible on any ground. */
class Pen {
  constructor(context) {
    this.context = context;
  }

  begin(ratio, width, height) {
    const { context } = this;
    this.tags = [];
    this.taken = [];
    this.width = width;
    this.height = height;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    context.font = '12px system-ui, "DejaVu Sans", sans-serif';
    context.textBaseline = 'middle';
    context.textAlign = 'left';
    context.lineJoin = 'round';
  }

  /** A name beside something: moved where it would cover another one, left out where there is no room. Names that come first have the first choice. */
  tag(text, x, y, options = {}) {
    this.tags.push({ text, x, y, options });
  }

  finish() {
    const high = 15;
    for (const { text, x, y, options } of this.tags) {
      const wide = this.context.measureText(text).width + 4;
      for (const [dx, dy] of [[0, 0], [0, -high], [0, high], [-wide - 20, 0], [-wide - 20, high], [0, 2 * high]]) {
        const box = [x + dx - 2, y + dy - high / 2, x + dx + wide, y + dy + high / 2];
        if (this.taken.some((other) => other.text === text && Math.hypot(other[0] - x, other[1] - y) < 40)) break;  // it stands there already
        if (this.taken.some((other) => box[0] < other[2] && box[2] > other[0] && box[1] < other[3] && box[3] > other[1])) continue;
        this.taken.push(Object.assign(box, { text }));
        this.text(text, x + dx, y + dy, options);
        break;
      }
    }
  }

  text(text, x, y, { color = theme().ink, align = 'left', halo = true } = {}) {
    const { context } = this;
    if (x < -200 || y < -20 || x > this.width + 200 || y > this.height + 20) return;
    context.textAlign = align;
    if (halo) {
      context.strokeStyle = theme().halo;
      context.globalAlpha = 0.8;
      context.lineWidth = 3;
      context.strokeText(text, x, y);
      context.globalAlpha = 1;
    }
    context.fillStyle = color;
    context.fillText(text, x, y);
  }

  line(points, color, width = 1.5) {
    const { context } = this;
    context.strokeStyle = color;
    context.lineWidth = width;
    context.beginPath();
    points.forEach(([x, y], i) => (i === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
    context.stroke();
  }
}
