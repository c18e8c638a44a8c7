// The camera: turns around a point of the floor, looks from the top, or follows a robot. Mouse, pen, fingers and keys.
import * as THREE from './three.module.js';

const fov_deg = 40;
const click_px = 5;  // a pointer that moved less was a click
const lowest_rad = 0.02, highest_rad = Math.PI / 2 - 0.001;

/** What looks is `camera.eye`, a perspective one in the free view, an orthographic one from the top. */
export class Camera {
  /** `onClick(x_px, y_px, event)`; `grab(x_px, y_px, event)` may return a drag { move(x, y, event), end(event) }, which then has the pointer. */
  constructor(canvas, { invalidate, onClick, grab }) {
    this.canvas = canvas;
    this.invalidate = invalidate;
    this.onClick = onClick;
    this.grab = grab;
    this.free = new THREE.PerspectiveCamera(fov_deg, 1, 0.01, 1000);
    this.top = new THREE.OrthographicCamera(-1, 1, 1, -1, -1000, 1000);
    this.free.up.set(0, 0, 1);
    this.isTop = false;
    this.target = new THREE.Vector3();
    this.distance = 5;
    this.azimuth = -Math.PI / 2 - 0.35;  // where the eye is, as seen from the target: south, a little west
    this.elevation = 0.9;
    this.home = { x: 0, y: 0, width: 5, depth: 5 };
    this.followed = null;  // id of a robot
    this.aspect = 1;
    this.height_px = 1;
    this.atHome = true;  // nobody has moved it
    this.homeDistance = this.distance;
    this.pointers = new Map();
    this.listen();
  }

  get eye() {
    return this.isTop ? this.top : this.free;
  }

  resize(width_px, height_px) {
    this.aspect = width_px / height_px;
    this.width_px = width_px;
    this.height_px = height_px;
    if (this.atHome) this.goHome();
    else this.place();
  }

  /** Looks at all of an arena when it is another one than before. */
  setHome(arena) {
    const width = arena.max_x - arena.min_x, depth = arena.max_y - arena.min_y;
    const home = { x: (arena.min_x + arena.max_x) / 2, y: (arena.min_y + arena.max_y) / 2, width, depth };
    const same = JSON.stringify(home) === JSON.stringify(this.home);
    this.home = home;
    if (!same) this.goHome();
  }

  goHome() {
    const { x, y, width, depth } = this.home;
    this.followed = null;
    this.target.set(x, y, 0);
    this.azimuth = -Math.PI / 2 - (this.isTop ? 0 : 0.35);
    this.elevation = 1.0;
    this.distance = Math.max(width, depth);
    // Nearer or farther until the corners lie within the picture, with room for what is written beside them.
    for (let round = 0; round < 8; ++round) {
      this.place();
      let widest = 0.1, lowest = 1, highest = -1;
      for (const [right, up] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) {
        const p = new THREE.Vector3(x + (right * width) / 2, y + (up * depth) / 2, 0).project(this.eye);
        if (p.z > 1) widest = 2;
        widest = Math.max(widest, Math.abs(p.x));
        [lowest, highest] = [Math.min(lowest, p.y), Math.max(highest, p.y)];
      }
      this.distance *= Math.max(widest, (highest - lowest) / 2) / 0.86;
      if (!this.isTop && highest < 2) this.pan(0, ((highest + lowest) / 4) * this.height_px);
    }
    this.atHome = true;
    this.homeDistance = this.distance;
    this.place();
  }

  setTop(top) {
    this.isTop = top;
    if (this.atHome) this.goHome();
    else this.place();
  }

  /** Matrices from the angles. */
  place() {
    const { target, free, top } = this;
    const cosE = Math.cos(this.elevation);
    free.position.set(target.x + this.distance * cosE * Math.cos(this.azimuth), target.y + this.distance * cosE * Math.sin(this.azimuth),
      target.z + this.distance * Math.sin(this.elevation));
    free.near = Math.max(0.003, this.distance / 200);
    free.far = this.distance * 3 + 4 * (this.home.width + this.home.depth);
    free.aspect = this.aspect;
    free.lookAt(target);
    free.updateProjectionMatrix();
    const half = this.distance * Math.tan((fov_deg * Math.PI) / 360);
    Object.assign(top, { top: half, bottom: -half, left: -half * this.aspect, right: half * this.aspect });
    top.position.set(target.x, target.y, 100);
    top.up.set(0, 1, 0);
    top.lookAt(target.x, target.y, 0);
    top.updateProjectionMatrix();
    for (const eye of [free, top]) {
      eye.updateMatrixWorld(true);
      eye.matrixWorldInverse.getInverse(eye.matrixWorld);
    }
    this.invalidate();
  }

  orbit(dx_rad, dy_rad) {
    if (this.isTop) return;
    this.atHome = false;
    this.azimuth -= dx_rad;
    this.elevation = Math.min(highest_rad, Math.max(lowest_rad, this.elevation + dy_rad));
    this.place();
  }

