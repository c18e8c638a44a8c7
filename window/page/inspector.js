// The chosen robots side by side: every port field by field, published state, parameters; any value can be plotted, or stop the run.
import { h, numberText, ageText, degrees, radians, toast } from './html.js';
import { openMenu } from './menu.js';

const most_values = 64;    // of one field, shown

export class Inspector {
  constructor(world, connection, selection, commands, plots, touch, host) {
    Object.assign(this, { world, connection, selection, commands, plots, touch, host });
    this.cards = new Map();  // by robot id
    this.stop = h('form', { class: 'stop', hidden: true });
    this.columns = h('div', { class: 'columns' });
    this.makeControl = null;  // of a robot's controls; see controls.js
    this.head = h('div', { class: 'row head' }, h('h2', {}, 'Chosen'), h('span', { class: 'spacer' }),
      h('button', { class: 'quiet', 'aria-label': 'Close, choose nothing (Escape)', onclick: () => selection.clear() }, '×'));
    host.append(plots.element, this.head, this.stop, this.columns);
    plots.on('change', () => this.plotted());
    selection.on('change', () => this.choose());
    world.on('hello', () => this.subscribe());
    world.on('marks', () => this.showHalted());
    connection.on('inspection', (message) => this.take(message));
  }

  showHost() {
    this.head.hidden = this.selection.ids.size === 0;
    this.plots.element.classList.toggle('alone', this.head.hidden);
    this.host.hidden = this.head.hidden && this.plots.list.length === 0;
  }

  choose() {
    const { ids } = this.selection;
    this.showHost();
    for (const [id, card] of this.cards) {
      if (ids.has(id)) continue;
      card.element.remove();
      this.cards.delete(id);
    }
    for (const id of ids) if (!this.cards.has(id)) this.addCard(id);
    this.subscribe();
  }

  subscribe() {
    if (!this.connection.isOpen) return;
    this.connection.ask({ do: 'inspect', robots: [...new Set([...this.selection.ids, ...this.plots.robots])] }).then((answer) => {
      if (!answer.ok) toast(answer.error, 'error');
    });
  }

  addCard(id) {
    const card = { id, fields: new Map(), open: new Set(), asks: new Map() };
    card.summary = h('p', { class: 'minor' });
    card.pose = h('p', { class: 'pose' });
    card.halt = h('button', { onclick: () => this.touch.halt(id, !this.isHalted(id)) }, 'Halt');
    card.ports = h('div', {});
    const forms = h('details', { class: 'move-form' }, h('summary', {}, 'Move'), this.moveForm(id));
    card.actions = h('div', { class: 'row' }, h('button', { onclick: () => this.onFollow(id), title: 'Follow with the camera (f)' }, 'Follow'), card.halt,
      h('button', { onclick: () => this.touch.remove({ robot: id }) }, 'Remove'));
    card.forms = forms;
    card.element = h('article', { class: 'robot', 'aria-label': `Robot ${id}`, 'data-robot': id },
      h('div', { class: 'row' }, h('h3', {}, id), h('span', { class: 'spacer' }), h('button', { class: 'quiet', 'aria-label': `Leave ${id}`, onclick: () => this.selection.leave(id) }, '×')),
      card.summary, card.pose, card.actions, forms, card.ports);
    this.cards.set(id, card);
    this.columns.append(card.element);
    const mayTouch = this.world.can.has('touch');
    forms.hidden = !mayTouch;
    card.actions.lastChild.hidden = !mayTouch;
    card.halt.hidden = this.world.hello?.mode === 'record';
    this.showHalted();
  }

  moveForm(id) {
    const input = (name) => h('input', { type: 'number', step: 'any', name, required: true });
    const [x, y, z, heading] = ['x', 'y', 'z', 'heading'].map(input);
    const filled = {};
    const fill = () => {
      const pose = this.world.poseOf(id);
      if (pose === null) return;
      [x.value, y.value, z.value, heading.value] = [pose.x.toFixed(3), pose.y.toFixed(3), pose.z.toFixed(3), degrees(pose.heading).toFixed(1)];
      [filled.z, filled.heading] = [z.value, heading.value];
    };
    const form = h('form', { class: 'grid', onsubmit: (event) => {
      event.preventDefault();
      const to = { x: Number(x.value), y: Number(y.value) };
      if (z.value !== filled.z) to.z = Number(z.value);
      if (heading.value !== filled.heading) to.heading = radians(Number(heading.value));
      this.touch.move({ robot: id }, to);
    } }, h('label', {}, 'x (m) ', x), h('label', {}, 'y (m) ', y), h('label', {}, 'z (m) ', z), h('label', {}, 'heading (°) ', heading),
    h('button', { type: 'button', onclick: fill }, 'Where it is'), h('button', { class: 'main' }, 'Put there'));
    queueMicrotask(fill);
    return form;
  }

