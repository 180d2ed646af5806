// A section drawn by hand, in the plane or on the face of a cut in space: values along it, as a curve and as a table.

// Places along a section.
const PLACES = 200;

// Reach of a particle in a mean along a section, in half the diagonals of its box.
const REACH = 1.6;

// The boxes that may count along a line: the particles around its places, by how far these reach.
function boxesAlong({ low, high, count }, [from, to], dimension) {
  const axes = [0, 1, 2].slice(0, dimension);
  const found = [];
  for (let box = 0; box < count; box += 1) {
    const at = 3 * box;
    const reach = REACH * 0.5 * Math.hypot(...axes.map((k) => high[at + k] - low[at + k]));
    const centre = axes.map((k) => 0.5 * (low[at + k] + high[at + k]));
    const isBeside = axes.some((k) => centre[k] < Math.min(from[k], to[k]) - reach || centre[k] > Math.max(from[k], to[k]) + reach);
    if (!isBeside) found.push({ box, reach, centre });
  }
  return found;
}

// The mean of the particles around a point, the nearer the heavier.
function meanAround(around, values, at) {
  let [sum, weights] = [0, 0];
  for (const { box, reach, centre } of around) {
    const off = Math.hypot(...centre.map((x, k) => x - at[k])) / reach;
    if (!(off < 1) || !Number.isFinite(values[box])) continue;
    const weight = (1 - off) ** 2;
    sum += weight * values[box];
    weights += weight;
  }
  return weights > 0 ? sum / weights : NaN;
}

// Values along a line at equal distances: of the field whose contours are drawn where there are pieces, else means of the
// particles around, or the particle's where there is one alone; none outside the bodies.
function alongSection(scene, values, [from, to]) {
  const { boxes, bodies: { soil }, dimension } = scene;
  const { pieces, low, high } = boxes;
  const field = pieces ? fieldOver(pieces, values, scene.centres(), soil) : null;
  const axes = from.map((_, k) => k);
  const length = Math.hypot(...axes.map((k) => to[k] - from[k]));
  const around = field ? [] : boxesAlong(boxes, [from, to], dimension);
  const holding = (at) => around.find(({ box }) => axes.every((k) => low[3 * box + k] <= at[k] && at[k] <= high[3 * box + k]));
  return Array.from({ length: PLACES + 1 }, (_, k) => {
    const share = k / PLACES;
    const at = axes.map((axis) => from[axis] + share * (to[axis] - from[axis]));
    if (field) {
      const piece = scene.overlay.pieceOver(...at);
      return [share * length, piece < 0 ? NaN : field(piece, ...at), ...at];
    }
    const own = holding(at);
    const mean = own ? meanAround(around, values, at) : NaN;
    return [share * length, own && Number.isNaN(mean) ? values[own.box] : mean, ...at];
  });
}

// A curve with its axes, as the lines of an SVG.
function sectionCurve(svg, rows, labels, divide) {
  const [width, height, left, right, top, bottom] = [460, 220, 60, 450, 10, 175];
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.replaceChildren();
  const points = rows.map(([s, value]) => [s, value / divide]);
  const own = points.map((point) => point[1]).filter(Number.isFinite);
  if (own.length === 0) return;
  const [xs, ys] = [[0, rows[rows.length - 1][0]], widened(Math.min(...own), Math.max(...own))];
  const x = (s) => left + ((right - left) * (s - xs[0])) / (xs[1] - xs[0]);
  const y = (value) => bottom - ((bottom - top) * (value - ys[0])) / (ys[1] - ys[0]);
  const add = (name, attributes, text) => {
    const element = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    if (text !== undefined) element.textContent = text;
    svg.append(element);
  };
  add("rect", { class: "axis", x: left, y: top, width: right - left, height: bottom - top });
  const [xTicks, yTicks] = [ticksOf(...xs, 6), ticksOf(...ys, 5)];
  for (const tick of xTicks) add("text", { x: x(tick), y: bottom + 15, "text-anchor": "middle" }, tickText(tick, xTicks));
  for (const tick of yTicks) add("text", { x: left - 5, y: y(tick) + 4, "text-anchor": "end" }, tickText(tick, yTicks));
  add("text", { x: (left + right) / 2, y: height - 8, "text-anchor": "middle" }, labels[0]);
  // A gap where the line leaves the bodies.
  let run = [];
  const flush = () => {
    if (run.length > 1) add("polyline", { class: "curve", points: run.join(" ") });
    run = [];
  };
  for (const [s, value] of points) {
    if (Number.isFinite(value)) run.push(`${x(s).toFixed(2)},${y(value).toFixed(2)}`);
    else flush();
  }
  flush();
}

