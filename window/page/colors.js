// What the colours of robots say: what they show themselves, their kind, a state that they publish, or how dense they stand; with a legend.
import * as THREE from './three.module.js';
import { h, numberText } from './html.js';
import { kindColor, rgb, scaleColor } from './palette.js';

const bytes = (hex) => rgb(hex).map((value) => Math.round(255 * value));

/** `mode`: "led", "kind", "density", or "state NAME". */
export class Colors {
  constructor(view, world, connection, robots, host) {
    Object.assign(this, { view, world, connection, robots });
    this.mode = 'led';
    this.legend = h('div', { id: 'legend', role: 'note', 'aria-label': 'What the colours mean', hidden: true });
    host.append(this.legend);
    this.select = h('select', { id: 'colors', onchange: (event) => this.set(event.target.value) });
    this.density = new Density(view, world);
    world.on('members', () => this.set(this.mode));
    world.on('hello', (hello) => this.offer(hello.states ?? []));
    world.on('states', () => this.mode.startsWith('state ') && this.show());
    this.offer([]);
  }

  offer(states) {
    const options = [['led', 'as they are'], ['kind', 'their kind'], ...states.map((name) => [`state ${name}`, `state: ${name}`]), ['density', 'none: a map of density']];
    this.select.replaceChildren(...options.map(([value, text]) => h('option', { value }, text)));
    if (!options.some(([value]) => value === this.mode)) this.mode = 'led';
    this.set(this.mode);
  }

  set(mode) {
    if (mode !== this.mode && (mode.startsWith('state ') || this.mode.startsWith('state '))) {
      this.connection.ask({ do: 'color_by', state: mode.startsWith('state ') ? mode.slice(6) : null });
    }
    this.mode = mode;
    this.select.value = mode;
    this.show();
  }

  show() {
    const { members, states } = this.world;
    this.density.setOn(this.mode === 'density');
    let rows = [], coloring = null;
    if (this.mode === 'kind') {
      const colors = members.kinds.map((_, kind) => bytes(kindColor(kind)));
      coloring = (robot) => colors[members.kind[robot]];
      rows = members.kinds.map((name, kind) => [kindColor(kind), name]);
    } else if (this.mode.startsWith('state ') && states !== null && states.name === this.mode.slice(6)) {
      [coloring, rows] = byState(states);
    } else if (this.mode === 'density') {
      rows = this.density.rows();
    }
    this.robots.setColoring(coloring);
    this.legend.hidden = rows.length === 0;
    const title = { kind: 'kind', density: 'robots per m²' }[this.mode] ?? this.mode.slice(6);
    this.legend.replaceChildren(h('strong', {}, title), ...rows.map(([color, text]) => {
      const dot = h('span', { class: 'dot' });
      dot.style.background = color;
      return h('span', { class: 'kind' }, dot, text);
    }));
  }
}

/** A colour each for up to eight whole numbers or words; else a scale from the least to the largest. */
function byState({ values, words }) {
  const seen = [...new Set(values)].filter(Number.isFinite).sort((a, b) => a - b);
  if (words !== undefined || (seen.length <= 8 && seen.every(Number.isInteger))) {
    const colors = new Map(seen.map((value, i) => [value, kindColor(i)]));
    const parts = new Map([...colors].map(([value, hex]) => [value, bytes(hex)]));
    return [(robot) => parts.get(values[robot]) ?? null, [...colors].map(([value, hex]) => [hex, words?.[value] ?? String(value)])];
  }
  const [low, high] = [seen[0], seen[seen.length - 1]];
  const at = (value) => scaleColor((value - low) / (high - low || 1));
  return [(robot) => (Number.isFinite(values[robot]) ? bytes(at(values[robot])) : null), [0, 0.25, 0.5, 0.75, 1].map((share) => [scaleColor(share), numberText(low + share * (high - low))])];
}

const cells = 96;  // along the longer side of the arena

/** A map of how many robots stand where, over the floor. */
class Density {
  constructor(view, world) {
    Object.assign(this, { view, world });
    this.most = 0;
    view.addItem(this);
    world.on('scene', () => this.forget());
  }

  setOn(on) {
    this.on = on;
    if (!on) this.forget();
    this.view.invalidate();
  }

  forget() {
    if (this.mesh !== undefined) {
      this.view.scene.remove(this.mesh);
      this.mesh.geometry.dispose();
      this.mesh.material.map.dispose();
      this.mesh = undefined;
    }
    this.counted = null;
    this.said = 0;
  }

  make({ min_x, min_y, max_x, max_y }) {
    const width = max_x - min_x, depth = max_y - min_y;
    this.cell = Math.max(width, depth) / cells;
    this.columns = Math.max(1, Math.round(width / this.cell));
    this.lines = Math.max(1, Math.round(depth / this.cell));
    this.sums = new Float32Array(this.columns * this.lines);
    const texture = new THREE.DataTexture(new Uint8Array(4 * this.sums.length), this.columns, this.lines, THREE.RGBAFormat, THREE.UnsignedByteType);
    texture.magFilter = texture.minFilter = THREE.LinearFilter;
    this.mesh = new THREE.Mesh(new THREE.PlaneBufferGeometry(width, depth), new THREE.MeshBasicMaterial({ map: texture, transparent: true, depthTest: false, depthWrite: false }));
    this.mesh.position.set((min_x + max_x) / 2, (min_y + max_y) / 2, 0.002);
    this.mesh.renderOrder = 2;
    this.view.scene.add(this.mesh);
  }

  /** Each robot counts in its cell and, less, in those around it. */
  update() {
    const { frame, scene } = this.world;
    if (!this.on || frame === null || scene === null || this.counted === frame) return;
    if (this.mesh === undefined) this.make(scene.arena);
    this.counted = frame;
    const { columns, lines, sums, cell } = this;
    sums.fill(0);
    for (let i = 0; i < frame.count; ++i) {
      const x = Math.floor((frame.floats[4 * i] - scene.arena.min_x) / cell), y = Math.floor((frame.floats[4 * i + 1] - scene.arena.min_y) / cell);
      for (let dy = -1; dy <= 1; ++dy) {
        for (let dx = -1; dx <= 1; ++dx) {
          if (x + dx < 0 || x + dx >= columns || y + dy < 0 || y + dy >= lines) continue;
          sums[(y + dy) * columns + x + dx] += (dx === 0 ? 0.5 : 0.25) * (dy === 0 ? 0.5 : 0.25);
        }
      }
    }
    this.most = sums.reduce((most, value) => Math.max(most, value), 0);
    const { data } = this.mesh.material.map.image;
    sums.forEach((value, i) => {
      const share = this.most > 0 ? value / this.most : 0;
      const [r, g, b] = bytes(scaleColor(share));
      data.set([r, g, b, value > 0 ? 40 + 200 * Math.sqrt(share) : 0], 4 * i);
    });
    this.mesh.material.map.needsUpdate = true;
    if (Math.abs(this.most - (this.said ?? 0)) <= 0.1 * (this.said ?? 0)) return;
    this.said = this.most;
    this.onCount?.();
  }

  rows() {
    const area = this.cell ** 2;
    return this.most > 0 ? [0.05, 0.25, 0.5, 0.75, 1].map((share) => [scaleColor(share), String(Number(((share * this.most) / area).toPrecision(2)))]) : [];
  }
}