  isHalted(id) {
    return this.world.halted.has(this.world.members.index.get(id));
  }

  showHalted() {
    for (const card of this.cards.values()) card.halt.textContent = this.isHalted(card.id) ? 'Release' : 'Halt';
  }

  take(message) {
    for (const robot of message.robots ?? []) {
      const card = this.cards.get(robot.id);
      if (card !== undefined) this.show(card, robot);
    }
  }

  show(card, robot) {
    card.element.classList.toggle('gone', robot.alive === false);
    if (robot.alive === false) {
      card.summary.textContent = 'This robot is gone.';
      return;
    }
    const halted = robot.halted?.length > 0 ? ` · halted by ${robot.halted.join(', ')}` : '';
    card.summary.textContent = [robot.kind, robot.controller].filter(Boolean).join(' · ') + halted;
    const { pose } = robot;
    if (pose) {
      card.pose.textContent = `x ${pose.x.toFixed(3)} m  y ${pose.y.toFixed(3)} m  z ${(pose.z ?? 0).toFixed(3)} m  ${degrees(pose.heading).toFixed(1)}°`;
    }
    const groups = [];
    if (pose) groups.push({ key: 'pose', title: 'pose', fields: ['x', 'y', 'z', 'heading'].map((name) => ({ name, unit: name === 'heading' ? 'rad' : 'm', values: [pose[name] ?? 0] })), role: 'pose', port: 'pose' });
    for (const port of robot.ports ?? []) {
      groups.push({ key: `${port.role} ${port.name}`, title: port.name, role: port.role, port: port.name, doc: port.doc, fields: port.fields,
        age: port.stamp_age_s, validity: port.validity });
    }
    if (robot.published?.length > 0) {
      groups.push({ key: 'published', title: 'published', role: 'published', port: '', fields: robot.published.map((p) => ({ ...p, values: Array.isArray(p.value) ? p.value : [p.value] })) });
    }
    const shape = JSON.stringify([groups.map((g) => [g.key, g.fields.map((f) => [f.name, f.unit, Array.isArray(f.values) ? Math.min(f.values.length, most_values) : 'text'])]), robot.params?.length, robot.controls]);
    if (shape !== card.shape) {
      if (!this.rebuild(card, groups, robot.params ?? [], robot.controls ?? [])) return;
      card.shape = shape;
    }
    for (const group of groups) {
      const shown = card.fields.get(group.key);
      shown.age.textContent = group.age === undefined || group.age === null ? '' : ageText(group.age);
      const validity = group.validity ?? '';
      shown.validity.textContent = validity === 'fresh' ? '' : validity;
      group.fields.forEach((field, number) => {
        const values = Array.isArray(field.values) ? field.values : [field.values];
        const cell = shown.fields[number];
        cell.bars?.(values);
        values.slice(0, most_values).forEach((value, index) => {
          if (cell.values[index] !== undefined) cell.values[index].firstChild.data = numberText(value);
        });
      });
    }
  }

