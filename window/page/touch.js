// Touching: drags and turns robots, objects and lamps, adds and removes them, halts and releases robots.
import * as THREE from './three.module.js';
import { h, section, toast, degrees, radians } from './html.js';
import { bodySize } from './models.js';
import { pick } from './pick.js';

const turn_rad = Math.PI / 12;    // by a key
const nudge_m = 0.01;             // by a key; with shift ten times so far

/** While `on`, a pointer that goes down on a thing drags it; else it moves the camera. */
export class Touch {
  constructor(view, world, commands, selection, scene, host) {
    Object.assign(this, { view, world, commands, selection, scene });
    this.on = false;
    this.placing = null;  // called with the next place on the floor that is clicked
    this.thing = null;    // { object } or { light } that is chosen
    this.ghost = makeGhost();
    this.ghost.visible = false;
    view.scene.add(this.ghost);
    const { element, body } = section('Touch', false, 'touch');
    this.element = element;
    this.body = body;
    this.thingHost = h('div', {});
    host.append(element);
    world.on('hello', () => this.rebuild());
    world.on('scene', () => this.showThing());
    world.on('members', () => this.choosePending());
  }

  get allowed() {
    return this.world.can.has('touch');
  }

  command(command) {
    return this.commands.carryOut(command);
  }

  move(what, to) {
    return this.command({ do: 'move', ...what, ...to });
  }

  remove(what) {
    return this.command({ do: 'remove', ...what }).then((answer) => {
      if (answer.ok && what.robot !== undefined) this.selection.leave(what.robot);
      if (answer.ok && what.robot === undefined) this.choose(null);
      return answer;
    });
  }

  halt(robot, halted) {
    return this.command({ do: halted ? 'halt' : 'release', robot });
  }

  setOn(on) {
    this.on = on && this.allowed;
    this.view.canvas.classList.toggle('touching', this.on);
    this.onChange?.();
  }

  /** Chooses an object or a lamp: { object: id }, { light: id } or null. */
  choose(thing) {
    this.thing = thing;
    this.scene.chosen = thing;
    this.showThing();
    this.view.invalidate();
  }

  poseOf(what) {
    if (what.robot !== undefined) return this.world.poseOf(what.robot);
    const thing = this.scene.find(what);
    return thing === undefined ? null : { x: thing.x, y: thing.y, z: thing.z, heading: thing.heading ?? 0 };
  }

  sizeOf(what) {
    if (what.robot !== undefined) return bodySize(this.world.body(this.world.members.index.get(what.robot))).radius;
    const thing = this.scene.find(what);
    return thing?.radius ?? (thing?.size_x !== undefined ? Math.hypot(thing.size_x, thing.size_y) / 2 : 0.08);
  }

  mayMove(what) {
    if (what.robot !== undefined || what.light !== undefined) return true;
    return this.scene.find(what)?.movable === true;
  }

  /** A drag that begins at this pixel, or null. With shift it turns the thing. */
  grab(x_px, y_px, event) {
    if (!this.on || this.placing !== null) return null;
    const { camera } = this.view;
    const what = pick(this.world, camera, x_px, y_px);
    if (what === null || !this.mayMove(what)) return null;
    const start = this.poseOf(what);
    if (start === null) return null;
    const level = what.light !== undefined ? start.z : start.z + 0.02;
    const from = camera.groundAt(x_px, y_px, level);
    if (from === null) return null;
    const size = this.sizeOf(what);
    let to = null;
    return {
      move: (x, y, now) => {
        const at = camera.groundAt(x, y, level);
        if (at === null) return;
        const turns = now.shiftKey || event.shiftKey;
        to = turns ? { heading: Math.atan2(at.y - start.y, at.x - start.x) } : { x: start.x + at.x - from.x, y: start.y + at.y - from.y };
        this.showGhost({ ...start, ...to }, size);
      },
      end: (_, done) => {
        this.ghost.visible = false;
        this.view.invalidate();
        if (done && to !== null) this.move(what, to);
      },
    };
  }

  showGhost(pose, size) {
    this.ghost.visible = true;
    this.ghost.position.set(pose.x, pose.y, pose.z + 0.005);
    this.ghost.rotation.z = pose.heading;
    this.ghost.scale.set(size, size, size);
    this.view.invalidate();
  }

  /** By keys: moves or turns what is chosen. Returns whether there was something. */
  nudge(dx, dy, turn, far) {
    const what = this.thing ?? (this.selection.last !== undefined ? { robot: this.selection.last } : null);
    const pose = what === null ? null : this.poseOf(what);
    if (!this.on || pose === null) return false;
    const by = far ? 10 * nudge_m : nudge_m;
    this.move(what, turn === 0 ? { x: pose.x + dx * by, y: pose.y + dy * by } : { heading: pose.heading + turn * turn_rad });
    return true;
  }

  /** A click on the floor while something is to be placed. */
  placed(x_px, y_px) {
    if (this.placing === null) return false;
    const at = this.view.camera.groundAt(x_px, y_px);
    if (at === null) return true;
    this.placing(at);
    return true;
  }

  stopPlacing() {
    this.placing = null;
    this.view.canvas.classList.remove('placing');
    for (const button of this.body.querySelectorAll('.placing')) button.classList.remove('placing');
  }

  rebuild() {
    this.element.hidden = !this.allowed;
    if (!this.allowed) {
      this.setOn(false);
      return;
    }
    this.body.replaceChildren(
      h('p', { class: 'minor' }, 'With "Touch" (m) in the picture\'s corner, robots, movable objects and lamps are dragged; with shift they turn.'),
      h('div', { class: 'row' }, h('button', { onclick: () => this.halt('*', true) }, 'Halt all'), h('button', { onclick: () => this.halt('*', false) }, 'Release all')),
      this.adder(), this.thingHost);
    this.showThing();
  }

