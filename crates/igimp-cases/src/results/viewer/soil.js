// The body on a canvas: cells in the colour of their value, rigid bodies, axes in metres, zoom, and the cell under a point.

// Of rigid bodies so much is in sight beside the soil, as a share of its larger side.
const BESIDE = 0.12;

const MARGIN = { left: 46, right: 8, top: 8, bottom: 26 };

function cssColour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

// Steps of 1, 2 or 5 times a power of ten, about so many in a range.
function ticksOf(low, high, about) {
  const raw = (high - low) / about;
  if (!(raw > 0)) return [];
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * [1, 2, 5, 10].find((factor) => factor * power >= raw);
  const ticks = [];
  for (let k = Math.ceil(low / step); k * step <= high; k += 1) ticks.push(Number((k * step).toPrecision(12)));
  return ticks;
}

class Soil {
  constructor(canvas) {
    this.canvas = canvas;
    this.corner = new Float64Array(0);
    this.lines = [];
    this.values = new Float64Array(0);
    this.range = [0, 1];
    this.colours = [];
    // What has been seen of the body, and what is in sight.
    this.extent = [Infinity, Infinity, -Infinity, -Infinity];
    this.sight = null;
    this.marked = -1;
    this.painting = 0;
  }

  show(corner, values, range, colours) {
    Object.assign(this, { corner, values, range, colours });
    const seen = this.extent;
    for (let k = 0; k < corner.length; k += 2) {
      seen[0] = Math.min(seen[0], corner[k]);
      seen[1] = Math.min(seen[1], corner[k + 1]);
      seen[2] = Math.max(seen[2], corner[k]);
      seen[3] = Math.max(seen[3], corner[k + 1]);
    }
    this.paint();
  }

  // What has been seen of the soil, and what of the rigid bodies is close to it.
  withBodies() {
    const [x0, y0, x1, y1] = this.extent;
    const [low, high] = [[x0, y0], [x1, y1]];
    const beside = BESIDE * Math.max(x1 - x0, y1 - y0);
    this.lines.forEach((value, k) => {
      const axis = k % 2;
      const [least, most] = axis === 0 ? [x0, x1] : [y0, y1];
      low[axis] = Math.min(low[axis], Math.max(value, least - beside));
      high[axis] = Math.max(high[axis], Math.min(value, most + beside));
    });
    return [...low, ...high];
  }

  // Size in CSS pixels, and the scale that brings what is in sight into it.
  layout() {
    const [x0, y0, x1, y1] = this.withBodies();
    const width = this.canvas.clientWidth;
    const inner = Math.max(width - MARGIN.left - MARGIN.right, 50);
    const tall = (inner * (y1 - y0)) / (x1 - x0);
    const height = Math.round(Math.min(Math.max(tall, 120), 0.68 * window.innerHeight)) + MARGIN.top + MARGIN.bottom;
    const high = height - MARGIN.top - MARGIN.bottom;
    const fit = Math.min(inner / (x1 - x0), high / (y1 - y0));
    const sight = this.sight || { x: (x0 + x1) / 2, y: (y0 + y1) / 2, zoom: 1 };
    const scale = fit * sight.zoom;
    return {
      width, height, scale, sight,
      left: MARGIN.left + inner / 2 - sight.x * scale,
      top: MARGIN.top + high / 2 + sight.y * scale,
    };
  }

  // Once before the next picture of the screen, however often it is asked for.
  paint() {
    if (this.painting) return;
    this.painting = requestAnimationFrame(() => {
      this.painting = 0;
      if (this.corner.length > 0 && this.canvas.clientWidth > 0) this.paintNow();
    });
  }

  paintNow() {
    const place = this.layout();
    const sharp = window.devicePixelRatio || 1;
    this.canvas.style.height = `${place.height}px`;
    this.canvas.width = Math.round(place.width * sharp);
    this.canvas.height = Math.round(place.height * sharp);
    const pen = this.canvas.getContext("2d");
    pen.scale(sharp, sharp);
    pen.save();
    pen.beginPath();
    pen.rect(MARGIN.left, MARGIN.top, place.width - MARGIN.left - MARGIN.right, place.height - MARGIN.top - MARGIN.bottom);
    pen.clip();
    this.cells(pen, place);
    this.bodies(pen, place);
    pen.restore();
    this.axes(pen, place);
  }

  trace(pen, place, cell) {
    for (let k = 0; k < 4; k += 1) {
      const x = place.left + place.scale * this.corner[8 * cell + 2 * k];
      const y = place.top - place.scale * this.corner[8 * cell + 2 * k + 1];
      if (k === 0) pen.moveTo(x, y);
      else pen.lineTo(x, y);
    }
    pen.closePath();
  }

  // Fills a cell and a little more, over the seams that smooth edges leave between neighbours. Each by
  // itself: a path of many cells takes browsers very long.
  fill(pen, place, cell) {
    const [c, at] = [this.corner, 8 * cell];
    if (c[at] === c[at + 6] && c[at + 1] === c[at + 3] && c[at + 2] === c[at + 4] && c[at + 5] === c[at + 7]) {
      const [x, y] = [place.left + place.scale * c[at], place.top - place.scale * c[at + 5]];
      pen.fillRect(x - 0.35, y - 0.35, place.scale * (c[at + 2] - c[at]) + 0.7, place.scale * (c[at + 5] - c[at + 1]) + 0.7);
      return;
    }
    pen.beginPath();
    this.trace(pen, place, cell);
    pen.fill();
    pen.stroke();
  }