// The values of a section as a table with SI units.
function sectionTable(rows, header) {
  const lines = rows.filter((row) => Number.isFinite(row[1])).map(([s, value, ...at]) => [s, ...at, value].map((own) => own.toExponential(6)).join(","));
  const places = ["x_[m]", "y_[m]", "z_[m]"].slice(0, rows[0].length - 2);
  return [`distance_[m],${places.join(",")},"${header.replaceAll('"', '""')}"`, ...lines, ""].join("\n");
}

// The section of a viewer: drawn with the pointer once its button was pressed, told of in every frame.
class SectionTool {
  constructor(viewer) {
    this.viewer = viewer;
    this.from = null;
    this.along = [];
    const { part } = viewer;
    this.button = part["draw-section"];
    this.button.addEventListener("click", () => this.press(!this.isOn()));
    const drawing = part.canvas.parentElement;
    const on = (name, call) => drawing.addEventListener(name, call.bind(this), { capture: true });
    on("pointerdown", this.begin);
    on("pointermove", this.move);
    on("pointerup", this.end);
    part["section-end"].addEventListener("click", () => this.lay(null));
    part["section-table"].addEventListener("click", () => this.keepTable());
  }

  press(isOn) {
    this.button.setAttribute("aria-pressed", String(isOn));
  }

  isOn() {
    return this.button.getAttribute("aria-pressed") === "true";
  }

  // The place of the pointer [m], in space on the face of the cut; the event goes no further.
  place(event) {
    event.stopPropagation();
    event.preventDefault();
    const { part, scene } = this.viewer;
    const box = part.canvas.getBoundingClientRect();
    const layout = scene.layout();
    const at = lifted(layout, scene.camera, event.clientX - box.left, event.clientY - box.top);
    if (scene.dimension === 2) return at.slice(0, 2);
    const { normal, offset } = scene.cut;
    const way = (offset - dot(normal, at)) / dot(normal, layout.eye);
    return at.map((x, k) => x + way * layout.eye[k]);
  }

  // Whether there is a plane to draw on that is not seen from its edge.
  hasPlane() {
    const { dimension, cut } = this.viewer.scene;
    return dimension === 2 || (cut !== null && Math.abs(dot(cut.normal, this.viewer.scene.layout().eye)) > 0.05);
  }

  begin(event) {
    const { canvas } = this.viewer.part;
    if (!this.isOn() || event.target !== canvas || !this.hasPlane()) return;
    this.from = this.place(event);
  }

  move(event) {
    if (this.from) this.lay([this.from, this.place(event)]);
  }

  end(event) {
    if (!this.from) return;
    this.lay([this.from, this.place(event)]);
    this.from = null;
    this.press(false);
  }

  // Takes a section up, or away.
  lay(section) {
    const { scene } = this.viewer;
    const isLine = section && Math.hypot(...section[0].map((x, k) => section[1][k] - x)) > 0;
    scene.overlay.section = isLine ? section : null;
    this.tell();
    scene.paint();
  }

  // The curve in the frame that is shown.
  tell() {
    const { part, scene, wish, field, values, shownEntry } = this.viewer;
    this.button.hidden = scene.dimension === 3 && !scene.cut;
    if (wish.section && wish.section.length === 2 * scene.dimension) {
      scene.overlay.section = [wish.section.slice(0, scene.dimension), wish.section.slice(scene.dimension)];
      wish.section = null;
    }
    const { section } = scene.overlay;
    part.section.hidden = !section;
    if (!section) return;
    this.along = alongSection(scene, values, section);
    const largest = this.along.reduce((most, row) => (Math.abs(row[1]) > most ? Math.abs(row[1]) : most), 0);
    const [divide, unit] = unitFor(field.unit, largest);
    sectionCurve(part["section-curve"], this.along, ["distance from A to B [m]"], divide);
    const [from, to] = section.map((point) => `(${point.map(short).join(", ")})`);
    part["section-told"].textContent = `${field.title}${unit ? ` [${unit}]` : ""}${field.rest} along A–B, from ${from} to ${to} m; ${shownEntry.label}`;
    const inside = this.along.filter((row) => Number.isFinite(row[1]));
    const [first, last] = [inside[0], inside[inside.length - 1]].map((row) => (row ? row[1] : ""));
    Object.assign(part.section.dataset, { places: inside.length, first, last });
  }

  keepTable() {
    const { field } = this.viewer;
    const header = `${field.title}${field.unit ? `_[${field.unit}]` : ""}`.replaceAll(" ", "_");
    keep(new Blob([sectionTable(this.along, header)], { type: "text/csv" }), nameOf(this.viewer, "csv"));
  }
}
