// Records what the picture shows, in real time, and saves it as a film.
import { h, timeText, toast } from './html.js';
import { download } from './plot.js';

const frames_per_s = 30, bits_per_s = 8e6;
const forms = ['video/webm;codecs=vp8', 'video/webm', 'video/mp4'];  // the cheapest to encode first

export class Film {
  constructor(view, name) {
    Object.assign(this, { view, name });
    this.recorder = null;
    this.button = h('button', { 'aria-pressed': 'false', title: 'Records what the picture shows, until it is pressed again (w)', onclick: () => this.toggle() }, 'Film');
  }

  toggle() {
    if (this.recorder !== null) this.recorder.stop();
    else this.start();
  }

  start() {
    const { view } = this;
    const form = forms.find((one) => window.MediaRecorder?.isTypeSupported(one));
    if (form === undefined) return toast('This browser records no films; "tandem run --film" does.', 'error');
    const canvas = document.createElement('canvas');
    [canvas.width, canvas.height] = [view.labels.width, view.labels.height];
    const pen = canvas.getContext('2d');
    const recorder = new MediaRecorder(canvas.captureStream(frames_per_s), { mimeType: form, videoBitsPerSecond: bits_per_s });
    const parts = [], began = performance.now();
    const draw = () => {
      if (this.recorder !== recorder) return;
      for (const layer of [view.canvas, view.labels]) pen.drawImage(layer, 0, 0, canvas.width, canvas.height);
      this.button.textContent = `■ Film ${timeText((performance.now() - began) / 1000)}`;
      view.afterPicture.push(draw);
    };
    recorder.ondataavailable = ({ data }) => parts.push(data);
    recorder.onstop = () => {
      this.show(null);
      if (parts.every((part) => part.size === 0)) return toast('The film is empty: it was ended before the browser had encoded its first picture.', 'error');
      return download(`${this.name()}.${form.includes('mp4') ? 'mp4' : 'webm'}`, new Blob(parts, { type: recorder.mimeType }));
    };
    this.show(recorder);
    view.afterPicture.push(draw);
    view.invalidate();
    recorder.start(1000);
    return toast('Recording the picture; "Film" (w) ends it and saves the file.');
  }

  show(recorder) {
    this.recorder = recorder;
    this.button.textContent = 'Film';
    this.button.setAttribute('aria-pressed', String(recorder !== null));
  }
}
