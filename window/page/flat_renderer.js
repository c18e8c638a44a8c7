// Draws the 3D scene with a 2D canvas, for browsers without WebGL: the floor, boxes, cylinders and lamps as outlines and
// areas, robots as discs, all lines. The part of THREE.WebGLRenderer's interface that view.js uses.
import * as THREE from './three.module.js';

const corners_of_disc = 20;

export class FlatRenderer {
  constructor(canvas) {
    this.canvas = canvas;
    this.pen = canvas.getContext('2d');
    this.ratio = 1;
  }

  setPixelRatio(ratio) {
    this.ratio = ratio;
  }

  setSize(width, height) {
    this.canvas.width = width * this.ratio;
    this.canvas.height = height * this.ratio;
  }

  setClearColor(color) {
    this.sky = color;
  }

  render(scene, eye) {
    const { pen, canvas } = this;
    pen.fillStyle = this.sky;
    pen.fillRect(0, 0, canvas.width, canvas.height);
    this.eye = eye;
    this.matrix = new THREE.Matrix4().multiplyMatrices(eye.projectionMatrix, eye.matrixWorldInverse).elements;
    const things = [], discs = [];
    scene.updateMatrixWorld();
    scene.traverseVisible((object) => {
      const attributes = object.geometry?.attributes;
      if (attributes === undefined) return;
      if (object.isPoints) this.gatherDiscs(object, discs);
      else if (attributes.size !== undefined) this.gatherThings(object, things);
      else if (object.isLineSegments) this.lines(object);
      else if (object.isMesh && !object.geometry.isInstancedBufferGeometry) this.mesh(object);
    });
    // What is farther is painted first.
    for (const shape of [...things, ...discs].sort((a, b) => b.depth - a.depth)) this.polygon(shape.points, shape.color, 'rgba(0,0,0,0.55)');
  }

  /** Place in the picture, or null: behind the eye. */
  at(x, y, z) {
    const m = this.matrix;
    const w = m[3] * x + m[7] * y + m[11] * z + m[15];
    if (w <= 0) return null;
    return [((m[0] * x + m[4] * y + m[8] * z + m[12]) / w + 1) * 0.5 * this.canvas.width, (1 - (m[1] * x + m[5] * y + m[9] * z + m[13]) / w) * 0.5 * this.canvas.height];
  }

  depth(x, y, z) {
    const m = this.eye.matrixWorldInverse.elements;
    return -(m[2] * x + m[6] * y + m[10] * z + m[14]);
  }

  polygon(points, color, edge = null) {
    const { pen } = this;
    if (points.length === 0 || points.includes(null)) return;
    pen.beginPath();
    points.forEach(([x, y], i) => (i === 0 ? pen.moveTo(x, y) : pen.lineTo(x, y)));
    pen.closePath();
    pen.fillStyle = color;
    pen.fill();
    if (edge === null) return;
    pen.strokeStyle = edge;
    pen.lineWidth = 1;
    pen.stroke();
  }

