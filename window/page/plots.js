// The plots, one under the other: of fields of robots and of measures. They stay when other robots are chosen.
import { h, toast } from './html.js';
import { Events } from './events.js';
import { Plot } from './plot.js';

const past_points = 600;

/** A series is named by `ask`: { robot, role, port, field, index }, or { measure, layer }. Emits "change". */
export class Plots extends Events {
  list = [];
  element = h('div', { class: 'plots', hidden: true });

  constructor(world, connection, goTo) {
    super();
    Object.assign(this, { world, connection, goTo });
    let latest = 0;
    connection.on('inspection', (message) => this.take(message)).on('panel', (message) => this.takeMeasures(message));
    world.on('state', (state) => {
      if (state.latest < latest) for (const plot of this.list) plot.forgetAfter(state.latest);
      latest = state.latest;
    });
  }

  key(ask) {
    return [ask.robot, ask.role, ask.port, ask.field, ask.index, ask.measure].join('\n');
  }

  /** The plot that shows it, or undefined. */
  find(ask) {
    return this.list.find((plot) => plot.has(this.key(ask)));
  }

  /** Ids of the robots whose values are shown. */
  get robots() {
    return new Set(this.list.flatMap((plot) => [...plot.series.values()].map(({ ask }) => ask.robot).filter(Boolean)));
  }

  /** @param plot in which it is shown; none: in a new one. */
  add(ask, unit, plot = this.make()) {
    const of = [ask.port, ask.field].filter(Boolean).join('.');
    plot.add(this.key(ask), ask.measure ?? `${ask.robot} ${of}${ask.index > 0 ? `[${ask.index}]` : ''}`, unit, ask);
    this.changed();
    if (this.world.hello?.mode === 'record') this.loadPast();
    return plot;
  }

  remove(ask) {
    this.find(ask)?.remove(this.key(ask));
    this.changed();
  }

  make() {
    const plot = new Plot(this.world, this.goTo);
    plot.loadPast = () => this.loadPast();
    plot.onChange = () => this.changed();
    plot.onPointer = (tick) => {
      for (const one of this.list) one.mark(tick);
    };
    this.list.push(plot);
    this.element.append(plot.element);
    return plot;
  }

  clear() {
    for (const plot of this.list) plot.series.clear();
    this.changed();
  }

  changed() {
    for (const plot of this.list) if (plot.series.size === 0) plot.element.remove();
    this.list = this.list.filter((plot) => plot.series.size > 0);
    this.element.hidden = this.list.length === 0;
    this.emit('change');
  }

  /** What a menu offers for a value: [label, call]. */
  choices(ask, unit) {
    if (this.find(ask)) return [['Take it off the plot', () => this.remove(ask)]];
    const last = this.list.at(-1);
    if (last === undefined) return [['Plot', () => this.add(ask, unit)]];
    return [['Plot', () => this.add(ask, unit, last)], ['Plot in a new one', () => this.add(ask, unit)],
      ...this.list.slice(0, -1).map((plot, i) => [`Plot in ${i + 1}`, () => this.add(ask, unit, plot)])];
  }

  take({ tick, robots }) {
    for (const robot of robots ?? []) {
      if (robot.alive === false) continue;
      for (const plot of this.list) {
        for (const { key, ask } of plot.series.values()) if (ask.robot === robot.id) plot.take(key, tick, valueOf(robot, ask));
      }
    }
  }

  takeMeasures({ tick, layer, rows }) {
    for (const { label, value } of rows) {
      const ask = { measure: label, layer };
      this.find(ask)?.take(this.key(ask), tick, value === '' ? NaN : Number(value));
    }
  }

  /** Asks for the values from the begin of the run on. */
  async loadPast() {
    const { state, hello } = this.world;
    const to = hello?.mode === 'record' ? state.latest : Math.max(this.world.tick, state.tick ?? 0), from = state.first ?? 0;
    const every = Math.max(1, Math.ceil((to - from) / past_points));
    for (const plot of this.list) {
      plot.hint.textContent = 'The past is being computed …';
      let said = 'All values from the begin on.';
      for (const [key, { ask, name }] of [...plot.series]) {
        if (ask.measure !== undefined) {
          said = `${name}: a measure has the values since it was chosen.`;
          continue;
        }
        const answer = await this.connection.ask({ do: 'history', ...ask, from, to, every });
        if (answer.ok) plot.takePast(key, answer.ticks, answer.values);
        else toast(answer.error, 'error');
        if (!answer.ok || answer.bounded) said = answer.ok ? `Only ${answer.bounded}.` : answer.error;
      }
      plot.hint.textContent = said;
    }
  }
}

/** Of a robot as an inspection tells it. */
function valueOf(robot, { role, port, field, index }) {
  if (role === 'pose') return robot.pose?.[field];
  const named = (list) => (list ?? []).find((one) => one.name === field);
  const found = role === 'published' ? named(robot.published)?.value : named((robot.ports ?? []).find((one) => one.role === role && one.name === port)?.fields)?.values;
  return Array.isArray(found) ? found[index] : found;
}