  /** False: not now, somebody is at one of its sliders. */
  rebuild(card, groups, params, controls) {
    if (card.ports.contains(document.activeElement) && document.activeElement.matches('.control *')) return false;
    card.fields.clear();
    card.asks.clear();
    const sections = groups.map((group) => {
      const age = h('span', { class: 'minor' }), validity = h('span', { class: 'invalid' });
      const rows = [];
      const fields = group.fields.map((field) => {
        const values = Array.isArray(field.values) ? field.values.slice(0, most_values) : [field.values];
        const many = values.length > 3;
        const buttons = values.map((_, index) => {
          const entry = { role: group.role, port: group.port, field: field.name, index };
          const button = h('button', { class: 'value', 'data-field': `${group.role}.${group.port}.${field.name}.${index}`, title: many ? `${field.name}[${index}]: plot or stop` : 'Plot it or stop the run by it',
            onclick: () => this.menu(card.id, entry, field.unit, button) }, '–');
          card.asks.set(button, { robot: card.id, ...entry });
          return button;
        });
        const cell = { values: buttons };
        const head = h('th', { scope: 'row', title: field.doc ?? '' }, field.name);
        if (many) {
          const bars = h('canvas', { class: 'bars', width: 96, height: 22, 'aria-hidden': 'true' });
          cell.bars = (now) => drawBars(bars, now);
          const key = `${group.key} ${field.name}`;
          const more = h('details', { open: card.open.has(key), ontoggle: (event) => (event.target.open ? card.open.add(key) : card.open.delete(key)) },
            h('summary', {}, bars), h('div', { class: 'values' }, buttons));
          rows.push(h('tr', {}, head, h('td', { class: 'number' }, more), h('td', { class: 'unit' }, field.unit ?? '')));
        } else {
          rows.push(h('tr', {}, head, h('td', { class: 'number' }, buttons), h('td', { class: 'unit' }, field.unit ?? '')));
        }
        return cell;
      });
      card.fields.set(group.key, { age, validity, fields });
      const mark = { sensor: 'sensor', actuator: 'actuator' }[group.role];
      return h('details', { class: 'port', open: !card.open.has(`closed ${group.key}`), ontoggle: (event) => (event.target.open ? card.open.delete(`closed ${group.key}`) : card.open.add(`closed ${group.key}`)) },
        h('summary', { title: group.doc ?? '' }, h('span', { class: 'port-name' }, group.title), mark ? h('span', { class: `role ${mark}` }, mark) : null, validity, age), h('table', {}, rows));
    });
    if (params.length > 0) {
      sections.push(h('details', { class: 'port' }, h('summary', {}, h('span', { class: 'port-name' }, 'parameters')),
        h('table', {}, params.map((p) => h('tr', {}, h('th', { scope: 'row', title: p.doc ?? '' }, p.name), h('td', { class: 'number' }, numberText(p.value)), h('td', { class: 'unit' }, p.unit ?? ''))))));
    }
    if (controls.length > 0) {
      sections.unshift(h('details', { class: 'port', open: true }, h('summary', {}, h('span', { class: 'port-name' }, 'controls')), controls.map((control) => this.makeControl(control))));
    }
    card.ports.replaceChildren(...sections);
    this.markPlotted(card);
    return true;
  }

  /** What can be done with a value. */
  menu(robot, entry, unit, button) {
    const mayStop = this.world.can.has('pause') && this.world.hello.mode !== 'record';
    openMenu(`${robot} ${entry.field}`, button, [...this.plots.choices({ robot, ...entry }, unit),
      ...(mayStop ? [['Stop when …', () => this.openStop(robot, entry, unit, button.textContent)]] : [])]);
  }

  /** After another choice of plots. */
  plotted() {
    this.showHost();
    this.subscribe();  // values come anew, also while the run is paused
    for (const card of this.cards.values()) this.markPlotted(card);
  }

  markPlotted(card) {
    for (const [button, ask] of card.asks) button.classList.toggle('plotted', this.plots.find(ask) !== undefined);
  }

  openStop(robot, entry, unit, value) {
    const op = h('select', { 'aria-label': 'How it is compared' }, ['<', '>', '==', '!='].map((text) => h('option', {}, text)));
    const limit = h('input', { type: 'number', step: 'any', value: Number.isFinite(Number(value)) ? value : 0, 'aria-label': `Limit${unit ? ' in ' + unit : ''}`, required: true });
    const anybody = h('input', { type: 'checkbox' });
    this.stop.hidden = false;
    this.stop.onsubmit = async (event) => {
      event.preventDefault();
      const { role, port, field, index } = entry;
      const answer = await this.commands.carryOut({ do: 'stop_when', robot: anybody.checked ? '*' : robot, role, port, field, index, op: op.value, value: Number(limit.value) });
      if (!answer.ok) return;
      this.stop.hidden = true;
      toast(`The run stops when ${field} ${op.value} ${limit.value} ${unit ?? ''}`);
    };
    this.stop.replaceChildren(h('strong', {}, `Stop when ${[entry.port, entry.field].filter(Boolean).join('.')}`), op, limit, unit ?? '', h('label', { class: 'switch' }, anybody, 'of any robot'),
      h('button', { class: 'main' }, 'Set'), h('button', { type: 'button', onclick: () => (this.stop.hidden = true) }, 'Cancel'));
    op.focus();
  }
}

/** Values of a field as bars from zero. */
function drawBars(canvas, values) {
  const pen = canvas.getContext('2d');
  const { width, height } = canvas;
  pen.clearRect(0, 0, width, height);
  const numbers = values.map((value) => (typeof value === 'number' && Number.isFinite(value) ? value : 0));
  const high = Math.max(0, ...numbers), low = Math.min(0, ...numbers);
  const span = high - low || 1;
  const zero = height - 1 - (-low / span) * (height - 2);
  pen.fillStyle = getComputedStyle(document.documentElement).getPropertyValue('--accent');
  const step = width / numbers.length;
  numbers.forEach((value, i) => {
    const top = zero - (value / span) * (height - 2);
    pen.fillRect(i * step, Math.min(zero, top), Math.max(1, step - 1), Math.max(1, Math.abs(top - zero)));
  });
}
