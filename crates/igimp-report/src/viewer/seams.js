// Lines in the face of a cut: where soil ends, and where soils meet.

// So far beyond a side of the face in a box it is looked what stands there, as a share of the face.
const BEYOND = 0.2;

// The corners, in turn, of the face of a cut in a box; none where it does not cross the box. Where the cut runs between boxes, or
// through a narrow crack, the face is in those that stay.
function faceIn({ low, high }, box, { axis, normal, offset }) {
  const ends = [low, high].map((numbers) => [0, 1, 2].map((k) => numbers[3 * box + k]));
  if (axis < 0) return crossing(...ends, normal, offset);
  const at = offset * normal[axis];
  const size = ends[1][axis] - ends[0][axis];
  const more = normal[axis] > 0 ? [1e-4, 0.1] : [-0.1, -1e-4];
  if (at < ends[0][axis] + more[0] * size || at > ends[1][axis] + more[1] * size) return [];
  for (const end of ends) end[axis] = at;
  return cornersOf(...ends, 2 * axis);
}

// Boxes by the bins that they reach into, as large as boxes are at the mean, and a search for those that hold a point.
function binsOf({ low, high }, own) {
  const mean = [0, 1, 2].map((k) => own.reduce((sum, box) => sum + high[3 * box + k] - low[3 * box + k], 0) / own.length || 1);
  const bin = (numbers, at, k) => Math.floor(numbers[at + k] / mean[k]);
  const bins = new Map();
  for (const box of own) {
    const [from, to] = [low, high].map((numbers) => [0, 1, 2].map((k) => bin(numbers, 3 * box, k)));
    for (let i = from[0]; i <= to[0]; i += 1) {
      for (let j = from[1]; j <= to[1]; j += 1) {
        for (let l = from[2]; l <= to[2]; l += 1) {
          const key = `${i} ${j} ${l}`;
          if (bins.has(key)) bins.get(key).push(box);
          else bins.set(key, [box]);
        }
      }
    }
  }
  return (point) => {
    const key = [0, 1, 2].map((k) => bin(point, 0, k)).join(" ");
    return (bins.get(key) || []).filter((box) => [0, 1, 2].every((k) => low[3 * box + k] <= point[k] && point[k] <= high[3 * box + k]));
  };
}

// The sides of the face of a cut in its boxes beyond which there is no soil, or another one, as segments of six numbers.
function seamsOf(boxes, soil, cut) {
  const faces = [];
  for (let box = 0; box < boxes.count; box += 1) {
    const corners = faceIn(boxes, box, cut);
    if (corners.length > 2) faces.push({ box, corners });
  }
  const holding = binsOf(boxes, faces.map(({ box }) => box));
  const seams = [];
  for (const { box, corners } of faces) {
    const ends = [boxes.low, boxes.high].map((numbers) => numbers[3 * box + Math.max(cut.axis, 0)]);
    const middle = [0, 1, 2].map((k) => corners.reduce((sum, corner) => sum + corner[k], 0) / corners.length);
    corners.forEach((from, at) => {
      const to = corners[(at + 1) % corners.length];
      const beyond = from.map((x, k) => (1 + BEYOND) * 0.5 * (x + to[k]) - BEYOND * middle[k]);
      // Where the cut runs between boxes, those beside are the ones that it leaves.
      if (cut.axis >= 0) beyond[cut.axis] = Math.min(Math.max(beyond[cut.axis], 0.95 * ends[0] + 0.05 * ends[1]), 0.05 * ends[0] + 0.95 * ends[1]);
      const others = holding(beyond).filter((other) => other !== box);
      const isSame = others.some((other) => !soil || soil[other] === soil[box]);
      // Of two soils that meet the line is drawn once.
      const isOther = others.length > 0 && others.every((other) => soil[other] < soil[box]);
      if (others.length === 0 || (!isSame && isOther)) seams.push(...from, ...to);
    });
  }
  return seams;
}
