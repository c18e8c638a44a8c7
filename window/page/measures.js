// Measures that hooks publish: their newest values; a click plots one.
import { h, section, numberText } from './html.js';
import { openMenu } from './menu.js';

export class Measures {
  constructor(world, connection, layers, plots, host) {
    Object.assign(this, { layers, plots });
    const { element, body } = section('Measures', true, 'measures');
    Object.assign(this, { element, body });
    host.append(element);
    element.hidden = true;
    element.addEventListener('toggle', () => this.ask());
    world.on('hello', (hello) => {
      this.names = (hello.layers ?? []).filter((layer) => layer.panel).map((layer) => layer.name);
      this.shape = '';
      element.hidden = true;
      this.ask();
    });
    connection.on('panel', (message) => this.take(message));
    plots.on('change', () => this.mark());
  }

  /** They are sent while they are shown or plotted. */
  ask() {
    for (const name of this.names ?? []) {
      const wanted = this.element.open || this.plots.list.some((plot) => [...plot.series.values()].some(({ ask }) => ask.layer === name));
      if (wanted !== this.layers.on.has(name)) this.layers.toggle(name, wanted);
    }
  }

  take({ layer, rows }) {
    const shape = JSON.stringify(rows.map(({ label, unit }) => [label, unit]));
    if (shape !== this.shape) this.rebuild(layer, rows);
    this.shape = shape;
    this.element.hidden = rows.length === 0;
    rows.forEach(({ value }, i) => (this.buttons[i].textContent = numberText(value)));
  }

  rebuild(layer, rows) {
    this.asks = rows.map(({ label }) => ({ measure: label, layer }));
    this.buttons = rows.map(({ label, unit }, i) => h('button', { class: 'value', 'data-measure': label, title: `Plot ${label}`,
      onclick: () => openMenu(label, this.buttons[i], this.plots.choices(this.asks[i], unit)) }, '–'));
    this.body.replaceChildren(h('table', {}, rows.map(({ label, unit }, i) => h('tr', {}, h('th', { scope: 'row' }, label), h('td', { class: 'number' }, this.buttons[i]), h('td', { class: 'unit' }, unit ?? '')))));
    this.mark();
  }

  mark() {
    (this.buttons ?? []).forEach((button, i) => button.classList.toggle('plotted', this.plots.find(this.asks[i]) !== undefined));
    this.ask();
  }
}
