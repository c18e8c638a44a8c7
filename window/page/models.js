// Models of robots, made from the links and lamps of their kind's look, and the shaders that draw all of a kind at once.
import * as THREE from './three.module.js';
import { Shape, circle } from './shape.js';
import { lightCode } from './light.js';

// What a vertex belongs to, for the shader.
const moves = { body: 0, joint: 1 };          // joint: 1 + its number
const paint = { own: 0, kind: 1, led: 2 };    // led: 2 + its number

/** Values that move a robot, at most; further ones stay as they are. */
export const mostValues = 8;

/** What is left of a model from far away: its largest links, so that it has about so many triangles, and circles with fewer corners. */
const details = [{ most: 90, corners: 6, lamp: 0 }, { most: 360, corners: 10, lamp: 2 }, { most: 1e5, corners: 28, lamp: 5 }];
export const finest = details.length - 1;

/** Radius and height that can be drawn, whatever the file says. */
export const bodySize = (body) => ({ radius: Math.max(0.005, body.radius || 0), height: Math.max(0.01, body.height || 0.05) });

/** The number of the joint of that name; -1: the body. */
const jointOf = (look, name) => (name === undefined ? -1 : look.joints.findIndex((joint) => joint.name === name));
const sitsOn = (look, name) => {
  const joint = jointOf(look, name);
  return joint < 0 || joint >= mostValues ? moves.body : moves.joint + joint;
};
const rgbOf = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);

/** One link; see docs/view-protocol.md for the forms. */
function addLink(shape, { low, high, shape: form, turned }, look, corners, bottom) {
  const [x0, y0, z0] = low, [x1, y1, z1] = high;
  const [cx, cy] = [(x0 + x1) / 2, (y0 + y1) / 2], r = (x1 - x0) / 2;
  shape.turned = turned ? { c: Math.cos(turned), s: Math.sin(turned), x: cx, y: cy } : null;
  const fine = corners >= details[finest].corners;
  const options = { bottom, bevel: fine ? Math.min(0.1 * r, 0.2 * (z1 - z0), 0.004) : 0 };
  if (form === 'cylinder') {
    const cut = (y1 - y0) / 2;
    shape.prism(circle(cx, cy, r, corners).map(([x, y]) => [x, cy + Math.max(-cut, Math.min(cut, y - cy))]), z0, z1, look, options);
  } else if (form === 'wheel') {
    shape.prism(circle((z0 + z1) / 2, cx, r, corners), y0, y1, look, { axis: 1, bottom: true });
  } else if (form === 'ring') {
    shape.ring(cx, cy, r, 0.88 * r, z0, z1, corners, look);
  } else if (form === 'ball') {
    shape.ball(low, high, fine ? 5 : 2, look);
  } else if (form === 'shield') {
    const arc = Array.from({ length: corners / 2 + 1 }, (_, i) => (4 * i) / corners - 1);
    shape.prism([[x0, y0], ...arc.map((t) => [x1 - 0.2 * (y1 - y0) * t * t, cy + ((y1 - y0) / 2) * t]), [x0, y1]], z0, z1, look, options);
  } else if (form === 'arrow') {
    for (const side of [[[x1, cy], [x0, y1], [x0 + 0.25 * (x1 - x0), cy]], [[x0 + 0.25 * (x1 - x0), cy], [x0, y0], [x1, cy]]]) shape.flat(side.map((p) => [...p, z1]), [0, 0, 1], look);
  } else if (form === 'fork') {
    const prong = 0.3 * (y1 - y0);
    shape.box(low, [x1, y0 + prong, z1], look, { bottom: true });
    shape.box([x0, y1 - prong, z0], high, look, { bottom: true });
  } else {
    shape.box(low, high, look, { ...options, bevel: fine ? Math.min(0.15 * (y1 - y0), 0.2 * (z1 - z0), 0.003) : 0 });
  }
  shape.turned = null;
}

/** A lamp on the axis shines to all sides, around what it sits on. */
const isBeacon = ({ at: [x, y] }) => Math.hypot(x, y) < 1e-6;

