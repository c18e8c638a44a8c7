// The time of the run: play, pause, one tick, speed, and the bar on which any earlier tick can be chosen.
import { h, icon, openDialog, timeText } from './html.js';

const speeds = [0.1, 0.25, 0.5, 1, 2, 5, 10, 20, 50, null];  // times real time; null: as fast as it goes
const most_marks = 400;

/** `log` gives the marks on the bar. */
export class Timeline {
  constructor(world, commands, log, host, now) {
    Object.assign(this, { world, commands, log, now });
    this.wanted = null;    // tick that is to be shown next
    this.seeking = false;  // a go_to is under way
    const button = (name, sign, label, call) => (this[name] = h('button', { title: label, 'aria-label': label, onclick: call }, icon(sign)));
    button('resetButton', 'reset', 'Start anew (Shift+R)', () => this.openReset());
    button('backButton', 'back', 'One tick back (,)', () => this.stepBack());
    button('playButton', 'play', 'Play (space)', () => this.toggle());
    button('forwardButton', 'forward', 'One tick (.)', () => this.step());
    button('undoButton', 'undo', 'Undo what was touched last (u)', () => this.undo());
    this.speed = h('select', { 'aria-label': 'Speed', title: 'Speed ([ and ])', onchange: () => this.setSpeed(speeds[this.speed.selectedIndex]) },
      speeds.map((times) => h('option', {}, times === null ? 'fastest' : `${times} ×`)));
    this.reached = h('span', { class: 'minor reached', title: 'What is reached, times real time' });
    this.bar = h('input', { type: 'range', min: 0, max: 0, step: 1, value: 0, 'aria-label': 'Tick', oninput: () => this.goTo(Number(this.bar.value)) });
    this.marks = h('canvas', { class: 'marks', 'aria-hidden': 'true' });
    this.ticks = h('output', { class: 'ticks' });
    this.why = h('span', { class: 'why', role: 'status' });
    host.append(h('div', { class: 'timeline', role: 'group', 'aria-label': 'Time' }, this.resetButton, this.backButton, this.playButton, this.forwardButton, this.speed, this.reached,
      h('div', { class: 'bar' }, this.marks, this.bar), this.ticks, this.undoButton), h('div', { class: 'timeline-why' }, this.why, commands.line));
    this.dialog = h('dialog', { 'aria-label': 'Start anew' });
    document.body.append(this.dialog);
    world.on('state', () => this.show()).on('poses', () => this.showTick()).on('hello', () => this.show());
    log.on('change', () => this.drawMarks());
    new ResizeObserver(() => this.drawMarks()).observe(this.bar);
    this.show();
  }

  command(command) {
    return this.commands.carryOut(command);
  }

  get paused() {
    return this.world.state.paused;
  }

  toggle() {
    return this.command({ do: this.paused ? 'play' : 'pause' });
  }

  step(ticks = 1) {
    return this.command({ do: 'step', ticks });
  }

  stepBack() {
    return this.goTo((this.wanted ?? this.world.tick) - 1);
  }

  undo() {
    return this.command({ do: 'undo' });
  }

  setSpeed(times) {
    return this.command({ do: 'speed', times });
  }

  /** One notch faster or slower. */
  shiftSpeed(by) {
    const at = this.nearestSpeed(this.world.state.speed);
    this.setSpeed(speeds[Math.min(speeds.length - 1, Math.max(0, at + by))]);
  }

  nearestSpeed(speed) {
    if (speed === null || speed === undefined) return speeds.length - 1;
    let best = 0;
    speeds.forEach((times, i) => {
      if (times !== null && Math.abs(Math.log(times / speed)) < Math.abs(Math.log(speeds[best] / speed))) best = i;
    });
    return best;
  }

  /** Shows another tick; of many wishes in a row only the newest is carried out. */
  async goTo(tick) {
    const { first, latest } = this.world.state;
    this.wanted = Math.min(latest, Math.max(first ?? 0, Math.round(tick)));
    this.showTick();
    if (this.seeking) return;
    this.seeking = true;
    while (this.wanted !== null) {
      const tick_ = this.wanted;
      const answer = await this.command({ do: 'go_to', tick: tick_ });
      if (this.wanted === tick_ || !answer.ok) this.wanted = null;
    }
    this.seeking = false;
    this.showTick();
  }

