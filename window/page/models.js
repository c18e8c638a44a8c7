// Shapes of robots, made from what the server says of a kind's body, and the shader that draws all of a kind at once.
import * as THREE from './three.module.js';

// What a vertex belongs to, for the shader.
const moves = { body: 0, ground: 1, joint: 2 };             // joint: 2 + its number
const paint = { own: 0, kind: 1, lit: 2, led: 3 };  // led: 3 + its number

/** Collects triangles. */
class Shape {
  position = [];
  normal = [];
  tint = [];
  part = [];

  /** Of a link that may hold something: `held` is the number of that value, `middle` the y of its middle. */
  triangle(points, normals, { color = [1, 1, 1], moves: move = moves.body, paint: painted = paint.kind, held = -1, middle = 0 }) {
    for (let i = 0; i < 3; ++i) {
      this.position.push(...points[i]);
      this.normal.push(...normals[i]);
      this.tint.push(...color);
      this.part.push(move, painted, held, middle);
    }
  }

  flat(points, normal, look) {
    for (let i = 2; i < points.length; ++i) this.triangle([points[0], points[i - 1], points[i]], [normal, normal, normal], look);
  }

  disc(cx, cy, z, radius, corners, look) {
    const points = [];
    for (let i = 0; i < corners; ++i) {
      const a = (2 * Math.PI * i) / corners;
      points.push([cx + radius * Math.cos(a), cy + radius * Math.sin(a), z]);
    }
    this.flat(points, [0, 0, 1], look);
  }

  /** The side of an upright cylinder or cone stump. */
  side(cx, cy, z0, r0, z1, r1, corners, look) {
    const slope = (r0 - r1) / Math.max(1e-9, z1 - z0);
    for (let i = 0; i < corners; ++i) {
      const [a, b] = [(2 * Math.PI * i) / corners, (2 * Math.PI * (i + 1)) / corners];
      const at = (angle, r, z) => [cx + r * Math.cos(angle), cy + r * Math.sin(angle), z];
      const out = (angle) => [Math.cos(angle), Math.sin(angle), slope];
      this.triangle([at(a, r0, z0), at(b, r0, z0), at(b, r1, z1)], [out(a), out(b), out(b)], look);
      this.triangle([at(a, r0, z0), at(b, r1, z1), at(a, r1, z1)], [out(a), out(b), out(a)], look);
    }
  }

  box(x0, x1, y0, y1, z0, z1, look) {
    const p = (x, y, z) => [x, y, z];
    this.flat([p(x0, y0, z1), p(x1, y0, z1), p(x1, y1, z1), p(x0, y1, z1)], [0, 0, 1], look);
    this.flat([p(x1, y0, z0), p(x1, y1, z0), p(x1, y1, z1), p(x1, y0, z1)], [1, 0, 0], look);
    this.flat([p(x0, y1, z0), p(x0, y0, z0), p(x0, y0, z1), p(x0, y1, z1)], [-1, 0, 0], look);
    this.flat([p(x1, y1, z0), p(x0, y1, z0), p(x0, y1, z1), p(x1, y1, z1)], [0, 1, 0], look);
    this.flat([p(x0, y0, z0), p(x1, y0, z0), p(x1, y0, z1), p(x0, y0, z1)], [0, -1, 0], look);
  }

  /** A small four-sided pyramid, upright. */
  bead(x, y, z, size, look) {
    const top = [x, y, z + size];
    const corners = [[1, 0], [0, 1], [-1, 0], [0, -1]].map(([a, b]) => [x + size * a, y + size * b, z - 0.3 * size]);
    for (let i = 0; i < 4; ++i) {
      const [a, b] = [corners[i], corners[(i + 1) % 4]];
      const n = [0, 0, 1];  // they shine
      this.triangle([a, b, top], [n, n, n], look);
    }
  }

  /** The same from far away: a square. */
  fleck(x, y, z, size, look) {
    const level = z + 0.5 * size;
    this.flat([[x - size, y, level], [x, y - size, level], [x + size, y, level], [x, y + size, level]], [0, 0, 1], look);
  }

  /** Corners that triangles share are kept once: half of the work where there is no graphics processor. */
  geometry() {
    const known = new Map();
    const kept = { position: [], normal: [], tint: [], part: [] };
    const index = [];
    for (let i = 0; i < this.part.length / 4; ++i) {
      const corner = { position: this.position.slice(3 * i, 3 * i + 3), normal: this.normal.slice(3 * i, 3 * i + 3), tint: this.tint.slice(3 * i, 3 * i + 3), part: this.part.slice(4 * i, 4 * i + 4) };
      const key = JSON.stringify(corner);
      if (!known.has(key)) {
        known.set(key, known.size);
        for (const [name, values] of Object.entries(corner)) kept[name].push(...values);
      }
      index.push(known.get(key));
    }
    const geometry = new THREE.InstancedBufferGeometry();
    for (const [name, values] of Object.entries(kept)) {
      geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(values), name === 'part' ? 4 : 3));
    }
    geometry.setIndex(index);
    return geometry;
  }
}

/** Values that move a robot, at most; further ones stay as they are. */
export const mostValues = 8;