  cells(pen, place) {
    const last = this.colours.length - 1;
    const [low, high] = this.range;
    const levels = Array.from({ length: last + 2 }, () => []);
    for (let cell = 0; cell < this.values.length; cell += 1) {
      const share = high > low ? (this.values[cell] - low) / (high - low) : 0.5;
      const level = Number.isFinite(share) ? Math.min(Math.max(Math.round(share * last), 0), last) : last + 1;
      levels[level].push(cell);
    }
    pen.lineWidth = 0.7;
    levels.forEach((own, level) => {
      if (own.length === 0) return;
      pen.fillStyle = this.colours[level] || "#a8a8a8";
      pen.strokeStyle = pen.fillStyle;
      for (const cell of own) this.fill(pen, place, cell);
    });
    if (this.marked >= 0) {
      pen.strokeStyle = cssColour("--cursor");
      pen.lineWidth = 2;
      pen.beginPath();
      this.trace(pen, place, this.marked);
      pen.stroke();
    }
  }

  // Rigid bodies: a line goes on from the one before it, or begins another body.
  bodies(pen, place) {
    const { lines } = this;
    pen.beginPath();
    for (let at = 0; at < lines.length; at += 4) {
      const [x0, y0, x1, y1] = [0, 1, 2, 3].map((k) => (k % 2 === 0 ? place.left + place.scale * lines[at + k] : place.top - place.scale * lines[at + k]));
      const goesOn = at > 0 && lines[at] === lines[at - 2] && lines[at + 1] === lines[at - 1];
      if (!goesOn) pen.moveTo(x0, y0);
      pen.lineTo(x1, y1);
    }
    this.canvas.dataset.lines = lines.length / 4;
    pen.fillStyle = cssColour("--line");
    pen.strokeStyle = cssColour("--soft");
    pen.lineWidth = 1.5;
    pen.fill();
    pen.stroke();
  }

  axes(pen, place) {
    const right = place.width - MARGIN.right;
    const bottom = place.height - MARGIN.bottom;
    pen.strokeStyle = cssColour("--line");
    pen.fillStyle = cssColour("--soft");
    pen.font = "11px system-ui, sans-serif";
    pen.lineWidth = 1;
    pen.strokeRect(MARGIN.left, MARGIN.top, right - MARGIN.left, bottom - MARGIN.top);
    pen.textAlign = "center";
    const xs = [MARGIN.left, right].map((x) => (x - place.left) / place.scale);
    for (const x of ticksOf(...xs, Math.max((right - MARGIN.left) / 80, 2))) {
      const at = place.left + x * place.scale;
      pen.fillText(`${short(x)}${at > right - 50 ? " m" : ""}`, Math.min(at, right - 10), bottom + 15);
      pen.fillRect(at, bottom, 1, 4);
    }
    pen.textAlign = "right";
    const ys = [bottom, MARGIN.top].map((y) => (place.top - y) / place.scale);
    for (const y of ticksOf(...ys, Math.max((bottom - MARGIN.top) / 50, 2))) {
      const at = place.top - y * place.scale;
      pen.fillText(short(y), MARGIN.left - 7, Math.max(at + 4, 12));
      pen.fillRect(MARGIN.left - 4, at, 4, 1);
    }
  }

  // The place under a point of the canvas [m].
  placeAt(x, y) {
    const place = this.layout();
    return [(x - place.left) / place.scale, (place.top - y) / place.scale];
  }

  centre(cell) {
    const of = (axis) => [0, 1, 2, 3].reduce((sum, k) => sum + this.corner[8 * cell + 2 * k + axis], 0) / 4;
    return [of(0), of(1)];
  }

  // The cell that holds a place; of several the one whose centre is nearest, and -1 where there is none.
  cellAt(x, y) {
    let [best, nearest] = [-1, Infinity];
    const c = this.corner;
    for (let at = 0; at < c.length; at += 8) {
      let inside = true;
      let turn = 0;
      for (let k = 0; k < 4 && inside; k += 1) {
        const [a, b] = [at + 2 * k, at + 2 * ((k + 1) % 4)];
        const cross = (c[b] - c[a]) * (y - c[a + 1]) - (c[b + 1] - c[a + 1]) * (x - c[a]);
        inside = cross * turn >= 0;
        turn = turn || Math.sign(cross);
      }
      if (!inside) continue;
      const [cx, cy] = this.centre(at / 8);
      const distance = Math.hypot(cx - x, cy - y);
      if (distance < nearest) [best, nearest] = [at / 8, distance];
    }
    return best;
  }

  // Zooms about a place, or back to the whole.
  zoom(factor, about) {
    const { sight } = this.layout();
    const zoom = Math.min(Math.max(sight.zoom * factor, 1), 200);
    const [x, y] = about || [sight.x, sight.y];
    const kept = sight.zoom / zoom;
    this.sight = zoom === 1 ? null : { zoom, x: x + (sight.x - x) * kept, y: y + (sight.y - y) * kept };
    this.paint();
  }

  move(dx, dy) {
    const { sight, scale } = this.layout();
    if (sight.zoom > 1) this.sight = { ...sight, x: sight.x - dx / scale, y: sight.y + dy / scale };
    this.paint();
  }

  whole() {
    this.sight = null;
    this.paint();
  }
}