  openReset() {
    if (!this.world.can.has('reset')) return;
    const seed = h('input', { type: 'number', min: 0, step: 1, value: this.world.state.seed ?? this.world.hello?.seed ?? 0, id: 'reset-seed' });
    const start = () => {
      this.dialog.close();
      this.command({ do: 'reset', seed: Number(seed.value) });
    };
    this.dialog.replaceChildren(h('form', { method: 'dialog', onsubmit: (event) => {
      event.preventDefault();
      start();
    } }, h('h2', {}, 'Start anew'), h('p', {}, 'All robots go back to where they began. The same seed gives the same run.'),
    h('label', {}, 'Seed ', seed),
    h('div', { class: 'row' }, h('button', { type: 'button', onclick: () => (seed.value = Math.floor(Math.random() * 1e6)) }, 'Another seed'),
      h('span', { class: 'spacer' }), h('button', { type: 'button', onclick: () => this.dialog.close() }, 'Cancel'), h('button', { class: 'main' }, 'Start anew'))));
    openDialog(this.dialog);
    seed.select();
  }

  show() {
    const { state, can, hello } = this.world;
    const isOver = state.ended !== null && state.ended !== undefined;
    const play = state.paused || isOver;
    this.playButton.replaceChildren(icon(play ? 'play' : 'pause'));
    this.playButton.setAttribute('aria-label', play ? 'Play (space)' : 'Pause (space)');
    this.playButton.title = play ? 'Play (space)' : 'Pause (space)';
    const mayPause = hello !== null && can.has('pause');
    this.playButton.disabled = !mayPause;
    this.forwardButton.disabled = !mayPause || can.has('real');
    this.speed.disabled = !mayPause || can.has('real');
    this.backButton.disabled = !can.has('back');
    this.bar.disabled = !can.has('back');
    this.resetButton.hidden = !can.has('reset');
    this.undoButton.hidden = !can.has('touch') || !can.has('back');
    this.speed.selectedIndex = this.nearestSpeed(state.speed);
    this.reached.textContent = state.paused || !(state.reached > 0) ? '' : `${state.reached < 10 ? state.reached.toFixed(2) : Math.round(state.reached)} ×`;
    const texts = [];
    if (can.has('real') && state.paused && !isOver) texts.push(state.tick === 0 ? 'Real robots stand, and wait for the start: space, or ▶.' : 'Paused: real robots stand, and time stands still.');
    else if (hello !== null && !can.has('pause')) texts.push('Real robots take part: time cannot be stopped. Halt the robots instead.');
    else if (hello !== null && !can.has('back')) texts.push(state.no_way_back ? `No way back: ${state.no_way_back}.` : 'This run cannot go back.');
    if (isOver) texts.push(typeof state.ended === 'string' ? `The run has ended: ${state.ended}` : 'The run has ended.');
    if (state.stopped_by) texts.push(`Stopped: ${state.stopped_by}`);
    if (state.message) texts.push(state.message);
    if (state.tick < state.latest && state.paused && hello?.mode === 'run') texts.push(`Looking back; the run was at tick ${state.latest}.`);
    this.why.textContent = texts.join(' ');
    this.showTick();
  }

  showTick() {
    const { state, hello } = this.world;
    const tick = this.wanted ?? this.world.tick;
    if (Number(this.bar.min) !== (state.first ?? 0)) this.bar.min = state.first ?? 0;
    const latest = Math.max(state.latest ?? 0, tick);
    if (Number(this.bar.max) !== latest) {
      this.bar.max = latest;
      this.drawMarks();
    }
    if (document.activeElement !== this.bar || this.wanted === null) this.bar.value = tick;
    const seconds = this.world.seconds(tick);
    this.bar.setAttribute('aria-valuetext', `tick ${tick}, ${timeText(seconds)}`);
    this.ticks.textContent = `${tick} / ${latest}`;
    this.now.textContent = hello === null ? '' : `${timeText(seconds)}${state.paused ? ' · paused' : ''}`;
  }

  /** Incidents and touches above the bar. */
  drawMarks() {
    const { marks, bar } = this;
    const entries = this.log.entries.filter((entry) => entry.kind !== 'log').slice(-most_marks);
    if (entries.length === 0 && !this.marked) return;
    this.marked = entries.length > 0;
    const box = bar.getBoundingClientRect();
    const ratio = window.devicePixelRatio || 1;
    marks.width = Math.max(1, box.width * ratio);
    marks.height = 8 * ratio;
    const pen = marks.getContext('2d');
    const thumb = 8 * ratio;
    const [min, max] = [Number(bar.min), Number(bar.max)];
    if (max <= min) return;
    const style = getComputedStyle(document.documentElement);
    for (const entry of entries) {
      const x = thumb + ((entry.tick - min) / (max - min)) * (marks.width - 2 * thumb);
      pen.fillStyle = style.getPropertyValue(entry.kind === 'incident' ? '--bad' : '--accent');
      pen.fillRect(x - ratio, entry.kind === 'incident' ? 0 : 3 * ratio, 2 * ratio, 8 * ratio);
    }
  }
}
