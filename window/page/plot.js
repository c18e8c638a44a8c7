// A plot of fields over time: lines that differ in colour and dash, axes with units, a value under the pointer; a click goes to that tick.
import { h, numberText } from './html.js';
import { lineStyle } from './palette.js';
import { roundLength } from './scene.js';

const most_points = 20000;

/** `goTo(tick)` is called with a click, `onPointer(tick)` with a tick under the pointer or null, `onChange()` when a series is taken away. */
export class Plot {
  constructor(world, goTo) {
    this.world = world;
    this.goTo = goTo;
    this.series = new Map();  // by key: { key, name, unit, style, ticks, values, ask }
    this.made = 0;
    this.canvas = h('canvas', { class: 'plot', tabindex: 0, role: 'img', 'aria-label': 'Plot of the chosen fields over time' });
    this.legend = h('ul', { class: 'legend' });
    this.hint = h('p', { class: 'minor' }, 'The values since it was chosen; earlier ones with "Past".');
    this.marked = null;  // tick under the pointer, of this plot or another one
    this.element = h('section', { class: 'plot-of', 'aria-label': 'Plot' }, this.canvas, this.legend,
      h('div', { class: 'row' }, h('button', { onclick: () => this.loadPast?.() , title: 'The values from the begin of the run' }, 'Past'),
        h('button', { onclick: () => this.save() }, 'Save CSV'), h('button', { onclick: () => this.clear() }, 'Clear')), this.hint);
    this.canvas.addEventListener('pointermove', (event) => this.onPointer?.(this.tickAt(event.offsetX)));
    this.canvas.addEventListener('pointerleave', () => this.onPointer?.(null));
    this.canvas.addEventListener('click', (event) => {
      const tick = this.tickAt(event.offsetX);
      if (tick !== null) this.goTo(tick);
    });
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  has(key) {
    return this.series.has(key);
  }

  add(key, name, unit, ask) {
    this.series.set(key, { key, name, unit, ask, style: lineStyle(this.made++), ticks: [], values: [] });
    this.show();
  }

  remove(key) {
    this.series.delete(key);
    this.show();
  }

  clear() {
    this.series.clear();
    this.onChange?.();
  }

  /** A line at this tick, with the values there; null: at the newest one. */
  mark(tick) {
    this.marked = tick;
    this.draw();
  }

  /** A new value. Ticks may come out of order after going back. */
  take(key, tick, value) {
    const line = this.series.get(key);
    if (line === undefined || typeof value !== 'number') return;
    const { ticks, values } = line;
    const at = lowerBound(ticks, tick);
    if (ticks[at] === tick) values[at] = value;
    else {
      ticks.splice(at, 0, tick);
      values.splice(at, 0, value);
    }
    if (ticks.length > most_points) {
      ticks.shift();
      values.shift();
    }
    this.ask();
  }

  /** Values of the past, put among those that are there. */
  takePast(key, pastTicks, pastValues) {
    const line = this.series.get(key);
    if (line === undefined) return;
    const both = new Map();
    pastTicks.forEach((tick, i) => both.set(tick, pastValues[i]));
    line.ticks.forEach((tick, i) => both.set(tick, line.values[i]));
    const sorted = [...both].filter(([, value]) => typeof value === 'number').sort((a, b) => a[0] - b[0]);
    line.ticks = sorted.map(([tick]) => tick);
    line.values = sorted.map(([, value]) => value);
    this.ask();
  }

  /** What was to come after this tick may become different. */
  forgetAfter(tick) {
    for (const line of this.series.values()) {
      const at = lowerBound(line.ticks, tick + 1);
      line.ticks.length = at;
      line.values.length = at;
    }
    this.ask();
  }

  ask() {
    if (this.asked || this.series.size === 0) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.draw();
    });
  }

  show() {
    this.legend.replaceChildren(...[...this.series.values()].map((line) => {
      line.valueText = h('output', {});
      const swatch = h('canvas', { class: 'swatch', width: 28, height: 8, 'aria-hidden': 'true' });
      const pen = swatch.getContext('2d');
      pen.strokeStyle = line.style.color;
      pen.setLineDash(line.style.dash);
      pen.lineWidth = 3;
      pen.beginPath();
      pen.moveTo(0, 4);
      pen.lineTo(28, 4);
      pen.stroke();
      return h('li', {}, swatch, h('span', {}, line.name), line.valueText,
        h('button', { class: 'quiet', 'aria-label': `Remove ${line.name} from the plot`, onclick: () => {
          this.remove(line.key);
          this.onChange?.();
        } }, '×'));
    }));
    this.draw();
  }

  range() {
    let [from, to, low, high] = [Infinity, -Infinity, Infinity, -Infinity];
    for (const { ticks, values } of this.series.values()) {
      if (ticks.length === 0) continue;
      from = Math.min(from, ticks[0]);
      to = Math.max(to, ticks[ticks.length - 1]);
      for (const value of values) {
        if (!Number.isFinite(value)) continue;
        low = Math.min(low, value);
        high = Math.max(high, value);
      }
    }
    if (!(to >= from) || !(high >= low)) return null;
    if (to === from) to = from + 1;
    if (high - low < 1e-9 * Math.max(1, Math.abs(high))) [low, high] = [low - 0.5, high + 0.5];
    const margin = 0.06 * (high - low);
    return { from, to, low: low - margin, high: high + margin };
  }

  tickAt(x_px) {
    const range = this.range();
    if (range === null) return null;
    const share = (x_px - this.left_px) / (this.canvas.clientWidth - this.left_px - right_px);
    return Math.round(range.from + Math.min(1, Math.max(0, share)) * (range.to - range.from));
  }

  draw() {
    const { canvas } = this;
    const ratio = window.devicePixelRatio || 1;
    const width = canvas.clientWidth, height = canvas.clientHeight;
    if (width === 0) return;
    canvas.width = width * ratio;
    canvas.height = height * ratio;
    const pen = canvas.getContext('2d');
    pen.scale(ratio, ratio);
    const css = getComputedStyle(document.documentElement);
    const ink = css.getPropertyValue('--ink'), faint = css.getPropertyValue('--edge');
    pen.font = '11px system-ui, "DejaVu Sans", sans-serif';
    const range = this.range();
    if (range === null) {
      pen.fillStyle = ink;
      pen.fillText('No values yet.', 12, 20);
      return;
    }
    const { from, to, low, high } = range;
    const step = roundLength((high - low) / 2.5);
    const labels = [];
    for (let value = Math.ceil(low / step) * step; value <= high; value += step) labels.push([value, axisText(value, step)]);
    this.left_px = 8 + Math.max(24, ...labels.map(([, text]) => pen.measureText(text).width));
    const { left_px } = this;
    const x = (tick) => left_px + ((tick - from) / (to - from)) * (width - left_px - right_px);
    const y = (value) => height - bottom_px - ((value - low) / (high - low)) * (height - bottom_px - top_px);
    pen.strokeStyle = faint;
    pen.fillStyle = ink;
    pen.lineWidth = 1;
    pen.textAlign = 'right';
    pen.textBaseline = 'middle';
    for (const [value, text] of labels) {
      line(pen, [[left_px, y(value)], [width - right_px, y(value)]]);
      pen.fillText(text, left_px - 4, y(value));
    }
    const perSecond = this.world.hello?.ticks_per_second || 10;
    const step_s = roundLength((to - from) / perSecond / 2.5);
    pen.textAlign = 'center';
    for (let t = Math.ceil(from / perSecond / step_s) * step_s; t * perSecond <= to; t += step_s) {
      line(pen, [[x(t * perSecond), top_px], [x(t * perSecond), height - bottom_px]]);
      pen.fillText(`${Number(t.toPrecision(6))} s`, x(t * perSecond), height - bottom_px / 2);
    }
    for (const series of this.series.values()) {
      pen.strokeStyle = series.style.color;
      pen.setLineDash(series.style.dash);
      pen.lineWidth = 1.8;
      pen.beginPath();
      const every = Math.max(1, Math.floor(series.ticks.length / (3 * width)));
      for (let i = 0; i < series.ticks.length; i += every) pen.lineTo(x(series.ticks[i]), y(series.values[i]));
      pen.stroke();
    }
    pen.setLineDash([]);
    this.drawMarked(pen, range, x, y, ink);
  }

  /** The line at a tick; under the pointer with its time and a dot on each series, whose values stand in the legend. */
  drawMarked(pen, { from, to }, x, y, ink) {
    const marked = this.marked ?? this.world.tick;
    const within = marked >= from && marked <= to;
    if (within) {
      pen.strokeStyle = pen.fillStyle = ink;
      pen.lineWidth = 1;
      line(pen, [[x(marked), top_px], [x(marked), this.canvas.clientHeight - bottom_px]]);
      const left = x(marked) > this.canvas.clientWidth / 2;
      pen.textAlign = left ? 'right' : 'left';
      if (this.marked !== null) pen.fillText(`${Number(this.world.seconds(marked).toFixed(3))} s, tick ${marked}`, x(marked) + (left ? -5 : 5), top_px + 6);
    }
    for (const series of this.series.values()) {
      const at = Math.min(series.ticks.length - 1, lowerBound(series.ticks, marked));
      series.valueText.textContent = at < 0 ? '–' : `${numberText(series.values[at])} ${series.unit ?? ''}`;
      if (at < 0 || !within || this.marked === null) continue;
      pen.fillStyle = series.style.color;
      pen.beginPath();
      pen.arc(x(series.ticks[at]), y(series.values[at]), 3.5, 0, 7);
      pen.fill();
    }
  }

  save() {
    const lines = ['series,unit,tick,time_s,value'];
    for (const { name, unit, ticks, values } of this.series.values()) {
      ticks.forEach((tick, i) => lines.push(`"${name}","${unit ?? ''}",${tick},${this.world.seconds(tick)},${values[i]}`));
    }
    download('plot.csv', new Blob([lines.join('\n') + '\n'], { type: 'text/csv' }));
  }
}

/** A number on an axis, with as many digits as its steps need. */
function axisText(value, step) {
  const order = (number) => Math.floor(Math.log10(Math.abs(number)) + 1e-9);
  if (Math.abs(value) >= 1e6 || step < 1e-5) return Math.abs(value) < step / 2 ? '0' : value.toExponential(Math.max(0, order(value) - order(step)));
  return (Math.abs(value) < step / 2 ? 0 : value).toFixed(Math.max(0, Math.ceil(-Math.log10(step) - 1e-9)));
}

const right_px = 10, top_px = 8, bottom_px = 20;

function line(pen, points) {
  pen.beginPath();
  points.forEach(([x, y]) => pen.lineTo(x, y));
  pen.stroke();
}

/** The first place in a rising list that is not below `value`. */
function lowerBound(list, value) {
  let low = 0, high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

export function download(name, blob) {
  const link = h('a', { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