/** All links and lamps of a kind; `detail` from 0, for far away, to `finest`. */
export function model(body, detail) {
  const { radius, height } = bodySize(body);
  const { look } = body;
  const { most, corners, lamp: rows } = details[detail];
  const shape = new Shape(height);
  let value = look.joints.length;  // the values of joints come first
  const links = look.links.map((link) => ({ ...link, number: link.held === undefined ? -1 : value++ }));
  const face = ({ low, high }) => {
    const [, a, b] = low.map((at, k) => high[k] - at).sort((x, y) => x - y);
    return a * b;
  };
  for (const link of links.sort((a, b) => face(b) - face(a))) {
    if (shape.triangles > most) break;
    const { low, high, on, color, number } = link;
    const paints = { color: color === undefined ? [1, 1, 1] : rgbOf(color), paint: color === undefined ? paint.kind : paint.own, moves: sitsOn(look, on), held: number, middle: (low[1] + high[1]) / 2 };
    addLink(shape, link, paints, corners, (body.rotor_arm ?? 0) > 0);
  }
  look.lamps.forEach((lamp, number) => {
    const { at: [x, y, z], on } = lamp;
    const paints = { color: [0.55, 0.56, 0.58], moves: sitsOn(look, on), paint: paint.led + number, middle: isBeacon(lamp) ? 1 : 0 };
    const wide = isBeacon(lamp) ? 0.42 * radius : Math.max(0.0025, 0.062 * radius) * (rows === 0 ? 1.4 : 1);
    const high = isBeacon(lamp) ? 0.07 * radius : wide;
    if (rows === 0) shape.flat([[x - wide, y, z + high], [x, y - wide, z + high], [x + wide, y, z + high], [x, y + wide, z + high]], [0, 0, 1], paints);
    else shape.ball([x - wide, y - wide, z - high], [x + wide, y + wide, z + high], rows, paints);
  });
  return shape.geometry();
}

/** A square a lamp, whose middle all its corners are at: the shader draws it towards the eye. Null: there is none. */
export function halos({ look }) {
  if (look.lamps.length === 0) return null;
  const position = [], corner = [], part = [], index = [];
  look.lamps.forEach((lamp, number) => {
    const { at, on } = lamp;
    for (const [a, b] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) {
      position.push(...at);
      corner.push(a, b, 0);
      part.push(sitsOn(look, on), paint.led + number, -1, isBeacon(lamp) ? 2 : 1);
    }
    index.push(...[0, 1, 2, 0, 2, 3].map((k) => 4 * number + k));
  });
  const geometry = new THREE.InstancedBufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(position), 3));
  geometry.setAttribute('corner', new THREE.BufferAttribute(new Float32Array(corner), 3));
  geometry.setAttribute('part', new THREE.BufferAttribute(new Float32Array(part), 4));
  geometry.setIndex(index);
  return geometry;
}

const instanceCode = /* glsl */ `
  attribute vec4 part;    // how the vertex moves, what it is painted with; the value that says whether it holds something, and its middle; of a beacon 1
  attribute vec4 pose;    // x, y, z, row in the table of LEDs or -1
  attribute vec4 turn;    // cosine and sine of the heading, roll and pitch
  attribute vec4 lit;     // mixed colour of lit LEDs; w: whether any is lit
  attribute vec4 valuesA; // what moves on the robot
  attribute vec4 valuesB;
  uniform vec4 jointAxis[${mostValues}];  // w: 1 of one that slides
  uniform vec4 jointAt[${mostValues}];    // w: scale of the value
  uniform float jointParent[${mostValues}];
  uniform sampler2D leds;
  uniform vec2 ledsSize;

  float value(float number) {
    vec4 is = vec4(equal(vec4(0.0, 1.0, 2.0, 3.0), vec4(mod(number, 4.0))));
    return dot(number < 3.5 ? valuesA : valuesB, is);
  }
  vec3 about(vec3 v, vec3 axis, float angle) {
    return cos(angle) * v + sin(angle) * cross(axis, v) + (1.0 - cos(angle)) * dot(axis, v) * axis;
  }
  vec3 aboutZ(vec3 v, vec2 by) {
    return vec3(by.x * v.x - by.y * v.y, by.y * v.x + by.x * v.y, v.z);
  }
  vec3 lean(vec3 v, vec2 roll, vec2 pitch) {
    v = vec3(v.x, roll.x * v.y - roll.y * v.z, roll.y * v.y + roll.x * v.z);
    return vec3(pitch.x * v.x + pitch.y * v.z, v.y, pitch.x * v.z - pitch.y * v.x);
  }
  void place(inout vec3 p, inout vec3 n) {
    float joint = part.x - ${moves.joint}.0;
    for (int i = 0; i < ${mostValues}; ++i) {
      if (joint < -0.5) break;
      int j = int(joint + 0.5);
      float by = jointAt[j].w * value(joint);
      if (jointAxis[j].w > 0.5) {
        p += by * jointAxis[j].xyz;
      } else {
        p = jointAt[j].xyz + about(p - jointAt[j].xyz, jointAxis[j].xyz, by);
        n = about(n, jointAxis[j].xyz, by);
      }
      joint = jointParent[j];
    }
    if (turn.z != 0.0 || turn.w != 0.0) {
      vec2 roll = vec2(cos(turn.z), sin(turn.z)), pitch = vec2(cos(turn.w), sin(turn.w));
      p = lean(p, roll, pitch);
      n = lean(n, roll, pitch);
    }
    p = aboutZ(p, turn.xy) + pose.xyz;
    n = aboutZ(n, turn.xy);
  }
  vec3 ledColor() {
    if (pose.w < -0.5) return lit.rgb;
    return texture2D(leds, (vec2(floor(part.y - ${paint.led}.0 + 0.5), pose.w) + 0.5) / ledsSize).rgb;
  }
  bool shines(vec3 c) { return dot(c, vec3(1.0)) > 0.02; }
`;