  /** Boxes and cylinders: sides, then the top. */
  gatherThings(object, things) {
    const { pose, size, tint } = object.geometry.attributes;
    const { round } = object.userData;
    for (let i = 0; i < object.geometry.maxInstancedCount; ++i) {
      const [x, y, z, heading] = pose.array.subarray(4 * i, 4 * i + 4);
      const [length, width, height] = size.array.subarray(4 * i, 4 * i + 3);
      const c = Math.cos(heading), s = Math.sin(heading);
      const outline = round ? Array.from({ length: corners_of_disc }, (_, k) => [0.5 * Math.cos((2 * Math.PI * k) / corners_of_disc), 0.5 * Math.sin((2 * Math.PI * k) / corners_of_disc)])
        : [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
      const ring = (level) => outline.map(([a, b]) => this.at(x + c * a * length - s * b * width, y + s * a * length + c * b * width, level));
      const color = (share) => `rgb(${[...tint.array.subarray(3 * i, 3 * i + 3)].map((value) => Math.round(255 * share * value)).join()})`;
      const depth = this.depth(x, y, z);
      const [foot, top] = [ring(z), ring(z + height)];
      // Sides that face away are hidden by those that do not.
      const sides = outline.map(([a, b], k) => {
        const next = (k + 1) % outline.length;
        const middle = [0.5 * (a + outline[next][0]), 0.5 * (b + outline[next][1])];
        const away = this.depth(x + c * middle[0] * length - s * middle[1] * width, y + s * middle[0] * length + c * middle[1] * width, z);
        return { depth: away + 1e-3, points: [foot[k], foot[next], top[next], top[k]], color: color(0.75) };
      });
      things.push(...sides, { depth: Math.min(depth, ...sides.map((side) => side.depth)) - 1e-3, points: top, color: color(1) });
    }
  }

  /** Robots, with their fronts as corners. */
  gatherDiscs(object, discs) {
    const outline = [[1.35, 0], [0.5, 0.8], [-0.4, 0.9], [-0.95, 0.3], [-0.95, -0.3], [-0.4, -0.9], [0.5, -0.8]];
    object.userData.discs?.((x, y, z, r, c, s, color) => {
      const points = outline.map(([a, b]) => this.at(x + r * (c * a - s * b), y + r * (s * a + c * b), z));
      discs.push({ depth: this.depth(x, y, z), points, color });
    });
  }

  lines(object) {
    const { position, tint } = object.geometry.attributes;
    const { pen } = this;
    pen.lineWidth = 1;
    for (let i = 0; i + 1 < position.count; i += 2) {
      const a = this.at(...position.array.subarray(3 * i, 3 * i + 3)), b = this.at(...position.array.subarray(3 * i + 3, 3 * i + 6));
      if (a === null || b === null) continue;
      pen.strokeStyle = tint === undefined ? object.material.color.getStyle() : `rgba(${[...tint.array.subarray(4 * i, 4 * i + 3)].join()},${tint.array[4 * i + 3] / 255})`;
      pen.beginPath();
      pen.moveTo(...a);
      pen.lineTo(...b);
      pen.stroke();
    }
  }

  /** The floor, rings, lamps: triangles. */
  mesh(object) {
    const { geometry, material } = object;
    if (material.color === undefined) return;
    const { position } = geometry.attributes;
    const place = new THREE.Vector3();
    const corner = (i) => {
      place.fromBufferAttribute(position, geometry.index === null ? i : geometry.index.getX(i)).applyMatrix4(object.matrixWorld);
      return this.at(place.x, place.y, place.z);
    };
    if (material.map?.image) return this.picture(object, material.map.image);
    const count = geometry.index === null ? position.count : geometry.index.count;
    const color = material.color.getStyle();
    for (let i = 0; i + 2 < count; i += 3) this.polygon([corner(i), corner(i + 1), corner(i + 2)], color, color);
  }

  /** The floor's picture: in small parallelograms, as the canvas knows no perspective. */
  picture(object, image) {
    const { width, height } = object.geometry.parameters, { x, y, z } = object.position;
    const parts = 24;
    for (let i = 0; i < parts; ++i) {
      for (let k = 0; k < parts; ++k) {
        const at = (a, b) => this.at(x + width * ((i + a) / parts - 0.5), y + height * (0.5 - (k + b) / parts), z);
        const [p, q, r] = [at(0, 0), at(1.02, 0), at(0, 1.02)];
        if (p === null || q === null || r === null) continue;
        const [w, h] = [image.width / parts, image.height / parts];
        this.pen.setTransform((q[0] - p[0]) / w, (q[1] - p[1]) / w, (r[0] - p[0]) / h, (r[1] - p[1]) / h, p[0], p[1]);
        this.pen.drawImage(image, i * w, k * h, w, h, 0, 0, w, h);
      }
    }
    this.pen.setTransform(1, 0, 0, 1, 0, 0);
  }
}
