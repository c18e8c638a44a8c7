// The robots that are chosen, by id.
import { Events } from './events.js';

const most = 8;  // side by side

/** Emits "change". */
export class Selection extends Events {
  ids = new Set();

  choose(id, add = false) {
    if (!add) this.ids.clear();
    else if (this.ids.has(id)) return this.leave(id);
    this.ids.add(id);
    while (this.ids.size > most) this.ids.delete(this.ids.values().next().value);
    this.emit('change');
  }

  leave(id) {
    if (this.ids.delete(id)) this.emit('change');
  }

  clear() {
    if (this.ids.size === 0) return;
    this.ids.clear();
    this.emit('change');
  }

  /** The one that was chosen last, or undefined. */
  get last() {
    return [...this.ids].pop();
  }
}
