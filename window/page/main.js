// The page: puts its parts together and joins them to the run.
import { Connection } from './connection.js';
import { World } from './world.js';
import { View } from './view.js';
import { Scene } from './scene.js';
import { Robots } from './robots.js';
import { Colors } from './colors.js';
import { Layers } from './layers.js';
import { Selection } from './selection.js';
import { Finder } from './finder.js';
import { Timeline } from './timeline.js';
import { Inspector } from './inspector.js';
import { Log } from './log.js';
import { Touch } from './touch.js';
import { Commands } from './commands.js';
import { Plots } from './plots.js';
import { Measures } from './measures.js';
import { Film } from './film.js';
import { Layout } from './layout.js';
import { Controls } from './controls.js';
import { Areas } from './areas.js';
import { Real } from './real.js';
import { Keyboard } from './keyboard.js';
import { pick } from './pick.js';
import { bodySize } from './models.js';
import { download } from './plot.js';
import { h, section, toast } from './html.js';

const frames_per_s = 30, hidden_frames_per_s = 0.2;
const element = (id) => document.getElementById(id);
const token = new URLSearchParams(location.search).get('token') ?? '';

function start() {
  const connection = new Connection(token);
  const world = new World(connection);
  const selection = new Selection();
  const view = new View(element('view'), element('labels'), { onClick: clicked, grab: (...at) => page.touch.grab(...at) });
  if (view.isFlat) toast('This browser has no WebGL: the picture is a plain one. Another browser or driver draws it in full.');
  const left = element('left');
  const { camera } = view;
  const scene = new Scene(view, world);
  const robots = new Robots(view, world, selection);
  const page = { connection, world, selection, view, camera, scene, robots, framesDrawn: 0 };
  page.colors = new Colors(view, world, connection, robots, element('stage'));
  page.colors.density.onCount = () => page.colors.show();
  page.finder = new Finder(world, selection, left, (id) => {
    const pose = world.poseOf(id);
    if (pose !== null) camera.lookAt(pose, Math.max(60 * bodySize(world.body(world.members.index.get(id))).radius, 0.4 * camera.homeDistance));
  });
  const commands = page.commands = new Commands(world, connection);
  page.plots = new Plots(world, connection, (tick) => world.can.has('back') && page.timeline.goTo(tick));
  page.areas = new Areas(view, world);
  page.real = new Real(view, world, connection, commands, selection, robots, element('alarm'), left);
  page.controls = new Controls(world, connection, commands, left);
  page.layers = new Layers(view, world, connection, selection, left);
  page.measures = new Measures(world, connection, page.layers, page.plots, left);
  page.touch = new Touch(view, world, commands, selection, scene, left);
  page.log = new Log(world, connection, element('bottom'));
  page.timeline = new Timeline(world, commands, page.log, element('bottom'), element('now'));
  page.inspector = new Inspector(world, connection, selection, commands, page.plots, page.touch, element('right'));

  page.toggleTop = () => {
    camera.setTop(!camera.isTop);
    showTools();
  };
  page.toggleFollow = (id = selection.last) => {
    if (camera.followed !== null && (id === undefined || id === camera.followed)) camera.followed = null;
    else if (id !== undefined) camera.followed = id;
    else toast('Choose a robot first: click it, or n.');
    view.invalidate();
    showTools();
  };
  page.inspector.makeControl = (control) => page.controls.make(control);
  page.inspector.onFollow = (id) => page.toggleFollow(id);
  page.showPanels = (shown = left.hidden) => {
    left.hidden = !shown;
    element('toggle-left').setAttribute('aria-expanded', String(shown));
  };
  page.toggleColors = () => {
    const { options, selectedIndex } = page.colors.select;
    page.colors.set(options[(selectedIndex + 1) % options.length].value);
    toast(`Robots in the colour of: ${page.colors.select.selectedOptions[0].text}`);
  };
  page.toggleHalt = () => {
    for (const id of selection.ids) page.touch.halt(id, !page.inspector.isHalted(id));
  };
  const pictureName = () => `${world.hello?.experiment || 'tandem'}-${world.tick}`;
  page.savePicture = async () => download(`${pictureName()}.png`, await view.snapshot());
  page.film = new Film(view, pictureName);
  page.layout = new Layout(page);
  page.touch.onChange = showTools;

  // The picture.
  const tools = makeTools();
  function showTools() {
    const is = { top: camera.isTop, follow: camera.followed !== null, touch: page.touch.on };
    for (const [name, pressed] of Object.entries(is)) tools[name].setAttribute('aria-pressed', String(pressed));
    tools.touch.hidden = !page.touch.allowed;
  }
  function makeTools() {
    const make = (text, title, call) => h('button', { title, onclick: call }, text);
    const made = {
      top: make('Top', 'From the top (t)', page.toggleTop), follow: make('Follow', 'Follow the chosen robot (f)', () => page.toggleFollow()),
      home: make('All', 'The whole arena (h)', () => camera.goHome()), nearer: make('+', 'Nearer (+)', () => camera.zoom(0.8)), farther: make('−', 'Farther (−)', () => camera.zoom(1.25)),
      touch: make('Touch', 'Drag robots and objects, or only look (m)', () => page.touch.setOn(!page.touch.on)),
    };
    element('tools').append(...Object.values(made));
    return made;
  }
  function clicked(x, y, event) {
    if (page.touch.placed(x, y)) return;
    const what = pick(world, camera, x, y);
    const add = event.shiftKey || event.ctrlKey || event.metaKey;
    if (what?.robot !== undefined) {
      page.touch.choose(null);
      selection.choose(what.robot, add);
    } else {
      page.touch.choose(what);
      if (!add) selection.clear();
    }
  }
  view.beforePicture = () => {
    const pose = camera.followed === null ? null : world.poseOf(camera.followed);
    if (pose !== null && (camera.target.x !== pose.x || camera.target.y !== pose.y)) {
      camera.target.set(pose.x, pose.y, camera.isTop ? 0 : pose.z);
      camera.place();
    }
    showTools();
  };
  let acknowledged = null;
  view.onPicture = () => {
    if (world.frame === null || world.frame === acknowledged || !connection.isOpen) return;
    acknowledged = world.frame;
    page.framesDrawn++;
    connection.socket.send(JSON.stringify({ do: 'got', frame: acknowledged.number }));
  };
  view.onLost = (lost) => banner('picture', lost ? 'The graphics driver took the picture away; it comes back when the driver gives it back, or when you reload the page. The run and all commands go on.' : '');
  selection.on('change', () => view.invalidate());
  world.on('members', () => {
    for (const id of [...selection.ids]) if (!world.members.index.has(id)) selection.leave(id);
  });

  // How it is looked at. "full" leaves nothing out, however late frames are.
  const setDetail = (level) => {
    robots.setLevel(level);
    view.quality.pin(level === 'full');
  };
  const look = section('Picture', false, 'picture');
  look.body.append(
    h('label', { class: 'control' }, h('span', {}, 'Robots in the colour of'), page.colors.select),
    h('label', { class: 'control' }, h('span', {}, 'Detail'), h('select', { id: 'detail', onchange: (event) => setDetail(event.target.value) }, ['auto', 'full', 'coarse'].map((level) => h('option', {}, level)))),
    h('div', { class: 'row' }, h('button', { onclick: page.savePicture }, 'Save this view'), page.film.button, h('button', { onclick: () => page.layout.open() }, 'Link…'),
      ...['svg', 'png'].map((form) => h('a', { class: 'button', href: `/picture.${form}?token=${encodeURIComponent(token)}`, target: '_blank', rel: 'noopener' }, `Picture as ${form.toUpperCase()}`))));
  left.append(look.element);
  const dropped = h('p', { id: 'dropped', class: 'minor', role: 'status', hidden: true });
  element('stage').append(dropped);
  view.onQuality = () => {
    dropped.textContent = view.quality.text;
    dropped.hidden = dropped.textContent === '';
  };

  // The link.
  const link = element('link');
  connection.on('link', (state, text) => {
    link.className = `badge ${state === 'open' ? 'good' : 'bad'}`;
    link.textContent = state === 'open' ? 'live' : state === 'lost' ? 'no link' : 'refused';
    link.title = text;
    document.body.classList.toggle('unlinked', state !== 'open');
    banner('link', state === 'open' ? '' : text);
    if (state === 'open') askRate();
  });
  function askRate() {
    if (connection.isOpen) connection.ask({ do: 'rate', frames_per_s: document.hidden ? hidden_frames_per_s : frames_per_s });
  }
  document.addEventListener('visibilitychange', askRate);
  connection.on('hello', (hello) => {
    element('title').textContent = hello.experiment || 'Tandem';
    document.title = `${hello.experiment || 'Tandem'} – Tandem`;
    element('mode').textContent = { run: 'simulation', mixed: 'mixed reality', record: 'record' }[hello.mode] ?? hello.mode;
    if (hello.mode === 'record') link.textContent = 'connected';
    if (hello.protocol !== 2) banner('link', `This page speaks protocol 2, the server ${hello.protocol}: reload the page.`);
    showTools();
  });
  connection.on('role', ({ role }) => { element('role').hidden = role !== 'viewer'; });
  page.log.on('go', (entry) => {
    if (world.can.has('back')) page.timeline.goTo(entry.tick);
    if (entry.robot && world.members.index.has(entry.robot)) page.finder.choose(entry.robot, false);
  });
  element('toggle-left').addEventListener('click', () => page.showPanels());
  if (window.innerWidth < 900) page.showPanels(false);
  page.keyboard = new Keyboard(page);
  page.place = (id) => {
    const pose = world.poseOf(id);
    return pose === null ? null : camera.project(pose.x, pose.y, pose.z + bodySize(world.body(world.members.index.get(id))).height / 2);
  };
  window.tandem = page;  // for tests and the curious
  connection.open();
}

const banners = new Map();
/** Says what is wrong with the link or the picture; an empty text: nothing is. */
function banner(of, text) {
  banners.set(of, text);
  element('banner').textContent = [...banners.values()].filter(Boolean).join(' ');
  element('banner').hidden = element('banner').textContent === '';
}

start();