const dark = [0.13, 0.14, 0.16], mid = [0.45, 0.47, 0.5], light = [0.92, 0.93, 0.94], shade = [0, 0, 0];

/** Radius and height that can be drawn, whatever the file says. */
export const bodySize = (body) => ({ radius: Math.max(0.005, body.radius || 0), height: Math.max(0.01, body.height || 0.05) });
export const isFlyer = (body) => (body.rotor_arm ?? 0) > 0;

/** The arrow on top that shows where front is. */
function arrow(shape, r, z, look) {
  shape.flat([[0.82 * r, 0, z], [-0.3 * r, 0.48 * r, z], [-0.05 * r, 0, z]], [0, 0, 1], look);
  shape.flat([[0.82 * r, 0, z], [-0.05 * r, 0, z], [-0.3 * r, -0.48 * r, z]], [0, 0, 1], look);
}

/** The number of the joint of that name; -1: the body. */
const jointOf = (look, name) => (name === undefined ? -1 : look.joints.findIndex((joint) => joint.name === name));
const sitsOn = (look, name) => {
  const joint = jointOf(look, name);
  return joint < 0 || joint >= mostValues ? moves.body : moves.joint + joint;
};
const rgbOf = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);

/** What the kind says that there is beside the body, but for lamps. */
function links(shape, look, fine) {
  let value = look.joints.length;  // the values of joints come first
  for (const { low: [x0, y0, z0], high: [x1, y1, z1], shape: form, on, color, held } of look.links) {
    const paints = { color: color === undefined ? light : rgbOf(color), moves: sitsOn(look, on), paint: paint.own, held: held === undefined ? -1 : value++, middle: (y0 + y1) / 2 };
    if (form === 'cylinder') {
      const x = (x0 + x1) / 2, r = (x1 - x0) / 2, corners = fine ? 14 : 8;
      shape.side(x, paints.middle, z0, r, z1, r, corners, paints);
      shape.disc(x, paints.middle, z1, r, corners, paints);
    } else if (form === 'fork') {
      const prong = 0.3 * (y1 - y0);
      shape.box(x0, x1, y0, y0 + prong, z0, z1, paints);
      shape.box(x0, x1, y1 - prong, y1, z0, z1, paints);
    } else {
      shape.box(x0, x1, y0, y1, z0, z1, paints);
    }
  }
}

/** A robot near enough to be seen: body, wheels or rotors, what its kind's look has, every lamp. Of `fine` ones curves are rounder. */
export function fullModel(body, fine) {
  const corners = fine ? 14 : 8;
  const { radius: r, height: h } = bodySize(body);
  const shape = new Shape();
  shape.disc(0, 0, 0.0008, isFlyer(body) ? 1.3 * body.rotor_arm : 1.06 * r, corners, { color: shade, moves: moves.ground, paint: paint.own });
  if (isFlyer(body)) {
    const arm = body.rotor_arm, rotor = 0.45 * arm, deck = 0.62 * h;
    shape.side(0, 0, 0.25 * h, 0.3 * r, deck, 0.42 * r, 10, {});
    shape.disc(0, 0, deck, 0.42 * r, 10, {});
    arrow(shape, 0.4 * r, deck + 0.003, { color: dark, paint: paint.own });
    for (let i = 0; i < 4; ++i) {
      const a = Math.PI / 4 + (i * Math.PI) / 2;
      const [x, y] = [arm * Math.cos(a), arm * Math.sin(a)];
      const w = 0.05 * arm;
      const across = [-Math.sin(a) * w, Math.cos(a) * w];
      shape.flat([[across[0], across[1], deck], [-across[0], -across[1], deck], [x - across[0], y - across[1], deck], [x + across[0], y + across[1], deck]],
        [0, 0, 1], { color: mid, paint: paint.own });
      shape.side(x, y, deck, rotor, deck + 0.06 * arm, rotor, corners, { color: i === 0 || i === 3 ? light : dark, paint: paint.own });
      shape.side(x, y, deck, 0.9 * rotor, deck + 0.06 * arm, 0.9 * rotor, corners, { color: i === 0 || i === 3 ? light : dark, paint: paint.own });
    }
    shape.side(0, 0, 0, 0.34 * r, 0.25 * h, 0.3 * r, 8, { color: mid, paint: paint.own });
  } else {
    const upper = sitsOn(body.look, body.look.upper);
    const split = upper === moves.body ? 0.86 * h : 0.55 * h;  // above: what turns
    shape.side(0, 0, 0.12 * h, 0.93 * r, split, 0.97 * r, corners, { color: mid, paint: paint.kind });
    for (const y of [0.72 * r, -0.72 * r]) {
      shape.box(-0.42 * r, 0.42 * r, y - 0.1 * r, y + 0.1 * r, 0, 0.5 * Math.min(h, r), { color: dark, paint: paint.own });
    }
    if (fine) shape.disc(0, 0, split, 0.97 * r, corners, { color: dark, paint: paint.own });
    shape.side(0, 0, split, 0.9 * r, h, 0.86 * r, corners, { moves: upper, paint: paint.lit });
    shape.disc(0, 0, h, 0.86 * r, corners, { moves: upper, paint: paint.lit });
    arrow(shape, 0.86 * r, h + 0.002, { color: dark, paint: paint.own });
  }
  links(shape, body.look, fine);
  const size = Math.max(0.004, 0.075 * r);
  body.look.lamps.forEach(({ at: [x, y, z], on }, number) => {
    shape[fine ? 'bead' : 'fleck'](x, y, Math.max(z, isFlyer(body) ? 0.66 * h : 0), size, { color: dark, moves: sitsOn(body.look, on), paint: paint.led + number });
  });
  return shape.geometry();
}

