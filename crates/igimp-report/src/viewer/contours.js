// Lines of equal value: in the plane along the pieces of the bodies, on their own soil; in space by values at the corners of
// boxes, between which the faces have them.

// Labels stand at least so far from each other, and on lines at least so long [CSS pixel].
const APART = 70;
const LABELLED = 90;

// Gives the places where corners of pieces meet numbers; pieces of different soils have none in common.
function placesOf({ corners, ends, whose }, soil) {
  const numbers = new Map();
  const placeOf = new Uint32Array(corners.length / 2);
  let start = 0;
  ends.forEach((end, k) => {
    const own = soil ? soil[whose[k]] : 0;
    for (let at = start; at < end; at += 1) {
      const key = `${own} ${corners[2 * at]} ${corners[2 * at + 1]}`;
      if (!numbers.has(key)) numbers.set(key, numbers.size);
      placeOf[at] = numbers.get(key);
    }
    start = end;
  });
  return { placeOf, count: numbers.size };
}

// Calls for every corner of every piece that has a value: the corner, its place and the box.
function eachCorner({ ends, whose }, { placeOf }, values, call) {
  let start = 0;
  ends.forEach((end, k) => {
    for (let at = start; at < end; at += 1) if (Number.isFinite(values[whose[k]])) call(at, placeOf[at], whose[k]);
    start = end;
  });
}

// Means over the pieces that meet at each place: of their values, and of the centres of their boxes.
function meansAt(pieces, places, values, centres) {
  const [value, x, y, weights] = Array.from({ length: 4 }, () => new Float64Array(places.count));
  eachCorner(pieces, places, values, (_, place, box) => {
    weights[place] += 1;
    value[place] += values[box];
    x[place] += centres[2 * box];
    y[place] += centres[2 * box + 1];
  });
  for (const sums of [value, x, y]) sums.forEach((sum, place) => (sums[place] = sum / weights[place]));
  return { value, x, y };
}

// The gradient of a field at each box, by least squares over the places of its corners, and the largest difference there: a
// linear field has its own.
function gradientsOf(pieces, places, values, centres, means) {
  const count = centres.length / 2;
  const [xx, xy, yy, xv, yv, most] = Array.from({ length: 6 }, () => new Float64Array(count));
  eachCorner(pieces, places, values, (_, place, box) => {
    const [dx, dy, dv] = [means.x[place] - centres[2 * box], means.y[place] - centres[2 * box + 1], means.value[place] - values[box]];
    xx[box] += dx * dx;
    xy[box] += dx * dy;
    yy[box] += dy * dy;
    xv[box] += dx * dv;
    yv[box] += dy * dv;
    most[box] = Math.max(most[box], Math.abs(dv));
  });
  const gradients = new Float64Array(2 * count);
  for (let box = 0; box < count; box += 1) {
    const size = xx[box] + yy[box];
    const by = xx[box] * yy[box] - xy[box] ** 2;
    if (!(by > 1e-6 * size * size)) continue;
    gradients[2 * box] = (yy[box] * xv[box] - xy[box] * yv[box]) / by;
    gradients[2 * box + 1] = (xx[box] * yv[box] - xy[box] * xv[box]) / by;
  }
  return { gradients, most };
}

// Values at the places of a field that has one for each box: means of what the boxes say of the place by their gradients, which
// say no more than twice the difference to their neighbours. A linear field is itself, at the boundary too.
function valuesAt(pieces, places, values, centres) {
  const means = meansAt(pieces, places, values, centres);
  const { gradients, most } = gradientsOf(pieces, places, values, centres, means);
  const [sums, weights] = [new Float64Array(places.count), new Float64Array(places.count)];
  eachCorner(pieces, places, values, (at, place, box) => {
    const off = [0, 1].map((axis) => pieces.corners[2 * at + axis] - centres[2 * box + axis]);
    const change = off[0] * gradients[2 * box] + off[1] * gradients[2 * box + 1];
    sums[place] += values[box] + Math.min(Math.max(change, -2 * most[box]), 2 * most[box]);
    weights[place] += 1;
  });
  return sums.map((sum, place) => sum / weights[place]);
}

