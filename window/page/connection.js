// The WebSocket to the server: sends commands and gives their answers, hands on what comes, connects anew when the
// link is lost, and says why it cannot.
import { Events } from './events.js';
import { decodeFrame } from './frames.js';

const retry_ms = 1000;
const longest_retry_ms = 5000;

/** Emits "link" (state, text), where state is "open", "lost", "refused" or "ended"; "frame" (decoded); and each text
 *  message under its type. */
export class Connection extends Events {
  constructor(token) {
    super();
    this.token = token;
    this.waiting = new Map();  // promises of answers, by id
    this.nextId = 1;
    this.retry = retry_ms;
    this.socket = null;
  }

  open() {
    const scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
    const socket = new WebSocket(`${scheme}//${location.host}/ws?token=${encodeURIComponent(this.token)}`);
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    let opened = false;
    socket.onopen = () => {
      opened = true;
      this.retry = retry_ms;
      this.emit('link', 'open', 'connected');
    };
    socket.onmessage = (message) => this.take(message.data);
    socket.onclose = (event) => this.closed(opened, event);
  }

  get isOpen() {
    return this.socket !== null && this.socket.readyState === WebSocket.OPEN;
  }

  /** Sends a command such as { do: 'pause' } and resolves to its answer, { ok, error?, … }. Never rejects. */
  ask(command) {
    if (!this.isOpen) return Promise.resolve({ ok: false, error: 'not sent: there is no link to the run' });
    const id = this.nextId++;
    this.socket.send(JSON.stringify({ id, ...command }));
    return new Promise((resolve) => this.waiting.set(id, resolve));
  }

  take(data) {
    if (typeof data !== 'string') {
      const frame = decodeFrame(data);
      if (frame !== null) this.emit('frame', frame);
      else console.warn('a binary message that is not a frame of this protocol');
      return;
    }
    const message = JSON.parse(data);
    const resolve = this.waiting.get(message.id);
    if (resolve === undefined) return this.emit(message.type, message);
    this.waiting.delete(message.id);
    return resolve(message);
  }

  async closed(opened, event) {
    for (const resolve of this.waiting.values()) resolve({ ok: false, error: 'the link was lost before the answer came' });
    this.waiting.clear();
    if (opened && event.code === 1008) {
      this.emit('link', 'refused', `the server closed the link: ${event.reason || 'this page broke its rules'}; reload the page`);
      return;
    }
    const reached = opened ? false : await this.serverAnswers();
    if (reached) {
      this.emit('link', 'refused', 'the server refuses this page: its token is wrong or of an earlier run, or too many watch. Open the address that the run printed');
    } else {
      this.emit('link', 'lost', opened && [1000, 1001].includes(event.code) ? 'the run has ended and closed the link; looking for a new one at the same address'
        : 'no link to the run; trying again');
    }
    setTimeout(() => this.open(), this.retry);
    this.retry = Math.min(longest_retry_ms, this.retry * 1.5);
  }

  /** Whether there is a server at all that refuses the WebSocket. */
  async serverAnswers() {
    try {
      await fetch(`/?token=${encodeURIComponent(this.token)}`, { cache: 'no-store' });
      return true;
    } catch {
      return false;
    }
  }
}
