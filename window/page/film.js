// Records what the picture shows, in real time, and saves it as a film.
import { h, timeText, toast } from './html.js';
import { download } from './plot.js';

const frames_per_s = 30, bits_per_s = 8e6;
const forms = ['video/webm;codecs=vp8', 'video/webm', 'video/mp4'];  // the cheapest to encode first

export class Film {
  constructor(view, name) {
    Object.assign(this, { view, name });
    this.recorder = null;
    this.ends = false;  // as soon as there is something in it
    this.bytes = 0;
    this.button = h('button', { 'aria-pressed': 'false', title: 'Records what the picture shows, until it is pressed again (w)', onclick: () => this.toggle() }, 'Film');
  }

  toggle() {
    if (this.recorder === null) return this.start();
    if (this.bytes > 0 || this.ends) return this.recorder.stop();
    this.ends = true;
    return toast('The film ends with the first pictures that the browser has encoded; "Film" (w) gives it up.');
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
    [this.ends, this.bytes] = [false, 0];
    recorder.ondataavailable = ({ data }) => {
      parts.push(data);
      this.bytes += data.size;
      if (this.ends && data.size > 0 && recorder.state === 'recording') recorder.stop();
    };
    recorder.onstop = () => {
      this.show(null);
      if (this.bytes === 0) return toast('The film is empty: it was ended before the browser had encoded its first picture.', 'error');
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
