// Values of contours in space: at places where a level crosses a face that is seen, with nothing before it.

// Most labels of a level, places on the way along its crossings that are tried, and how far a face has to look at the eye.
const MOST_OF_LEVEL = 2;
const TRIED = [0.5, 0.3, 0.7, 0.18, 0.82, 0.4, 0.6, 0.08, 0.92];
const LEAST_SLANT = 0.12;

// The two ends of the line along which a level crosses a polygon, whose corners have places and values; none where it does not.
function crossingOf(polygon, level) {
  const ends = [];
  polygon.forEach((a, k) => {
    const b = polygon[(k + 1) % polygon.length];
    if (a.value > level === b.value > level) return;
    const share = (level - a.value) / (b.value - a.value);
    ends.push(a.at.map((x, axis) => x + share * (b.at[axis] - x)));
  });
  return ends.length === 2 ? ends : null;
}

// The corner of a box by the bits of its number, x first, with its value.
function cornerOf({ low, high }, levels, box, number) {
  const at = [0, 1, 2].map((axis) => ((number >> axis) & 1 ? high : low)[3 * box + axis]);
  return { at, value: levels[8 * box + number] };
}

// The corners of a face of a box, or of the square in which a level cut at a place on an axis meets it.
function faceOf(boxes, levels, box, axis, side, share) {
  const [one, two] = [1 << (axis + 1) % 3, 1 << (axis + 2) % 3];
  return [0, one, one | two, two].map((bits) => {
    const [from, to] = [bits, bits | (1 << axis)].map((number) => cornerOf(boxes, levels, box, number));
    if (share === undefined) return side ? to : from;
    return { at: from.at.map((x, k) => x + share * (to.at[k] - x)), value: from.value + share * (to.value - from.value) };
  });
}

// What a cut leaves of a line; none where it takes all of it.
function leftOf(ends, cut, near) {
  if (!ends || !cut) return ends;
  const beyond = ends.map((end) => dot(cut.normal, end) - cut.offset);
  if (Math.max(...beyond) <= near) return ends;
  if (Math.min(...beyond) >= -near) return null;
  const share = beyond[0] / (beyond[0] - beyond[1]);
  const at = ends[0].map((x, axis) => x + share * (ends[1][axis] - x));
  return beyond[0] > 0 ? [at, ends[1]] : [ends[0], at];
}

// Calls for every polygon that looks at the eye, with its box: faces that the cut leaves, and the face of the cut.
function eachPolygon({ boxes, surface, cut }, { eye }, call) {
  const { corners: levels } = surface;
  const { box: owners, face } = boxes.faces;
  for (let k = 0; k < owners.length; k += 1) {
    const [axis, side] = [face[k] >> 1, face[k] & 1];
    if ((2 * side - 1) * eye[axis] > LEAST_SLANT) call(owners[k], faceOf(boxes, levels, owners[k], axis, side));
  }
  if (!cut || dot(cut.normal, eye) <= LEAST_SLANT) return;
  if (cut.axis < 0) {
    const { sliced, sliceLevels, slicePlaces } = surface;
    for (let k = 0; k + 2 < sliced.length; k += 3) {
      const corner = (j) => ({ at: [0, 1, 2].map((axis) => slicePlaces[3 * j + axis]), value: sliceLevels[j] });
      call(sliced[k], [corner(k), corner(k + 1), corner(k + 2)]);
    }
    return;
  }
  const place = cut.offset / cut.normal[cut.axis];
  for (let box = 0; box < boxes.count; box += 1) {
    const [low, high] = [boxes.low[3 * box + cut.axis], boxes.high[3 * box + cut.axis]];
    if (low < place && place < high) call(box, faceOf(boxes, levels, box, cut.axis, 0, (place - low) / (high - low)));
  }
}

// Where levels 0, 1, ... cross what is seen, by level: the box, and both ends of the crossing on the canvas.
function crossingsInSight(scene, place, count) {
  const found = Array.from({ length: count }, () => []);
  const { cut } = scene;
  eachPolygon(scene, place, (box, polygon) => {
    if (scene.isLeftOut(box)) return;
    const values = polygon.map(({ value }) => value);
    const [low, high] = [Math.min(...values), Math.max(...values)];
    for (let level = Math.max(Math.ceil(low), 0); level < Math.min(high, count); level += 1) {
      const ends = leftOf(crossingOf(polygon, level), cut, 1e-9 * place.deep);
      if (!ends) continue;
      const [from, to] = ends.map((end) => projected(place, scene.camera, end));
      found[level].push({ box, from, to, at: [0, 1].map((axis) => 0.5 * (from[axis] + to[axis])) });
    }
  });
  return found;
}

// Writes the texts of levels on lines that are long enough, where there is room and nothing stands before; the number of labels.
function writeLevels(pen, scene, place, texts) {
  const { room } = place;
  const isInside = ([x, y]) => x > room.left && x < place.width - room.right && y > room.top && y < place.height - room.bottom;
  const taken = [];
  const isFree = (at) => isInside(at) && taken.every((own) => Math.hypot(own[0] - at[0], own[1] - at[1]) > APART);
  crossingsInSight(scene, place, texts.length).forEach((crossings, level) => {
    const length = crossings.reduce((sum, { from, to }) => sum + Math.hypot(to[0] - from[0], to[1] - from[1]), 0);
    if (length < LABELLED) return;
    crossings.sort((a, b) => a.at[0] + 0.3 * a.at[1] - b.at[0] - 0.3 * b.at[1]);
    let written = 0;
    for (const share of TRIED) {
      const { box, from, to, at } = crossings[Math.floor(share * (crossings.length - 1))];
      if (written === MOST_OF_LEVEL || !isFree(at) || scene.boxAt(...at) !== box) continue;
      const angle = Math.atan2(to[1] - from[1], to[0] - from[0]);
      Contours.label(pen, texts[level], { at, angle: Math.abs(angle) > Math.PI / 2 ? angle + Math.PI : angle });
      taken.push(at);
      written += 1;
    }
  });
  return taken.length;
}
