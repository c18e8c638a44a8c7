// Sliders, switches and buttons that hooks and controllers declare.
import { h, section, numberText } from './html.js';

export class Controls {
  constructor(world, connection, commands, host) {
    this.commands = commands;
    const { element, body } = section('Controls', true, 'controls');
    this.element = element;
    this.body = body;
    element.hidden = true;
    host.append(element);
    world.on('hello', (hello) => this.rebuild(hello.controls ?? []));
    connection.on('controls', (message) => this.rebuild(message.controls));
  }

  command(command) {
    return this.commands.carryOut(command);
  }

  rebuild(controls) {
    // A slider that is being pulled stays.
    if (this.body.contains(document.activeElement) && this.names === controls.map((c) => c.owner + c.name).join()) return;
    this.names = controls.map((c) => c.owner + c.name).join();
    this.element.hidden = controls.length === 0;
    const owners = [...new Set(controls.map((control) => control.owner))];
    this.body.replaceChildren(...owners.map((owner) => h('fieldset', {}, h('legend', {}, owner.replace(':', ' ')),
      controls.filter((control) => control.owner === owner).map((control) => this.make(control)))));
  }

  make(control) {
    const { owner, name, kind, value, min, max, unit, options, doc } = control;
    const set = (to) => this.command({ do: 'set', owner, control: name, value: to });
    const label = (...inputs) => h('label', { class: 'control', title: doc ?? '' }, h('span', {}, name.replaceAll('_', ' ')), ...inputs);
    const data = { 'data-control': `${owner}/${name}` };
    if (kind === 'button') return h('button', { ...data, title: doc ?? '', onclick: () => this.command({ do: 'press', owner, control: name }) }, name.replaceAll('_', ' '));
    if (kind === 'flag') return h('label', { class: 'switch', title: doc ?? '' }, h('input', { ...data, type: 'checkbox', checked: value === true, onchange: (event) => set(event.target.checked) }), h('span', {}, name.replaceAll('_', ' ')));
    if (kind === 'choice') return label(h('select', { ...data, onchange: (event) => set(event.target.value) }, (options ?? []).map((option) => h('option', { selected: option === value }, option))));
    if (kind === 'text') return label(h('input', { ...data, type: 'text', value, onchange: (event) => set(event.target.value) }));
    const step = kind === 'integer' ? 1 : 'any';
    const number = h('input', { type: 'number', step, min, max, value, onchange: () => {
      if (slider !== null) slider.value = number.value;
      set(Number(number.value));
    } });
    const bounded = Number.isFinite(min) && Number.isFinite(max) && max > min;
    const slider = bounded ? h('input', { ...data, type: 'range', min, max, step: kind === 'integer' ? 1 : (max - min) / 1000, value, 'aria-label': name,
      oninput: () => (number.value = Number(Number(slider.value).toPrecision(6))), onchange: () => set(Number(slider.value)) }) : null;
    if (slider === null) Object.entries(data).forEach(([key, text]) => number.setAttribute(key, text));
    return label(slider, number, h('span', { class: 'unit' }, unit ?? ''), bounded ? h('span', { class: 'minor' }, `${numberText(min)} … ${numberText(max)}`) : null);
  }
}
