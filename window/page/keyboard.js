// Everything by keys, and the list of them.
import { h, openDialog } from './html.js';

const groups = [
  ['Time', [['space', 'play, pause'], ['.', 'one tick'], [',', 'one tick back'], ['[ ]', 'slower, faster'], ['Home End', 'first, newest tick'], ['Shift+R', 'start anew, with a seed'], ['u', 'undo what was touched last']]],
  ['Camera', [['← → ↑ ↓', 'turn; from the top: move'], ['Shift+arrows', 'move over the floor'], ['+ −', 'nearer, farther'], ['t', 'from the top, and back'], ['f', 'follow the chosen robot'], ['h', 'the whole arena']]],
  ['Robots', [['n p', 'next, previous robot'], ['/', 'find by id'], ['click, Shift+click', 'choose, choose one more'], ['Esc', 'choose nothing']]],
  ['Touch', [['m', 'touch or only look'], ['arrows', 'while touching: move what is chosen (Shift: ten times so far)'], ['< >', 'while touching: turn it'], ['x', 'halt or release the chosen robots'], ['e', 'emergency stop of real robots']]],
  ['Page', [['v', 'panels on and off'], ['l', 'log'], ['c', 'what colours say: as they are, kind, state, density'], ['s', 'save the picture'], ['w', 'record a film, and end it'], ['?', 'this list']]],
];

/** `page` has everything that keys can do; see main.js. */
export class Keyboard {
  constructor(page) {
    this.page = page;
    this.help = h('dialog', { class: 'help', 'aria-label': 'Keys' }, h('h2', {}, 'Keys'),
      h('div', { class: 'keys' }, groups.map(([title, rows]) => h('section', {}, h('h3', {}, title),
        h('table', {}, rows.map(([keys, what]) => h('tr', {}, h('th', { scope: 'row' }, keys.split(' ').length < 3 && !keys.includes(',') ? keys.split(' ').map((key) => h('kbd', {}, key)) : h('kbd', {}, keys)), h('td', {}, what))))))),
      h('p', { class: 'minor' }, 'With a finger: one turns, two move and zoom, a tap chooses. With a mouse: left turns, right or Shift moves, the wheel zooms.'),
      h('button', { class: 'main', onclick: () => this.help.close() }, 'Close'));
    document.body.append(this.help);
    document.getElementById('help-button').addEventListener('click', () => openDialog(this.help));
    document.addEventListener('keydown', (event) => this.press(event));
  }

  press(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const target = event.target;
    const writes = target instanceof Element && target.matches('input:not([type=checkbox]):not([type=range]), select, textarea');
    if (writes) {
      if (event.key === 'Escape') target.blur();
      return;
    }
    if (document.querySelector('dialog[open]') !== null) {
      if (event.key === 'e') this.page.real.emergencyStop();
      return;
    }
    const onWidget = target instanceof Element && target.matches('button, summary, a, input, [role=menuitem]');
    if (onWidget && [' ', 'Enter'].includes(event.key)) return;
    if (target instanceof Element && target.matches('input[type=range], .entries') && /^(Arrow|Home|End|Page)/.test(event.key)) return;
    if (this.act(event)) event.preventDefault();
  }

  act({ key, shiftKey }) {
    const { timeline, camera, touch, finder, real, selection, log } = this.page;
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    if (arrows[key] !== undefined) {
      const [x, y] = arrows[key];
      if (touch.nudge(x, y, 0, shiftKey)) return true;
      if (shiftKey || camera.isTop) camera.pan(-40 * x, 40 * y);
      else camera.orbit(-0.1 * x, 0.08 * y);
      return true;
    }
    const actions = {
      ' ': () => timeline.playButton.disabled || timeline.toggle(),
      '.': () => timeline.step(),
      ',': () => timeline.backButton.disabled || timeline.stepBack(),
      '[': () => timeline.shiftSpeed(-1),
      ']': () => timeline.shiftSpeed(1),
      Home: () => timeline.bar.disabled || timeline.goTo(this.page.world.state.first ?? 0),
      End: () => timeline.bar.disabled || timeline.goTo(this.page.world.state.latest),
      R: () => timeline.openReset(),
      u: () => timeline.undo(),
      '+': () => camera.zoom(0.85),
      '=': () => camera.zoom(0.85),
      '-': () => camera.zoom(1 / 0.85),
      t: () => this.page.toggleTop(),
      f: () => this.page.toggleFollow(),
      h: () => camera.goHome(),
      n: () => finder.next(1),
      p: () => finder.next(-1),
      '/': () => {
        this.page.showPanels(true);
        finder.input.focus();
      },
      Escape: () => {
        touch.stopPlacing();
        touch.choose(null);
        selection.clear();
      },
      m: () => touch.setOn(!touch.on),
      '<': () => touch.nudge(0, 0, 1, false),
      '>': () => touch.nudge(0, 0, -1, false),
      x: () => this.page.toggleHalt(),
      e: () => real.emergencyStop(),
      v: () => this.page.showPanels(),
      l: () => (log.element.open = !log.element.open),
      c: () => this.page.toggleColors(),
      s: () => this.page.savePicture(),
      w: () => this.page.film.toggle(),
      '?': () => openDialog(this.help),
    };
    if (actions[key] === undefined) return false;
    actions[key]();
    return true;
  }
}
