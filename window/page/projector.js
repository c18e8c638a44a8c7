// The virtual world on the real floor, through a projector: drawn from straight above, without anything around it, and fitted
// to the floor by its four corners.
//   /projector?token=…           &rings=0: no rings around real robots   &layers=rays,links: these layers, too   &lines=0: no edge
import { Connection } from './connection.js';
import { World } from './world.js';
import { rowX, rowY, rowHeading, rowColor } from './frames.js';
import { kindColor, okabeIto } from './palette.js';
import { homography, cssMatrix, isConvex } from './homography.js';

const longest_px = 2000;  // of the canvas
const names = ['north-west', 'north-east', 'south-east', 'south-west'];
const wish = new URLSearchParams(location.search);
const element = (id) => document.getElementById(id);

class Projector {
  constructor() {
    this.connection = new Connection(wish.get('token') ?? '');
    this.world = new World(this.connection);
    this.canvas = element('floor');
    this.pen = this.canvas.getContext('2d');
    this.corners = null;   // of the window, from its top left to (1, 1); in the order of `names`
    this.fitting = false;
    this.clicked = 0;      // corners clicked since fitting began
    this.floor = null;     // image
    this.drawings = new Map();
    this.pictures = 0;
    this.marks = names.map((name, i) => this.makeMark(name, i));
    element('marks').append(...this.marks);
    for (const name of ['scene', 'members', 'poses', 'objects', 'marks', 'leds']) this.world.on(name, () => this.invalidate());
    this.world.on('hello', (hello) => this.takeHello(hello)).on('scene', (scene) => this.takeScene(scene))
      .on('drawing', (frame) => {
        this.drawings.set(frame.number, frame);
        this.invalidate();
      });
    this.connection.on('projector', (message) => this.takeCorners(message.corners)).on('link', (state, text) => {
      if (state !== 'open') this.say(text);
      else if (!this.fitting) this.say('');
    });
    element('marks').addEventListener('pointerdown', (event) => this.click(event));
    document.addEventListener('keydown', (event) => this.press(event));
    window.addEventListener('resize', () => this.place());
    this.connection.open();
  }

  say(text) {
    element('help').textContent = text;
  }

  takeHello(hello) {
    document.title = `${hello.experiment || 'Tandem'} – projector`;
    this.key = `tandem projector ${hello.experiment}`;
    const layers = (wish.get('layers') ?? '').split(',').filter((name) => name !== '');
    if (layers.length > 0) this.connection.ask({ do: 'layers', on: layers, robots: '*' });
    const kept = JSON.parse(localStorage.getItem(this.key) ?? 'null');
    if (this.corners === null) this.takeCorners(kept);
  }

  /** Null: nobody has fitted it yet. */
  takeCorners(corners) {
    if (this.fitting) return;
    this.corners = corners ?? this.corners;
    if (this.corners === null) this.fit();
    this.place();
  }

  takeScene(scene) {
    const { arena } = scene;
    const width = arena.max_x - arena.min_x, height = arena.max_y - arena.min_y;
    this.scale = longest_px / Math.max(width, height);
    this.canvas.width = Math.round(width * this.scale);
    this.canvas.height = Math.round(height * this.scale);
    if (scene.floor && scene.floor !== this.floorAddress) {
      this.floorAddress = scene.floor;
      const image = new Image();
      image.onload = () => {
        this.floor = image;
        this.invalidate();
      };
      image.src = scene.floor;
    }
    if (!scene.floor) this.floor = null;
    this.place();
  }

  // --- fitting

  makeMark(name, i) {
    const mark = document.createElement('button');
    mark.className = 'mark';
    mark.dataset.corner = i;
    mark.setAttribute('aria-label', `Corner in the ${name}`);
    const label = document.createElement('span');
    label.textContent = name;
    mark.append(label);
    mark.addEventListener('pointerdown', (event) => {
      event.stopPropagation();
      mark.setPointerCapture(event.pointerId);
      mark.focus();
      this.dragged = i;
    });
    mark.addEventListener('pointermove', (event) => {
      if (this.dragged === i) this.move(i, event.clientX, event.clientY);
    });
    mark.addEventListener('pointerup', () => {
      this.dragged = undefined;
    });
    return mark;
  }

