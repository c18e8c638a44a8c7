// Real robots: state of their links, why they do not drive, arming, and the emergency stop.
import { h, section, openDialog, toast, numberText, ageText } from './html.js';
import { okabeIto } from './palette.js';

export class Real {
  constructor(view, world, connection, commands, selection, robots, alarm, host) {
    Object.assign(this, { view, world, connection, commands, selection });
    this.states = new Map();  // by id
    this.motions = new Map();  // verdicts of first motions, by id; null while one goes on
    this.stop = h('button', { class: 'estop', title: 'Stops all real robots (e)', onclick: () => this.emergencyStop() }, 'EMERGENCY STOP');
    this.stop.hidden = true;
    alarm.append(this.stop);
    const { element, body } = section('Real robots', true, 'real');
    this.element = element;
    this.list = h('div', {});
    this.roll = h('ul', { class: 'roll', 'aria-label': 'Real robots, by what they do', 'aria-live': 'polite' });
    this.said = h('p', { class: 'minor', role: 'status' });
    this.spares = [];
    this.dialog = h('dialog', { 'aria-label': 'Real robots' });
    document.body.append(this.dialog);
    this.buttons = h('div', { class: 'row' }, h('button', { title: 'Looks for what is in the way of the run; moves nothing', onclick: () => this.preflight() }, 'Preflight'), h('button', { title: 'Ends the emergency stop', onclick: () => this.command({ do: 'arm', robot: '*' }) }, 'Arm all'),
      h('button', { onclick: () => this.command({ do: 'rearm', robot: '*' }), title: 'After a stop: those that are proved to be the robots that were armed; each other one by its own button' }, 'Re-arm all'));
    body.append(this.buttons, this.said, this.roll, this.list);
    element.hidden = true;
    host.append(element);
    world.on('hello', (hello) => {
      const real = hello.mode === 'mixed' || world.can.has('real');
      this.stop.hidden = !real;
      document.body.classList.toggle('has-stop', real);
      element.hidden = !real;
    });
    connection.on('real', (message) => this.take(message));
    robots.realText = (id) => {
      const state = this.states.get(id);
      return state === undefined || state.driving ? id : `${id}: ${state.state}`;
    };
    view.addItem(this);
  }

  command(command) {
    return this.commands.carryOut(command);
  }

  emergencyStop() {
    if (this.stop.hidden) return;
    this.command({ do: 'estop' });
  }

  take(message) {
    this.spares = message.spares ?? [];
    this.said.textContent = saidText(message.desk);
    this.stop.classList.toggle('on', message.estop === true);
    this.stop.textContent = message.estop ? 'STOPPED' : 'EMERGENCY STOP';
    this.states = new Map(message.robots.map((robot) => [robot.id, robot]));
    this.showRoll(message.roll ?? []);
    this.held = message.paused === true && this.world.state.tick === 0;
    this.showCards();
    this.view.invalidate();
  }

  /** Who may move, waits for a person, cannot be reached: all of them, however many. */
  showRoll(groups) {
    const text = JSON.stringify(groups);
    if (text === this.shownRoll) return;
    this.shownRoll = text;
    this.roll.replaceChildren(...groups.map((group) => h('li', { class: group.urgent ? 'urgent' : '' }, group.text)));
  }

  showCards() {
    const focused = document.activeElement?.dataset?.key;
    this.list.replaceChildren(...[...this.states.values()].map((robot) => this.card(robot)));
    if (focused) this.list.querySelector(`[data-key="${CSS.escape(focused)}"]`)?.focus();
  }

