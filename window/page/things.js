// Boxes and cylinders of the scene; walls that would hide the arena are cut away.
import * as THREE from './three.module.js';
import { lightCode } from './light.js';

/** Many of one form. `round`: cylinders. */
export class Things {
  constructor(group, round) {
    this.group = group;
    this.round = round;
    this.shape = round ? uprightCylinder() : new THREE.BoxBufferGeometry(1, 1, 1);
    this.material = new THREE.ShaderMaterial({
      vertexShader: /* glsl */ `
        attribute vec4 pose;  // x, y, z of the base, heading
        attribute vec4 size;  // w: 1 of what may hide the arena, as walls do
        attribute vec3 tint;
        uniform vec4 arena;   // middle, half of its sides
        uniform float cut;    // 0: nothing is cut away
        varying vec3 color;
        ${lightCode}
        vec3 aboutZ(vec3 v, float a) { return vec3(cos(a) * v.x - sin(a) * v.y, sin(a) * v.x + cos(a) * v.y, v.z); }
        void main() {
          // A wall between the eye and the arena is cut down to a stump.
          vec2 side = (pose.xy - arena.xy) / arena.zw;
          vec3 eye = normalize(cameraPosition - vec3(arena.xy, 0.0));
          float hides = cut * size.w * smoothstep(0.12, 0.38, dot(normalize(side * arena.zw + 1e-9), eye.xy)) * step(0.8, max(abs(side.x), abs(side.y)));
          float height = mix(size.z, min(size.z, 0.012 * max(arena.z, arena.w)), hides);
          vec3 p = aboutZ(vec3(position.xy, position.z + 0.5) * vec3(size.xy, height), pose.w) + pose.xyz;
          vec3 n = normalize(aboutZ(normal, pose.w));
          float low = p.z < pose.z + 0.001 && pose.z < 0.02 ? 0.78 : 1.0;  // the floor takes light away
          color = tint * lightOn(n) * low * (1.0 - 0.25 * hides * step(0.5, n.z));
          gl_Position = projectionMatrix * (viewMatrix * vec4(p, 1.0));
        }`,
      fragmentShader: 'varying vec3 color; void main() { gl_FragColor = vec4(color, 1.0); }',
      uniforms: { arena: { value: new THREE.Vector4(0, 0, 1, 1) }, cut: { value: 1 } },
    });
    this.capacity = -1;
  }

  begin(most) {
    this.count = 0;
    if (most <= this.capacity) return;
    if (this.mesh !== undefined) {
      this.group.remove(this.mesh);
      this.mesh.geometry.dispose();
    }
    this.capacity = most;
    const geometry = new THREE.InstancedBufferGeometry().copy(this.shape);
    for (const [name, size] of [['pose', 4], ['size', 4], ['tint', 3]]) {
      geometry.setAttribute(name, new THREE.InstancedBufferAttribute(new Float32Array(size * Math.max(1, most)), size));
    }
    this.mesh = new THREE.Mesh(geometry, this.material);
    this.mesh.frustumCulled = false;
    this.mesh.userData.round = this.round;
    this.group.add(this.mesh);
  }

  put(thing, x, y, z, color, hides) {
    const { pose, size, tint } = this.mesh.geometry.attributes;
    pose.array.set([thing.x, thing.y, thing.z, thing.heading], 4 * this.count);
    size.array.set([x, y, z, hides ? 1 : 0], 4 * this.count);
    tint.array.set(color, 3 * this.count);
    this.count++;
  }

  finish() {
    this.mesh.geometry.maxInstancedCount = this.count;
    this.mesh.visible = this.count > 0;
    for (const name of ['pose', 'size', 'tint']) this.mesh.geometry.attributes[name].needsUpdate = true;
  }
}

function uprightCylinder() {
  const shape = new THREE.CylinderBufferGeometry(0.5, 0.5, 1, 36);
  shape.rotateX(Math.PI / 2);
  return shape;
}
