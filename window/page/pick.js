// What lies under a pixel: a robot, an object or a lamp.
import { bodySize } from './models.js';

const least_px = 9;  // so near is hit, however small the robot looks

/** { robot: id } | { object: id } | { light: id } | null; the nearest to the eye. */
export function pick(world, camera, x_px, y_px) {
  const ray = camera.ray(x_px, y_px);
  const thing = pickObject(world, ray);
  const robot = pickRobot(world, camera, x_px, y_px);
  if (robot !== null && (thing === null || robot.depth <= thing.depth + 0.05)) return { robot: robot.id };
  return thing === null ? null : thing.what;
}

function depthOf(ray, x, y, z) {
  const { origin, direction } = ray;
  return (x - origin.x) * direction.x + (y - origin.y) * direction.y + (z - origin.z) * direction.z;
}

function pickRobot(world, camera, x_px, y_px) {
  const count = world.frame?.count ?? 0;
  const ray = camera.ray(x_px, y_px);
  let best = null;
  for (let i = 0; i < count; ++i) {
    const pose = world.pose(i);
    const body = world.body(i);
    const { radius, height } = bodySize(body);
    const z = pose.z + height / 2;
    const at = camera.project(pose.x, pose.y, z);
    if (!at.inFront) continue;
    const wide = Math.max(radius, body.rotor_arm ?? 0, height / 2) / camera.metresPerPixel(pose.x, pose.y, z);
    const away = Math.hypot(at.x - x_px, at.y - y_px);
    if (away > Math.max(least_px, wide)) continue;
    const rank = away / Math.max(least_px, wide);
    if (best === null || rank < best.rank) best = { rank, id: world.members.ids[i], depth: depthOf(ray, pose.x, pose.y, z) - radius };
  }
  return best;
}

function pickObject(world, { origin, direction }) {
  let best = null;
  const offer = (depth, what) => {
    if (depth !== null && (best === null || depth < best.depth)) best = { depth, what };
  };
  for (const o of world.scene?.objects ?? []) {
    const c = Math.cos(o.heading), s = Math.sin(o.heading);
    const from = [c * (origin.x - o.x) + s * (origin.y - o.y), c * (origin.y - o.y) - s * (origin.x - o.x), origin.z - o.z];
    const along = [c * direction.x + s * direction.y, c * direction.y - s * direction.x, direction.z];
    const half = o.shape === 'box' ? [o.size_x / 2, o.size_y / 2] : [o.radius, o.radius];
    offer(slab(from, along, [-half[0], -half[1], 0], [half[0], half[1], Math.max(0.01, o.height)]), { object: o.id });
  }
  for (const light of world.scene?.lights ?? []) {
    const r = 0.08;
    offer(slab([origin.x - light.x, origin.y - light.y, origin.z - light.z], [direction.x, direction.y, direction.z], [-r, -r, -r], [r, r, r]), { light: light.id });
  }
  return best;
}

/** Where a line enters a box, or null. */
function slab(from, along, low, high) {
  let enter = -Infinity, leave = Infinity;
  for (let i = 0; i < 3; ++i) {
    if (Math.abs(along[i]) < 1e-12) {
      if (from[i] < low[i] || from[i] > high[i]) return null;
      continue;
    }
    const a = (low[i] - from[i]) / along[i], b = (high[i] - from[i]) / along[i];
    enter = Math.max(enter, Math.min(a, b));
    leave = Math.min(leave, Math.max(a, b));
  }
  return enter <= leave ? enter : null;
}
