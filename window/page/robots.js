// Draws the robots of the newest frame, in full or as discs, by how large they are in the picture; rings around the chosen, real and halted ones.
import * as THREE from './three.module.js';
import { okabeIto, kindColor, rgb } from './palette.js';
import { fullModel, robotMaterial, discMaterial, bodySize, mostValues } from './models.js';
import { rowX, rowY, rowZ, rowHeading, rowRoll, rowPitch, rowColor } from './frames.js';

const most_in_full = 1200;         // robots in the picture; above that the largest so many
const most_fine = 250;             // above that curves have fewer corners
const full_px = 2.5;               // radius from which parts can be told apart

/** Instances of one model. */
class Herd {
  constructor(scene, geometry, material) {
    this.mesh = new THREE.Mesh(geometry, material);
    this.mesh.frustumCulled = false;
    this.capacity = 0;
    this.count = 0;
    scene.add(this.mesh);
  }

  reserve(count) {
    this.count = 0;
    if (count <= this.capacity) return;
    this.capacity = Math.max(16, count, 2 * this.capacity);
    const add = (name, array, normalized) => {
      this[name] = array;
      const attribute = new THREE.InstancedBufferAttribute(array, 4, normalized);
      attribute.setUsage(THREE.DynamicDrawUsage);
      this.mesh.geometry.setAttribute(name, attribute);
    };
    // three.js keeps buffers by attribute; those that are replaced are dropped with the geometry.
    this.mesh.geometry.dispose();
    add('pose', new Float32Array(4 * this.capacity), false);
    add('lit', new Uint8Array(4 * this.capacity), true);
    for (const name of ['turn', 'valuesA', 'valuesB']) add(name, new Float32Array(4 * this.capacity), false);
  }

  finish() {
    this.mesh.visible = this.count > 0;
    this.mesh.geometry.maxInstancedCount = this.count;
    if (this.count === 0) return;
    for (const name of ['pose', 'lit', 'turn', 'valuesA', 'valuesB']) {
      const attribute = this.mesh.geometry.attributes[name];
      attribute.updateRange = { offset: 0, count: 4 * this.count };
      attribute.needsUpdate = true;
    }
  }

  dispose(scene) {
    scene.remove(this.mesh);
    this.mesh.geometry.dispose();
  }
}

export class Robots {
  /** `selection` has `ids`, a set. */
  constructor(view, world, selection) {
    this.view = view;
    this.world = world;
    this.selection = selection;
    this.group = new THREE.Group();
    view.scene.add(this.group);
    this.herds = [];  // by kind: [fine, plain]
    this.level = view.isFlat ? 'coarse' : 'auto';
    this.byKind = false;
    this.shown = { full: 0, coarse: 0 };
    this.leds = { texture: { value: emptyTexture() }, size: { value: new THREE.Vector2(1, 1) } };
    this.sizes = new Float32Array(0);
    this.makeDiscs();
    this.rings = new Rings(this.group);
    world.on('members', () => this.rebuild());
    world.on('hello', () => this.rebuild());
    world.on('leds', () => this.takeLeds());
    for (const name of ['poses', 'marks', 'leds', 'values']) world.on(name, () => view.invalidate());
    view.addItem(this);
  }

  rebuild() {
    for (const herd of this.herds.flat()) herd.dispose(this.group);
    const { bodies } = this.world.members;
    this.herds = bodies.map((body, kind) => {
      const material = robotMaterial(kindColor(kind), this.leds, body.look);
      return [true, false].map((fine) => new Herd(this.group, fullModel(body, fine), material));
    });
    this.tints = bodies.map((_, kind) => rgb(kindColor(kind)).map((value) => 230 * value));
    this.sizes = new Float32Array(this.world.members.count);
    this.takeLeds();
    this.view.invalidate();
  }

  takeLeds() {
    const { leds, ledsPerRobot, members } = this.world;
    if (leds === null || members.count === 0) {
      if (this.hasLeds) this.leds.texture.value = emptyTexture();
      this.hasLeds = false;
      return;
    }
    const old = this.leds.texture.value;
    if (old.image.width === ledsPerRobot && old.image.height === members.count) {
      old.image.data = leds;
      old.needsUpdate = true;
    } else {
      old.dispose();
      const texture = new THREE.DataTexture(leds, ledsPerRobot, members.count, THREE.RGBAFormat, THREE.UnsignedByteType);
      texture.needsUpdate = true;
      this.leds.texture.value = texture;
      this.leds.size.value.set(ledsPerRobot, members.count);
    }
    this.hasLeds = true;
    this.view.invalidate();
  }

  setColoring(byKind) {
    this.byKind = byKind;
    this.view.invalidate();
  }

  setLevel(level) {
    this.level = level;
    this.view.invalidate();
  }