  /** The arena in the middle of the window. */
  usualCorners() {
    const aspect = this.canvas.width / this.canvas.height, room = window.innerWidth / window.innerHeight;
    const w = 0.4 * Math.min(1, aspect / room), h = 0.4 * Math.min(1, room / aspect);
    return [[0.5 - w, 0.5 - h], [0.5 + w, 0.5 - h], [0.5 + w, 0.5 + h], [0.5 - w, 0.5 + h]];
  }

  fit() {
    this.fitting = true;
    this.clicked = 0;
    this.corners ??= this.usualCorners();
    this.before = this.corners.map((corner) => [...corner]);
    document.body.classList.add('fitting');
    this.ask();
    this.place();
  }

  ask() {
    this.say(this.clicked < 4 ? `Click where the ${names[this.clicked]} corner of the arena is on the floor, or drag the marks; arrows move the last one. Enter keeps it, Escape does not.`
      : 'Drag what does not fit yet; arrows move the last one. Enter keeps it, Escape does not.');
  }

  click(event) {
    if (!this.fitting || this.clicked >= 4) return;
    this.move(this.clicked, event.clientX, event.clientY);
    this.marks[this.clicked].focus({ preventScroll: true });
    event.preventDefault();
    this.clicked++;
    this.ask();
  }

  move(corner, x, y) {
    this.corners[corner] = [x / window.innerWidth, y / window.innerHeight];
    this.place();
  }

  press(event) {
    const { key } = event;
    if (key === 'c' && !this.fitting) return this.fit();
    if (key === 'f' && !this.fitting) return document.fullscreenElement === null ? document.documentElement.requestFullscreen?.() : document.exitFullscreen();
    if (!this.fitting) return undefined;
    if (key === 'Enter') {
      event.preventDefault();
      return this.keep();
    }
    if (key === 'Escape') {
      this.corners = this.before;
      return this.done();
    }
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[key];
    const corner = Number(document.activeElement?.dataset?.corner ?? NaN);
    if (step === undefined || Number.isNaN(corner)) return undefined;
    event.preventDefault();
    const [x, y] = this.corners[corner], far = event.shiftKey ? 10 : 1;
    return this.move(corner, x * window.innerWidth + far * step[0], y * window.innerHeight + far * step[1]);
  }

  async keep() {
    if (!isConvex(this.corners)) return this.say('These corners cross each other: click them in the order north-west, north-east, south-east, south-west, as the projector shows them.');
    localStorage.setItem(this.key, JSON.stringify(this.corners));
    const answer = await this.connection.ask({ do: 'projector', corners: this.corners });
    this.done();
    if (answer.ok) return undefined;
    this.say(`It is kept in this browser alone: ${answer.error}`);
    return setTimeout(() => this.say(''), 6000);
  }

  done() {
    this.fitting = false;
    document.body.classList.remove('fitting');
    this.say('');
    this.place();
  }

  place() {
    if (this.corners === null) return;
    const { width, height } = this.canvas;
    const to = this.corners.map(([x, y]) => [x * window.innerWidth, y * window.innerHeight]);
    to.forEach(([x, y], i) => {
      this.marks[i].style.left = `${x}px`;
      this.marks[i].style.top = `${y}px`;
    });
    this.map = homography([[0, 0], [width, 0], [width, height], [0, height]], to);
    if (this.map !== null) this.canvas.style.transform = cssMatrix(this.map);
    this.invalidate();
  }

  // --- the picture

  invalidate() {
    if (this.due) return;
    this.due = true;
    requestAnimationFrame(() => {
      this.due = false;
      this.draw();
    });
  }

