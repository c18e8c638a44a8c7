// Draws what is not a robot: the floor, boxes, cylinders, lamps, and the borders of engines' regions.
import * as THREE from './three.module.js';
import { theme, rgb } from './palette.js';
import { Things } from './things.js';
import { Shadows } from './light.js';

/** The longest of 1, 2, 5, 10, 20 … m (or a decimal fraction of them) that is not above `limit`. */
export function roundLength(limit) {
  const ten = 10 ** Math.floor(Math.log10(limit));
  return (limit >= 5 * ten ? 5 : limit >= 2 * ten ? 2 : 1) * ten;
}
const lengthText = (metres) => (metres >= 1 ? `${metres} m` : metres >= 0.01 ? `${Math.round(metres * 100)} cm` : `${Math.round(metres * 1000)} mm`);

/** Fixed things are grey, movable ones have the colour of wood. */
export class Scene {
  constructor(view, world) {
    this.view = view;
    this.world = world;
    this.group = new THREE.Group();
    this.boxes = new Things(this.group, false);
    this.cylinders = new Things(this.group, true);
    this.shadows = new Shadows(this.group);
    this.floorAddress = undefined;
    view.scene.add(this.group);
    view.addItem(this);
    world.on('scene', () => this.rebuild());
    world.on('objects', () => this.place());
    this.chosen = null;  // { object or light: id }, ringed
  }

  update(camera) {
    this.shadows.mesh.visible = this.view.quality.shadows && this.shadows.count > 0;
    for (const things of [this.boxes, this.cylinders]) things.material.uniforms.cut.value = camera.isTop ? 0 : 1;
  }

  retint() {
    if (this.world.scene !== null) this.rebuild();
  }

  rebuild() {
    const { scene } = this.world;
    const { arena } = scene;
    this.view.camera.setHome(arena);
    const place = [(arena.min_x + arena.max_x) / 2, (arena.min_y + arena.max_y) / 2, (arena.max_x - arena.min_x) / 2, (arena.max_y - arena.min_y) / 2];
    for (const things of [this.boxes, this.cylinders]) things.material.uniforms.arena.value.set(...place);
    this.shadows.setArena(...place);
    for (const part of [this.ground, this.grid, this.lamps, this.borders, this.beads]) {
      if (part !== undefined) this.group.remove(part);
    }
    this.makeGround(scene);
    this.makeBorders(scene.borders);
    this.makeLamps(scene.lights);
    this.place();
  }

  makeGround({ arena, floor }) {
    const width = arena.max_x - arena.min_x, depth = arena.max_y - arena.min_y;
    const middle = [(arena.min_x + arena.max_x) / 2, (arena.min_y + arena.max_y) / 2];
    const geometry = new THREE.PlaneBufferGeometry(width, depth);
    const material = new THREE.MeshBasicMaterial({ color: theme().ground, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 4 });
    this.ground = new THREE.Mesh(geometry, material);
    this.ground.position.set(...middle, -0.001);
    this.group.add(this.ground);
    if (floor) this.loadFloor(floor, material);
    const step = roundLength(Math.max(width, depth) / 8);
    const points = [];
    for (let x = Math.ceil(arena.min_x / step) * step; x <= arena.max_x + 1e-9; x += step) points.push(x, arena.min_y, 0, x, arena.max_y, 0);
    for (let y = Math.ceil(arena.min_y / step) * step; y <= arena.max_y + 1e-9; y += step) points.push(arena.min_x, y, 0, arena.max_x, y, 0);
    this.grid = lines(points, theme().grid);
    this.grid.visible = !floor && this.showGrid !== false;
    this.group.add(this.grid);
    this.step = step;
  }

  loadFloor(address, material) {
    if (this.floorTexture !== undefined && this.floorAddress === address) {
      material.map = this.floorTexture;
      material.color.set('#ffffff');
      return;
    }
    new THREE.TextureLoader().load(address, (texture) => {
      texture.anisotropy = 8;
      this.floorTexture?.dispose();
      this.floorTexture = texture;
      this.floorAddress = address;
      // The newest ground, which may not be the one that asked.
      if (this.world.scene.floor !== address) return;
      this.ground.material.map = texture;
      this.ground.material.color.set('#ffffff');
      this.ground.material.needsUpdate = true;
      this.view.invalidate();
    }, undefined, () => console.warn('the picture of the floor did not come'));
  }

