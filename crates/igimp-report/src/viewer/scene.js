// The body on the page: boxes in the colour of their value, rigid bodies, axes in metres, zoom, rotation, a
// cut, and the box under a point. Boxes are drawn by WebGL2, or by a plain canvas where there is none.

// Of rigid bodies so much is in sight beside the soil, as a share of its larger side.
const BESIDE = 0.12;

// Least and largest corner of points, three numbers each.
function extentOf(points, start = { low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] }) {
  const { low, high } = start;
  for (let k = 0; k < points.length; k += 1) {
    if (points[k] < low[k % 3]) low[k % 3] = points[k];
    if (points[k] > high[k % 3]) high[k % 3] = points[k];
  }
  return { low, high };
}

// The eight corners of a box, on the surface of the body without stairs: bit k of their numbers for the upper end along axis k.
function cornersOf({ low, high, moves }, box) {
  return Array.from({ length: 8 }, (_, corner) =>
    [0, 1, 2].map((k) => {
      const at = 3 * box + k;
      return ((corner >> k) & 1 ? high : low)[at] + ((moves[24 * box + 3 * corner + k] - 128) / 127) * (high[at] - low[at]);
    }),
  );
}

// The same with the corners of the box itself beside them, six numbers each.
function cornersBeside(boxes, box) {
  const { low, high } = boxes;
  return cornersOf(boxes, box).map((own, corner) => [...own, ...[0, 1, 2].map((k) => ((corner >> k) & 1 ? high : low)[3 * box + k])]);
}

// The numbers of the corners of a face of a box in turn, by the number of the face: its axis and side.
function aroundFace(face) {
  const axis = Math.floor(face / 2);
  const [one, two] = [1, 2].map((k) => 1 << ((axis + k) % 3));
  const first = (face % 2) << axis;
  return [first, first | one, first | one | two, first | two];
}

class Scene {
  constructor(canvas, below) {
    this.canvas = canvas;
    this.below = below;
    this.dimension = 0;
    this.boxes = null;
    this.bodies = { lines: [], triangles: [], members: [], water: [], slip: null, soil: null };
    this.segments = [];
    this.seams = [];
    this.outlined = true;
    this.overlay = new Overlay(this);
    this.extent = extentOf([]);
    this.cut = null;
    this.least = 0;
    this.marked = -1;
    this.painting = 0;
    this.axes = new Axes(this);
    try {
      this.surface = new Surface(below);
    } catch {
      this.surface = null;
    }
    canvas.dataset.by = this.surface ? "webgl2" : "canvas";
  }

  // Takes up boxes by their corners, and rigid bodies.
  show(dimension, shapes, bodies) {
    if (dimension !== this.dimension) this.camera = new Camera(dimension);
    this.dimension = dimension;
    const count = shapes.low ? shapes.low.length / 3 : 0;
    const none = new Uint8Array(0);
    const neutral = (per) => new Uint8Array(per * count).fill(128);
    const { low = none, high = none, lie = neutral(4), moves = neutral(24) } = shapes;
    this.bodies = bodies;
    this.extent = extentOf(high, extentOf(low, this.extent));
    const masks = shapes.faces || new Uint8Array(count).fill(32);
    const origin = [0, 1, 2].map((k) => (count > 0 ? 0.5 * (this.extent.low[k] + this.extent.high[k]) : 0));
    const pieces = shapes.pieces ? { corners: shapes.pieces, ends: shapes["piece-ends"], whose: shapes.whose } : null;
    const edges = shapes.edges ? { corners: shapes.edges, ends: shapes["edge-ends"] } : null;
    this.boxes = { low, high, lie, moves, masks, origin, count, pieces, edges };
    this.cover();
    this.slice();
    this.canvas.dataset.lines = bodies.lines.length / 6;
    this.canvas.dataset.members = bodies.members.length / 6;
    this.canvas.dataset.water = bodies.water.length;
    this.canvas.dataset.pieces = pieces ? pieces.ends.length : 0;
    this.canvas.dataset.edges = edges ? edges.ends.length : 0;
    this.canvas.dataset.slip = bodies.slip ? (bodies.slip.x || bodies.slip).length : 0;
    if (dimension === 3) this.lineate(edges);
  }