  /** Fills the instances; called before each picture. */
  update(camera) {
    const frame = this.world.frame;
    const count = frame?.count ?? 0;
    const smallestFull = this.measure(frame, count, camera);
    const { kind } = this.world.members;
    const shown = { full: 0, coarse: 0 };
    for (let i = 0; i < count; ++i) {
      if (this.sizes[i] >= smallestFull && this.sizes[i] > 0) shown.full++;
    }
    const plain = shown.full > most_fine ? 1 : 0;
    for (const herd of this.herds.flat()) {
      herd.reserve(shown.full);
      herd.mesh.material.uniforms.byKind.value = this.byKind ? 1 : 0;
    }
    this.reserveDiscs(count);
    for (let i = 0; i < count; ++i) {
      const size = this.sizes[i];
      if (size === 0) continue;
      if (size >= smallestFull) this.put(this.herds[kind[i]][plain], frame, i);
      else this.putDisc(frame, i, shown.coarse++);
    }
    for (const herd of this.herds.flat()) herd.finish();
    this.finishDiscs(shown.coarse, camera);
    this.shown = shown;
    this.ring(camera);
  }

  /** Fills `sizes` with the radius of each robot in pixels, 0 where it is out of the picture; returns the size from which robots are drawn in full. */
  measure(frame, count, camera) {
    const { kind, bodies } = this.world.members;
    const radii = bodies.map((body) => bodySize(body).radius);
    const eye = camera.eye;
    const m = new THREE.Matrix4().multiplyMatrices(eye.projectionMatrix, eye.matrixWorldInverse).elements;
    const sx = eye.projectionMatrix.elements[0], sy = eye.projectionMatrix.elements[5];
    const half_px = camera.height_px / 2;
    const bins = new Uint32Array(64);
    for (let i = 0; i < count; ++i) {
      const x = rowX(frame, i), y = rowY(frame, i), z = rowZ(frame, i), r = radii[kind[i]];
      const w = m[3] * x + m[7] * y + m[11] * z + m[15];
      const cx = Math.abs(m[0] * x + m[4] * y + m[8] * z + m[12]), cy = Math.abs(m[1] * x + m[5] * y + m[9] * z + m[13]);
      let size = 0;
      if (w > 0 && cx - 3 * r * sx < w && cy - 3 * r * sy < w) size = (r * sy * half_px) / w;
      this.sizes[i] = size;
      if (size >= full_px) bins[Math.min(63, Math.floor(8 * Math.log2(size / full_px)))]++;
    }
    if (this.level === 'full') return 0;
    if (this.level === 'coarse') return Infinity;
    let sum = 0;
    for (let bin = 63; bin >= 0; --bin) {
      sum += bins[bin];
      if (sum > most_in_full) return full_px * 2 ** ((bin + 1) / 8);
    }
    return full_px;
  }

  put(herd, frame, i) {
    const at = 4 * herd.count++;
    const { pose, lit, turn } = herd;
    pose[at] = rowX(frame, i);
    pose[at + 1] = rowY(frame, i);
    pose[at + 2] = rowZ(frame, i);
    pose[at + 3] = this.hasLeds ? i : -1;
    putColor(lit, at, rowColor(frame, i));
    lit[at + 3] = rowColor(frame, i) === 0 ? 0 : 255;
    const heading = rowHeading(frame, i);
    turn[at] = Math.cos(heading);
    turn[at + 1] = Math.sin(heading);
    turn[at + 2] = rowRoll(frame, i);
    turn[at + 3] = rowPitch(frame, i);
    const values = this.world.values[i];
    for (let k = 0; k < mostValues; ++k) (k < 4 ? herd.valuesA : herd.valuesB)[at + (k & 3)] = values[k] ?? 0;
  }

  makeDiscs() {
    this.discs = new THREE.Points(new THREE.BufferGeometry(), discMaterial());
    this.discs.frustumCulled = false;
    this.discs.visible = false;
    this.discCapacity = 0;
    this.group.add(this.discs);
  }

