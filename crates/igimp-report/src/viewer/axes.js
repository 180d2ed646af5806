// Axes in metres: the frame of the plane, and edges around a body in space.

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

// A tick with as many digits as the step between ticks asks for; very small and large ones by the same power of ten.
function tickText(tick, ticks) {
  const step = ticks.length > 1 ? Math.abs(ticks[1] - ticks[0]) : Math.abs(tick);
  const largest = Math.max(...ticks.map(Math.abs));
  if (!(step > 0)) return short(tick);
  const power = largest >= 1e6 || largest < 2e-3 ? Math.floor(Math.log10(largest) + 1e-9) : 0;
  const digits = Math.min(Math.max(power - Math.floor(Math.log10(step) + 1e-9), 0), 6);
  const text = (tick / 10 ** power).toFixed(digits).replace("-", "−");
  return power === 0 || tick === 0 ? text.replace(/^−?0\.0+$/, "0") : `${text}·10${raised(power)}`;
}

// A whole number as a raised one.
function raised(power) {
  return [...String(power)].map((sign) => (sign === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(sign)])).join("");
}

// The same range, or one of visible width about it where the values are equal but for rounding.
function widened(low, high) {
  const size = Math.max(Math.abs(low), Math.abs(high));
  if (high - low > 1e-9 * size) return [low, high];
  const half = size > 0 ? 0.1 * size : 1;
  return [low - half, high + half];
}

class Axes {
  constructor(scene) {
    this.scene = scene;
  }

  pencil(pen) {
    pen.strokeStyle = cssColour("--line");
    pen.fillStyle = cssColour("--soft");
    pen.font = "11px system-ui, sans-serif";
    pen.lineWidth = 1;
  }

  // The frame of the plane.
  plane(pen, place) {
    this.pencil(pen);
    const { room } = place;
    const right = place.width - room.right;
    const bottom = place.height - room.bottom;
    pen.strokeRect(room.left, room.top, right - room.left, bottom - room.top);
    pen.textAlign = "center";
    const [from, to] = [[room.left, bottom], [right, room.top]].map(([x, y]) => lifted(place, this.scene.camera, x, y));
    const xTicks = ticksOf(from[0], to[0], Math.max((right - room.left) / 80, 2));
    for (const x of xTicks) {
      const [at] = projected(place, this.scene.camera, [x, 0, 0]);
      const isLast = x === xTicks[xTicks.length - 1];
      pen.fillText(`${tickText(x, xTicks)}${isLast ? " m" : ""}`, Math.min(at, right - 10), bottom + 15);
      pen.fillRect(at, bottom, 1, 4);
    }
    pen.textAlign = "right";
    const yTicks = ticksOf(from[1], to[1], Math.max((bottom - room.top) / 50, 2));
    for (const y of yTicks) {
      const [, at] = projected(place, this.scene.camera, [0, y, 0]);
      pen.fillText(tickText(y, yTicks), room.left - 7, Math.max(at + 4, 12));
      pen.fillRect(room.left - 4, at, 4, 1);
    }
  }

  // The axes of space: along the edge of the body's surrounding box that lies outermost, with ticks.
  space(pen, place) {
    this.pencil(pen);
    const { low, high } = this.scene.inSight();
    const see = (point) => projected(place, this.scene.camera, point);
    const middle = see(place.centre);
    for (let axis = 0; axis < 3; axis += 1) {
      const [one, two] = [(axis + 1) % 3, (axis + 2) % 3];
      const edges = [0, 1, 2, 3].map((k) => {
        const from = [0, 0, 0];
        from[one] = k % 2 ? high[one] : low[one];
        from[two] = k > 1 ? high[two] : low[two];
        const to = [...from];
        [from[axis], to[axis]] = [low[axis], high[axis]];
        return { from, to, start: see(from), end: see(to) };
      });
      const along = [0, 1].map((k) => edges[0].end[k] - edges[0].start[k]);
      const length = Math.hypot(...along);
      if (length < 36) continue;
      // Level axes below the body, the upright one to its left.
      const outwards = [along[1] / length, -along[0] / length];
      const isUpright = Math.abs(along[1]) > 2 * Math.abs(along[0]);
      const sense = isUpright ? -Math.sign(outwards[0]) : Math.sign(outwards[1]) || 1;
      const out = outwards.map((x) => sense * x);
      const far = ({ start, end }) => [0, 1].reduce((sum, k) => sum + out[k] * (start[k] + end[k] - 2 * middle[k]), 0);
      const edge = edges.reduce((best, own) => (far(own) > far(best) + 1e-6 ? own : best));
      const at = (x) => [0, 1].map((k) => edge.start[k] + ((x - low[axis]) / (high[axis] - low[axis])) * along[k] + 6 * out[k]);
      const text = (words, [x, y], by) => {
        pen.textAlign = out[0] < -0.35 ? "right" : out[0] > 0.35 ? "left" : "center";
        pen.fillText(words, x + by * out[0], y + by * out[1] + 4);
      };
      const line = (from, to) => {
        pen.beginPath();
        pen.moveTo(...from);
        pen.lineTo(...to);
        pen.stroke();
      };
      pen.strokeStyle = cssColour("--soft");
      line(at(low[axis]), at(high[axis]));
      const ticks = ticksOf(low[axis], high[axis], Math.max(length / 70, 2));
      for (const x of ticks) {
        const place2 = at(x);
        line(place2, [0, 1].map((k) => place2[k] + 4 * out[k]));
        text(tickText(x, ticks), place2, 9);
      }
      pen.font = "600 12px system-ui, sans-serif";
      const share = ticks.length > 1 ? 0.5 * (ticks[Math.ceil(ticks.length / 2) - 1] + ticks[Math.ceil(ticks.length / 2)]) : 0.5 * (low[axis] + high[axis]);
      text(`${"xyz"[axis]} [m]`, at(share), 20);
      pen.font = "11px system-ui, sans-serif";
    }
  }
}
