// Triangles of simple forms: what the models of robots are made of.
import * as THREE from './three.module.js';

/** Collects triangles. `look` of a call: { color, moves, paint, held, middle } (models.js). */
export class Shape {
  position = [];
  normal = [];
  tint = [];
  part = [];
  turned = null;  // { c, s, x, y }: what follows is turned about that upright line

  /** `height`: up to which the floor takes light away. */
  constructor(height) {
    this.height = height;
  }

  triangle(points, normals, { color, moves, paint, held = -1, middle = 0 }) {
    for (let i = 0; i < 3; ++i) {
      let [x, y, z] = points[i], [nx, ny, nz] = normals[i];
      if (this.turned !== null) {
        const { c, s, x: ax, y: ay } = this.turned;
        [x, y] = [ax + c * (x - ax) - s * (y - ay), ay + s * (x - ax) + c * (y - ay)];
        [nx, ny] = [c * nx - s * ny, s * nx + c * ny];
      }
      const share = 0.74 + 0.26 * Math.min(1, Math.max(0, z / (0.7 * this.height)));
      this.position.push(x, y, z);
      this.normal.push(nx, ny, nz);
      this.tint.push(...color.map((value) => share * value));
      this.part.push(moves, paint, held, middle);
    }
  }

  get triangles() {
    return this.part.length / 12;
  }

  flat(points, normal, look) {
    for (let i = 2; i < points.length; ++i) this.triangle([points[0], points[i - 1], points[i]], [normal, normal, normal], look);
  }

  /** A prism over an outline, counter-clockwise; its edges are round where they turn little. `bevel`: of the upper edge. `axis` 1: along y. */
  prism(outline, z0, z1, look, { bevel = 0, bottom = false, axis = 2 } = {}) {
    const count = outline.length;
    const middle = [0, 1].map((k) => outline.reduce((sum, p) => sum + p[k], 0) / count);
    const at = axis === 2 ? ([a, b], c) => [a, b, c] : ([a, b], c) => [b, c, a];  // of a wheel the outline lies in z, x
    const edges = outline.map(([x, y], i) => {
      const [u, v] = outline[(i + 1) % count];
      const length = Math.hypot(u - x, v - y) || 1;
      return [(v - y) / length, (x - u) / length];
    });
    const normal = (edge, other, up = 0) => {
      const [a, b] = [edges[(edge + count) % count], edges[(other + count) % count]];
      const round = a[0] * b[0] + a[1] * b[1] > 0.7;
      const [x, y] = round ? [a[0] + b[0], a[1] + b[1]] : a;
      const length = Math.hypot(x, y, up) || 1;
      return at([x / length, y / length], up / length);
    };
    const inner = bevel <= 0 ? outline : outline.map(([x, y]) => {
      const length = Math.hypot(x - middle[0], y - middle[1]) || 1;
      return [x - (bevel * (x - middle[0])) / length, y - (bevel * (y - middle[1])) / length];
    });
    const side = (low, high, c0, c1, up) => {
      for (let i = 0; i < count; ++i) {
        const next = (i + 1) % count;
        const [p, q, r, s] = [at(low[i], c0), at(low[next], c0), at(high[next], c1), at(high[i], c1)];
        const [n, m] = [normal(i, i - 1, up), normal(i, i + 1, up)];
        this.triangle([p, q, r], [n, m, m], look);
        this.triangle([p, r, s], [n, m, n], look);
      }
    };
    side(outline, outline, z0, z1 - bevel, 0);
    if (bevel > 0) side(outline, inner, z1 - bevel, z1, 1.2);
    const cap = (ring, c, sign) => {
      const points = ring.map((p) => at(p, c));
      this.flat(sign > 0 ? points : points.reverse(), at([0, 0], sign), look);
    };
    cap(inner, z1, 1);
    if (bottom) cap(outline, z0, -1);
  }