  // The outlines in space.
  lineate(edges) {
    const soil = edges ? segmentsOf(edges) : [];
    const rigid = creasesOf(this.bodies.triangles);
    this.segments = [...soil, ...rigid];
    Object.assign(this.canvas.dataset, { edgeLength: lengthOf(soil), rigidEdgeLength: lengthOf(rigid) });
    if (!this.surface) return;
    this.surface.lines("strips", this.segments, this.boxes);
    const { water, slip } = this.bodies;
    this.surface.sheets("water", water.flatMap((own) => sheetOf(own, this.extent)), this.boxes);
    const sheet = slip ? sheetOf(slip, this.extent) : [];
    this.surface.sheets("slip", sheet, this.boxes);
    this.canvas.dataset.slipSheet = sheet.length;
  }

  // Shows the outlines of bodies, or leaves them out.
  outline(isShown) {
    this.outlined = isShown;
    this.canvas.dataset.outlined = isShown;
    this.paint();
  }

  // The centres of the boxes in the plane.
  centres() {
    const { low, high, count } = this.boxes;
    return new Float64Array(2 * count).map((_, k) => 0.5 * (low[3 * (k >> 1) + (k & 1)] + high[3 * (k >> 1) + (k & 1)]));
  }

  // Contours of a field at levels, which have these colours on the scale, with texts where these are given.
  contour(values, levels, colours, texts) {
    const { boxes, bodies: { soil } } = this;
    if (this.dimension === 3) {
      const range = levels.length > 1 ? [levels[0], levels[1] - levels[0]] : [levels[0], 1];
      if (this.surface) this.surface.contour(levels.length > 0 ? cornerValues(boxes, values).map((own) => (own - range[0]) / range[1]) : null, colours);
      this.overlay.contours.take([], colours, this.surface ? texts : null);
      this.canvas.dataset.contourLevels = levels.join(" ");
    } else if (boxes.pieces) {
      this.overlay.contours.take(levels.length > 0 ? contoursOf(boxes.pieces, values, this.centres(), levels, soil) : [], colours, texts);
    }
    this.paint();
  }

  // The faces of boxes: those of the skin, or all where some particles are left out.
  cover() {
    const { boxes } = this;
    boxes.faces = Scene.facesOf(this.least > 0 ? new Uint8Array(boxes.count).fill(63) : boxes.masks);
    if (this.surface) this.surface.shape(boxes, this.bodies.triangles);
    this.canvas.dataset.faces = boxes.faces.box.length;
  }

  // Leaves out particles whose value is less than a share of the scale.
  from(least) {
    const covers = least > 0 !== this.least > 0;
    this.least = least;
    if (!covers || !this.boxes) return;
    this.cover();
    this.slice();
  }

  isLeftOut(box) {
    return this.colours[4 * box + 3] === 0;
  }

  // The face of the cut: its lines and its triangles; an ordinary canvas has none of a slanted cut.
  slice() {
    const { surface, cut, boxes, bodies, canvas } = this;
    this.seams = this.dimension === 3 && cut ? seamsOf(boxes, bodies.soil, cut) : [];
    canvas.dataset.seamLength = lengthOf(this.seams);
    if (!surface) return;
    surface.lines("seams", this.seams, boxes);
    const face = cut ? sliceOf(boxes, cut) : { places: [], owners: [], area: 0 };
    surface.slice(face, boxes.origin);
    canvas.dataset.cutArea = face.area;
  }

  // The faces that are seen, by box and number.
  static facesOf(masks) {
    let count = 0;
    for (const mask of masks) for (let bits = mask; bits > 0; bits >>= 1) count += bits & 1;
    const faces = { box: new Uint32Array(count), face: new Uint8Array(count) };
    let at = 0;
    masks.forEach((mask, box) => {
      for (let face = 0; face < 6; face += 1) {
        if (!((mask >> face) & 1)) continue;
        faces.box[at] = box;
        faces.face[at] = face;
        at += 1;
      }
    });
    return faces;
  }

