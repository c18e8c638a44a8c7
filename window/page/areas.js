// Fences, keep-outs and zones of a run or a record.
import { numberText } from './html.js';
import { okabeIto } from './palette.js';

export class Areas {
  constructor(view, world) {
    this.areas = [];
    world.on('hello', (hello) => {
      this.areas = hello.areas ?? [];
      view.invalidate();
    });
    view.addItem(this);
  }

  /** Edges, on the floor and at their upper and lower ends. */
  label(pen, camera) {
    const colors = { fence: okabeIto.green, keep_out: okabeIto.vermilion, zone: okabeIto.orange };
    for (const area of this.areas) {
      const heights = [...new Set([area.from, area.to < 100 ? area.to : area.from])];
      for (const z of heights) {
        const points = area.corners.map(([x, y]) => camera.project(x, y, z));
        if (points.every((p) => p.inFront)) pen.line([...points, points[0]].map((p) => [p.x, p.y]), colors[area.kind], 2);
      }
      const [x, y] = area.corners[0];
      const at = camera.project(x, y, area.from);
      const text = area.max_speed ? `${area.id}: ${numberText(area.max_speed)} m/s` : area.id;
      if (at.inFront) pen.tag(text, at.x + 6, at.y - 8, { color: colors[area.kind] });
    }
  }
}
