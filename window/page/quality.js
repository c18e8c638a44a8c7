// How richly the picture is drawn: as the machine allows. Frames that are late drop one thing after the other; it comes back when there is time.

/** What is left out, one after the other; `drops` is said to people. */
const steps = [
  { drops: 'smooth edges of a still picture', still: false },
  { drops: 'round curves', fine: false },
  { drops: 'half of the pixels of a sharp screen', ratio: 1 },
  { drops: 'parts of robots that look small', middle: false },
  { drops: 'glow around lamps', glow: false },
  { drops: 'shadows', shadows: false },
  { drops: 'all but 300 robots with their parts', mostInFull: 300 },
  { drops: 'three quarters of the pixels', ratio: 0.5 },
];
const all = { still: true, fine: true, middle: true, glow: true, shadows: true, ratio: 2, mostInFull: 2000 };

const late_ms = 35, early_ms = 24;       // of a picture, in the mean; screens show one every 16.7 ms
const judged = 12;                       // pictures before a judgement
const wait_ms = 4000, mostWait_ms = 64000;  // before something comes back; twice as long whenever that was too early

export class Quality {
  /** `changed` is called when something was dropped or came back. */
  constructor(changed) {
    this.changed = changed;
    this.dropped = 0;
    this.automatic = true;
    this.wait = wait_ms;
    this.since = 0;
    this.start();
    Object.assign(this, all);
  }

  start() {
    this.sum = this.count = 0;
  }

  /** A picture took so long, from when it was begun until the browser could begin another. */
  note(took_ms, now_ms) {
    if (!this.automatic || took_ms > 2000) return;  // a tab that slept
    this.sum += took_ms;
    if (++this.count < judged) return;
    const mean = this.sum / this.count;
    this.start();
    if (mean > late_ms && this.dropped < steps.length) {
      if (this.cameBack && now_ms - this.since < wait_ms) this.wait = Math.min(mostWait_ms, 2 * this.wait);
      this.set(this.dropped + 1, now_ms);
      this.cameBack = false;
    } else if (mean < early_ms && this.dropped > 0 && now_ms - this.since > this.wait) {
      this.set(this.dropped - 1, now_ms);
      this.cameBack = true;
    }
  }

  /** Nothing is left out from now on, or what has to be. */
  pin(pinned) {
    this.automatic = !pinned;
    if (pinned) this.set(0);
  }

  set(dropped, now_ms = 0) {
    this.dropped = Math.max(0, Math.min(steps.length, dropped));
    this.since = now_ms;
    Object.assign(this, all, ...steps.slice(0, this.dropped));
    this.changed();
  }

  /** "without shadows, …", or "". */
  get text() {
    const names = steps.slice(0, this.dropped).map((step) => step.drops);
    return names.length === 0 ? '' : `Frames were late, so the picture is without: ${names.join(', ')}.`;
  }
}