  // Colours by box: shares of the scale, grey where there is no value.
  colour(values, [low, high], colours) {
    const bytes = new Uint8Array(4 * this.boxes.count);
    const last = colours.length - 1;
    let seen = 0;
    for (let box = 0; box < this.boxes.count; box += 1) {
      const share = high > low ? (values[box] - low) / (high - low) : 0.5;
      const colour = Number.isFinite(share) ? colours[Math.min(Math.max(Math.round(share * last), 0), last)] : [168, 168, 168];
      bytes.set(colour, 4 * box);
      const isSeen = !(this.least > 0 && !(share >= this.least));
      bytes[4 * box + 3] = isSeen ? 255 : 0;
      if (isSeen) seen += 1;
    }
    this.canvas.dataset.particles = seen;
    this.colours = bytes;
    if (this.surface) this.surface.colour(bytes);
    this.paint();
  }

  // What has been seen of the soil, and what of the rigid bodies is close to it.
  inSight() {
    const low = [...this.extent.low];
    const high = [...this.extent.high];
    const beside = BESIDE * Math.max(...high.map((x, k) => x - low[k]));
    for (const points of [this.bodies.lines, this.bodies.triangles, this.bodies.members]) {
      points.forEach((x, k) => {
        const axis = k % 3;
        low[axis] = Math.min(low[axis], Math.max(x, this.extent.low[axis] - beside));
        high[axis] = Math.max(high[axis], Math.min(x, this.extent.high[axis] + beside));
      });
    }
    return { low, high };
  }

  layout() {
    return this.camera.layout(this.canvas.clientWidth, this.inSight());
  }

  // Once before the next picture of the screen, however often it is asked for.
  paint() {
    if (this.painting) return;
    this.painting = requestAnimationFrame(() => {
      this.painting = 0;
      if (this.colours && this.boxes.count > 0 && this.canvas.clientWidth > 0) this.paintNow();
    });
  }

  paintNow() {
    const { canvas, below, camera } = this;
    const place = this.layout();
    const sharp = window.devicePixelRatio || 1;
    for (const own of [canvas, below]) own.style.height = `${place.height}px`;
    canvas.width = Math.round(place.width * sharp);
    canvas.height = Math.round(place.height * sharp);
    const pen = canvas.getContext("2d");
    pen.scale(sharp, sharp);
    pen.save();
    if (this.dimension === 2) {
      const { room } = place;
      pen.beginPath();
      pen.rect(room.left, room.top, place.width - room.left - room.right, place.height - room.top - room.bottom);
      pen.clip();
    }
    if (this.surface) this.surface.paint(place, camera, this, sharp);
    else if (this.boxes.pieces) this.overlay.pieces(pen, place, this.colours);
    else paintBoxes(pen, place, this);
    this.outlines(pen, place);
    this.overlay.paint(pen, place);
    this.mark(pen, place);
    pen.restore();
    if (this.dimension === 2) this.axes.plane(pen, place);
    else this.axes.space(pen, place);
  }

  corner(name, box) {
    const numbers = this.boxes[name];
    return [numbers[3 * box], numbers[3 * box + 1], numbers[3 * box + 2]];
  }

  trace(pen, points) {
    pen.beginPath();
    points.forEach(([x, y], k) => (k === 0 ? pen.moveTo(x, y) : pen.lineTo(x, y)));
    pen.closePath();
  }

  // Rigid bodies of the plane: a line goes on from the one before it, or begins another body.
  outlines(pen, place) {
    const { lines } = this.bodies;
    pen.beginPath();
    for (let at = 0; at < lines.length; at += 6) {
      const [from, to] = [lines.slice(at, at + 3), lines.slice(at + 3, at + 6)];
      const goesOn = at > 0 && [0, 1, 2].every((k) => lines[at + k] === lines[at - 3 + k]);
      const [start, end] = [projected(place, this.camera, from), projected(place, this.camera, to)];
      if (!goesOn) pen.moveTo(start[0], start[1]);
      pen.lineTo(end[0], end[1]);
    }
    pen.fillStyle = cssColour("--line");
    pen.strokeStyle = cssColour("--soft");
    pen.lineWidth = 1.5;
    pen.fill();
    pen.stroke();
  }

