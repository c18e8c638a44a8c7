// The log of the run: incidents, what was touched, and what robots and hooks said; a click goes to tick and robot.
import { h, timeText } from './html.js';
import { Events } from './events.js';
import { actionBy } from './words.js';

const most_entries = 5000, most_shown = 300;
const names = { incident: 'Incidents', action: 'Touches', log: 'Messages' };

/** Emits "change" and "go" (entry). */
export class Log extends Events {
  entries = [];
  shown = new Set(['incident', 'action', 'log']);
  text = '';

  constructor(world, connection, host) {
    super();
    this.world = world;
    this.count = h('span', { class: 'count' });
    this.list = h('ol', { class: 'entries', tabindex: 0, 'aria-label': 'Entries of the log' });
    const filters = Object.entries(names).map(([kind, name]) => h('label', { class: 'switch' },
      h('input', { type: 'checkbox', checked: true, onchange: (event) => {
        if (event.target.checked) this.shown.add(kind);
        else this.shown.delete(kind);
        this.show();
      } }), h('span', {}, name)));
    const search = h('input', { type: 'search', placeholder: 'robot or text', 'aria-label': 'Only entries with this robot or text', oninput: (event) => {
      this.text = event.target.value.toLowerCase();
      this.show();
    } });
    this.element = h('details', { id: 'log' }, h('summary', {}, 'Log ', this.count), h('div', { class: 'filters' }, filters, search), this.list);
    this.element.addEventListener('toggle', () => this.show());
    host.append(this.element);
    world.on('hello', () => {
      this.entries = [];
      this.emit('change');
      this.show();
    });
    connection.on('log', (message) => this.take(message.entries));
  }

  take(entries) {
    const last = this.entries.length > 0 ? this.entries[this.entries.length - 1].n : -Infinity;
    this.entries.push(...entries.filter((entry) => entry.n === undefined || entry.n > last));
    if (this.entries.length > most_entries) this.entries.splice(0, this.entries.length - most_entries);
    this.emit('change');
    if (this.asked) return;
    this.asked = true;
    setTimeout(() => {
      this.asked = false;
      this.show();
    }, 100);
  }

  show() {
    const incidents = this.entries.filter((entry) => entry.kind === 'incident').length;
    this.count.textContent = incidents > 0 ? `${incidents} incident${incidents > 1 ? 's' : ''}` : '';
    if (!this.element.open) return;
    const wanted = this.entries.filter((entry) => this.shown.has(entry.kind)
      && (this.text === '' || `${entry.robot ?? ''} ${entry.text}`.toLowerCase().includes(this.text)));
    this.list.replaceChildren(...wanted.slice(-most_shown).reverse().map((entry) => h('li', {},
      h('button', { class: `entry ${entry.kind}`, title: 'Go to this tick and robot', onclick: () => this.emit('go', entry) },
        h('span', { class: 'when' }, timeText(this.world.seconds(entry.tick))), h('span', { class: 'tick' }, `tick ${entry.tick}`),
        h('span', { class: 'who' }, entry.robot ?? ''), h('span', { class: 'what' }, textOf(entry))))));
    if (wanted.length === 0) this.list.replaceChildren(h('li', { class: 'minor' }, 'Nothing yet.'));
  }
}

/** An action comes as JSON. */
function textOf(entry) {
  return entry.kind === 'action' && entry.text.startsWith('{') ? actionBy(JSON.parse(entry.text)) : entry.text;
}