  box([x0, y0, z0], [x1, y1, z1], look, options) {
    this.prism([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], z0, z1, look, options);
  }

  /** Hollow, upright. */
  ring(cx, cy, outer, inner, z0, z1, corners, look) {
    const rim = (r) => circle(cx, cy, r, corners);
    this.band(rim(outer), z0, z1, 1, look);
    this.band(rim(inner), z0, z1, -1, look);
    const [a, b] = [rim(outer), rim(inner)];
    for (const [z, up] of [[z1, 1], [z0, -1]]) {
      for (let i = 0; i < corners; ++i) {
        const k = (i + 1) % corners;
        const points = [[...a[i], z], [...a[k], z], [...b[k], z], [...b[i], z]];
        this.flat(up > 0 ? points : points.reverse(), [0, 0, up], look);
      }
    }
  }

  band(rim, z0, z1, out, look) {
    const [cx, cy] = [0, 1].map((k) => rim.reduce((sum, p) => sum + p[k], 0) / rim.length);
    const normal = ([x, y]) => {
      const length = Math.hypot(x - cx, y - cy) || 1;
      return [(out * (x - cx)) / length, (out * (y - cy)) / length, 0];
    };
    rim.forEach((p, i) => {
      const q = rim[(i + 1) % rim.length];
      const corners = [[...p, z0], [...q, z0], [...q, z1], [...p, z1]], normals = [normal(p), normal(q), normal(q), normal(p)];
      for (const order of out > 0 ? [[0, 1, 2], [0, 2, 3]] : [[0, 2, 1], [0, 3, 2]]) this.triangle(order.map((k) => corners[k]), order.map((k) => normals[k]), look);
    });
  }

  /** An ellipsoid in a box. */
  ball([x0, y0, z0], [x1, y1, z1], rows, look) {
    const middle = [(x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2], half = [(x1 - x0) / 2, (y1 - y0) / 2, (z1 - z0) / 2];
    const around = 2 * rows;
    const on = (row, column) => {
      const up = Math.PI * (row / rows - 0.5), turn = (2 * Math.PI * column) / around;
      return [Math.cos(up) * Math.cos(turn), Math.cos(up) * Math.sin(turn), Math.sin(up)];
    };
    const at = (n) => n.map((value, k) => middle[k] + half[k] * value);
    for (let row = 0; row < rows; ++row) {
      for (let column = 0; column < around; ++column) {
        const [a, b, c, d] = [on(row, column), on(row, column + 1), on(row + 1, column + 1), on(row + 1, column)];
        if (row > 0) this.triangle([at(a), at(b), at(c)], [a, b, c], look);
        if (row < rows - 1) this.triangle([at(a), at(c), at(d)], [a, c, d], look);
      }
    }
  }

  /** Corners that triangles share are kept once: half of the work where there is no graphics processor. */
  geometry() {
    const known = new Map();
    const kept = { position: [], normal: [], tint: [], part: [] };
    const sizes = { position: 3, normal: 3, tint: 3, part: 4 };
    const index = [];
    for (let i = 0; i < this.part.length / 4; ++i) {
      const corner = Object.entries(sizes).map(([name, size]) => this[name].slice(size * i, size * i + size));
      const key = corner.join();
      if (!known.has(key)) {
        known.set(key, known.size);
        Object.keys(sizes).forEach((name, k) => kept[name].push(...corner[k]));
      }
      index.push(known.get(key));
    }
    const geometry = new THREE.InstancedBufferGeometry();
    for (const [name, size] of Object.entries(sizes)) geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(kept[name]), size));
    geometry.setIndex(index);
    return geometry;
  }
}

export function circle(cx, cy, radius, corners) {
  return Array.from({ length: corners }, (_, i) => {
    const a = (2 * Math.PI * (i + 0.5)) / corners;
    return [cx + radius * Math.cos(a), cy + radius * Math.sin(a)];
  });
}
