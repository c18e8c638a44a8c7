// Layers that the run draws (rays, links, trails …): switches for them, their lines and texts in the picture.
import * as THREE from './three.module.js';
import { h, section, toast } from './html.js';

export class Layers {
  /** `selection` says whose layers are asked for when "all robots" is off. */
  constructor(view, world, connection, selection, host) {
    Object.assign(this, { view, world, connection, selection });
    this.on = new Set();
    this.drawings = new Map();  // by index: lines
    this.texts = new Map();     // by index
    const { element, body } = section('Layers', true, 'layers');
    this.list = body;
    host.append(element);
    this.material = new THREE.ShaderMaterial({
      vertexShader: 'attribute vec4 tint; varying vec4 color; void main() { color = tint; gl_Position = projectionMatrix * (viewMatrix * vec4(position, 1.0)); }',
      fragmentShader: 'varying vec4 color; void main() { gl_FragColor = color; }',
      transparent: true,
      depthWrite: false,
    });
    world.on('hello', (hello) => this.rebuild(hello.layers ?? []));
    world.on('drawing', (frame) => this.takeDrawing(frame));
    connection.on('texts', (message) => {
      this.texts.set(message.layer, message.texts);
      view.invalidate();
    });
    selection.on('change', () => {
      if (!this.everybody && this.on.size > 0) this.ask();
    });
    view.addItem(this);
  }

  rebuild(layers) {
    const known = this.layers === undefined ? null : new Set(this.on);
    this.layers = layers;
    this.on = new Set(layers.filter((layer) => (known === null ? layer.on : known.has(layer.name))).map((layer) => layer.name));
    this.everybody ??= true;
    for (const drawing of this.drawings.values()) this.view.scene.remove(drawing);
    this.drawings.clear();
    this.texts.clear();
    const drawn = layers.filter((layer) => !layer.panel);  // others: measures.js
    const switchOf = (layer) => h('label', { class: 'switch', title: layer.summary },
      h('input', { type: 'checkbox', 'data-layer': layer.name, checked: this.on.has(layer.name), onchange: (event) => this.toggle(layer.name, event.target.checked) }),
      h('span', {}, layer.name.replaceAll('_', ' ')));
    const idle = drawn.filter((layer) => layer.idle);
    this.list.replaceChildren(
      ...drawn.filter((layer) => !layer.idle).map(switchOf),
      idle.length === 0 ? '' : h('details', {}, h('summary', {}, 'of sensors that no robot has'), ...idle.map(switchOf)),
      h('label', { class: 'switch minor' },
        h('input', { type: 'checkbox', id: 'layers-everybody', checked: this.everybody, onchange: (event) => {
          this.everybody = event.target.checked;
          this.ask();
        } }),
        h('span', {}, 'of all robots, not only the chosen')));
    if (drawn.length === 0) this.list.replaceChildren(h('p', { class: 'minor' }, 'This run has none.'));
    if (this.on.size > 0) this.ask();
  }

  toggle(name, on) {
    if (on) this.on.add(name);
    else this.on.delete(name);
    if (!on) this.drop(this.layers.findIndex((layer) => layer.name === name));
    this.ask();
  }

  async ask() {
    const answer = await this.connection.ask({ do: 'layers', on: [...this.on], robots: this.everybody ? '*' : [...this.selection.ids] });
    if (!answer.ok) toast(answer.error, 'error');
  }

  drop(index) {
    const drawing = this.drawings.get(index);
    if (drawing !== undefined) {
      this.view.scene.remove(drawing);
      drawing.geometry.dispose();
    }
    this.drawings.delete(index);
    this.texts.delete(index);
    this.view.invalidate();
  }

  takeDrawing(frame) {
    this.drop(frame.number);
    const layer = this.layers?.[frame.number];
    if (layer === undefined || !this.on.has(layer.name)) return;
    const position = new Float32Array(6 * frame.count), tint = new Uint8Array(8 * frame.count);
    for (let i = 0; i < frame.count; ++i) {
      position.set(frame.floats.subarray(7 * i, 7 * i + 6), 6 * i);
      const color = frame.bytes.subarray(28 * i + 24, 28 * i + 28);
      tint.set(color, 8 * i);
      tint.set(color, 8 * i + 4);
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(position, 3));
    geometry.setAttribute('tint', new THREE.BufferAttribute(tint, 4, true));
    const drawing = new THREE.LineSegments(geometry, this.material);
    drawing.frustumCulled = false;
    this.drawings.set(frame.number, drawing);
    this.view.scene.add(drawing);
    this.view.invalidate();
  }

  label(pen, camera) {
    for (const texts of this.texts.values()) {
      for (const { x, y, z, text, color } of texts) {
        const at = camera.project(x, y, z ?? 0);
        if (at.inFront) pen.tag(text, at.x, at.y, { color: typeof color === 'string' ? color : Array.isArray(color) ? `rgb(${color.slice(0, 3).join()})` : undefined });
      }
    }
  }

  get segmentsShown() {
    let sum = 0;
    for (const drawing of this.drawings.values()) sum += drawing.geometry.attributes.position.count / 2;
    return sum;
  }
}