  card(robot) {
    const facts = [
      ['link', robot.trouble ? `${robot.health}: ${robot.trouble}` : robot.health], ['age of readings', typeof robot.age_s !== 'number' ? undefined : ageText(robot.age_s)], ['round trip', typeof robot.round_trip_s !== 'number' ? undefined : ageText(robot.round_trip_s)],
      ['held back', robot.held_back_ticks > 0 ? `${robot.held_back_ticks} ticks${robot.held_back_m_s > 0 ? `, now by ${numberText(robot.held_back_m_s)} m/s` : ''}` : undefined],
      ['battery', robot.battery === undefined || robot.battery === null ? undefined : `${Math.round(100 * robot.battery)} %${typeof robot.supply_V === 'number' ? `, ${robot.supply_V.toFixed(2)} V` : ''}`],
      ['robot', robot.device && robot.device !== robot.id ? `'${robot.device}' on ${robot.link}` : undefined], ['firmware', robot.identity],
      ['deadlines', ledgerText(robot.ledger)],
    ].filter(([, value]) => value !== undefined && value !== null && value !== '');
    const sources = (robot.sources ?? []).map((s) => h('tr', {}, h('th', { scope: 'row' }, s.name), h('td', {}, `${numberText(s.x)}, ${numberText(s.y)} m, ${numberText(((s.heading ?? 0) * 180) / Math.PI)}°, ${ageText(s.age_s)} ago`)));
    return h('article', { class: `real ${robot.driving ? 'driving' : 'standing'}` },
      h('div', { class: 'row' }, h('button', { class: 'link', 'data-key': `${robot.id} choose`, onclick: () => this.selection.choose(robot.id) }, robot.id),
        h('span', { class: `badge ${robot.driving ? 'good' : 'bad'}` }, robot.driving ? 'driving' : robot.state), h('span', { class: 'spacer' }),
        robot.armed ? null : h('button', { 'data-key': `${robot.id} arm`, onclick: () => this.command({ do: 'arm', robot: robot.id }) }, 'Arm'),
        robot.awaits_rearm === false ? null : h('button', { 'data-key': `${robot.id} rearm`, onclick: () => this.command({ do: 'rearm', robot: robot.id }) }, 'Re-arm'),
        this.held ? h('button', { class: 'quiet', 'data-key': `${robot.id} move`, title: 'First motion: it turns a little', disabled: [...this.motions.values()].includes(null), onclick: () => this.openMove(robot.id) }, 'Move…') : null,
        robot.coming ? h('span', { class: 'minor' }, `'${robot.coming}' comes`) : h('button', { class: 'quiet', 'data-key': `${robot.id} replace`, title: 'Another robot takes its place', onclick: () => this.openReplace(robot.id) }, 'Replace…')),
      this.motionText(robot.id),
      h('table', {}, facts.map(([name, value]) => h('tr', {}, h('th', { scope: 'row' }, name), h('td', {}, value))), sources));
  }

  /** Who is held back from somebody, or from an area. */
  drawHeldBack(pen, camera) {
    for (const [id, robot] of this.states) {
      const pose = robot.held_back_m_s > 0 ? this.world.poseOf(id) : null;
      const at = pose === null ? null : camera.project(pose.x, pose.y, pose.z);
      if (at?.inFront) pen.tag('held back', at.x + 10, at.y + 8, { color: okabeIto.vermilion });
    }
  }

  async preflight() {
    const answer = await this.connection.ask({ do: 'preflight' });
    if (!answer.ok) {
      toast(answer.error, 'error');
      return;
    }
    const words = { ok: 'ok', warn: 'look at', fail: 'in the way' };
    this.dialog.replaceChildren(h('h2', {}, answer.worst === 'fail' ? 'Something is in the way' : 'Nothing is in the way'),
      h('table', { class: 'preflight' }, answer.preflight.map((row) => h('tr', { class: row.finding }, h('td', {}, words[row.finding]), h('th', { scope: 'row' }, row.about), h('td', {}, row.check),
        h('td', {}, row.found, row.advice ? h('div', { class: 'minor' }, row.advice) : null)))),
      h('button', { class: 'main', onclick: () => this.dialog.close() }, 'Close'));
    openDialog(this.dialog);
  }

  /** Says what will move, and moves it when told so. The dialog is closed before: nothing may cover the emergency stop. */
  openMove(id) {
    this.dialog.replaceChildren(h('form', { onsubmit: (event) => {
      event.preventDefault();
      this.dialog.close();
      this.move(id);
    } }, h('h2', {}, `Move '${id}'?`), h('p', {}, `'${id}' turns on the spot by about 30° to the left and back, slowly. All other robots are to stand; whether they do is watched.`),
    h('p', { class: 'minor' }, 'EMERGENCY STOP (key e) stops it.'),
    h('div', { class: 'row' }, h('span', { class: 'spacer' }), h('button', { type: 'button', onclick: () => this.dialog.close() }, 'Cancel'), h('button', { class: 'main' }, `Move '${id}'`))));
    openDialog(this.dialog);
  }