  mark(pen, place) {
    if (this.marked < 0 || this.marked >= this.boxes.count) return;
    pen.strokeStyle = cssColour("--cursor");
    pen.lineWidth = 2;
    if (this.boxes.pieces) {
      this.overlay.markPiece(pen, place, this.marked);
      return;
    }
    const corners = cornersOf(this.boxes, this.marked);
    for (let face = 0; face < 6; face += 1) {
      if ((2 * (face % 2) - 1) * place.eye[Math.floor(face / 2)] <= 1e-6) continue;
      this.trace(pen, aroundFace(face).map((corner) => projected(place, this.camera, corners[corner])));
      pen.stroke();
    }
  }

  centre(box) {
    const [low, high] = [this.corner("low", box), this.corner("high", box)];
    return low.map((x, k) => 0.5 * (x + high[k]));
  }

  // The box that is seen at a point of the canvas, and -1 where there is none. Where boxes of the plane overlap
  // it is the one whose centre is nearest.
  boxAt(x, y) {
    const place = this.layout();
    const from = lifted(place, this.camera, x, y);
    if (this.dimension === 2) return this.holding(from);
    const { low, high, count } = this.boxes;
    let [least, most] = [-Infinity, Infinity];
    if (this.cut) {
      // Along the way to the eye, up to the cut or from it.
      const [speed, room] = [dot(this.cut.normal, place.eye), this.cut.offset - dot(this.cut.normal, from)];
      if (speed > 1e-9) most = room / speed;
      else if (speed < -1e-9) least = room / speed;
      else if (room < 0) return -1;
    }
    let [best, nearest] = [-1, -Infinity];
    for (let box = 0; box < count; box += 1) {
      if (this.isLeftOut(box)) continue;
      let [enter, leave] = [least, most];
      for (let k = 0; k < 3 && enter < leave; k += 1) {
        const [a, b] = [low[3 * box + k] - from[k], high[3 * box + k] - from[k]];
        if (Math.abs(place.eye[k]) < 1e-9) {
          if (a > 0 || b < 0) leave = -Infinity;
          continue;
        }
        const ends = [a / place.eye[k], b / place.eye[k]];
        enter = Math.max(enter, Math.min(...ends));
        leave = Math.min(leave, Math.max(...ends));
      }
      if (enter < leave && leave > nearest) [best, nearest] = [box, leave];
    }
    return best;
  }

  // The box of the piece that is drawn last over a point of the plane, or the box that holds it.
  holding([x, y]) {
    if (this.boxes.pieces) return this.overlay.pieceAt(x, y);
    const { low, high, count } = this.boxes;
    let [best, nearest] = [-1, Infinity];
    for (let box = 0; box < count; box += 1) {
      const at = 3 * box;
      if (x < low[at] || x > high[at] || y < low[at + 1] || y > high[at + 1]) continue;
      const distance = Math.hypot(0.5 * (low[at] + high[at]) - x, 0.5 * (low[at + 1] + high[at + 1]) - y);
      if (distance < nearest) [best, nearest] = [box, distance];
    }
    return best;
  }

  // Zooms about a point of the canvas, or about the middle.
  zoom(factor, about) {
    const { camera } = this;
    const before = this.layout();
    camera.zoom = Math.min(Math.max(camera.zoom * factor, this.dimension === 2 ? 1 : 0.5), 200);
    const after = this.layout();
    const [x, y] = about || before.middle;
    const from = [x - before.middle[0], before.middle[1] - y];
    camera.pan = camera.pan.map((own, k) => own + from[k] / before.scale - from[k] / after.scale);
    if (this.dimension === 2 && camera.zoom === 1) camera.pan = [0, 0];
    this.paint();
  }

  move(dx, dy) {
    const { camera } = this;
    const { scale } = this.layout();
    if (this.dimension === 3 || camera.zoom > 1) camera.pan = [camera.pan[0] - dx / scale, camera.pan[1] + dy / scale];
    this.paint();
  }

  rotate(turn, raise) {
    this.camera.rotate(turn, raise);
    this.paint();
  }

  look(name) {
    this.camera.look(name);
    this.paint();
  }

  whole() {
    this.camera.reset();
    this.paint();
  }
}
