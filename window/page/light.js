// Light of the picture: the sun, the sky, and what they leave dark on the floor.
import * as THREE from './three.module.js';

const sun = new THREE.Vector3(0.42, -0.46, 0.78).normalize();  // towards it: the south-east, rather high
const vec = (v) => `vec3(${[v.x, v.y, v.z].map((value) => value.toFixed(4)).join()})`;

/** GLSL: how bright a surface with this normal is. */
export const lightCode = /* glsl */ `
  vec3 lightOn(vec3 n) {
    vec3 sky = mix(vec3(0.46, 0.445, 0.43), vec3(0.58, 0.60, 0.63), 0.5 + 0.5 * n.z);
    return sky + vec3(0.50, 0.485, 0.455) * max(0.0, dot(n, ${vec(sun)}));
  }
`;

const most_soft_m = 0.35;  // of a shadow's edge

/** Shadows of upright things on the floor, soft where what throws them is high, and the light that lit robots throw there. */
export class Shadows {
  constructor(group) {
    this.mesh = new THREE.Mesh(new THREE.InstancedBufferGeometry(), new THREE.ShaderMaterial({
      vertexShader: /* glsl */ `
        attribute vec4 place;   // x, y, z of the base, height
        attribute vec4 form;    // half length, half width (0: round, of radius half length), cosine and sine of the heading
        attribute vec4 glow;
        varying vec2 at;        // from the middle of the base, in m
        varying vec4 own;       // as form
        varying vec3 high;      // z of the base, height, how strong it glows
        varying vec3 shine;
        varying vec2 floorAt;   // inside of the arena where both are between -1 and 1
        uniform vec4 arena;     // middle, half of its sides
        void main() {
          vec2 away = -${vec(sun)}.xy / ${vec(sun)}.z;
          float wide = form.y > 0.0 ? length(form.xy) : form.x;
          float top = place.z + place.w;
          vec2 low = away * place.z, high_ = away * top;
          float soft = min(${most_soft_m}, 0.16 * top) + 0.35 * wide;
          float reach = max(wide + soft, glow.a > 0.0 ? 3.2 * wide : 0.0);
          vec2 along = normalize(away);
          vec2 middle = 0.5 * (low + high_);
          at = middle + along * position.x * (reach + 0.5 * length(high_ - low)) + vec2(-along.y, along.x) * position.y * reach;
          own = form;
          high = vec3(place.zw, glow.a);
          shine = glow.rgb;
          floorAt = (place.xy + at - arena.xy) / arena.zw;
          gl_Position = projectionMatrix * (viewMatrix * vec4(place.xy + at, 0.0012, 1.0));
        }`,
      fragmentShader: /* glsl */ `
        precision highp float;
        varying vec2 at;
        varying vec4 own;
        varying vec3 high;
        varying vec3 shine;
        varying vec2 floorAt;
        const vec2 away = -${vec(sun)}.xy / ${vec(sun)}.z;
        float outside(vec2 p) {
          if (own.y <= 0.0) return length(p) - own.x;
          p = abs(vec2(own.z * p.x + own.w * p.y, own.z * p.y - own.w * p.x)) - own.xy;
          return length(max(p, 0.0)) + min(max(p.x, p.y), 0.0);
        }
        void main() {
          float dark = 0.0;
          if (own.y <= 0.0) {
            float t = clamp(dot(at - away * high.x, away) / (dot(away, away) * max(high.y, 1e-4)), 0.0, 1.0);
            float z = high.x + t * high.y;
            float soft = min(${most_soft_m}, 0.16 * z) + 0.004;
            dark = 1.0 - smoothstep(-soft, soft, outside(at - away * z));
          } else {
            // Heights at which the box lies between the floor and the sun.
            vec2 p = vec2(own.z * at.x + own.w * at.y, own.z * at.y - own.w * at.x);
            vec2 v = vec2(own.z * away.x + own.w * away.y, own.z * away.y - own.w * away.x);
            v += vec2(1e-4) * (step(0.0, v) * 2.0 - 1.0);
            vec2 a = (p - own.xy) / v, b = (p + own.xy) / v;
            vec2 low = min(a, b), up = max(a, b);
            float enter = max(max(low.x, low.y), high.x), leave = min(min(up.x, up.y), high.x + high.y);
            float soft = min(${most_soft_m}, 0.16 * max(0.0, min(enter, high.x + high.y))) + 0.005;
            dark = 1.0 - smoothstep(-soft, soft, (enter - leave) * length(v));
          }
          float near = max(0.0, outside(at));
          if (max(abs(floorAt.x), abs(floorAt.y)) > 1.0) discard;
          float beneath = max(0.0, exp(-near / min(0.03, 0.16 * own.x + 0.003)) - 0.1) * max(0.0, 1.0 - 20.0 * high.x);
          float a = max(0.36 * dark / (1.0 + 0.5 * high.x), 0.3 * beneath);
          float lit = high.z * max(0.0, 0.75 * exp(-near / (0.55 * own.x)) - 0.015);
          gl_FragColor = vec4(shine * lit, a * (1.0 - 0.5 * lit));
        }`,
      transparent: true,
      depthWrite: false,
      blending: THREE.CustomBlending,
      blendSrc: THREE.OneFactor,
      blendDst: THREE.OneMinusSrcAlphaFactor,
      uniforms: { arena: { value: new THREE.Vector4(0, 0, 1e6, 1e6) } },
    }));
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = -1;
    this.mesh.geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), 3));
    this.mesh.geometry.setIndex([0, 1, 2, 0, 2, 3]);
    this.capacity = -1;
    group.add(this.mesh);
  }

  /** Middle and half of the sides of the floor that they fall on. */
  setArena(x, y, half_x, half_y) {
    this.mesh.material.uniforms.arena.value.set(x, y, half_x, half_y);
  }

  begin(most) {
    this.count = 0;
    if (most <= this.capacity) return;
    this.capacity = Math.max(16, most);
    const { geometry } = this.mesh;
    geometry.dispose();
    const add = (name, array, normalized) => geometry.setAttribute(name, new THREE.InstancedBufferAttribute(array, 4, normalized));
    add('place', new Float32Array(4 * this.capacity), false);
    add('form', new Float32Array(4 * this.capacity), false);
    add('glow', new Uint8Array(4 * this.capacity), true);
  }

  /** `halfWidth` 0: round. `glow`: where its colour is in `colors`, or -1. */
  put(x, y, z, height, halfLength, halfWidth, cos, sin, colors = null, glow = -1) {
    const at = 4 * this.count++;
    const { place, form, glow: shine } = this.mesh.geometry.attributes;
    place.array[at] = x;
    place.array[at + 1] = y;
    place.array[at + 2] = z;
    place.array[at + 3] = height;
    form.array[at] = halfLength;
    form.array[at + 1] = halfWidth;
    form.array[at + 2] = cos;
    form.array[at + 3] = sin;
    for (let k = 0; k < 4; ++k) shine.array[at + k] = glow < 0 ? 0 : colors[glow + k];
  }

  finish(shown = true) {
    this.mesh.visible = shown && this.count > 0;
    this.mesh.geometry.maxInstancedCount = this.count;
    if (!this.mesh.visible) return;
    for (const name of ['place', 'form', 'glow']) {
      const attribute = this.mesh.geometry.attributes[name];
      attribute.updateRange = { offset: 0, count: 4 * this.count };
      attribute.needsUpdate = true;
    }
  }
}