  adder() {
    const { hello } = this.world;
    const kinds = hello.kinds ?? [], controllers = hello.controllers ?? [];
    const what = h('select', { 'aria-label': 'What is added', onchange: () => show() }, ['robot', 'box', 'cylinder', 'light'].map((name) => h('option', {}, name)));
    const select = (names) => h('select', {}, names.map((name) => h('option', {}, name)));
    const number = (value, min = null) => h('input', { type: 'number', step: 'any', value, min, required: true });
    const forms = {
      robot: { kind: select(kinds), controller: select(controllers), 'heading (°)': number(0) },
      box: { 'size x (m)': number(0.3, 0), 'size y (m)': number(0.3, 0), 'height (m)': number(0.2, 0), 'heading (°)': number(0), movable: h('input', { type: 'checkbox', checked: true }) },
      cylinder: { 'radius (m)': number(0.1, 0), 'height (m)': number(0.2, 0), movable: h('input', { type: 'checkbox', checked: true }) },
      light: { 'z (m)': number(1, 0), intensity: number(1, 0), color: h('input', { type: 'color', value: '#ffff00' }) },
    };
    const x = number(0), y = number(0);
    const fields = h('div', { class: 'grid' });
    const show = () => fields.replaceChildren(...Object.entries(forms[what.value]).map(([name, input]) => h('label', {}, `${name} `, input)), h('label', {}, 'x (m) ', x), h('label', {}, 'y (m) ', y));
    const add = async (at) => {
      const form = forms[what.value];
      const value = (name) => Number(form[name].value);
      const made = {
        robot: () => ({ robot: { kind: form.kind.value, controller: form.controller.value, ...at, heading: radians(value('heading (°)')) } }),
        box: () => ({ object: { shape: 'box', ...at, heading: radians(value('heading (°)')), size_x: value('size x (m)'), size_y: value('size y (m)'), height: value('height (m)'), movable: form.movable.checked } }),
        cylinder: () => ({ object: { shape: 'cylinder', ...at, heading: 0, radius: value('radius (m)'), height: value('height (m)'), movable: form.movable.checked } }),
        light: () => ({ light: { ...at, z: value('z (m)'), intensity: value('intensity'), color: form.color.value } }),
      }[what.value]();
      const answer = await this.command({ do: 'add', ...made });
      if (answer.ok && made.robot !== undefined) {
        this.pending = answer.added;
        this.choosePending();
      } else if (answer.ok) this.choose(made.light === undefined ? { object: answer.added } : { light: answer.added });
    };
    const click = h('button', { type: 'button', onclick: () => {
      if (this.placing !== null) return this.stopPlacing();
      click.classList.add('placing');
      this.view.canvas.classList.add('placing');
      this.placing = add;
      toast('Click on the floor; Escape ends it.');
      return undefined;
    } }, 'Click on the floor');
    show();
    return h('form', { class: 'add', onsubmit: (event) => {
      event.preventDefault();
      add({ x: Number(x.value), y: Number(y.value) });
    } }, h('h3', {}, 'Add'), what, fields, h('div', { class: 'row' }, h('button', { class: 'main' }, 'Add'), click));
  }

  /** Chooses the robot that was just added, when it is there. */
  choosePending() {
    if (this.pending === undefined || !this.world.members.index.has(this.pending)) return;
    this.selection.choose(this.pending);
    this.pending = undefined;
  }

  /** What can be done with the object or lamp that is chosen. */
  showThing() {
    const thing = this.thing === null || this.world.scene === null ? undefined : this.scene.find(this.thing);
    if (thing === undefined) {
      this.thingHost.replaceChildren();
      return;
    }
    const parts = [h('h3', {}, thing.id), h('p', { class: 'minor' }, `x ${thing.x.toFixed(3)} m, y ${thing.y.toFixed(3)} m`
      + (thing.heading ? `, ${degrees(thing.heading).toFixed(1)}°` : '') + (thing.movable === false ? ', fixed' : ''))];
    if (this.thing.light !== undefined) {
      const on = thing.intensity > 0;
      const intensity = h('input', { type: 'number', min: 0, step: 'any', value: thing.intensity, 'aria-label': 'Intensity' });
      const color = h('input', { type: 'color', value: `#${thing.color.map((value) => value.toString(16).padStart(2, '0')).join('')}`, 'aria-label': 'Colour' });
      if (on) this.brightness = thing.intensity;
      parts.push(h('div', { class: 'row' }, h('button', { onclick: () => this.command({ do: 'light', light: thing.id, intensity: on ? 0 : this.brightness ?? 1 }) }, on ? 'Switch off' : 'Switch on'),
        intensity, color, h('button', { onclick: () => this.command({ do: 'light', light: thing.id, intensity: Number(intensity.value), color: color.value }) }, 'Set')));
    }
    parts.push(h('div', { class: 'row' }, h('button', { onclick: () => this.remove(this.thing) }, 'Remove')));
    this.thingHost.replaceChildren(h('section', { class: 'thing' }, parts));
    this.element.open = true;
  }
}

/** A disc with a hand that shows where a thing will be. */
function makeGhost() {
  const material = new THREE.MeshBasicMaterial({ color: '#e69f00', transparent: true, opacity: 0.6, depthTest: false, side: THREE.DoubleSide });
  const group = new THREE.Group();
  const hand = new THREE.Mesh(new THREE.PlaneBufferGeometry(1.5, 0.12), material);
  hand.position.x = 0.75;
  group.add(new THREE.Mesh(new THREE.CircleBufferGeometry(1, 32), material), hand);
  for (const part of group.children) part.renderOrder = 6;
  return group;
}