  reserveDiscs(count) {
    if (count <= this.discCapacity) return;
    this.discCapacity = count;
    const { geometry } = this.discs;
    geometry.dispose();
    for (const [name, size] of [['position', 3], ['radius', 1], ['aim', 2]]) {
      geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(size * count), size));
    }
    geometry.setAttribute('tint', new THREE.BufferAttribute(new Uint8Array(4 * count), 4, true));
  }

  putDisc(frame, i, at) {
    const { position, radius, aim, tint } = this.discs.geometry.attributes;
    const body = this.world.body(i);
    const size = bodySize(body);
    position.array[3 * at] = rowX(frame, i);
    position.array[3 * at + 1] = rowY(frame, i);
    position.array[3 * at + 2] = rowZ(frame, i) + 0.5 * size.height;
    radius.array[at] = size.radius;
    const heading = rowHeading(frame, i);
    aim.array[2 * at] = Math.cos(heading);
    aim.array[2 * at + 1] = Math.sin(heading);
    const color = this.byKind ? 0 : rowColor(frame, i);
    if (color !== 0) putColor(tint.array, 4 * at, color);
    else tint.array.set(this.tints[this.world.members.kind[i]], 4 * at);
  }

  finishDiscs(count, camera) {
    this.discs.visible = count > 0;
    if (count === 0) return;
    const { uniforms } = this.discs.material;
    uniforms.height.value = camera.height_px * this.view.pixelRatio;
    uniforms.smallest.value = 2 * this.view.pixelRatio;
    this.discs.geometry.setDrawRange(0, count);
    for (const attribute of Object.values(this.discs.geometry.attributes)) {
      attribute.updateRange = { offset: 0, count: attribute.itemSize * count };
      attribute.needsUpdate = true;
    }
  }

  ring(camera) {
    const { world, rings } = this;
    rings.begin();
    const radius = (i, pose, factor, least_px) =>
      Math.max(factor * Math.max(bodySize(world.body(i)).radius, world.body(i).rotor_arm ?? 0), least_px * camera.metresPerPixel(pose.x, pose.y, pose.z));
    const each = (indices, draw) => {
      for (const i of indices) {
        const pose = world.pose(i);
        if (pose !== null) draw(i, pose);
      }
    };
    each(world.members.real, (i, pose) => rings.put('dashed', pose, radius(i, pose, 1.55, 11), okabeIto.blue));
    each(world.halted, (i, pose) => rings.put('cross', { ...pose, z: pose.z + bodySize(world.body(i)).height + 0.004 }, radius(i, pose, 0.9, 5), okabeIto.vermilion));
    each([...this.selection.ids].map((id) => world.members.index.get(id)).filter((i) => i !== undefined),
      (i, pose) => rings.put('ring', pose, radius(i, pose, 1.3, 8), okabeIto.yellow));
    rings.finish();
  }

  /** Names of the chosen and the real robots. */
  label(pen, camera) {
    const { world } = this;
    const name = (i, text) => {
      const pose = world.pose(i);
      if (pose === null) return;
      const at = camera.project(pose.x, pose.y, pose.z + bodySize(world.body(i)).height);
      if (at.inFront) pen.text(text, at.x + 10, at.y - 8);
    };
    for (const id of this.selection.ids) {
      const i = world.members.index.get(id);
      if (i !== undefined) name(i, id);
    }
    for (const i of world.members.real) {
      const id = world.members.ids[i];
      if (!this.selection.ids.has(id)) name(i, this.realText?.(id) ?? id);
    }
  }
}

/** Flat marks on the floor around robots: few, so each is a mesh. */
class Rings {
  constructor(group) {
    this.group = group;
    this.pool = { ring: [], dashed: [], cross: [] };
    const dashes = [];
    for (let i = 0; i < 8; ++i) dashes.push(new THREE.RingBufferGeometry(0.86, 1, 4, 1, (i * Math.PI) / 4, Math.PI / 7));
    this.shapes = { ring: new THREE.RingBufferGeometry(0.84, 1, 40), dashed: join(dashes), cross: crossShape() };
    this.materials = {};
  }

  begin() {
    this.used = { ring: 0, dashed: 0, cross: 0 };
  }

  put(shape, pose, radius, color) {
    const pool = this.pool[shape];
    const number = this.used[shape]++;
    if (pool.length <= number) {
      this.materials[color] ??= new THREE.MeshBasicMaterial({ color, depthTest: false, transparent: true, side: THREE.DoubleSide });
      const mesh = new THREE.Mesh(this.shapes[shape], this.materials[color]);
      mesh.renderOrder = 5;
      pool.push(mesh);
      this.group.add(mesh);
    }
    const mesh = pool[number];
    mesh.visible = true;
    mesh.position.set(pose.x, pose.y, pose.z + 0.003);
    mesh.scale.set(radius, radius, 1);
  }

  finish() {
    for (const [shape, pool] of Object.entries(this.pool)) {
      for (let i = this.used[shape]; i < pool.length; ++i) pool[i].visible = false;
    }
  }
}

function join(geometries) {
  const position = [];
  for (const geometry of geometries) position.push(...geometry.toNonIndexed().attributes.position.array);
  const joined = new THREE.BufferGeometry();
  joined.setAttribute('position', new THREE.BufferAttribute(new Float32Array(position), 3));
  return joined;
}

function crossShape() {
  const w = 0.14;
  const bar = [[-1, -w], [1, -w], [1, w], [-1, -w], [1, w], [-1, w]];
  const turned = (angle) => bar.flatMap(([x, y]) => [x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) + y * Math.cos(angle), 0]);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array([...turned(Math.PI / 4), ...turned(-Math.PI / 4)]), 3));
  return geometry;
}

function putColor(to, at, rgb565) {
  to[at] = ((rgb565 >> 11) * 527 + 23) >> 6;
  to[at + 1] = (((rgb565 >> 5) & 63) * 259 + 33) >> 6;
  to[at + 2] = ((rgb565 & 31) * 527 + 23) >> 6;
}

function emptyTexture() {
  const texture = new THREE.DataTexture(new Uint8Array(4), 1, 1, THREE.RGBAFormat, THREE.UnsignedByteType);
  texture.needsUpdate = true;
  return texture;
}