// The triangles between the corners of a piece and its middle, by number, place and value of their corners; the middle has the
// mean. None where a corner has no value.
function trianglesIn({ corners, ends }, { placeOf, count }, at, k) {
  const own = [];
  for (let corner = k > 0 ? ends[k - 1] : 0; corner < ends[k]; corner += 1) own.push({ number: placeOf[corner], x: corners[2 * corner], y: corners[2 * corner + 1], value: at[placeOf[corner]] });
  if (!own.every(({ value }) => Number.isFinite(value))) return [];
  const mean = (name) => own.reduce((sum, corner) => sum + corner[name], 0) / own.length;
  const middle = { number: count + k, x: mean("x"), y: mean("y"), value: mean("value") };
  return own.map((corner, j) => [corner, own[(j + 1) % own.length], middle]);
}

// The shares of the corners of a triangle in a point.
function sharesIn([a, b, c], x, y) {
  const whole = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  const first = ((b.x - x) * (c.y - y) - (c.x - x) * (b.y - y)) / whole;
  const second = ((c.x - x) * (a.y - y) - (a.x - x) * (c.y - y)) / whole;
  return [first, second, 1 - first - second];
}

// The field whose contours are drawn, as a function of the piece and the point in it.
function fieldOver(pieces, values, centres, soil) {
  const places = placesOf(pieces, soil);
  const at = valuesAt(pieces, places, values, centres);
  return (k, x, y) => {
    let [best, least] = [NaN, -Infinity];
    for (const triangle of trianglesIn(pieces, places, at, k)) {
      const shares = sharesIn(triangle, x, y);
      const own = Math.min(...shares);
      if (own > least) [best, least] = [shares.reduce((sum, share, j) => sum + share * triangle[j].value, 0), own];
    }
    return best;
  };
}

// The two points at which a level crosses the sides of a triangle, each with a key that it shares with the triangle beyond.
function crossed(triangle, level) {
  const found = [];
  triangle.forEach((a, k) => {
    const b = triangle[(k + 1) % 3];
    if (a.value > level === b.value > level) return;
    const [low, high] = a.number < b.number ? [a, b] : [b, a];
    const share = (level - low.value) / (high.value - low.value);
    found.push({ key: low.number * 2 ** 26 + high.number, point: [low.x + share * (high.x - low.x), low.y + share * (high.y - low.y)] });
  });
  return found;
}

// Joins segments by the keys of their ends to lines of points.
function joined(segments) {
  const at = new Map();
  for (const segment of segments) {
    for (const { key } of segment) at.set(key, [...(at.get(key) || []), segment]);
  }
  const used = new Set();
  const follow = (start, first) => {
    const line = [start.point];
    let [end, segment] = [start, first];
    while (segment) {
      used.add(segment);
      end = segment[0].key === end.key ? segment[1] : segment[0];
      line.push(end.point);
      segment = at.get(end.key).find((own) => !used.has(own));
    }
    return line;
  };
  const lines = [];
  // Lines that end begin at an end; what is left is closed.
  for (const isOpen of [true, false]) {
    for (const segment of segments) {
      const end = segment.find(({ key }) => !isOpen || at.get(key).length === 1);
      if (!used.has(segment) && end) lines.push(follow(end, segment));
    }
  }
  return lines;
}

// Lines of equal value of a field that has a value for each box, over the pieces of the plane: a level with its lines, for each
// level. `soil` tells pieces apart that have no value in common.
function contoursOf(pieces, values, centres, levels, soil) {
  const places = placesOf(pieces, soil);
  const at = valuesAt(pieces, places, values, centres);
  const segments = levels.map(() => []);
  for (let piece = 0; piece < pieces.ends.length; piece += 1) {
    for (const triangle of trianglesIn(pieces, places, at, piece)) {
      const own = triangle.map(({ value }) => value);
      const [low, high] = [Math.min(...own), Math.max(...own)];
      levels.forEach((level, k) => {
        if (low <= level && level < high) segments[k].push(crossed(triangle, level));
      });
    }
  }
  return levels.map((level, k) => ({ level, lines: joined(segments[k]) }));
}

