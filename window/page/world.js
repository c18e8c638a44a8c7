// What the page knows of the run: its scene, its robots and where they were in the newest frame.
import { Events } from './events.js';
import { rowX, rowY, rowZ, rowHeading } from './frames.js';

/** Emits "hello", "scene", "members", "poses", "leds", "values", "state", "states", "objects", "marks". Robots are numbered by their place in the newest list of members. */
export class World extends Events {
  constructor(connection) {
    super();
    this.hello = null;
    this.can = new Set();
    this.scene = null;
    this.members = noMembers();
    this.state = { tick: 0, latest: 0, first: 0, paused: true, speed: 1, reached: 0, ended: null, stopped_by: null };
    this.frame = null;      // newest poses, decoded
    this.leds = null;       // 4 bytes an LED, `ledsPerRobot` a robot; null: only mixed colours are known
    this.ledsPerRobot = 0;
    this.values = [];       // by robot: what moves on it, in the order of its kind's joints, then of its links that hold something
    this.halted = new Set();
    this.states = null;     // { name, values by robot, words } of the published state that was asked for
    this.framesSeen = 0;
    connection.on('hello', (message) => this.takeHello(message))
      .on('scene', (message) => this.takeScene(message))
      .on('members', (message) => this.takeMembers(message))
      .on('state', (message) => this.takeState(message))
      .on('states', (message) => {
        this.states = message;
        this.emit('states');
      })
      .on('objects', (message) => this.takeObjects(message))
      .on('marks', (message) => {
        this.halted = new Set(message.halted ?? []);
        this.emit('marks');
      })
      .on('frame', (frame) => this.takeFrame(frame));
  }

  takeHello(message) {
    this.hello = message;
    this.can = new Set(message.can ?? []);
    this.frame = null;
    this.members = noMembers();
    this.leds = null;
    this.values = [];
    this.halted = new Set();
    this.emit('hello', message);
  }

  takeScene(scene) {
    scene.objects ??= [];
    scene.lights ??= [];
    scene.borders ??= [];
    this.scene = scene;
    this.emit('scene', scene);
  }

  takeState(state) {
    this.state = state;
    this.emit('state', state);
  }

  takeMembers(message) {
    const before = this.members;
    const ledsBefore = this.leds;
    const perRobotBefore = this.ledsPerRobot;
    const { ids, kinds, kind, bodies } = message;
    this.members = { count: ids.length, ids, kinds, kind, bodies, real: new Set(message.real ?? []), index: new Map(ids.map((id, i) => [id, i])) };
    for (const body of bodies) body.look ??= { joints: [], links: [], lamps: [] };
    this.ledsPerRobot = Math.max(1, ...bodies.map((body) => body.look.lamps.length));
    this.values = ids.map((id) => this.values[before.index.get(id)] ?? []);
    this.leds = null;
    // LEDs of the robots that stay.
    if (ledsBefore !== null) {
      this.leds = new Uint8Array(this.members.count * this.ledsPerRobot * 4);
      const both = Math.min(perRobotBefore, this.ledsPerRobot) * 4;
      ids.forEach((id, i) => {
        const old = before.index.get(id);
        if (old === undefined) return;
        const from = old * perRobotBefore * 4;
        this.leds.set(ledsBefore.subarray(from, from + both), i * this.ledsPerRobot * 4);
      });
    }
    if (this.frame !== null && this.frame.count !== this.members.count) this.frame = null;
    this.emit('members');
  }

  takeObjects(message) {
    if (this.scene === null) return;
    for (const [number, x, y, z, heading] of message.poses) {
      const object = this.scene.objects[number];
      if (object !== undefined) Object.assign(object, { x, y, z, heading });
    }
    this.emit('objects');
  }

  takeFrame(frame) {
    if (frame.type === 'poses') {
      if (frame.count !== this.members.count) return;  // of members that are not known yet
      this.frame = frame;
      this.framesSeen++;
      this.emit('poses', frame);
    } else if (frame.type === 'leds') {
      this.takeLeds(frame);
    } else if (frame.type === 'values') {
      for (let i = 0; i < frame.count; ++i) {
        const values = this.values[frame.integers[3 * i]];
        if (values !== undefined) values[frame.integers[3 * i + 1]] = frame.floats[3 * i + 2];
      }
      this.emit('values');
    } else {
      this.emit('drawing', frame);
    }
  }

  takeLeds(frame) {
    this.leds ??= new Uint8Array(this.members.count * this.ledsPerRobot * 4);
    const rows = new DataView(frame.bytes.buffer, frame.bytes.byteOffset);
    for (let i = 0; i < frame.count; ++i) {
      const robot = rows.getUint32(8 * i, true);
      const led = frame.bytes[8 * i + 4];
      if (robot >= this.members.count || led >= this.ledsPerRobot) continue;
      const at = (robot * this.ledsPerRobot + led) * 4;
      this.leds.set(frame.bytes.subarray(8 * i + 5, 8 * i + 8), at);
      this.leds[at + 3] = 255;
    }
    this.emit('leds');
  }

  body(robot) {
    return this.members.bodies[this.members.kind[robot]];
  }

  /** { x, y, z, heading } of a robot in the newest frame, or null. */
  pose(robot) {
    if (this.frame === null || robot === undefined || robot >= this.frame.count) return null;
    return { x: rowX(this.frame, robot), y: rowY(this.frame, robot), z: rowZ(this.frame, robot), heading: rowHeading(this.frame, robot) };
  }

  poseOf(id) {
    return this.pose(this.members.index.get(id));
  }

  /** The tick that is shown. */
  get tick() {
    return this.frame?.tick ?? this.state.tick;
  }

  seconds(tick) {
    return tick / (this.hello?.ticks_per_second || 10);
  }
}

const noMembers = () => ({ count: 0, ids: [], kinds: [], kind: [], bodies: [], real: new Set(), index: new Map() });
