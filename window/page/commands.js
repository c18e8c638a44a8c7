// Sends what people command, says in sight whether it was carried out, and asks before a touch drops what came after it.
import { h, openDialog, toast } from './html.js';
import { actionText, countText } from './words.js';

const touches = new Set(['move', 'add', 'remove', 'light', 'halt', 'release', 'set', 'press', 'undo']);
const slow_ms = 300;  // then it says that it waits

export class Commands {
  /** `line` is for the page, to stand where it is always seen. */
  constructor(world, connection) {
    Object.assign(this, { world, connection });
    this.line = h('output', { class: 'said', 'aria-label': 'The last command' });
    this.dialog = h('dialog', { 'aria-label': 'Drop what came after?' });
    document.body.append(this.dialog);
  }

  say(state, text) {
    const signs = { waits: '…', done: '✓', refused: '✗' };
    this.line.className = `said ${state}`;
    this.line.textContent = `${signs[state]} ${text}`;
  }

  /** The answer of the run; { ok: false } where the person thinks better of it. */
  async carryOut(command) {
    if (touches.has(command.do) && !(await this.mayDrop(command))) return { ok: false };
    const waits = setTimeout(() => this.say('waits', `${actionText(command)}: not carried out yet`), slow_ms);
    const answer = await this.connection.ask(command);
    clearTimeout(waits);
    if (!answer.ok) {
      this.say('refused', `refused: ${answer.error}`);
      toast(answer.error, 'error');
      return answer;
    }
    // The key for both takes the other one the next time, though the run's state may not be here yet.
    if (command.do === 'play' || command.do === 'pause') this.world.takeState({ ...this.world.state, paused: command.do === 'pause' });
    const { paused } = this.world.state;
    const later = command.do === 'press' && paused ? '; the run is paused: it may show at the next tick' : '';
    const dropped = answer.dropped_ticks > 0 ? `; ${countText(answer.dropped_ticks, 'later tick')} dropped, undo (u) brings them back` : '';
    if (!answer.skipped) this.say('done', `${actionText(command, answer)}${later}${dropped}${answer.note ? `; ${answer.note}` : ''}`);
    if (answer.note) toast(answer.note);
    return answer;
  }

  /** Whether a touch may drop the ticks that came after this one. */
  mayDrop(command) {
    const { tick, latest } = this.world.state;
    if (!this.world.can.has('back') || !(latest > tick)) return Promise.resolve(true);
    const after = countText(latest - tick, 'tick');
    return new Promise((resolve) => {
      let said = false;
      const close = (yes) => {
        said = yes;
        this.dialog.close();
      };
      this.dialog.replaceChildren(h('h2', {}, `Drop ${after}?`),
        h('p', {}, `The picture shows tick ${tick.toLocaleString('en')}, and the run has been at ${latest.toLocaleString('en')}. ${command.do === 'undo' ? 'Undoing' : 'Touching'} something here makes it another run: the ${after} that came after are dropped.`),
        h('p', { class: 'minor' }, command.do === 'undo' ? 'They cannot be brought back.' : 'Undo (u) brings them back.'),
        h('div', { class: 'row' }, h('span', { class: 'spacer' }), h('button', { autofocus: true, onclick: () => close(false) }, 'Cancel'), h('button', { class: 'main', onclick: () => close(true) }, `Drop ${after}`)));
      this.dialog.addEventListener('close', () => resolve(said), { once: true });
      openDialog(this.dialog);
    });
  }
}