  /** Moves over the floor by so many pixels of the picture. */
  pan(dx_px, dy_px) {
    this.atHome = false;
    const metres = (2 * this.distance * Math.tan((fov_deg * Math.PI) / 360)) / this.height_px;
    const turn = this.isTop ? -Math.PI / 2 : this.azimuth;
    const up = this.isTop ? 1 : Math.max(0.3, Math.sin(this.elevation));
    const right = [-Math.sin(turn), Math.cos(turn)], away = [-Math.cos(turn), -Math.sin(turn)];
    const along = -dx_px * metres, across = (dy_px * metres) / up;
    this.target.x += right[0] * along + away[0] * across;
    this.target.y += right[1] * along + away[1] * across;
    this.followed = null;
    this.place();
  }

  zoom(factor) {
    this.atHome = false;
    this.distance = Math.min(2000, Math.max(0.08, this.distance * factor));
    this.place();
  }

  /** Brings a place into the middle, and nearer when it is far. */
  lookAt(pose, near_m = null) {
    this.atHome = false;
    this.target.set(pose.x, pose.y, this.isTop ? 0 : pose.z);
    if (near_m !== null && this.distance > near_m) this.distance = near_m;
    this.place();
  }

  /** Where a place is in the picture: { x, y } in CSS pixels, and whether it is before the eye. */
  project(x, y, z) {
    const p = new THREE.Vector3(x, y, z).project(this.eye);
    return { x: ((p.x + 1) / 2) * this.width_px, y: ((1 - p.y) / 2) * this.height_px, inFront: p.z > -1 && p.z < 1 };
  }

  /** Metres that a pixel shows at that place. */
  metresPerPixel(x, y, z) {
    const m = this.eye.matrixWorldInverse.elements;
    const depth = this.isTop ? 1 : -(m[2] * x + m[6] * y + m[10] * z + m[14]);
    return (2 * Math.max(depth, 1e-6)) / (this.eye.projectionMatrix.elements[5] * this.height_px);
  }

  ray(x_px, y_px) {
    const caster = new THREE.Raycaster();
    caster.setFromCamera(new THREE.Vector2((2 * x_px) / this.width_px - 1, 1 - (2 * y_px) / this.height_px), this.eye);
    return caster.ray;
  }

  /** The point of a level plane under a pixel, or null: the pixel shows the sky. */
  groundAt(x_px, y_px, height = 0) {
    const { origin, direction } = this.ray(x_px, y_px);
    if (Math.abs(direction.z) < 1e-9) return null;
    const t = (height - origin.z) / direction.z;
    if (!this.isTop && t <= 0) return null;
    return { x: origin.x + t * direction.x, y: origin.y + t * direction.y };
  }

  listen() {
    const { canvas, pointers } = this;
    const place = (event) => {
      const box = canvas.getBoundingClientRect();
      return { x: event.clientX - box.left, y: event.clientY - box.top };
    };
    let start = null, drag = null, moved = false;
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    canvas.addEventListener('pointerdown', (event) => {
      canvas.focus({ preventScroll: true });
      canvas.setPointerCapture(event.pointerId);
      const at = place(event);
      pointers.set(event.pointerId, at);
      if (pointers.size === 1) {
        start = at;
        moved = false;
        drag = event.button === 0 ? this.grab?.(at.x, at.y, event) ?? null : null;
      }
    });
    canvas.addEventListener('pointermove', (event) => {
      const before = pointers.get(event.pointerId);
      if (before === undefined) return;
      const at = place(event);
      if (start !== null && Math.hypot(at.x - start.x, at.y - start.y) > click_px) moved = true;
      if (drag !== null) {
        if (moved) drag.move(at.x, at.y, event);
      } else if (pointers.size === 2) {
        this.twoFingers(event.pointerId, before, at);
      } else if (moved) {
        const dx = at.x - before.x, dy = at.y - before.y;
        const pans = this.isTop || event.buttons === 2 || event.buttons === 4 || event.shiftKey || event.ctrlKey;
        if (pans) this.pan(dx, dy);
        else this.orbit((dx * Math.PI) / this.height_px, (dy * Math.PI) / this.height_px);
      }
      pointers.set(event.pointerId, at);
    });
    const end = (event) => {
      const at = pointers.get(event.pointerId);
      if (at === undefined) return;
      pointers.delete(event.pointerId);
      if (drag !== null && pointers.size === 0) {
        drag.end(event, moved && event.type === 'pointerup');
        drag = null;
      }
      if (!moved && pointers.size === 0 && event.type === 'pointerup' && event.button === 0) this.onClick(at.x, at.y, event);
    };
    canvas.addEventListener('pointerup', end);
    canvas.addEventListener('pointercancel', end);
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      const pixels = event.deltaMode === 1 ? event.deltaY * 16 : event.deltaY;
      this.zoom(Math.exp(Math.max(-0.5, Math.min(0.5, pixels * 0.0015))));
    }, { passive: false });
  }

  /** One of two fingers went from `before` to `at`: apart zooms, together pans, around turns. */
  twoFingers(id, before, at) {
    let other = null;
    for (const [number, place] of this.pointers) if (number !== id) other = place;
    const was = [before.x - other.x, before.y - other.y], is = [at.x - other.x, at.y - other.y];
    const ratio = Math.hypot(...was) / Math.max(1, Math.hypot(...is));
    this.zoom(Math.min(2, Math.max(0.5, ratio)));
    this.pan((at.x - before.x) / 2, (at.y - before.y) / 2);
    const turned = Math.atan2(is[1], is[0]) - Math.atan2(was[1], was[0]);
    if (Math.abs(turned) < 1) this.orbit(turned, 0);
  }
}
