// Robots that are few pixels large, or too many: discs with their front marked, one vertex each, straight from the frame's bytes.
import * as THREE from './three.module.js';
import { bodySize } from './models.js';
import { rowX, rowY, rowZ, rowHeading, rowColor, rgb565 } from './frames.js';

export class Discs {
  constructor(group) {
    this.mesh = new THREE.Points(new THREE.BufferGeometry(), material());
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
    this.mesh.userData.discs = (draw) => this.each(draw);
    group.add(this.mesh);
  }

  /** `tints`: [r, g, b] by kind, 0 to 255. */
  rebuild({ count, kind, bodies }, tints) {
    const { geometry } = this.mesh;
    geometry.dispose();
    this.places = new THREE.InterleavedBuffer(new Float32Array(4 * count), 4);
    this.words = new THREE.InterleavedBuffer(new Uint16Array(8 * count), 8);
    const size = new Float32Array(2 * count), tint = new Uint8Array(4 * count);
    for (let i = 0; i < count; ++i) {
      const { radius, height } = bodySize(bodies[kind[i]]);
      size.set([radius, 0.5 * height], 2 * i);
      tint.set(tints[kind[i]], 4 * i);
    }
    geometry.setAttribute('position', new THREE.InterleavedBufferAttribute(this.places, 2, 0));
    geometry.setAttribute('words', new THREE.InterleavedBufferAttribute(this.words, 3, 4));
    geometry.setAttribute('size', new THREE.BufferAttribute(size, 2));
    geometry.setAttribute('tint', new THREE.BufferAttribute(tint, 4, true));
    this.over = new THREE.BufferAttribute(new Uint8Array(4 * count), 4, true);
    geometry.setAttribute('over', this.over);
    this.count = count;
  }

  /** All robots of the frame but those whose radius is `fullFrom_px` or more. */
  show(frame, fullFrom_px, { height_px }, pixelRatio, any) {
    this.mesh.visible = any;
    if (!any) return;
    this.frame = frame;
    if (this.places.array !== frame.floats) {
      this.places.array = frame.floats;
      this.words.array = frame.words;
      this.places.needsUpdate = this.words.needsUpdate = true;
    }
    const { uniforms } = this.mesh.material;
    uniforms.height.value = height_px * pixelRatio;
    uniforms.smallest.value = 2 * pixelRatio;
    uniforms.fullFrom.value = Math.min(1e9, 2 * fullFrom_px * pixelRatio);
  }

  /** Of all robots, for pictures without WebGL: `draw(x, y, z, radius, cos, sin, color)`. */
  each(draw) {
    const { size, tint } = this.mesh.geometry.attributes;
    const mixed = [0, 0, 0];
    for (let i = 0; i < this.count; ++i) {
      const lit = rowColor(this.frame, i), heading = rowHeading(this.frame, i);
      const over = this.over.array.subarray(4 * i, 4 * i + 4);
      if (lit !== 0) rgb565(mixed, 0, lit);
      const color = over[3] > 0 ? over : lit !== 0 ? mixed : tint.array.subarray(4 * i, 4 * i + 3);
      draw(rowX(this.frame, i), rowY(this.frame, i), rowZ(this.frame, i) + size.array[2 * i + 1], size.array[2 * i], Math.cos(heading), Math.sin(heading),
        `rgb(${color[0]},${color[1]},${color[2]})`);
    }
  }
}

function material() {
  return new THREE.ShaderMaterial({
    vertexShader: /* glsl */ `
      attribute vec3 words;   // z in mm, heading in parts of a turn, RGB565
      attribute vec2 size;    // radius, half of the height
      attribute vec3 tint;
      attribute vec4 over;
      uniform float height;   // of the picture in its own pixels
      uniform float smallest;
      uniform float fullFrom;
      varying vec3 color;
      varying vec2 front;     // in the picture, y down; zero: too small to be seen
      void main() {
        vec3 lit = vec3(floor(words.z / 2048.0) / 31.0, floor(mod(words.z, 2048.0) / 32.0) / 63.0, mod(words.z, 32.0) / 31.0);
        color = over.w > 0.0 ? over.rgb : words.z > 0.0 ? lit : tint;
        vec4 middle = projectionMatrix * (viewMatrix * vec4(position.xy, words.x / 1000.0 + size.y, 1.0));
        float foot = middle.w - projectionMatrix[2][3] * viewMatrix[2][2] * size.y;  // how far away its base is
        float wide = size.x * projectionMatrix[1][1] * height / middle.w;
        front = vec2(0.0);
        if (wide > 7.0) {
          float heading = words.y * ${(2 * Math.PI / 65536).toFixed(12)};
          vec4 ahead = middle + projectionMatrix * (viewMatrix * vec4(cos(heading) * size.x, sin(heading) * size.x, 0.0, 0.0));
          vec2 to = ahead.xy / ahead.w - middle.xy / middle.w;
          to.x *= projectionMatrix[1][1] / projectionMatrix[0][0];
          front = normalize(vec2(to.x, -to.y) + vec2(1e-9));
        }
        gl_Position = size.x * projectionMatrix[1][1] * height / foot < fullFrom ? middle : vec4(2.0, 2.0, 2.0, 1.0);
        gl_PointSize = max(smallest, wide);
      }`,
    fragmentShader: /* glsl */ `
      varying vec3 color;
      varying vec2 front;
      void main() {
        vec2 d = gl_PointCoord * 2.0 - 1.0;
        float away = dot(d, d);
        vec3 shown = color;
        if (front != vec2(0.0)) {
          if (away > 1.0) discard;
          float along = dot(d, front), across = abs(d.x * front.y - d.y * front.x);
          shown *= 0.92 + 0.16 * dot(d, vec2(-0.4, -0.6));
          if (away > 0.7) shown *= 0.72;
          if (along > -0.3 && across < 0.42 * (0.85 - along)) shown *= 0.3;
        }
        gl_FragColor = vec4(shown, 1.0);
      }`,
    uniforms: { height: { value: 600 }, smallest: { value: 2 }, fullFrom: { value: 1e9 } },
  });
}
