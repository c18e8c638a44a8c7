// Draws the robots of the newest frame, in full or as discs, by how large they are in the picture; marks around the chosen, real and halted ones.
import * as THREE from './three.module.js';
import { okabeIto, kindColor, rgb } from './palette.js';
import { model, halos, robotMaterials, bodySize, mostValues, finest } from './models.js';
import { Discs } from './discs.js';
import { Rings } from './rings.js';
import { Shadows } from './light.js';
import { rowX, rowY, rowZ, rowHeading, rowRoll, rowPitch, rowColor, rgb565 } from './frames.js';

const full_px = 2.5;             // radius from which parts can be told apart
const detail_px = [0, 9, 30];    // and from which each detail of a model is drawn

const instanced = { pose: Float32Array, lit: Uint8Array, turn: Float32Array, valuesA: Float32Array, valuesB: Float32Array, over: Uint8Array };

/** Instances of one model, and what shines on them. */
class Herd {
  constructor(scene, geometry, haloGeometry, materials) {
    this.meshes = [new THREE.Mesh(geometry, materials.body)];
    if (haloGeometry !== null) this.meshes.push(new THREE.Mesh(haloGeometry, materials.halo));
    for (const mesh of this.meshes) {
      mesh.frustumCulled = false;
      scene.add(mesh);
    }
    this.triangles = geometry.index.count / 3;
    this.capacity = 0;
    this.count = 0;
    this.anyLit = false;
  }

  reserve(count) {
    this.count = 0;
    this.anyLit = false;
    if (count <= this.capacity) return;
    this.capacity = Math.max(16, count, 2 * this.capacity);
    // three.js keeps buffers by attribute; those that are replaced are dropped with the geometry.
    for (const mesh of this.meshes) mesh.geometry.dispose();
    for (const [name, Type] of Object.entries(instanced)) {
      this[name] = new Type(4 * this.capacity);
      const attribute = new THREE.InstancedBufferAttribute(this[name], 4, Type === Uint8Array);
      attribute.setUsage(THREE.DynamicDrawUsage);
      for (const mesh of this.meshes) mesh.geometry.setAttribute(name, attribute);
    }
  }

  finish(shines) {
    const [body, halo] = this.meshes;
    body.visible = this.count > 0;
    if (halo !== undefined) halo.visible = this.count > 0 && this.anyLit && shines;
    for (const mesh of this.meshes) mesh.geometry.maxInstancedCount = this.count;
    if (this.count === 0) return;
    for (const name of Object.keys(instanced)) {
      const attribute = body.geometry.attributes[name];
      attribute.updateRange = { offset: 0, count: 4 * this.count };
      attribute.needsUpdate = true;
    }
  }

  dispose(scene) {
    for (const mesh of this.meshes) {
      scene.remove(mesh);
      mesh.geometry.dispose();
    }
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
    this.herds = [];  // by kind, by detail
    this.level = view.isFlat ? 'coarse' : 'auto';
    this.coloring = null;  // colors.js: (robot) -> [r, g, b], or null
    this.shown = { full: 0, coarse: 0 };
    this.leds = { texture: { value: emptyTexture() }, size: { value: new THREE.Vector2(1, 1) } };
    this.sizes = new Float32Array(0);
    this.discs = new Discs(this.group);
    this.shadows = new Shadows(this.group);
    this.rings = new Rings(this.group);
    world.on('scene', () => {
      const { min_x, min_y, max_x, max_y } = world.scene.arena;
      this.shadows.setArena((min_x + max_x) / 2, (min_y + max_y) / 2, (max_x - min_x) / 2, (max_y - min_y) / 2);
    });
    world.on('members', () => this.rebuild());
    world.on('hello', () => this.rebuild());
    world.on('leds', () => this.takeLeds());
    for (const name of ['poses', 'marks', 'leds', 'values']) world.on(name, () => view.invalidate());
    view.addItem(this);
  }

