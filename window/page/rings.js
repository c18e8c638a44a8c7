// Flat marks on the floor around robots: few, so each is a mesh.
import * as THREE from './three.module.js';

export class Rings {
  constructor(group) {
    this.group = group;
    const dashes = [];
    for (let i = 0; i < 8; ++i) dashes.push(new THREE.RingBufferGeometry(0.86, 1, 4, 1, (i * Math.PI) / 4, Math.PI / 7));
    this.shapes = { edge: new THREE.RingBufferGeometry(0.79, 1.05, 40), ring: new THREE.RingBufferGeometry(0.84, 1, 40), dashed: join(dashes), cross: crossShape() };
    this.pool = Object.fromEntries(Object.keys(this.shapes).map((name) => [name, []]));
    this.materials = {};
  }

  begin() {
    this.used = Object.fromEntries(Object.keys(this.shapes).map((name) => [name, 0]));
  }

  put(shape, pose, radius, color) {
    const pool = this.pool[shape];
    const number = this.used[shape]++;
    if (pool.length <= number) {
      this.materials[color] ??= new THREE.MeshBasicMaterial({ color, depthTest: false, transparent: true, side: THREE.DoubleSide });
      const mesh = new THREE.Mesh(this.shapes[shape], this.materials[color]);
      mesh.renderOrder = shape === 'edge' ? 4 : 5;
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