// Means of a field over the crossings of a raster as fine as the boxes, each box counted at the eight around its centre.
function rasterOf({ low, high, count }, values) {
  const middle = (numbers) => numbers.sort((a, b) => a - b)[Math.floor(numbers.length / 2)] || 1;
  const every = Math.max(1, Math.floor(count / 2000));
  const [from, to, size] = [[], [], []];
  for (let axis = 0; axis < 3; axis += 1) {
    const widths = [];
    [from[axis], to[axis]] = [Infinity, -Infinity];
    for (let box = 0; box < count; box += 1) {
      const at = 3 * box + axis;
      if (box % every === 0) widths.push(high[at] - low[at]);
      from[axis] = Math.min(from[axis], low[at]);
      to[axis] = Math.max(to[axis], high[at]);
    }
    size[axis] = Math.max(middle(widths), (to[axis] - from[axis]) / 400);
  }
  const counts = size.map((own, axis) => Math.ceil((to[axis] - from[axis]) / own - 1e-6) + 1);
  const total = counts[0] * counts[1] * counts[2];
  const [sums, weights] = [new Float32Array(total), new Float32Array(total)];
  // Calls for the crossings around a place with their shares in it.
  const around = (place, call) => {
    const steps = place.map((x, axis) => Math.min(Math.max((x - from[axis]) / size[axis], 0), counts[axis] - 1 - 1e-9));
    const first = steps.map((x) => Math.max(Math.floor(x), 0));
    for (let k = 0; k < 8; k += 1) {
      const upper = [k & 1, (k >> 1) & 1, k >> 2];
      const share = steps.reduce((product, x, axis) => product * (upper[axis] ? x - first[axis] : 1 - x + first[axis]), 1);
      const [i, j, l] = first.map((own, axis) => Math.min(own + upper[axis], counts[axis] - 1));
      call((l * counts[1] + j) * counts[0] + i, share);
    }
  };
  for (let box = 0; box < count; box += 1) {
    if (!Number.isFinite(values[box])) continue;
    const centre = [0, 1, 2].map((axis) => 0.5 * (low[3 * box + axis] + high[3 * box + axis]));
    around(centre, (crossing, share) => {
      sums[crossing] += share * values[box];
      weights[crossing] += share;
    });
  }
  return { around, sums, weights };
}

// A value for each of the eight corners of each box, x first: the same wherever corners meet.
function cornerValues(boxes, values) {
  const { around, sums, weights } = rasterOf(boxes, values);
  const found = new Float32Array(8 * boxes.count);
  for (let box = 0; box < boxes.count; box += 1) {
    for (let k = 0; k < 8; k += 1) {
      const upper = [k & 1, (k >> 1) & 1, k >> 2];
      const place = upper.map((isUpper, axis) => (isUpper ? boxes.high : boxes.low)[3 * box + axis]);
      let [sum, weight] = [0, 0];
      around(place, (crossing, share) => {
        if (!(weights[crossing] > 1e-6)) return;
        sum += (share * sums[crossing]) / weights[crossing];
        weight += share;
      });
      found[8 * box + k] = weight > 1e-6 ? sum / weight : values[box];
    }
  }
  return found;
}

// Whether a line on a colour has to be light.
function isDark([red, green, blue]) {
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue < 110;
}

// Draws contours of the plane, with their values where these are wanted.
class Contours {
  constructor(scene) {
    this.scene = scene;
    this.sets = [];
    this.colours = [];
    this.texts = null;
  }

  // Takes up contours, the colours of the scale at their levels, and the texts of the levels where these are to be written.
  take(sets, colours, texts) {
    Object.assign(this, { sets, colours, texts });
    const { canvas } = this.scene;
    canvas.dataset.contours = sets.reduce((sum, own) => sum + own.lines.length, 0);
    canvas.dataset.contourLevels = sets.filter((own) => own.lines.length > 0).map((own) => own.level).join(" ");
  }

