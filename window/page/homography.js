// The map of a plane onto a plane by four corners, as CSS takes it.

/** Solves a x = b by elimination; `rows` are [a…, b]. Null: there is no single solution. */
function solve(rows) {
  const n = rows.length;
  for (let i = 0; i < n; ++i) {
    let best = i;
    for (let k = i + 1; k < n; ++k) if (Math.abs(rows[k][i]) > Math.abs(rows[best][i])) best = k;
    if (Math.abs(rows[best][i]) < 1e-12) return null;
    [rows[i], rows[best]] = [rows[best], rows[i]];
    for (let k = 0; k < n; ++k) {
      if (k === i) continue;
      const share = rows[k][i] / rows[i][i];
      for (let j = i; j <= n; ++j) rows[k][j] -= share * rows[i][j];
    }
  }
  return rows.map((row, i) => row[n] / row[i]);
}

/** [a, b, c, d, e, f, g, h] of x' = (a x + b y + c) / (g x + h y + 1), y' = (d x + e y + f) / (g x + h y + 1), which takes each
 *  of four points `from` to its one of `to`; null where three of them lie on a line. */
export function homography(from, to) {
  const rows = [];
  from.forEach(([x, y], i) => {
    const [u, v] = to[i];
    rows.push([x, y, 1, 0, 0, 0, -x * u, -y * u, u], [0, 0, 0, x, y, 1, -x * v, -y * v, v]);
  });
  return solve(rows);
}

export function applied([a, b, c, d, e, f, g, h], [x, y]) {
  const w = g * x + h * y + 1;
  return [(a * x + b * y + c) / w, (d * x + e * y + f) / w];
}

/** For `transform`, with the origin at the top left. */
export const cssMatrix = ([a, b, c, d, e, f, g, h]) => `matrix3d(${[a, d, 0, g, b, e, 0, h, 0, 0, 1, 0, c, f, 0, 1].join()})`;

/** Whether four corners go once around in one direction. */
export function isConvex(corners) {
  const turns = corners.map(([x, y], i) => {
    const [x1, y1] = corners[(i + 1) % 4], [x2, y2] = corners[(i + 2) % 4];
    return Math.sign((x1 - x) * (y2 - y1) - (y1 - y) * (x2 - x1));
  });
  return turns[0] !== 0 && turns.every((turn) => turn === turns[0]);
}