const bodyShader = /* glsl */ `
  attribute vec3 tint;
  attribute vec4 over;    // a colour over all of it; w: how much
  uniform vec3 kindColor;
  varying vec3 color;
  ${instanceCode}
  ${lightCode}
  void main() {
    vec3 p = position, n = normal;
    bool holds = part.z > -0.5 && value(part.z) != 0.0;
    if (part.y > 1.5 && part.w > 0.5 && !shines(ledColor())) p.xy *= 0.3;  // a beacon that is not lit is a bulb
    if (holds) p.y = part.w + 0.45 * (p.y - part.w);  // prongs close
    place(p, n);
    gl_Position = projectionMatrix * (viewMatrix * vec4(p, 1.0));
    vec3 base = part.y < 0.5 ? (holds ? 0.35 : 1.0) * tint : tint * kindColor;
    if (part.y < 1.5) {
      float bright = max(base.r, max(base.g, base.b));
      color = mix(base, over.rgb * (0.3 + 0.7 * bright), over.w * smoothstep(0.1, 0.35, bright)) * lightOn(normalize(n));
    } else {
      vec3 led = ledColor();
      color = shines(led) ? mix(led, vec3(1.0), 0.3) : tint * lightOn(normalize(n));
    }
  }
`;
const haloShader = /* glsl */ `
  attribute vec3 corner;
  uniform float haloSize;
  varying vec3 color;
  varying vec2 at;
  ${instanceCode}
  void main() {
    vec3 p = position, n = vec3(0.0, 0.0, 1.0);
    place(p, n);
    color = ledColor();
    at = corner.xy;
    vec4 seen = viewMatrix * vec4(p, 1.0);
    seen.xy += corner.xy * haloSize * part.w;
    seen.z += 0.6 * haloSize * part.w;  // before what carries the lamp
    gl_Position = shines(color) ? projectionMatrix * seen : vec4(2.0, 2.0, 2.0, 1.0);
  }
`;

/** { body, halo }: materials of a kind. */
export function robotMaterials(body, kindColor, leds) {
  const { look } = body;
  const joints = look.joints.slice(0, mostValues);
  const padded = (values, empty) => Array.from({ length: mostValues }, (_, i) => values[i] ?? empty);
  const uniforms = {
    kindColor: { value: new THREE.Color(kindColor) },
    haloSize: { value: Math.max(0.012, 0.34 * bodySize(body).radius) },
    leds: leds.texture,
    ledsSize: leds.size,
    jointAxis: { value: padded(joints.map(({ axis, slides }) => new THREE.Vector4(...axis, slides ? 1 : 0)), new THREE.Vector4()) },
    jointAt: { value: padded(joints.map(({ at, scale }) => new THREE.Vector4(...at, scale)), new THREE.Vector4()) },
    jointParent: { value: padded(joints.map(({ on }) => jointOf(look, on)), -1) },
  };
  return {
    body: new THREE.ShaderMaterial({ uniforms, vertexShader: bodyShader, fragmentShader: 'varying vec3 color; void main() { gl_FragColor = vec4(color, 1.0); }' }),
    halo: new THREE.ShaderMaterial({
      uniforms, vertexShader: haloShader, transparent: true, depthWrite: false, blending: THREE.AdditiveBlending,
      fragmentShader: /* glsl */ `
        varying vec3 color;
        varying vec2 at;
        void main() {
          float far = dot(at, at);
          gl_FragColor = vec4(color, max(0.0, 0.75 * exp(-4.5 * far) - 0.01));
        }`,
    }),
  };
}
