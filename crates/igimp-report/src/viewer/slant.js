// A cut along a plane: its face in every box that it crosses.

// The edges of a box by its corners, whose numbers have bit k for the upper end along axis k.
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

// The corners, in turn, of the polygon in which a plane crosses a box of eight corners; what stands beside these is there too.
function crossing(corners, normal, offset) {
  const beyond = corners.map((corner) => dot(normal, corner) - offset);
  const points = [];
  for (const [a, b] of EDGES) {
    if (beyond[a] > 0 === beyond[b] > 0) continue;
    const share = beyond[a] / (beyond[a] - beyond[b]);
    points.push(corners[a].map((x, k) => x + share * (corners[b][k] - x)));
  }
  if (points.length < 3) return [];
  const middle = [0, 1, 2].map((k) => points.reduce((sum, point) => sum + point[k], 0) / points.length);
  const from = (point) => middle.map((x, k) => point[k] - x);
  const one = from(points[0]);
  const two = cross(normal, one);
  const angle = (point) => Math.atan2(dot(two, from(point)), dot(one, from(point)));
  return points.sort((a, b) => angle(a) - angle(b));
}

// The corners, in turn, of the face of a cut in a box, each with its place on the box itself beside it; none where it does not
// cross the box. Where the cut runs between boxes, or through a narrow crack, the face is in those that stay.
function faceIn(boxes, box, { axis, normal, offset }) {
  const [low, high] = [boxes.low, boxes.high].map((numbers) => numbers.subarray(3 * box, 3 * box + 3));
  if (axis < 0) {
    // Corners leave a box by less than its size.
    let [off, reach] = [-offset, 0];
    for (let k = 0; k < 3; k += 1) {
      off += 0.5 * normal[k] * (low[k] + high[k]);
      reach += 1.3 * Math.abs(normal[k]) * (high[k] - low[k]);
    }
    return Math.abs(off) > reach ? [] : crossing(cornersBeside(boxes, box), normal, offset);
  }
  const at = offset * normal[axis];
  const size = high[axis] - low[axis];
  const more = normal[axis] > 0 ? [1e-4, 0.1] : [-0.1, -1e-4];
  if (at < low[axis] + more[0] * size || at > high[axis] + more[1] * size) return [];
  const within = Math.min(Math.max(at, low[axis] + 1e-3 * size), high[axis] - 1e-3 * size);
  const face = crossing(cornersBeside(boxes, box), normal, within * normal[axis]);
  for (const corner of face) corner[axis] = at;
  return face;
}

// The face of a cut through all boxes as triangles, whose they are, and its area [m²].
function sliceOf(boxes, cut) {
  const [places, owners] = [[], []];
  let area = 0;
  for (let box = 0; box < boxes.count; box += 1) {
    const points = faceIn(boxes, box, cut).map((point) => point.slice(0, 3));
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
