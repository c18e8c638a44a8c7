// Finds robots by id, for those who do not see or hit them in the picture.
import { h, section } from './html.js';
import { kindColor } from './palette.js';

const most_found = 30;

export class Finder {
  constructor(world, selection, host, show) {
    this.world = world;
    this.selection = selection;
    this.input = h('input', { type: 'search', id: 'find', placeholder: 'id of a robot ( / )', 'aria-label': 'Find a robot by its id', oninput: () => this.list(),
      onkeydown: (event) => {
        if (event.key !== 'Enter') return;
        event.preventDefault();
        const [first] = this.found();
        if (first !== undefined) this.choose(first, event.ctrlKey || event.shiftKey);
      } });
    this.results = h('div', { class: 'found' });
    this.summary = h('p', { class: 'minor' });
    this.show = show;
    const { element, body } = section('Robots', true, 'robots');
    body.append(this.summary, this.input, this.results);
    host.append(element);
    world.on('members', () => this.count());
    selection.on('change', () => this.list());
  }

  count() {
    const { kinds, kind, count } = this.world.members;
    const each = new Array(kinds.length).fill(0);
    for (const k of kind) each[k]++;
    this.summary.replaceChildren(...kinds.map((name, k) => {
      const dot = h('span', { class: 'dot' });
      dot.style.background = kindColor(k);
      return h('span', { class: 'kind' }, dot, `${each[k]} ${name}`);
    }));
    if (count === 0) this.summary.textContent = 'There is none.';
    this.list();
  }

  found() {
    const text = this.input.value.trim().toLowerCase();
    if (text === '') return [];
    const { ids } = this.world.members;
    const exact = ids.filter((id) => id.toLowerCase() === text);
    const others = [];
    for (const id of ids) {
      if (others.length >= most_found) break;
      if (id.toLowerCase().includes(text) && id.toLowerCase() !== text) others.push(id);
    }
    return [...exact, ...others];
  }

  choose(id, add) {
    this.selection.choose(id, add);
    this.show(id);
  }

  list() {
    this.results.replaceChildren(...this.found().map((id) => h('button', { class: 'link', 'aria-pressed': String(this.selection.ids.has(id)),
      onclick: (event) => this.choose(id, event.ctrlKey || event.shiftKey) }, id)));
  }

  /** Chooses the robot after (1) or before (-1) the one that was chosen last, in the order of their ids: ep2 before ep10. */
  next(by) {
    if (this.sorted?.of !== this.world.members) this.sorted = { of: this.world.members, ids: [...this.world.members.ids].sort(new Intl.Collator('en', { numeric: true }).compare) };
    const { ids } = this.sorted;
    if (ids.length === 0) return;
    const at = ids.indexOf(this.selection.last);
    const to = at < 0 ? (by > 0 ? 0 : ids.length - 1) : (at + by + ids.length) % ids.length;
    this.choose(ids[to], false);
  }
}