  makeBorders(borders) {
    this.borders = new THREE.Group();
    const walls = [], gates = [];
    for (const [ax, ay, bx, by, wall] of borders) (wall ? walls : gates).push(ax, ay, 0.004, bx, by, 0.004);
    if (walls.length > 0) this.borders.add(lines(walls, theme().border));
    if (gates.length > 0) {
      const gate = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineDashedMaterial({ color: theme().border, dashSize: 0.1, gapSize: 0.1 }));
      gate.geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(gates), 3));
      gate.computeLineDistances();
      gate.frustumCulled = false;
      this.borders.add(gate);
    }
    this.group.add(this.borders);
  }

  makeLamps(lights) {
    this.lamps = new THREE.Group();
    for (const light of lights) {
      const [r, g, b] = light.color.map((value) => value / 255);
      const on = light.intensity > 0;
      const color = new THREE.Color(on ? r : 0.3, on ? g : 0.3, on ? b : 0.3);
      const bulb = new THREE.Mesh(new THREE.SphereBufferGeometry(0.04, 20, 14), new THREE.MeshBasicMaterial({ color: on ? color.clone().lerp(white, 0.45) : color }));
      bulb.position.set(light.x, light.y, light.z);
      this.lamps.add(bulb);
      const post = (radius, low, high) => {
        const mesh = new THREE.Mesh(new THREE.CylinderBufferGeometry(radius, radius, high - low, 14), new THREE.MeshBasicMaterial({ color: theme().post }));
        mesh.rotation.x = Math.PI / 2;
        mesh.position.set(light.x, light.y, (low + high) / 2);
        this.lamps.add(mesh);
      };
      if (light.z > 0.06) {
        post(0.007, 0, light.z - 0.03);
        post(0.045, 0, 0.008);
      }
      if (!on) continue;
      const halo = new THREE.Sprite(new THREE.SpriteMaterial({ map: haloTexture(), color, transparent: true, opacity: 0.7, depthWrite: false, blending: THREE.AdditiveBlending }));
      halo.position.copy(bulb.position);
      const size = 0.4 + 0.12 * Math.min(4, Math.sqrt(light.intensity));
      halo.scale.set(size, size, 1);
      this.lamps.add(halo);
    }
    this.group.add(this.lamps);
  }

  /** Puts the boxes and cylinders where they are. */
  place() {
    const { objects } = this.world.scene;
    const { arena } = this.world.scene;
    const long = 0.06 * Math.max(arena.max_x - arena.min_x, arena.max_y - arena.min_y);
    const tint = { fixed: rgb(theme().wall), movable: rgb(theme().movable) };
    for (const all of [this.boxes, this.cylinders, this.shadows]) all.begin(objects.length);
    const beads = [];
    for (const o of objects) {
      const color = o.movable ? tint.movable : tint.fixed;
      const height = Math.max(0.002, o.height);
      const c = Math.cos(o.heading), s = Math.sin(o.heading);
      const [x, y] = o.shape === 'box' ? [o.size_x, o.size_y] : [2 * o.radius, 2 * o.radius];
      const hides = !o.movable && Math.max(x, y) > long;
      (o.shape === 'box' ? this.boxes : this.cylinders).put(o, x, y, height, color, hides);
      this.shadows.put(o.x, o.y, o.z, Math.min(height, 0.5), x / 2, o.shape === 'box' ? y / 2 : 0, c, s);
      for (const [x, y, z, r, g, b] of o.leds ?? []) {
        beads.push({ at: [o.x + c * x - s * y, o.y + s * x + c * y, o.z + z], color: [r / 255, g / 255, b / 255] });
      }
    }
    for (const all of [this.boxes, this.cylinders, this.shadows]) all.finish();
    if (this.beads !== undefined) this.group.remove(this.beads);
    this.beads = new THREE.Group();
    for (const { at, color } of beads) {
      const isLit = color[0] + color[1] + color[2] > 0;
      const bead = new THREE.Mesh(beadShape, new THREE.MeshBasicMaterial({ color: new THREE.Color(...(isLit ? color : [0.15, 0.15, 0.15])) }));
      bead.position.set(...at);
      this.beads.add(bead);
    }
    this.group.add(this.beads);
    this.view.invalidate();
  }

  /** Coordinates along two sides of the arena, and a length to compare with. */
  label(pen, camera) {
    const { scene } = this.world;
    if (scene === null) return;
    const { arena } = scene;
    const write = (x, y, text, align) => {
      const at = camera.project(x, y, 0);
      if (at.inFront) pen.text(text, at.x, at.y, { align });
    };
    const digits = Math.max(0, -Math.floor(Math.log10(this.step)));
    const coordinate = (value) => (Math.abs(value) < this.step / 1000 ? 0 : value).toFixed(digits);
    const gap = 14 * camera.metresPerPixel((arena.min_x + arena.max_x) / 2, arena.min_y, 0);
    for (let x = Math.ceil(arena.min_x / this.step) * this.step; x <= arena.max_x + 1e-9; x += this.step) write(x, arena.min_y - gap, coordinate(x), 'center');
    for (let y = Math.ceil(arena.min_y / this.step) * this.step; y <= arena.max_y + 1e-9; y += this.step) write(arena.min_x - gap, y, coordinate(y), 'right');
    const { target } = camera;
    const pixel = camera.metresPerPixel(target.x, target.y, target.z);
    const length = roundLength(110 * pixel);
    const width = length / pixel;
    const [right, bottom] = [pen.width - 16, pen.height - 16];
    pen.line([[right - width, bottom - 4], [right - width, bottom], [right, bottom], [right, bottom - 4]], theme().ink);
    pen.text(lengthText(length), right - width / 2, bottom - 10, { align: 'center' });
    if (this.chosen === null) return;
    const thing = this.find(this.chosen);
    if (thing === undefined) return;
    const at = camera.project(thing.x, thing.y, thing.z + (thing.height ?? 0));
    if (at.inFront) {
      pen.text(thing.id, at.x + 10, at.y - 8);
      pen.line([[at.x - 8, at.y], [at.x, at.y - 8], [at.x + 8, at.y], [at.x, at.y + 8], [at.x - 8, at.y]], theme().ink, 2);
    }
  }

  find({ object, light }) {
    const { objects, lights } = this.world.scene;
    return object !== undefined ? objects.find((o) => o.id === object) : lights.find((l) => l.id === light);
  }
}

function lines(points, color) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(points), 3));
  const made = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color }));
  made.frustumCulled = false;
  return made;
}

const white = new THREE.Color(1, 1, 1);
const beadShape = new THREE.SphereBufferGeometry(0.012, 8, 6);

let halo = null;
function haloTexture() {
  if (halo !== null) return halo;
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = 64;
  const context = canvas.getContext('2d');
  const fade = context.createRadialGradient(32, 32, 0, 32, 32, 32);
  fade.addColorStop(0, 'rgba(255,255,255,0.9)');
  fade.addColorStop(1, 'rgba(255,255,255,0)');
  context.fillStyle = fade;
  context.fillRect(0, 0, 64, 64);
  halo = new THREE.CanvasTexture(canvas);
  return halo;
}
