// Builds elements of the page and the texts in them.

/** h('button', { class: 'quiet', onclick }, 'Play'). Attributes that begin with "on" are listeners; null and false are left out. */
export function h(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else if (name === 'value' || name === 'checked' || name === 'disabled' || name === 'hidden') element[name] = value;
    else element.setAttribute(name, value === true ? '' : value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return element;
}

const shapes = {
  play: 'M5 3l12 7-12 7z',
  pause: 'M4 3h4v14H4zM12 3h4v14h-4z',
  forward: 'M4 3l9 7-9 7zM14 3h3v14h-3z',
  back: 'M16 3l-9 7 9 7zM3 3h3v14H3z',
  reset: 'M10 3a7 7 0 1 0 7 7h-2.5A4.5 4.5 0 1 1 10 5.500V8.500l5-4.200L10 0z',
  undo: 'M8 3L2 8l6 5V9.500c4 0 6.500 1.500 8 4.500 0-5-3-8-8-8z',
};
/** One of the signs above, in the colour of the text around it. */
export function icon(name) {
  const space = 'http://www.w3.org/2000/svg';
  const svg = document.createElementNS(space, 'svg');
  svg.setAttribute('viewBox', '0 0 20 20');
  svg.setAttribute('class', 'icon');
  svg.setAttribute('aria-hidden', 'true');
  const path = document.createElementNS(space, 'path');
  path.setAttribute('d', shapes[name]);
  svg.append(path);
  return svg;
}

/** A section of a side panel that can be folded; `body` is where its contents go. */
export function section(title, open = true, id = null) {
  const body = h('div', { class: 'body' });
  const element = h('details', { open, id }, h('summary', {}, title), body);
  return { element, body };
}

export function numberText(value) {
  if (value === null || value === undefined) return '–';
  if (typeof value !== 'number') return String(value);
  if (Number.isInteger(value)) return String(value);
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) return value.toExponential(2);
  return value.toFixed(Math.max(0, 4 - Math.max(1, Math.ceil(Math.log10(Math.max(size, 1e-9))))));
}

/** "1:02:03.4" of a time of the run in seconds. */
export function timeText(seconds) {
  const tenths = Math.round(Math.max(0, seconds) * 10);
  const s = Math.floor(tenths / 10);
  const two = (n) => String(n).padStart(2, '0');
  const hours = Math.floor(s / 3600);
  return `${hours > 0 ? hours + ':' + two(Math.floor(s / 60) % 60) : Math.floor(s / 60)}:${two(s % 60)}.${tenths % 10}`;
}

export function ageText(seconds) {
  if (seconds === null || seconds === undefined) return '–';
  if (seconds < 1) return `${Math.round(seconds * 1000)} ms`;
  return seconds < 100 ? `${seconds.toFixed(1)} s` : `${Math.round(seconds)} s`;
}

export const degrees = (radians) => (radians * 180) / Math.PI;
export const radians = (degrees_) => (degrees_ * Math.PI) / 180;

let alarm;
/** Opens a dialog at its start. The emergency stop moves into it, to the same place on the screen: nothing covers, dims or blocks it. */
export function openDialog(dialog) {
  alarm ??= document.getElementById('alarm');
  dialog.append(alarm);
  dialog.addEventListener('close', () => (document.querySelector('dialog[open]') ?? document.body).append(alarm), { once: true });
  dialog.showModal();
  const first = dialog.querySelector('[autofocus], input, select') ?? dialog.querySelector('h2');
  if (first.matches('h2')) first.tabIndex = -1;
  first.focus();
  dialog.scrollTop = 0;
}

/** A short message that goes away by itself; `kind` is "error" or "note". */
export function toast(text, kind = 'note') {
  const host = document.getElementById('toasts');
  const element = h('div', { class: `toast ${kind}` }, text,
    h('button', { class: 'quiet', 'aria-label': 'Close', onclick: () => element.remove() }, '×'));
  host.append(element);
  while (host.children.length > 4) host.firstChild.remove();
  setTimeout(() => element.remove(), kind === 'error' ? 12000 : 5000);
}