  paint(pen, place) {
    const see = ([x, y]) => projected(place, this.scene.camera, [x, y, 0]);
    const sets = this.sets.map(({ lines }) => lines.map((line) => line.map(see)));
    pen.lineJoin = "round";
    pen.lineWidth = 1;
    sets.forEach((lines, k) => {
      pen.strokeStyle = isDark(this.colours[k]) ? "rgba(255,255,255,0.85)" : "rgba(16,16,16,0.85)";
      pen.beginPath();
      for (const line of lines) Contours.curve(pen, line);
      pen.stroke();
    });
    pen.lineJoin = "miter";
  }

  // Writes the values of the lines, over all that lies over these.
  write(pen, place) {
    const { scene, texts } = this;
    if (scene.dimension === 3) {
      scene.canvas.dataset.contourLabels = texts && texts.length > 0 ? writeLevels(pen, scene, place, texts) : 0;
      return;
    }
    const see = ([x, y]) => projected(place, this.scene.camera, [x, y, 0]);
    const sets = this.texts ? this.sets.map(({ lines }) => lines.map((line) => line.map(see))) : [];
    this.scene.canvas.dataset.contourLabels = this.label(pen, place, sets);
  }

  // A line whose corners are rounded off.
  static curve(pen, line) {
    pen.moveTo(...line[0].slice(0, 2));
    for (let k = 1; k + 1 < line.length; k += 1) {
      const [a, b] = [line[k], line[k + 1]];
      pen.quadraticCurveTo(a[0], a[1], 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]));
    }
    pen.lineTo(...line[line.length - 1].slice(0, 2));
  }

  // Writes the value of each line that is long enough along it, where there is room; the number of labels.
  label(pen, place, sets) {
    const { room } = place;
    const isInside = ([x, y]) => x > room.left + 24 && x < place.width - room.right - 24 && y > room.top + 12 && y < place.height - room.bottom - 12;
    const taken = [];
    sets.forEach((lines, k) => {
      for (const line of lines) {
        const spot = Contours.spot(line, (at) => isInside(at) && taken.every((own) => Math.hypot(own[0] - at[0], own[1] - at[1]) > APART));
        if (!spot) continue;
        taken.push(spot.at);
        Contours.label(pen, this.texts[k], spot);
      }
    });
    return taken.length;
  }

  // A free place on a line near its middle, and which way the line goes there; none on a short line.
  static spot(line, isFree) {
    const lengths = [0];
    for (let k = 1; k < line.length; k += 1) lengths.push(lengths[k - 1] + Math.hypot(line[k][0] - line[k - 1][0], line[k][1] - line[k - 1][1]));
    const whole = lengths[lengths.length - 1];
    if (whole < LABELLED) return null;
    const at = (length) => {
      const k = Math.min(Math.max(lengths.findIndex((own) => own >= length), 1), line.length - 1);
      const share = (length - lengths[k - 1]) / (lengths[k] - lengths[k - 1] || 1);
      return [0, 1].map((axis) => line[k - 1][axis] + share * (line[k][axis] - line[k - 1][axis]));
    };
    for (const share of [0.5, 0.38, 0.62, 0.26, 0.74]) {
      const middle = at(share * whole);
      if (!isFree(middle)) continue;
      const [a, b] = [at(share * whole - 14), at(share * whole + 14)];
      const angle = Math.atan2(b[1] - a[1], b[0] - a[0]);
      return { at: middle, angle: Math.abs(angle) > Math.PI / 2 ? angle + Math.PI : angle };
    }
    return null;
  }

  static label(pen, text, { at, angle }) {
    pen.save();
    pen.translate(...at);
    pen.rotate(angle);
    pen.font = "600 11px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.lineWidth = 3.5;
    pen.lineJoin = "round";
    pen.strokeStyle = "rgba(255,255,255,0.85)";
    pen.strokeText(text, 0, 0);
    pen.fillStyle = "#101010";
    pen.fillText(text, 0, 0);
    pen.restore();
  }
}