  rebuild() {
    for (const herd of this.herds.flat()) herd.dispose(this.group);
    const { members } = this.world;
    this.herds = members.bodies.map((body, kind) => {
      const materials = robotMaterials(body, kindColor(kind), this.leds);
      return detail_px.map((_, detail) => new Herd(this.group, model(body, detail), halos(body), materials));
    });
    this.discs.rebuild(members, members.bodies.map((_, kind) => rgb(kindColor(kind)).map((value) => 230 * value)));
    this.sizes = new Float32Array(members.count);
    this.recolored = true;
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

  /** `coloring(robot)`: [r, g, b] of 0 to 255, or null: as it is; null for all: as they are. */
  setColoring(coloring) {
    this.coloring = coloring;
    this.recolored = true;
    this.view.invalidate();
  }

  setLevel(level) {
    this.level = level;
    this.view.invalidate();
  }

  /** Fills the instances; called before each picture. */
  update(camera) {
    const { frame } = this.world;
    const count = frame?.count ?? 0;
    const { quality } = this.view;
    const fullFrom = this.measure(frame, count, camera, quality.mostInFull);
    const { kind } = this.world.members;
    const shown = { full: 0, coarse: 0, details: detail_px.map(() => 0), triangles: 0 };
    const detailOf = (size) => (size >= detail_px[2] && quality.fine ? 2 : size >= detail_px[1] && quality.middle ? 1 : 0);
    const needs = this.herds.map((details) => details.map(() => 0));
    for (let i = 0; i < count; ++i) {
      const size = this.sizes[i];
      if (size === 0) continue;
      if (size >= fullFrom) ++needs[kind[i]][detailOf(size)];
      else ++shown.coarse;
    }
    this.herds.forEach((details, k) => details.forEach((herd, detail) => {
      herd.reserve(needs[k][detail]);
      shown.full += needs[k][detail];
      shown.details[detail] += needs[k][detail];
      shown.triangles += needs[k][detail] * herd.triangles;
    }));
    this.recolor(count);
    this.shadows.begin(quality.shadows ? shown.full : 0);
    if (shown.full > 0) {
      for (let i = 0; i < count; ++i) {
        if (this.sizes[i] > 0 && this.sizes[i] >= fullFrom) this.put(this.herds[kind[i]][detailOf(this.sizes[i])], frame, i, quality);
      }
    }
    for (const herd of this.herds.flat()) herd.finish(quality.glow);
    this.shadows.finish();
    this.discs.show(frame, fullFrom, camera, this.view.pixelRatio, shown.coarse > 0);
    this.shown = shown;
    this.ring(camera);
  }

  /** The colours over robots, when they are others. */
  recolor(count) {
    if (count === 0 || (this.coloring === null && !this.recolored)) return;
    const { array } = this.discs.over;
    for (let i = 0; i < count; ++i) {
      const color = this.coloring?.(i) ?? null;
      array[4 * i + 3] = color === null ? 0 : 255;
      if (color !== null) for (let k = 0; k < 3; ++k) array[4 * i + k] = color[k];
    }
    this.discs.over.needsUpdate = true;
    this.recolored = false;
  }

  /** Fills `sizes` with the radius of each robot in pixels, 0 where it is out of the picture; returns the size from which robots are drawn in full. */
  measure(frame, count, camera, mostInFull) {
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
      if (w > 0 && cx - 6 * r * sx < w && cy - 6 * r * sy < w) size = (r * sy * half_px) / w;
      this.sizes[i] = size;
      if (size >= full_px) bins[Math.min(63, Math.floor(8 * Math.log2(size / full_px)))]++;
    }
    if (this.level === 'full') return 0;
    if (this.level === 'coarse') return Infinity;
    let sum = 0;
    for (let bin = 63; bin >= 0; --bin) {
      sum += bins[bin];
      if (sum > mostInFull) return full_px * 2 ** ((bin + 1) / 8);
    }
    return full_px;
  }

  put(herd, frame, i, quality) {
    const at = 4 * herd.count++;
    const { pose, lit, turn, over } = herd;
    const x = rowX(frame, i), y = rowY(frame, i), z = rowZ(frame, i), mixed = rowColor(frame, i);
    pose[at] = x;
    pose[at + 1] = y;
    pose[at + 2] = z;
    pose[at + 3] = this.hasLeds ? i : -1;
    rgb565(lit, at, mixed);
    lit[at + 3] = mixed === 0 ? 0 : 255;
    if (mixed !== 0) herd.anyLit = true;
    const heading = rowHeading(frame, i);
    turn[at] = Math.cos(heading);
    turn[at + 1] = Math.sin(heading);
    turn[at + 2] = rowRoll(frame, i);
    turn[at + 3] = rowPitch(frame, i);
    const values = this.world.values[i];
    for (let k = 0; k < mostValues; ++k) (k < 4 ? herd.valuesA : herd.valuesB)[at + (k & 3)] = values[k] ?? 0;
    for (let k = 0; k < 4; ++k) over[at + k] = this.discs.over.array[4 * i + k];
    over[at + 3] *= 0.85;
    if (!quality.shadows) return;
    const { radius, height } = bodySize(this.world.body(i));
    this.shadows.put(x, y, z, height, radius, 0, 1, 0, lit, quality.glow && mixed !== 0 ? at : -1);
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
    each([...this.selection.ids].map((id) => world.members.index.get(id)).filter((i) => i !== undefined), (i, pose) => {
      rings.put('edge', pose, radius(i, pose, 1.3, 8), okabeIto.black);  // yellow alone is hard to see on a light floor
      rings.put('ring', pose, radius(i, pose, 1.3, 8), okabeIto.yellow);
    });
    rings.finish();
  }

  /** Names of the chosen and the real robots. */
  label(pen, camera) {
    const { world } = this;
    const name = (i, text) => {
      const pose = world.pose(i);
      if (pose === null) return;
      const at = camera.project(pose.x, pose.y, pose.z + bodySize(world.body(i)).height);
      if (at.inFront) pen.tag(text, at.x + 10, at.y - 8);
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

function emptyTexture() {
  const texture = new THREE.DataTexture(new Uint8Array(4), 1, 1, THREE.RGBAFormat, THREE.UnsignedByteType);
  texture.needsUpdate = true;
  return texture;
}