  draw() {
    const { pen, canvas, world, scale } = this;
    const { scene, frame, members } = world;
    pen.resetTransform();
    pen.fillStyle = '#000';
    pen.fillRect(0, 0, canvas.width, canvas.height);
    if (scene === null) return;
    if (this.floor !== null) pen.drawImage(this.floor, 0, 0, canvas.width, canvas.height);
    pen.setTransform(scale, 0, 0, -scale, -scene.arena.min_x * scale, scene.arena.max_y * scale);
    if (wish.get('lines') !== '0') {
      pen.strokeStyle = '#808080';
      pen.lineWidth = 4 / scale;
      pen.strokeRect(scene.arena.min_x, scene.arena.min_y, scene.arena.max_x - scene.arena.min_x, scene.arena.max_y - scene.arena.min_y);
    }
    for (const object of scene.objects) this.drawObject(object);
    for (const light of scene.lights) if (light.intensity > 0) this.disc(light.x, light.y, 0.02, '#f0e442');
    for (const drawing of this.drawings.values()) this.drawLayer(drawing);
    for (let i = 0; frame !== null && i < frame.count; ++i) this.drawRobot(frame, i, members.real.has(i));
    this.pictures++;
    if (frame !== null && this.connection.isOpen) this.connection.socket.send(JSON.stringify({ do: 'got', frame: frame.number }));
  }

  disc(x, y, radius, color) {
    this.pen.fillStyle = color;
    this.pen.beginPath();
    this.pen.arc(x, y, radius, 0, 2 * Math.PI);
    this.pen.fill();
  }

  drawObject(object) {
    const { pen } = this;
    const color = object.movable ? '#d9b26a' : '#b0b6bf';
    if (object.shape === 'cylinder') return this.disc(object.x, object.y, object.radius, color);
    pen.save();
    pen.translate(object.x, object.y);
    pen.rotate(object.heading);
    pen.fillStyle = color;
    pen.fillRect(-object.size_x / 2, -object.size_y / 2, object.size_x, object.size_y);
    return pen.restore();
  }

  /** Virtual ones as they are; real ones stand there themselves, and get a ring at most. */
  drawRobot(frame, i, isReal) {
    const { pen, world } = this;
    const [x, y, heading] = [rowX(frame, i), rowY(frame, i), rowHeading(frame, i)];
    const { radius } = world.body(i);
    if (isReal) {
      if (wish.get('rings') === '0') return;
      pen.strokeStyle = world.halted.has(i) ? okabeIto.vermilion : okabeIto.skyBlue;
      pen.lineWidth = 0.15 * radius;
      pen.beginPath();
      pen.arc(x, y, 1.35 * radius, 0, 2 * Math.PI);
      pen.stroke();
      return;
    }
    const lit = rowColor(frame, i);
    const color = lit === 0 ? kindColor(world.members.kind[i]) : `rgb(${((lit >> 11) * 255) / 31},${(((lit >> 5) & 63) * 255) / 63},${((lit & 31) * 255) / 31})`;
    this.disc(x, y, radius, color);
    pen.strokeStyle = '#fff';
    pen.lineWidth = 0.15 * radius;
    pen.beginPath();
    pen.moveTo(x, y);
    pen.lineTo(x + radius * Math.cos(heading), y + radius * Math.sin(heading));
    pen.stroke();
  }

  drawLayer(frame) {
    const { pen } = this;
    pen.lineWidth = 2 / this.scale;
    for (let i = 0; i < frame.count; ++i) {
      const [x0, y0, , x1, y1] = frame.floats.subarray(7 * i, 7 * i + 6);
      const [red, green, blue, opacity] = frame.bytes.subarray(28 * i + 24, 28 * i + 28);
      pen.strokeStyle = `rgba(${red},${green},${blue},${opacity / 255})`;
      pen.beginPath();
      pen.moveTo(x0, y0);
      pen.lineTo(x1, y1);
      pen.stroke();
    }
  }
}

window.tandem = new Projector();  // for tests and the curious
