// Commands and actions in words: for the log, for what is confirmed, and for questions.
import { numberText, degrees } from './html.js';

const coordinates = { x: (v) => `x ${numberText(v)} m`, y: (v) => `y ${numberText(v)} m`, z: (v) => `z ${numberText(v)} m`, heading: (v) => `heading ${numberText(degrees(v))}°` };
const placeText = (at) => Object.keys(coordinates).filter((name) => typeof at[name] === 'number').map((name) => coordinates[name](at[name])).join(', ');
const whom = ({ robot }) => (robot === '*' ? 'all robots' : robot);
const thing = ({ robot, object, light }) => robot ?? object ?? (light === undefined ? '' : `lamp ${light}`);
const owner = (name = '') => name.replace(':', ' ');
const speedText = (times) => (times === null || times === undefined ? 'as fast as possible' : `${numberText(times)} × real time`);

function addedText({ robot, object, light }) {
  const [name, made] = robot ? [`robot ${robot.id ?? ''}`, robot] : object ? [`${object.shape} ${object.id ?? ''}`, object] : [`lamp ${light?.id ?? ''}`, light ?? {}];
  const kind = [robot?.kind, robot?.controller && `controller ${robot.controller}`].filter(Boolean).join(', ');
  return `${name.trim()}${kind ? ` (${kind})` : ''} added at ${placeText(made)}`;
}

/** What a command does once it is carried out: (command, its answer) => text. */
const texts = {
  play: () => 'the run goes on',
  pause: ({}, { tick }) => `paused${tick === undefined ? '' : ` at tick ${tick}`}`,
  step: ({ ticks = 1 }) => (ticks === 1 ? 'one tick' : `${ticks} ticks`),
  speed: ({ times }) => `speed: ${speedText(times)}`,
  go_to: ({ tick }) => `at tick ${tick}`,
  reset: ({ seed }) => `started anew${seed === undefined ? '' : ` with seed ${seed}`}`,
  undo: ({}, { undone, tick }) => (undone ? `undone: ${actionText(undone)}; back at tick ${tick}` : 'undone'),
  stop_when: () => 'the condition is set',
  move: (c) => `${thing(c)} moved to ${placeText(c)}`,
  add: (c) => addedText(c),
  remove: (c) => `${thing(c)} removed`,
  light: ({ light, intensity, color }) => `lamp ${light}: ${intensity === 0 ? 'off' : `intensity ${numberText(intensity)}`}${color ? `, colour ${color}` : ''}`,
  halt: (c) => `${whom(c)} halted`,
  release: (c) => `${whom(c)} released`,
  set: (c) => `${owner(c.owner)}: ${String(c.control).replaceAll('_', ' ')} is ${numberText(c.value)}`,
  press: (c) => `${owner(c.owner)}: ${String(c.control).replaceAll('_', ' ')} pressed`,
  reload: ({ controller, files }) => `controller ${controller} begins anew with ${Object.keys(files ?? {}).join(', ') || 'its scripts'}`,
  estop: () => 'emergency stop of all real robots',
  arm: (c) => `${whom(c)} armed`,
  rearm: (c) => `${whom(c)} re-armed`,
  replace: (c) => `${c.robot} replaced${c.spare ? ` by ${c.spare}` : c.link ? ` by the robot on ${c.link}` : ''}`,
  first_motion: (c) => `first motion of ${c.robot}`,
  preflight: () => 'preflight done',
  back: ({ to }) => `the run goes on another way from tick ${to}; what came after it does not count`,
};

/** "ep1 moved to x 0.50 m, y -0.40 m"; of a command that has no words its name. */
export function actionText(command, answer = {}) {
  const name = command.do ?? command.kind ?? '';
  return texts[name]?.(command, answer) ?? String(name).replaceAll('_', ' ');
}

/** The same with the one who said it, where that is not this page's operator. */
export function actionBy(command) {
  const by = [command.who, command.by?.role === 'viewer' ? 'a viewer' : null].filter(Boolean).join(', ');
  return `${actionText(command)}${by ? ` (by ${by})` : ''}`;
}

export const countText = (count, noun) => `${count.toLocaleString('en')} ${noun}${count === 1 ? '' : noun.endsWith('ch') ? 'es' : 's'}`;
