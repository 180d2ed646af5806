// A cut along a slanted plane: its face in every box that it crosses.

// Corners of a box by their numbers, and its edges.
const EDGES = [[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]];

// The direction of what is taken away, by the direction in which the plane dips, from x towards y, and its dip [°].
function slantOf(turn, dip) {
  const [t, d] = [(turn * Math.PI) / 180, (dip * Math.PI) / 180];
  return [Math.sin(d) * Math.cos(t), Math.sin(d) * Math.sin(t), Math.cos(d)];
}

// Least and largest offset of planes of a normal that meet an extent.
function offsetsOf(normal, { low, high }) {
  const ends = [0, 1, 2].map((k) => [normal[k] * low[k], normal[k] * high[k]].sort((a, b) => a - b));
  return [0, 1].map((end) => ends[0][end] + ends[1][end] + ends[2][end]);
}

// The corners, in turn, of the polygon in which a plane crosses a box.
function crossing(low, high, normal, offset) {
  const corners = Array.from({ length: 8 }, (_, k) => [k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]]);
  const beyond = corners.map((corner) => dot(normal, corner) - offset);
  const points = [];
  for (const [a, b] of EDGES) {
    if (beyond[a] > 0 === beyond[b] > 0) continue;
    const share = beyond[a] / (beyond[a] - beyond[b]);
    points.push(corners[a].map((x, k) => x + share * (corners[b][k] - x)));
  }
  if (points.length < 3) return [];
  const middle = [0, 1, 2].map((k) => points.reduce((sum, point) => sum + point[k], 0) / points.length);
  const from = (point) => point.map((x, k) => x - middle[k]);
  const one = from(points[0]);
  const two = cross(normal, one);
  const angle = (point) => Math.atan2(dot(two, from(point)), dot(one, from(point)));
  return points.sort((a, b) => angle(a) - angle(b));
}

// The face of a slanted cut through all boxes as triangles, and its area [m²].
function sliceOf({ low, high, count }, { normal, offset }) {
  const [places, owners] = [[], []];
  let area = 0;
  for (let box = 0; box < count; box += 1) {
    const ends = [low, high].map((numbers) => [0, 1, 2].map((k) => numbers[3 * box + k]));
    const points = crossing(...ends, normal, offset);
    for (let k = 1; k + 1 < points.length; k += 1) {
      for (const point of [points[0], points[k], points[k + 1]]) {
        places.push(...point);
        owners.push(box);
      }
      const sides = [points[k], points[k + 1]].map((point) => point.map((x, j) => x - points[0][j]));
      area += 0.5 * Math.hypot(...cross(...sides));
    }
  }
  return { places, owners, area };
}
