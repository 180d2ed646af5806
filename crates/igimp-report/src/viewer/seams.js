// Lines in the face of a cut: where soil ends, and where soils meet.

// So far beyond a side of the face in a box it is looked what stands there, as a share of the face.
const BEYOND = 0.2;

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
    // What stands beside a face is found on the boxes themselves.
    const middle = [3, 4, 5].map((k) => corners.reduce((sum, corner) => sum + corner[k], 0) / corners.length);
    corners.forEach((from, at) => {
      const to = corners[(at + 1) % corners.length];
      const beyond = middle.map((x, k) => (1 + BEYOND) * 0.5 * (from[3 + k] + to[3 + k]) - BEYOND * x);
      // Where the cut runs between boxes, those beside are the ones that it leaves.
      if (cut.axis >= 0) beyond[cut.axis] = Math.min(Math.max(beyond[cut.axis], 0.95 * ends[0] + 0.05 * ends[1]), 0.05 * ends[0] + 0.95 * ends[1]);
      const others = holding(beyond).filter((other) => other !== box);
      const isSame = others.some((other) => !soil || soil[other] === soil[box]);
      // Of two soils that meet the line is drawn once.
      const isOther = others.length > 0 && others.every((other) => soil[other] < soil[box]);
      if (others.length === 0 || (!isSame && isOther)) seams.push(...from.slice(0, 3), ...to.slice(0, 3));
    });
  }
  return seams;
}