  async move(id) {
    this.motions.set(id, null);
    this.showCards();
    const answer = await this.connection.ask({ do: 'first_motion', robot: id });
    if (answer.ok) this.motions.set(id, { ...answer.preflight[0], others: answer.preflight.length > 1 });
    else this.motions.set(id, { finding: 'fail', found: answer.error, advice: '' });
    this.showCards();
  }

  motionText(id) {
    if (!this.motions.has(id)) return null;
    const row = this.motions.get(id);
    if (row === null) return h('p', { class: 'motion', role: 'status' }, 'It turns to the left and back…');
    const words = { ok: 'moved as told', warn: 'nobody saw it move', fail: row.others ? 'another robot moved' : 'did not move as told' };
    return h('p', { class: `motion ${row.finding}`, role: 'status' }, `${words[row.finding]}: ${row.found}`, row.advice ? h('span', { class: 'minor' }, ` ${row.advice}`) : null);
  }

  openReplace(id) {
    const free = this.spares.filter((spare) => !spare.used);
    const choice = h('select', { 'aria-label': 'Robot that comes' }, free.map((spare) => h('option', { value: spare.id }, `${spare.id} on ${spare.link}`)), h('option', { value: '' }, 'another one, on this link:'));
    const link = h('input', { type: 'text', 'aria-label': 'Its link', placeholder: 'serial:/dev/rfcomm1@115200' });
    choice.addEventListener('change', () => (link.hidden = choice.value !== ''));
    link.hidden = choice.value !== '';
    this.dialog.replaceChildren(h('form', { onsubmit: (event) => {
      event.preventDefault();
      this.dialog.close();
      this.command({ do: 'replace', robot: id, ...(choice.value === '' ? { link: link.value } : { spare: choice.value }) });
    } }, h('h2', {}, `Replace '${id}'`), h('p', {}, 'It is stopped, for good. Its twin stays; the other robot stands until it is armed.'),
    h('div', { class: 'row' }, choice, link),
    h('div', { class: 'row' }, h('span', { class: 'spacer' }), h('button', { type: 'button', onclick: () => this.dialog.close() }, 'Cancel'), h('button', { class: 'main' }, 'Stop and replace'))));
    openDialog(this.dialog);
  }

  /** Where each source says that a chosen real robot is. */
  label(pen, camera) {
    this.drawHeldBack(pen, camera);
    for (const id of this.selection.ids) {
      const pose = this.world.poseOf(id);
      if (pose === null) continue;
      const middle = camera.project(pose.x, pose.y, pose.z);
      for (const source of this.states.get(id)?.sources ?? []) {
        if (!Number.isFinite(source.x) || !Number.isFinite(source.y)) continue;
        const at = camera.project(source.x, source.y, pose.z);
        if (!at.inFront) continue;
        pen.line([[middle.x, middle.y], [at.x, at.y]], okabeIto.blue, 1);
        pen.line([[at.x - 5, at.y], [at.x + 5, at.y], [at.x, at.y], [at.x, at.y - 5], [at.x, at.y + 5]], okabeIto.blue, 2);
        pen.text(source.name, at.x + 7, at.y + 9);
      }
    }
  }
}

/** Whose word counted last. */
function saidText(desk) {
  if (!desk || !desk.last) return '';
  const { last, turned_back: back } = desk;
  const words = { estop: 'emergency stop', play: 'start', arm: 'arm', rearm: 're-arm', pause: 'pause', replace: 'replace', halt: 'halt', release: 'release' };
  return `${words[last.do] ?? last.do}${last.robot && last.robot !== '*' ? ` ${last.robot}` : ''} by ${last.who}, ${ageText(last.age_s)} ago${back > 0 ? `; ${back} taken back` : ''}`;
}

/** Nothing where nobody keeps one, or nothing is in it yet. */
function ledgerText(ledger) {
  if (!ledger || !(ledger.ticks > 0)) return undefined;
  const missed = ledger.late_readings + ledger.late_commands;
  return `${missed} of ${ledger.ticks} missed; age ${Math.round(ledger.age_median_ms)} ms, 99 % ${Math.round(ledger.age_p99_ms)} ms; jitter ${ledger.jitter_ms.toFixed(1)} ms`;
}