const vertexShader = /* glsl */ `
  attribute vec3 tint;
  attribute vec4 part;    // how the vertex moves, what it is painted with; the value that says whether it holds something, and its middle
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
  uniform vec3 kindColor;
  uniform float byKind;
  varying vec4 color;

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

  void main() {
    vec3 p = position, n = normal;
    bool onGround = part.x > 0.5 && part.x < 1.5;
    bool holds = part.z > -0.5 && value(part.z) != 0.0;
    if (holds) p.y = part.w + 0.45 * (p.y - part.w);  // prongs close
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
    if (!onGround) {
      vec2 roll = vec2(cos(turn.z), sin(turn.z)), pitch = vec2(cos(turn.w), sin(turn.w));
      p = lean(p, roll, pitch);
      n = lean(n, roll, pitch);
    }
    p = aboutZ(p, turn.xy);
    n = aboutZ(n, turn.xy);
    p += vec3(pose.xy, onGround ? 0.0 : pose.z);
    gl_Position = projectionMatrix * viewMatrix * vec4(p, 1.0);

    float light = 0.62 + 0.38 * max(0.0, dot(normalize(n), vec3(0.36, -0.48, 0.8)));
    vec3 shown;
    if (part.y < 0.5) shown = (holds ? 0.35 : 1.0) * tint * light;
    else if (part.y < 1.5) shown = tint * kindColor * light;
    else if (part.y < 2.5) shown = lit.w > 0.45 && byKind < 0.5 ? lit.rgb * (0.8 + 0.2 * light) : kindColor * light;
    else {
      vec4 led = lit;
      if (pose.w > -0.5) led = texture2D(leds, (vec2(floor(part.y - 2.5), pose.w) + 0.5) / ledsSize);
      shown = dot(led.rgb, vec3(1.0)) > 0.02 ? led.rgb : tint;
    }
    color = vec4(shown, onGround ? 0.22 : 1.0);  // on the ground is the shadow alone
  }
`;
const fragmentShader = /* glsl */ `
  varying vec4 color;
  void main() { gl_FragColor = color; }
`;

/** `look`: of the kind. */
export function robotMaterial(kindColor, leds, look) {
  const joints = look.joints.slice(0, mostValues);
  const padded = (values, empty) => Array.from({ length: mostValues }, (_, i) => values[i] ?? empty);
  return new THREE.ShaderMaterial({
    vertexShader,
    fragmentShader,
    side: THREE.DoubleSide,
    transparent: true,
    uniforms: {
      kindColor: { value: new THREE.Color(kindColor) },
      leds: leds.texture,
      ledsSize: leds.size,
      byKind: { value: 0 },
      jointAxis: { value: padded(joints.map(({ axis, slides }) => new THREE.Vector4(...axis, slides ? 1 : 0)), new THREE.Vector4()) },
      jointAt: { value: padded(joints.map(({ at, scale }) => new THREE.Vector4(...at, scale)), new THREE.Vector4()) },
      jointParent: { value: padded(joints.map(({ on }) => jointOf(look, on)), -1) },
    },
  });
}

/** Robots that are few pixels large, or too many: discs with their front marked, one vertex each. */
export function discMaterial() {
  return new THREE.ShaderMaterial({
    vertexShader: /* glsl */ `
      attribute float radius;
      attribute vec2 aim;     // cosine and sine of the heading
      attribute vec3 tint;
      uniform float height;   // of the picture in its own pixels
      uniform float smallest;
      varying vec3 color;
      varying vec2 front;     // in the picture, y down; zero: too small to be seen
      void main() {
        color = tint;
        vec4 middle = projectionMatrix * viewMatrix * vec4(position, 1.0);
        vec4 ahead = projectionMatrix * viewMatrix * vec4(position + vec3(aim, 0.0) * radius, 1.0);
        float size = radius * projectionMatrix[1][1] * height / middle.w;
        vec2 to = ahead.xy / ahead.w - middle.xy / middle.w;
        to.x *= projectionMatrix[1][1] / projectionMatrix[0][0];
        front = size > 4.5 ? normalize(vec2(to.x, -to.y) + vec2(1e-9)) : vec2(0.0);
        gl_Position = middle;
        gl_PointSize = max(smallest, size);
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
          if (away > 0.7) shown *= 0.72;
          if (along > -0.3 && across < 0.42 * (0.85 - along)) shown *= 0.3;
        }
        gl_FragColor = vec4(shown, 1.0);
      }`,
    uniforms: { height: { value: 600 }, smallest: { value: 2 } },
  });
}
