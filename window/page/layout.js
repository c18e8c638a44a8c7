// The layout as a link: camera, layers, chosen robots and plots stand behind the "#" of the address.
import { h, openDialog, toast } from './html.js';

const mark = '#layout=';
const finite = (values, count) => Array.isArray(values) && values.length === count && values.every(Number.isFinite);
const texts = (values) => (Array.isArray(values) ? values.filter((value) => typeof value === 'string').slice(0, 100) : []);

/** Its known members alone: the address may come from anybody. */
function askOf(one) {
  if (typeof one.measure === 'string') return { measure: one.measure, layer: String(one.layer) };
  return { robot: String(one.robot), role: String(one.role), port: String(one.port), field: String(one.field), index: Number.isInteger(one.index) ? one.index : 0 };
}

export class Layout {
  constructor(page) {
    this.page = page;
    this.dialog = h('dialog', { 'aria-label': 'Share the layout' });
    document.body.append(this.dialog);
    this.wanted = location.hash.startsWith(mark) ? location.hash.slice(mark.length) : null;
    page.connection.on('role', ({ look_on }) => (this.token = look_on));
    page.world.on('poses', () => this.apply());
  }

  describe() {
    const { camera, layers, selection, plots, colors } = this.page;
    const { x, y, z } = camera.target;
    return {
      camera: [x, y, z, camera.distance, camera.azimuth, camera.elevation].map((value) => Number(value.toFixed(4))), top: camera.isTop, follow: camera.followed,
      layers: [...layers.on], all: layers.everybody, robots: [...selection.ids], colors: colors.mode,
      plots: plots.list.map((plot) => [...plot.series.values()].map(({ ask, unit }) => ({ ...ask, unit }))),
    };
  }

  /** The address of this run with this layout, for those who look on. */
  get link() {
    const bytes = new TextEncoder().encode(JSON.stringify(this.describe()));
    return `${location.origin}${location.pathname}?token=${encodeURIComponent(this.token ?? '')}${mark}${btoa(String.fromCharCode(...bytes)).replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '')}`;
  }

  /** Once, with the first picture: what the address asks for and this run has. */
  apply() {
    const { wanted } = this;
    if (wanted === null) return;
    this.wanted = null;
    try {
      const bytes = Uint8Array.from(atob(wanted.replaceAll('-', '+').replaceAll('_', '/')), (one) => one.charCodeAt(0));
      this.take(JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(bytes)));
    } catch {
      toast('The layout in the address cannot be read; the page begins as always.', 'error');
    }
  }

  take(layout) {
    const { camera, layers, selection, plots, colors, world } = this.page;
    if (finite(layout.camera, 6)) {
      const [x, y, z, distance, azimuth, elevation] = layout.camera;
      camera.atHome = false;
      camera.target.set(x, y, z);
      Object.assign(camera, { distance: Math.min(2000, Math.max(0.08, distance)), azimuth, elevation: Math.min(1.57, Math.max(0.02, elevation)) });
      camera.setTop(layout.top === true);
    }
    for (const name of texts(layout.layers)) {
      const box = layers.list.querySelector(`[data-layer="${CSS.escape(name)}"]`);
      if (box !== null && !box.checked) box.click();
    }
    const everybody = document.getElementById('layers-everybody');
    if (layout.all === false && everybody?.checked) everybody.click();
    if ([...colors.select.options].some(({ value }) => value === layout.colors)) colors.set(layout.colors);
    for (const id of texts(layout.robots)) if (world.members.index.has(id)) selection.choose(id, true);
    if (world.members.index.has(layout.follow)) camera.followed = layout.follow;
    for (const series of Array.isArray(layout.plots) ? layout.plots.slice(0, 20) : []) {
      let plot;
      for (const one of Array.isArray(series) ? series.slice(0, 20) : []) plot = plots.add(askOf(one), one.unit === undefined ? '' : String(one.unit), plot);
    }
  }

  open() {
    const { link } = this;
    const address = h('input', { type: 'text', readonly: true, value: link, 'aria-label': 'Link', onfocus: () => address.select() });
    const copy = async () => {
      address.select();
      try {
        await navigator.clipboard.writeText(link);
      } catch {
        document.execCommand('copy');  // of a page that came over plain http
      }
      this.dialog.close();
      toast('The link is in the clipboard.');
    };
    this.dialog.replaceChildren(h('h2', {}, 'This layout as a link'), h('p', {}, 'Camera, layers, chosen robots and plots. Whoever opens it looks on, and commands nothing but an emergency stop. Behind the address of another run, what stands behind "#" does the same there.'),
      address, h('div', { class: 'row' }, h('span', { class: 'spacer' }), h('button', { onclick: () => this.dialog.close() }, 'Close'), h('button', { class: 'main', onclick: copy }, 'Copy')));
    openDialog(this.dialog);
  }
}
